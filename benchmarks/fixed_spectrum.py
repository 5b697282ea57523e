"""How long does a certified fixed spectrum take, beside its peers and its floor?"""

from __future__ import annotations

import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from benchmarks import peers
from benchmarks.measure import interleaved, processor_seconds
from mcexact import analyze, checker
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.protocol import Answer, encode
from mcexact.checker.kinds import check_document
from mcexact.cli import verified
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import system_with_fixed_mode
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    question : str
    ratio : float
        The first median over the second, or a time in seconds where ``unit`` says so.
    limit : str
        What was asked for.
    holds : bool
    detail : str
    unit : str
    """

    question: str
    ratio: float
    limit: str
    holds: bool
    detail: str
    unit: str = "x"


def dense(n: int, digits: int = 1, seed: int = 1) -> tuple[Matrix, list[Matrix], list[Matrix]]:
    """Integer entries of so many digits, n/2 channels of one input and one output."""
    rng, most = random.Random(seed), 10**digits - 1

    def matrix(rows: int, cols: int) -> Matrix:
        return Matrix.from_integers(
            [[rng.randint(-most, most) for _ in range(cols)] for _ in range(rows)], ncols=cols
        )

    m = n // 2
    return matrix(n, n), [matrix(n, 1) for _ in range(m)], [matrix(1, n) for _ in range(m)]


def fresh(parts: tuple[Matrix, list[Matrix], list[Matrix]]) -> MultiChannelSystem:
    """A system, with matrices, that nothing has been computed of yet."""
    A, B, C = (
        Matrix.from_integers(parts[0].numerators),
        [Matrix.from_integers(b.numerators) for b in parts[1]],
        [Matrix.from_integers(c.numerators) for c in parts[2]],
    )
    return MultiChannelSystem(A, B, C)


def certified(system: MultiChannelSystem) -> FixedSpectrum:
    """The fixed spectrum, its certificate written out."""
    found = fixed_spectrum(system)
    encode(found)
    return found


def absence_rows(n: int, digits: int) -> Iterator[Row]:
    """A dense system without fixed modes: the answer alone, and with its text, against numpy."""
    parts = dense(n, digits)
    A, B, C, widths = peers.arrays(fresh(parts))
    pool = iter([fresh(parts) for _ in range(14)])
    times = interleaved(
        {
            "found": lambda: fixed_spectrum(next(pool)),
            "written": lambda: certified(next(pool)),
            "numpy": lambda: peers.heuristic(A, B, C, widths, seed=1),
        },
    )
    for what, limit in (("found", 0.15), ("written", 0.6 if n == 200 else 0.5)):
        ratio = times[what].median / times["numpy"].median
        yield Row(
            f"no fixed mode, n={n}, m={n // 2}, entries of {digits} digits, {what}, against numpy",
            ratio,
            f"<= {limit:g}",
            ratio <= limit,
            f"{times[what].median:.4f} s / {times['numpy'].median:.4f} s",
        )


def checked_rows(n: int, limit: float) -> Iterator[Row]:
    """The certificate of such a system, checked by the copied-out checker."""
    seconds, line = copied_out(encode(fixed_spectrum(fresh(dense(n)))))
    yield Row(
        f"no fixed mode, n={n}, m={n // 2}, checked",
        seconds,
        f"<= {limit:g} s",
        seconds <= limit and line.startswith("VALID"),
        line[:60],
        unit="s",
    )


def planted_rows() -> Iterator[Row]:
    """A planted mode at n=16, against two rigorous enumerations of all subsets."""
    for m, limit in ((10, 10), (12, 40), (16, 800)):
        drawn = system_with_fixed_mode(SeededChoices(m), states=16, channels=m)
        system = drawn.system
        parts = (system.A, [c.B for c in system.channels], [c.C for c in system.channels])
        expected = {f.polynomial: f.rank for f in fixed_spectrum(fresh(parts)).factors}
        for name, peer in (
            ("the enumeration of pencils", peers.pencil_enumeration),
            ("the enumeration after one elimination", peers.reduced_enumeration),
        ):
            pool = iter([fresh(parts) for _ in range(20)])
            found: list[peers.Found] = []
            times = interleaved(
                {
                    "ours": lambda pool=pool: certified(next(pool)),  # type: ignore[misc]
                    "peer": lambda run=peer, s=system, found=found: found.append(run(s, 1)),  # type: ignore[misc]
                },
                runs=3 if m < 16 else 1,
                warmup=1 if m < 16 else 0,
            )
            if any(each != expected for each in found):
                raise ArithmeticError(f"{name} finds {found[0]}, not {expected}")
            ratio = times["peer"].median / times["ours"].median
            described = name == "the enumeration of pencils"
            yield Row(
                f"planted mode, n=16, m={m}: how many times faster than {name}",
                ratio,
                f">= {limit}" if described else "reported",
                ratio >= limit if described else True,
                f"{times['peer'].median:.3f} s / {times['ours'].median:.4f} s",
            )


def large_rows() -> Iterator[Row]:
    """A planted mode at n=80, m=40: found and certified, and checked by the copied-out checker."""
    for degree in (1, 3):
        system = system_with_fixed_mode(
            SeededChoices(degree), states=80, channels=40, degree=degree
        ).system
        start = processor_seconds()
        found = fixed_spectrum(system)
        text = encode(found)
        seconds = processor_seconds() - start
        yield Row(
            f"planted mode of degree {degree}, n=80, m=40, found and certified",
            seconds,
            "<= 3 s",
            seconds <= 3 and not found.empty,
            f"certificate of {len(text)} bytes",
            unit="s",
        )
        seconds, line = copied_out(text)
        yield Row(
            f"planted mode of degree {degree}, n=80, m=40, checked",
            seconds,
            "<= 30 s",
            seconds <= 30 and line.startswith("VALID"),
            line[:60],
            unit="s",
        )


def high_degree_rows() -> Iterator[Row]:
    """A fixed factor of degree 30 at n=60: all questions, in seconds of the processor."""
    for seed, channels in ((1, 10), (3, 4), (6, 20)):
        system = system_with_fixed_mode(
            SeededChoices(seed), states=60, channels=channels, degree=30
        ).system
        start = processor_seconds()
        found = analyze(system)
        found.decided()
        seconds = processor_seconds() - start
        degrees = sorted(each.polynomial.degree for each in found.fixed_spectrum.factors)
        yield Row(
            f"a fixed factor of degree 30, n=60, m={channels}, analyzed",
            seconds,
            "<= 4 s",
            seconds <= 4 and 30 in degrees,
            f"factors of degree {', '.join(map(str, degrees))}",
            unit="s",
        )


def copied_out(text: str) -> tuple[float, str]:
    """Check a certificate with a copy of the checker's folder, in a process of its own."""
    with tempfile.TemporaryDirectory() as folder:
        shutil.copytree(Path(checker.__file__).parent, Path(folder) / "checker")
        path = Path(folder) / "certificate.json"
        path.write_text(text, encoding="ascii")
        start = processor_seconds()
        done = subprocess.run(
            [sys.executable, "-S", "-E", "-m", "checker", str(path)],
            cwd=folder,
            capture_output=True,
            text=True,
            check=False,
        )
        line = done.stdout[done.stdout.find("VALID") :] if done.returncode == 0 else done.stdout
        return processor_seconds() - start, line


def without_fixed_mode(n: int) -> MultiChannelSystem:
    """A dense plant of n // 2 channels."""
    return fresh(dense(n))


def planted(n: int) -> MultiChannelSystem:
    """A plant with a fixed mode, which is proved by gains."""
    return system_with_fixed_mode(SeededChoices(n), states=n, channels=max(n // 4, 2)).system


def second_rows(
    plant: str,
    make: Callable[[], MultiChannelSystem],
    question: Callable[[MultiChannelSystem], Answer] = fixed_spectrum,
) -> Iterator[Row]:
    """A certificate checked by mcexact-verified and by the checker, both with start and reading."""
    program = verified.program()
    if program is None:
        raise LookupError("needs the program mcexact-verified: make verified")
    system = make()
    n = system.n
    text = encode(question(system))
    lines: list[str] = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "certificate.json"
        path.write_text(text, "ascii")

        # The first run of each is not counted: it leaves the checker compiled.
        compiled = os.environ | {"PYTHONPYCACHEPREFIX": folder, "PYTHONDONTWRITEBYTECODE": ""}

        def run(*call: str) -> None:
            done = subprocess.run(
                [*call, str(path)], capture_output=True, text=True, check=False, env=compiled
            )
            lines.append(done.stdout)

        times = interleaved(
            {
                "first": lambda: run(sys.executable, "-m", "mcexact.checker"),
                "inside": lambda: check_document(text.encode("ascii")),
                "second": lambda: run(program),
            },
            runs=5 if n < 500 else 3,
        )
    first, inside, other = (times[name].median for name in ("first", "inside", "second"))
    least = 1.0 if n <= 100 else 0.25
    yield Row(
        f"{plant}, n={n}, m={system.m}: how many times faster mcexact-verified is",
        first / other,
        f">= {least:g}",
        first >= least * other and all(x.startswith(("VALID", "CONFIRMED")) for x in lines),
        f"{first:.4f} s ({inside:.4f} s without the start of Python) / {other:.4f} s",
    )


def completeness_rows() -> Iterator[Row]:
    """Completeness with its certificate, against the fixed spectrum of the same system."""
    rng = random.Random(5)
    n, m = 100, 20

    def matrix(rows: int, cols: int) -> Matrix:
        return Matrix.from_integers(
            [[rng.randint(-9, 9) for _ in range(cols)] for _ in range(rows)], ncols=cols
        )

    parts = (
        matrix(n, n),
        [matrix(n, 1) for _ in range(m)],
        [matrix(1, n) for _ in range(m)],
    )
    pool = iter([fresh(parts) for _ in range(20)])
    times = interleaved(
        {
            "completeness": lambda: encode(completeness(next(pool))),
            "fixed spectrum": lambda: certified(next(pool)),
        }
    )
    ratio = times["completeness"].median / times["fixed spectrum"].median
    yield Row(
        "completeness, n=100, m=20, against the fixed spectrum",
        ratio,
        "<= 5",
        ratio <= 5,
        f"{times['completeness'].median:.4f} s / {times['fixed spectrum'].median:.4f} s",
    )
