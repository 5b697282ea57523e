"""How long do the questions about a plant take, and the check of each beside that of the first?"""

from __future__ import annotations

import compileall
import itertools
import random
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import mcexact
from benchmarks.fixed_spectrum import Row
from benchmarks.measure import in_turns, processor_seconds
from mcexact import (
    assignability,
    completeness,
    controllability_indices,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    observability_indices,
    setpoint_solvability,
    transfer_graph,
)
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import Draw, drawn_system, system_with_fixed_mode
from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix, block, vstack
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem

QUESTIONS: dict[str, Callable[[MultiChannelSystem], Any]] = {
    "fixed spectrum": fixed_spectrum,
    "controllability": joint_controllability,
    "observability": joint_observability,
    "controllability indices": controllability_indices,
    "observability indices": observability_indices,
    "transfer graph": transfer_graph,
    "completeness": completeness,
    "assignability": assignability,
    "set-points": setpoint_solvability,
}
DENSE = tuple((n, m) for n in (20, 100, 200, 500, 1000, 2000) for m in dict.fromkeys((2, n // 10)))
WHOLE = {3: 0.35, 20: 0.5, 100: 1.0, 200: 1.5, 500: 5.0, 1000: 20.0}
"""The seconds in which `analyze` is to end, by the states of a dense plant."""
_RATIO = 3.0
_SPARSE = 5.0


def dense_plant(n: int, m: int) -> MultiChannelSystem:
    """Integer entries from −9 to 9, with m channels of one input and one output."""
    rng = random.Random(n + m)

    def matrix(rows: int, cols: int) -> Matrix:
        entries = [[rng.randint(-9, 9) for _ in range(cols)] for _ in range(rows)]
        return Matrix.from_integers(entries, ncols=cols)

    return MultiChannelSystem(
        matrix(n, n), [matrix(n, 1) for _ in range(m)], [matrix(1, n) for _ in range(m)]
    )


def dense_rows(n: int, m: int) -> Iterator[Row]:
    """Every question about a dense plant."""
    limit = _RATIO if n >= 100 else None
    yield from _rows(f"dense, n={n}, m={m}", partial(dense_plant, n, m), limit, _runs(n))


def _runs(n: int) -> int:
    """Of how many runs the median is taken: one run has ratios of 3.15 where seven have 2.7."""
    return 5 if n <= 200 else 3 if n <= 500 else 1


def sparse_rows(n: int, m: int) -> Iterator[Row]:
    """Every question about a large building."""
    drawn = Draw(0, n, m, network="building")
    yield from _rows(f"building, n={n}, m={m}", partial(drawn_system, drawn), None, 1, _SPARSE)


def channel_chains(n: int, m: int) -> MultiChannelSystem:
    """Chains of n/m states, each with a channel from start to end; every second drives the next."""
    rng, size = random.Random(n), n // m
    entries = {(i, i): rng.randint(-9, 9) for i in range(n)}
    entries |= {(i, i - 1): rng.randint(1, 9) for i in range(1, n) if i % (2 * size)}
    entries |= {(i, i + 1): rng.randint(1, 9) for i in range(n - 1) if (i + 1) % size}
    return MultiChannelSystem(
        Matrix.from_entries((n, n), [(i, j, x) for (i, j), x in entries.items() if x]),
        [Matrix.from_entries((n, 1), [(size * k, 0, 1)]) for k in range(m)],
        [Matrix.from_entries((1, n), [(0, size * k + size - 1, 1)]) for k in range(m)],
    )


def chain_questions(n: int, m: int) -> Iterator[Row]:
    """Every question about such chains."""
    yield from _rows(f"chains, n={n}, m={m}", lambda: channel_chains(n, m), None, 1, _SPARSE)


def planted_plant(n: int, m: int, size: int = 3) -> MultiChannelSystem:
    """A dense plant with so many states that no channel drives, hidden by a change of basis."""
    rng, k = random.Random(n + m), n - size

    def matrix(rows: int, cols: int, most: int = 9) -> Matrix:
        entries = [[rng.randint(-most, most) for _ in range(cols)] for _ in range(rows)]
        return Matrix.from_integers(entries, ncols=cols)

    A = block([[matrix(k, k), matrix(k, size)], [Matrix.zeros(size, k), matrix(size, size)]])
    X, Y = matrix(size, k, 1), matrix(k, size, 1)
    T = _lower(X) @ _lower(Y.T).T
    inverse = _lower(-Y.T).T @ _lower(-X)
    B = [T @ vstack([matrix(k, 1), Matrix.zeros(size, 1)]) for _ in range(m)]
    C = [matrix(1, n) @ inverse for _ in range(m)]
    return MultiChannelSystem(T @ A @ inverse, B, C)


def _lower(X: Matrix) -> Matrix:
    """[I 0; X I]."""
    r, c = X.nrows, X.ncols
    return block([[Matrix.identity(c), Matrix.zeros(c, r)], [X, Matrix.identity(r)]])


PLANTED = (100, 200, 300, 500)


def planted_rows(n: int) -> Iterator[Row]:
    """Every question about such a plant, beside the first one about a plant without such states."""
    m = n // 10
    name, plant = f"planted, n={n}, m={m}", partial(planted_plant, n, m)
    yield from _rows(name, plant, _RATIO, _runs(n), None, partial(dense_plant, n, m))


DEFICIENT = (20, 100, 200, 500)


def deficient_plant(n: int, m: int) -> MultiChannelSystem:
    """A dense plant in which two channels measure the same, and so cannot be held at two values."""
    channels = (plant := dense_plant(n, m)).channels
    outputs = [channels[0].C, *(channel.C for channel in channels[:-1])]
    return MultiChannelSystem(plant.A, [channel.B for channel in channels], outputs)


def deficient_rows() -> Iterator[Row]:
    """Set-points that nothing holds, because the normal rank is deficient."""
    for n in DEFICIENT:
        m = max(n // 10, 2)
        turn = _turn(partial(deficient_plant, n, m), setpoint_solvability)
        name = f"two channels measure the same, n={n}, m={m}, set-points, checked"
        yield Row(name, turn.checked, "reported", turn.verdict == "VALID", turn.detail(), "s")


HIDDEN = (100, 200, 300)


def hidden_plant(n: int, m: int) -> MultiChannelSystem:
    """A plant with a decentralized fixed mode that a change of basis hides."""
    return system_with_fixed_mode(SeededChoices(3), n, m).system


def hidden_rows() -> Iterator[Row]:
    """The fixed spectrum of such plants."""
    for n in HIDDEN:
        m = n // 10
        make = partial(hidden_plant, n, m)
        turn = _turn(make, fixed_spectrum)
        good = turn.verdict == "VALID" and turn.checked <= 10
        name = f"hidden decentralized fixed mode, n={n}, m={m}, fixed spectrum, checked"
        yield Row(name, turn.checked, "<= 10 s", good, turn.detail(), "s")


Plant = Callable[[], MultiChannelSystem]
_WITHOUT = "the first check without"


def _rows(
    plant: str,
    make: Plant,
    ratio: float | None,
    runs: int,
    limit: float | None = None,
    compared: Plant | None = None,
) -> Iterator[Row]:
    """Every question, beside the first one about the plant itself or about another one.

    The questions take turns, so that a machine that grows slower meets all of them.
    """
    asked = {name: (make, decide) for name, decide in QUESTIONS.items()}
    if compared:
        asked = {_WITHOUT: (compared, fixed_spectrum), **asked}
    left_open: dict[str, LimitReached] = {}

    def turn(name: str) -> _Turn | None:
        if name not in left_open:
            try:
                return _turn(*asked[name])
            except LimitReached as reached:
                left_open[name] = reached
        return None

    turns = in_turns({name: partial(turn, name) for name in asked}, runs=runs)
    largest, first = 0.0, 0.0
    for name in asked:
        if name in left_open:
            detail = f"left open: {left_open[name]}"[:120]
            yield Row(f"{plant}, {name}", 0.0, "reported", True, detail, "s")
            continue
        median = _median([each for each in turns[name] if each])
        checked, verdict = median.checked, median.verdict
        first = first or checked
        if name == _WITHOUT:
            yield Row(f"{plant}, {name}", checked, "reported", verdict == "VALID", "", "s")
            continue
        largest = max(largest, checked / first)
        good = verdict == "VALID" and (limit is None or checked <= limit)
        detail = f"{median.detail()}, {checked / first:.2f} times the first check"
        said = "reported" if limit is None else f"<= {limit:g} s"
        yield Row(f"{plant}, {name}, checked", checked, said, good, detail, "s")
    good = ratio is None or largest <= ratio
    said = "reported" if ratio is None else f"<= {ratio:g}"
    yield Row(f"{plant}, the slowest check beside the first", largest, said, good, "")


@dataclass(frozen=True)
class _Turn:
    """Seconds to find, write and check an answer, the verdict, and the bytes of the certificate."""

    found: float
    written: float
    checked: float
    verdict: str
    size: int

    def detail(self) -> str:
        return (
            f"found {self.found:.3f} s, written {self.written:.3f} s, "
            f"{self.size / 1000:.0f} kB, {self.verdict}"
        )


def _turn(make: Plant, decide: Callable[[MultiChannelSystem], Any]) -> _Turn:
    """One question about a plant that is made anew."""
    system, times = make(), [processor_seconds()]
    answer = decide(system)
    times.append(processor_seconds())
    data = encode(answer).encode()
    times.append(processor_seconds())
    verdict = check_document(data).verdict
    times.append(processor_seconds())
    found, written, checked = (b - a for a, b in itertools.pairwise(times))
    return _Turn(found, written, checked, verdict, len(data))


def _median(turns: list[_Turn]) -> _Turn:
    """The last turn, with the medians of the seconds."""
    medians = {
        name: statistics.median(getattr(turn, name) for turn in turns)
        for name in ("found", "written", "checked")
    }
    return replace(turns[-1], **medians)


def whole_rows(n: int) -> Iterator[Row]:
    """`analyze` in a process of its own, with certificates and manifest, all of them checked."""
    m = max(n // 10, 2)
    seconds, size, status = _whole(n, m)
    if n <= 200:  # the median of three
        seconds = statistics.median([seconds, *(_whole(n, m)[0] for _ in range(2))])
    good = status == 0 and seconds <= WHOLE[n]
    detail = f"folder of {size / 1000:.0f} kB, status {status}"
    yield Row(f"whole analyze, n={n}, m={m}", seconds, f"<= {WHOLE[n]:g} s", good, detail, "s")


def _whole(n: int, m: int) -> tuple[float, int, int]:
    """The seconds with compiled files, the bytes of the folder, and the status."""
    compileall.compile_dir(Path(mcexact.__file__).parent, quiet=1)
    with tempfile.TemporaryDirectory() as place:
        plant, folder = Path(place, "plant.json"), Path(place, "certificates")
        save_system(dense_plant(n, m), plant)
        command = [sys.executable, "-m", "mcexact", "analyze", str(plant)]
        start = processor_seconds()
        run = subprocess.run(
            [*command, "--certificates", str(folder)], capture_output=True, text=True, check=False
        )
        seconds = processor_seconds() - start
        size = sum(file.stat().st_size for file in folder.iterdir())
    return seconds, size, run.returncode


def chain_rows() -> Iterator[Row]:
    """Chains of fractions in a row, with two states between them that no channel moves."""
    for n in (400, 600, 800, 2000, 10_000):
        turn = _turn(partial(chains, n), fixed_spectrum)
        good = turn.verdict == "VALID" and turn.found <= 5 and turn.checked <= 5
        name = f"chains with a fixed mode, n={n}, m=20"
        yield Row(name, turn.checked, "<= 5 s", good, turn.detail(), "s")


def chains(n: int, m: int = 20) -> MultiChannelSystem:
    """m chains, each driving the next, and between the middle ones x² + 3x + 1, in drawn order."""
    rng, size = random.Random(n), (n - 2) // m
    n = m * size + 2
    order = rng.sample(range(n), n)
    entries = [(n - 2, n - 1, -1), (n - 1, n - 2, 1), (n - 1, n - 1, -3)]
    starts = [size * k for k in range(m)]
    for k, start in enumerate(starts):
        for a in range(start, start + size):
            entries.append((a, a, Fraction(rng.randint(-9, 9), rng.choice([1, 2, 5]))))
            if a > start:
                entries.append((a, a - 1, rng.choice([1, -1, 2, 3])))
                entries.append((a - 1, a, Fraction(rng.choice([1, -1, 2, 5]), rng.choice([1, 3]))))
        if k and k != m // 2:
            entries.append((start + size // 2, starts[k - 1], 1))
    entries += [(n - 2, starts[m // 2 - 1], 1), (starts[m // 2] + size // 2, n - 1, 1)]
    A = Matrix.from_entries((n, n), [(order[a], order[b], x) for a, b, x in entries])
    B = [Matrix.from_entries((n, 1), [(order[a], 0, 1)]) for a in starts]
    C = [Matrix.from_entries((1, n), [(0, order[a], 1)]) for a in starts]
    return MultiChannelSystem(A, B, C)
