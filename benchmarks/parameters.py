"""How long does it take to decide and to check a question for all values of a parameter?"""

from __future__ import annotations

import cProfile
import json
import pstats
import random
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from benchmarks.fixed_spectrum import Row
from benchmarks.measure import processor_seconds
from mcexact import ParametricSystem, fixed_spectrum
from mcexact.answer.protocol import document
from mcexact.checker.kinds import Verdict, check_document

LIMITS = {
    ("one entry", 20): (0.11, 1.05),
    ("one entry", 40): (2.05, 25.0),
}
"""Seconds for deciding and for checking, where some were asked for."""
SIZES = dict.fromkeys(("one entry", "four entries", "all entries"), (5, 10, 20, 40))
DECIDING = {
    "det(xI − A_F)": ("exact/bivariate.py", "characteristic"),
    "modulo ℓ": ("exact/bivariate.py", "characteristic_modulo"),
    "resultants": ("exact/bivariate.py", "resultant_modulo"),
    "common divisors": ("exact/bivariate.py", "gcd"),
    "zero blocks": ("parameters/modes.py", "zero_block"),
}
CHECKING = {
    "reading": ("checker/parametric_system.py", "read_parametric"),
    "det(xI − A_F)": ("checker/bivariate.py", "characteristic"),
    "resultants": ("checker/bivariate.py", "resultant"),
    "coprimality": ("checker/core/arithmetic.py", "coprime"),
    "zero blocks": ("checker/parameters.py", "zero_block"),
}
"""The ends of files' paths, and names, of functions that do most of the work."""


def plant(n: int, kind: str, seed: int = 1) -> ParametricSystem:
    """A plant of n states and n/5 channels, whose last state is reached through one entry alone."""
    rng = random.Random(seed * 1000 + n)
    m = max(2, n // 5)
    A: list[list[Any]] = [
        [rng.randint(-3, 3) if i == j or rng.random() < 3 / n else 0 for j in range(n)]
        for i in range(n)
    ]
    A[-1] = [0] * (n - 1) + [5]
    B: list[Any] = [
        [[rng.randint(-2, 2)] if i < n - 1 else [0] for i in range(n)] for _ in range(m)
    ]
    C = [[[rng.randint(-2, 2) for _ in range(n)]] for _ in range(m)]
    if kind == "one entry":
        A[-1][0] = "t - 3"
    elif kind == "four entries":
        A[-1][0], A[0][1], A[1][2] = "t^2 - 2", f"{A[0][1]} + t", f"{A[1][2]} + t"
        B[0][0][0] = "1 + t"
    else:
        A = [[f"{a} + (t - 3)*({rng.randint(-2, 2)})" for a in row] for row in A]
    return ParametricSystem(A, B, C, parameters=["t"])


def rows(kind: str, n: int) -> Iterator[Row]:
    """The least of some runs each of deciding which modes are fixed, and of checking it.

    Each beside deciding it, or checking it, for one value of the parameter.
    """
    system = plant(n, kind)
    one = system.at({"t": 7})
    runs = 5 if n < 40 else 3
    times: list[list[float]] = []
    for _ in range(runs):
        text, decided = _decided(system)
        verdict, checked = _checked(text)
        alone, beside = _decided(one)
        times.append([decided, checked, beside, _checked(alone)[1]])
    least = [min(column) for column in zip(*times, strict=True)]
    limits = LIMITS.get((kind, n))
    stages = (
        _profile(lambda: _decided(system), DECIDING),
        _profile(lambda: _checked(text), CHECKING),
    )
    for k, what in enumerate(("decided", "checked")):
        most = limits[k] if limits else None
        size = f"{len(text) / 1000:.0f} kB, {verdict.spent / 1e6:.0f} million units; " if k else ""
        yield Row(
            f"fixed modes for all values, n={n}, t in {kind}, {what}",
            least[k],
            "reported" if most is None else f"<= {most} s",
            verdict.verdict == "VALID" and (most is None or least[k] <= most),
            f"{least[k] / least[k + 2]:.0f} times as long as for t = 7; {size}{stages[k]}",
            "s",
        )


def _decided(system: Any) -> tuple[bytes, float]:
    """The certificate of what is fixed, and the seconds."""
    start = processor_seconds()
    text = json.dumps(document(fixed_spectrum(system))).encode()
    return text, processor_seconds() - start


def _checked(text: bytes) -> tuple[Verdict, float]:
    """The verdict within the work that is granted, and the seconds."""
    start = processor_seconds()
    verdict = check_document(text)
    return verdict, processor_seconds() - start


def _profile(run: Callable[[], object], stages: Mapping[str, tuple[str, str]]) -> str:
    """The parts of the work that some functions do, in a run under a profiler."""
    profile = cProfile.Profile()
    profile.runcall(run)
    stats: dict[tuple[str, int, str], Any] = pstats.Stats(profile).stats  # type: ignore[attr-defined]
    whole = max(row[3] for row in stats.values())
    parts = []
    for name, (file, function) in stages.items():
        spent = sum(
            row[3]
            for (path, _, f), row in stats.items()
            if f == function and path.endswith(f"/{file}")
        )
        parts.append(f"{name} {100 * spent / whole:.0f} %")
    return ", ".join(parts)
