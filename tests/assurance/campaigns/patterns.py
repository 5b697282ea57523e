"""Structural fixed modes against enumeration and drawn numbers; prints the counts.

Run as ``python -m tests.assurance.campaigns.patterns [COUNT [SEED]]``; the tests call the parts
with small counts.
"""

from __future__ import annotations

import random
import sys
import time
from collections import Counter

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.patterns import structural_fixed_modes, why_fixed
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.structure import agree, require_valid
from tests.oracle.draws import exact, sparse_system
from tests.oracle.enumeration import fixed_factors, plain
from tests.oracle.patterns import (
    Pattern,
    Table,
    drawn_fixed_polynomial,
    drawn_pattern,
    least_at_zero,
    without_feedback,
)

Seen = Counter[str]


def filled(rng: random.Random, pattern: Pattern) -> MultiChannelSystem:
    """A plant with short numbers at the places, whose agents receive the outputs that they use."""

    def table(M: Table, columns: int) -> Matrix:
        return Matrix.from_rows(
            [[rng.choice([1, 2, -1, -3]) if place else 0 for place in row] for row in M],
            ncols=columns,
        )

    names = [str(i + 1) for i in range(pattern.m)]
    return MultiChannelSystem(
        table(pattern.A, pattern.n),
        [table(M, pattern.width(i)) for i, M in enumerate(pattern.B)],
        [table(M, pattern.n) for M in pattern.C],
        names=names,
        neighbors=NeighborGraph(names, [tuple(each) for each in pattern.used]),
    )


def compare_patterns(count: int, seed: int) -> Seen:
    """Of drawn patterns: every path, every permutation, and loops with drawn numbers."""
    seen = Seen()
    for number in range(seed, seed + count):
        rng = random.Random(number)
        pattern = drawn_pattern(rng)
        found = structural_fixed_modes(filled(rng, pattern), "outputs")
        what = f"pattern {number}"
        agree(f"{what}, states", [*found.without_feedback], without_feedback(pattern))
        agree(f"{what}, at 0", found.at_zero, least_at_zero(pattern))
        agree(f"{what}, drawn", *drawn_fixed_polynomial(rng, pattern))
        require_valid(what, [found])
        seen["patterns"] += 1
        seen["without structural fixed modes"] += found.empty
        seen["states without feedback"] += bool(found.without_feedback)
        seen["with modes at 0 beside"] += found.at_zero > 0
        seen["with outputs of others"] += any(len(each) > 1 for each in pattern.used)
    return seen


def compare_plants(count: int, seed: int) -> Seen:
    """Of drawn plants: fixed modes divided in two, as plants with drawn numbers keep or lose them.

    What the zeros fix is fixed; what stays fixed with the plant's own A_UU and other numbers
    elsewhere is what the zeros fix.
    """
    seen = Seen()
    for number in range(seed, seed + count):
        rng = random.Random(number)
        plant = exact(sparse_system(rng))
        own = {tuple(p) for p in fixed_factors(plain(plant))}
        why = why_fixed(plant)
        named = {tuple(p.coefficients) for p in (*why.by_zeros, *why.by_equalities)}
        agree(f"plant {number}, fixed", named, own)
        structural = structural_fixed_modes(plant)
        other = _redrawn(rng, plant, {*structural.without_feedback})
        kept = {f.polynomial for f in fixed_spectrum(other).factors}
        agree(f"plant {number}, zeros", {*why.by_zeros}, kept)
        agree(f"plant {number}, VALID", check_document(_bytes(structural)).verdict, "VALID")
        seen["plants"] += 1
        seen["by zeros"] += len(why.by_zeros)
        seen["by equalities"] += len(why.by_equalities)
    return seen


def _bytes(answer: object) -> bytes:
    return encode(answer).encode("ascii")  # type: ignore[arg-type]


def _redrawn(rng: random.Random, plant: MultiChannelSystem, kept: set[int]) -> MultiChannelSystem:
    """The plant with drawn numbers at the same places, but those of A between some states."""

    def other(M: Matrix, *, square: bool = False) -> Matrix:
        inside = (
            (i, j, M[i, j] if square and {i, j} <= kept else rng.randint(1, 10**6))
            for i, j, _ in M.nonzero()
        )
        return Matrix.from_entries(M.shape, inside)

    B, C = ([other(M) for M in each] for each in (plant.B, plant.C))
    return MultiChannelSystem(other(plant.A, square=True), B, C, time=plant.time)


def main(arguments: list[str]) -> None:
    """Run both parts, and print the counts."""
    count = int(arguments[0]) if arguments else 1000
    seed = int(arguments[1]) if len(arguments) > 1 else 1
    for compare in (compare_patterns, compare_plants):
        start = time.process_time()
        seen = compare(count, seed)
        print(f"{compare.__name__} ({time.process_time() - start:.0f} s)")
        for what, number in sorted(seen.items()):
            print(f"  {number:6d}  {what}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
