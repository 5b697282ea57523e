"""What is proved for every plant in a box, of published plants, and how long it takes.

Run as ``python -m benchmarks.boxes [PART …] [FOLDER]``, with a folder of further system files.
Parts are

``members``   at 0.1 % of every entry: no fixed mode for any member, or stabilizable, for each plant
``largest``   the largest proved part, and a plant that fails, for each plant
``drawn``     members of proved boxes, decided exactly, and boxes with a planted fixed mode
``size``      how the time of the checker grows with the number of states of networks
``loops``     the same of loops that stay stable
``methods``   the largest part that is proved by discs of one matrix and frames, and by several

Writes tables in Markdown to the standard output.  Seconds are those of the processor.
"""

from __future__ import annotations

import os
import random
import statistics
import sys
import time
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from mcexact import MultiChannelSystem, check, fixed_spectrum, gallery, load_system
from mcexact.analysis.boxes.cover import Outside
from mcexact.analysis.boxes.members import FixedModeSearch
from mcexact.analysis.boxes.pencils import Members
from mcexact.answer.protocol import encode
from mcexact.boxes import (
    Box,
    box_controllability,
    box_fixed_modes,
    box_stability,
    box_stabilizability,
    largest_uncertainty,
)
from mcexact.derived.drawn.networks import network_system
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import system_with_fixed_mode
from mcexact.designs import local_controllers
from mcexact.errors import LimitReached

T = TypeVar("T")

PART = Fraction(1, 1000)
_MOST_STATES = 30
_SMALL = 12
_EFFORT = 10.0
SIZES = (
    ("ring", 5, 1, 1e-3),
    ("ring", 20, 5, 1e-4),
    ("ring", 60, 10, 1e-5),
    ("ring", 60, 10, 1e-4),
    ("ring", 200, 20, 1e-6),
    ("ring", 200, 20, 1e-5),
    ("platoon", 60, 10, 1e-4),
    ("platoon", 198, 33, 1e-5),
    ("building", 60, 10, 1e-4),
    ("building", 200, 20, 1e-6),
    ("consensus", 60, 10, 1e-4),
    ("consensus", 200, 20, 1e-6),
    ("swing-grid", 60, 10, 1e-4),
    ("swing-grid", 200, 20, 1e-6),
)
"""A network, its states and channels, and the part of every entry."""
CONTROLLED = {("ring", 60, 10, 1e-4), ("ring", 200, 20, 1e-6)}
"""Those of which it is asked, too, whether all channels control every member."""
METHODS = ((20, 5, 3, False), (20, 5, 3, True), (60, 10, 4, False), (60, 10, 3, True))
"""The states and channels of a ring, the first power of ten, and whether by several matrices."""


def main(arguments: list[str]) -> None:
    """Measure the parts asked for, by default all."""
    folders = [each for each in arguments if Path(each).is_dir()]
    asked = [each for each in arguments if each not in folders] or list(PARTS)
    plants = {name: gallery(name) for name in gallery()}
    for folder in folders:
        for file in sorted(Path(folder).glob("*.json")):
            plants[file.stem] = load_system(file)
    for name in asked:
        PARTS[name](plants)


def timed(work: Callable[[], T]) -> tuple[T | None, float]:
    """A result and its seconds; None if no proof was found."""
    began = time.process_time()
    try:
        found = work()
    except LimitReached:
        found = None
    return found, time.process_time() - began


def members(plants: dict[str, MultiChannelSystem]) -> None:
    """Print for each plant what is proved at 0.1 %, or why nothing can be."""
    counts = {"no fixed mode": 0, "stabilizable": 0, "neither": 0}
    heading("At 0.1 % of every entry", "plant", "n", "m", "every member", "s to find", "s to check")
    for name, plant in plants.items():
        if plant.n > _MOST_STATES:
            continue
        system = Box.relative(plant, PART).system
        spectrum = fixed_spectrum(plant)
        proof, seconds = timed(partial(box_fixed_modes, system, spectrum=spectrum))
        told = "no fixed mode"
        if proof is None:
            proof, more = timed(partial(box_stabilizability, system, spectrum=spectrum))
            seconds, told = seconds + more, "stabilizable"
        checking = 0.0
        if proof is None:
            told = "neither" if spectrum.stabilizable else "neither: the plant itself fails"
        else:
            verdict, checking = timed(partial(check, proof))
            told = told if verdict is not None and verdict.valid else "REJECTED"
        counts[told.partition(":")[0]] += 1
        row(name, plant.n, plant.m, told, f"{seconds:.2f}", f"{checking:.3f}")
    print("\n" + ", ".join(f"{count} {told}" for told, count in counts.items()) + ".\n")


def largest(plants: dict[str, MultiChannelSystem]) -> None:
    """Print for each plant the two ends of the largest uncertainty."""
    ratios = []
    heading(
        "The largest part of every entry",
        "plant", "n", "proved", "fails within", "ratio", "s to find", "s to check",
    )  # fmt: skip
    for name, plant in plants.items():
        if not 0 < plant.n <= _SMALL:
            continue
        found, seconds = timed(partial(largest_uncertainty, plant, effort=_EFFORT))
        if found is None:
            continue
        checking, ratio = 0.0, ""
        if found.proof is not None:
            verdict, checking = timed(partial(check, found.proof))
            if verdict is None or not verdict.valid:
                print(f"{name}: REJECTED")
        if found.upper and found.lower:
            ratios.append(float(found.upper / found.lower))
            ratio = f"{ratios[-1]:.2f}"
        upper = "–" if found.upper is None else f"{float(found.upper):.3g}"
        low = f"{float(found.lower):.3g}"
        row(name, plant.n, low, upper, ratio, f"{seconds:.1f}", f"{checking:.3f}")
    print(f"\nMedian ratio {statistics.median(ratios):.2f} of {len(ratios)}.\n")


def drawn(plants: dict[str, MultiChannelSystem], count: int = 10_000) -> None:
    """Decide drawn members of proved boxes exactly, and look for proofs about planted ones."""
    proved = []
    for plant in plants.values():
        if not 0 < plant.n <= _SMALL:
            continue
        for part in (PART, Fraction(1, 20)):
            box = Box.relative(plant, part)
            proof, _ = timed(partial(box_fixed_modes, box.system))
            if proof is not None:
                proved.append(box)
    rng, contradicted = random.Random(0), 0
    for k in range(count):
        member = proved[k % len(proved)].member(rng, vertex=k % 3 == 0)
        contradicted += not fixed_spectrum(member).empty
    print("## Drawn members\n")
    told = f"{count} members of {len(proved)} proved boxes, a third of them vertices"
    print(f"{told}: {contradicted} have a fixed mode.")
    certified = 0
    for k in range(count // 20):
        planted = system_with_fixed_mode(SeededChoices(k), 4, 2).system
        inner = Box.relative(planted, Fraction(1, 50))
        proof, _ = timed(
            lambda inner=inner: box_fixed_modes(Box(inner.member(rng), inner.radii).system)
        )
        certified += proof is not None
    print(f"{count // 20} boxes with a planted fixed mode: {certified} certified.\n")


def size(plants: dict[str, MultiChannelSystem]) -> None:
    """Print how long finding and checking take for networks of growing size."""
    heading(
        "Networks",
        "network", "n", "m", "part", "s to find", "s to check",
        "matrices", "frames", "squares", "bytes",
    )  # fmt: skip
    for name, n, m, part in SIZES:
        plant = ring(n, m) if name == "ring" else network_system(SeededChoices(0), name, n, m)
        system = Box.relative(plant, Fraction(str(part))).system
        network_row(name, f"{part:g}", system, partial(box_fixed_modes, starts=1))
        if (name, n, m, part) in CONTROLLED:
            network_row(f"{name}, controllable", f"{part:g}", system, box_controllability)


def network_row(
    name: str, part: str, system: MultiChannelSystem, question: Callable[..., Any]
) -> None:
    """Print what a proof about a network takes."""
    proof, seconds = timed(partial(question, system))
    if proof is None:
        row(name, system.n, system.m, part, f"no proof in {seconds:.1f}", *[""] * 5)
        return
    verdict, checking = timed(partial(check, proof))
    checked = f"{checking:.2f} {'?' if verdict is None else verdict.verdict}"
    counts = len(proof.exterior), len(proof.frames), sum(map(len, proof.cover))
    row(name, system.n, system.m, part, f"{seconds:.2f}", checked, *counts, len(encode(proof)))


def methods(plants: dict[str, MultiChannelSystem]) -> None:
    """Print the largest power of ten that is proved as a part, by one matrix or by several."""
    heading("By one matrix or by several", "ring of n", "m", "discs of", "part", "s to find")
    for n, m, first, several in METHODS:
        system = ring(n, m)
        for k in range(first, 9):
            part = Fraction(1, 10**k)
            boxed = Box.relative(system, part).system
            search = FixedModeSearch(Members.of(boxed), starts=1, several=several)
            began = time.process_time()
            outside = Outside(boxed.time, None)
            enough = search.capacity(outside) > 1
            proof = search.evidence(Fraction(1), outside) if enough else None
            seconds = time.process_time() - began
            if proof is not None:
                row(n, m, "several" if several else "A", f"1e-{k}", f"{seconds:.1f}")
                break


def loops(plants: dict[str, MultiChannelSystem]) -> None:
    """Print how long it takes for loops of growing size that all members are stable."""
    heading(
        "Loops with buildings",
        "n", "m", "part", "s to find", "s to check", "frames", "segments", "bytes",
    )  # fmt: skip
    for n, m in ((20, 5), (60, 10), (200, 20)):
        plant = network_system(SeededChoices(0), "building", n, m)
        controller = local_controllers(plant, [[[-1] * plant.q(i)] * plant.p(i) for i in range(m)])
        system = Box.relative(plant, Fraction(1, 100)).system
        proof, seconds = timed(partial(box_stability, system, controller))
        if proof is None:
            row(n, m, "0.01", f"no proof in {seconds:.1f}", *[""] * 4)
            continue
        verdict, checking = timed(partial(check, proof))
        checked = f"{checking:.2f} {'?' if verdict is None else verdict.verdict}"
        counts = len(proof.frames), len(proof.segments), len(encode(proof))
        row(n, m, "0.01", f"{seconds:.2f}", checked, *counts)


def heading(title: str, *columns: str) -> None:
    """Print a title, and the names of the columns of a table."""
    print(f"## {title}\n")
    row(*columns)
    row(*["---"] * len(columns))


def row(*cells: object) -> None:
    """Print a row of a table."""
    print("| " + " | ".join(map(str, cells)) + " |", flush=True)


def ring(n: int, m: int) -> MultiChannelSystem:
    """Subsystems in a ring, each coupled to its two neighbors, with entries of three decimals."""
    rng, k = np.random.default_rng(1), n // m
    A = np.zeros((n, n))
    B, C = [], []
    for i in range(m):
        own = slice(i * k, (i + 1) * k)
        A[own, own] = rng.standard_normal((k, k))
        for j in {(i + 1) % m, (i - 1) % m} - {i}:
            A[own, j * k : (j + 1) * k] += 0.3 * rng.standard_normal((k, k))
        b, c = np.zeros((n, 1)), np.zeros((1, n))
        b[own, 0], c[0, own] = rng.standard_normal(k), rng.standard_normal(k)
        B.append(b)
        C.append(c)

    def rounded(M: Any) -> Any:
        return np.round(M, 3)

    return MultiChannelSystem.from_float(
        rounded(A), [rounded(b) for b in B], [rounded(c) for c in C], rounding="decimal"
    )


PARTS: dict[str, Callable[[dict[str, MultiChannelSystem]], None]] = {
    "members": members,
    "largest": largest,
    "drawn": drawn,
    "size": size,
    "methods": methods,
    "loops": loops,
}

if __name__ == "__main__":
    main(sys.argv[1:])
