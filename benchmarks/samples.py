"""Sampled plants beside the exponential at 100 digits, and designs for samples a step late.

Run as ``python -m benchmarks.samples``, which takes a minute, or with files of plants in continuous
time and the step of each, ``python -m benchmarks.samples plant.json=1/10``.

Without files 200 plants and steps are drawn.  Every entry of the exact samples has to be within its
radius, and the largest radius of each plant is compared with its largest error.  Then 100 members
are drawn within radii of each plant, half of them at vertices, and sampled at 100 digits: it is
counted how many are outside.  The exponential is that of ball arithmetic, which squares what it
scales; the radii come from a series.

With files each plant is sampled with inputs one step late, a controller is designed and certified,
and all certificates are checked; a line holds what is certified, and seconds of the processor.
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from mcexact import design_decentralized, load_system
from mcexact.checker.command import manifest_verdicts
from mcexact.checker.core.reading import Limits
from mcexact.checker.kinds import Expectation
from mcexact.constructions import sampled_system
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import percent, three_digits
from mcexact.exact.sampling import held_exponential
from mcexact.synthesis.performance import performance_of
from tests.oracle.sampling import Rows, drawn_plant, drawn_radii, exponential, member

PLANTS, MEMBERS = 200, 100
ERROR = Fraction(1, 10**99)
"""More than the error of the exponential that is compared with."""


def distances(center: Rows, M: Rows, h: Fraction) -> Iterator[Fraction]:
    """How far the exact samples of [A, B] = M are from the center, entry by entry."""
    n = len(M)
    exact = exponential([row[:n] for row in M], [row[n:] for row in M], h)
    for row, other in zip(center, exact, strict=True):
        yield from (abs(x - y) for x, y in zip(row, other, strict=True))


def enclosed(M: Rows, D: Rows, h: Fraction) -> tuple[Rows, list[Fraction]]:
    """The center, and all radii in one list."""
    center, radii = held_exponential(Matrix.from_rows(M), Matrix.from_rows(D), h, 12)
    return [list(row) for row in center.rows()], [x for row in radii.rows() for x in row]


def enclosures() -> Iterator[str]:
    """The lines about drawn plants."""
    outside, entries, ratios, tight = 0, 0, list[float](), list[float]()
    away, drawn = 0, 0
    for seed in range(PLANTS):
        rng = random.Random(seed)
        A, B, h = drawn_plant(rng)
        M = [[*a, *b] for a, b in zip(A, B, strict=True)]
        center, radii = enclosed(M, [[Fraction(0)] * len(row) for row in M], h)
        found = list(distances(center, M, h))
        entries += len(found)
        outside += sum(d > r + ERROR for d, r in zip(found, radii, strict=True))
        if max(found) > ERROR:
            ratios.append(float(max(radii) / max(found)))
        D = drawn_radii(rng, M)
        center, radii = enclosed(M, D, h)
        reached = Fraction(0)
        for _ in range(MEMBERS):
            pairs = list(zip(distances(center, member(rng, M, D), h), radii, strict=True))
            drawn, away = drawn + 1, away + any(d > r + ERROR for d, r in pairs)
            reached = max([reached, *(d / r for d, r in pairs if r)])
        tight.append(float(reached))
    ratios.sort()
    tight.sort()
    yield f"{PLANTS} plants, {entries} entries: {outside} outside of their radii"
    yield f"largest radius over largest error: median {ratios[len(ratios) // 2]:.4f}, "
    yield f"  at most {ratios[-1]:.4f}"
    yield f"{drawn} members within radii of the plants: {away} outside"
    middle, quarter = (tight[len(tight) // k] for k in (2, 4))
    yield f"largest part of a radius that a member reaches: median {middle:.2f}, "
    yield f"  in a quarter of the plants at most {quarter:.2f}"


def designed(file: str, step: str) -> str:
    """The line about a controller for a plant at its samples, one step late."""
    begin = time.process_time()
    plant = sampled_system(load_system(file), step, 1)
    design = design_decentralized(plant)
    proved = performance_of(design.loop.closed)
    around = design.every_loop()
    account = design.account_with(around, proved)
    seconds = time.process_time() - begin
    with tempfile.TemporaryDirectory() as folder:
        account.save(folder)
        begin = time.process_time()
        verdicts = [each.verdict for _, each in manifest_verdicts(folder, Expectation(), Limits())]
        checked = time.process_time() - begin
        size = sum(path.stat().st_size for path in Path(folder).iterdir())
    good = sum(each in {"VALID", "IMPLIED", "REMARK"} for each in verdicts)
    said = "; ".join(each.line for each in account.sentences.at("first"))
    box = "none" if around.part is None else percent(around.part)
    margins = [
        f"{at} {three_digits(each.disk.margin)}"
        for at, each in around.margins.items()
        if each.disk is not None
    ]
    return (
        f"{Path(file).stem} at {step}, {plant.n} states, order {design.order}: {said}; box of "
        f"exact samples {box}, margins in half of it: {', '.join(margins) or 'none'}; "
        f"{seconds:.1f} s, "
        f"{size // 1000} kB, checked in {checked:.1f} s: {good} of {len(verdicts)}"
    )


def main(files: list[str]) -> None:
    """Print the lines."""
    if not files:
        for line in enclosures():
            print(line, flush=True)
    for each in files:
        file, _, step = each.rpartition("=")
        print(designed(file, step), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
