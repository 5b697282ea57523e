"""Allocations by exhaustive search over subsets of channels, and dimensions or arcs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction

from tests.oracle.enumeration import (
    Coefficients,
    PlainSystem,
    characteristic_polynomial,
    irreducible_factors,
    pencil_rank,
    subsets,
)

Neighbors = Sequence[Sequence[int]]


def augmented(system: PlainSystem, neighbors: Neighbors) -> PlainSystem:
    """Every agent receives the outputs of its neighbors (itself included), in ascending order."""
    neighborhoods = [sorted({i, *neighbors[i]}) for i in range(system.m)]
    return PlainSystem(
        system.A, system.B, [[r for j in h for r in system.C[j]] for h in neighborhoods]
    )


def boundary(s: Sequence[int], neighbors: Neighbors) -> frozenset[int]:
    """N_s∖s."""
    return frozenset(j for i in s for j in neighbors[i] if j not in s)


def deficiencies(base: PlainSystem) -> dict[tuple[int, ...], int]:
    """For every subset s the largest n − rank P_s(λ) over all λ, at least 0."""
    modes: list[Coefficients] = list(irreducible_factors(characteristic_polynomial(base.A)))
    return {
        s: max((base.n - pencil_rank(base, s, p) for p in modes), default=0)
        for s in subsets(base.m)
    }


def demands(
    system: PlainSystem, neighbors: Neighbors, *, outputs: bool
) -> list[tuple[frozenset[int], int]]:
    """The inequalities Σ n_i over N_s∖s ≥ δ_s that the dimensions must satisfy."""
    base = augmented(system, neighbors) if outputs else system
    return [(boundary(s, neighbors), d) for s, d in deficiencies(base).items() if d > 0]


def least_cost(
    inequalities: Sequence[tuple[frozenset[int], int]],
    costs: Sequence[Fraction],
    upper: Sequence[int],
) -> Fraction | None:
    """The least Σ c_i n_i with 0 ≤ n_i ≤ upper_i that satisfies all inequalities, or None."""
    best: Fraction | None = None
    for values in itertools.product(*(range(u + 1) for u in upper)):
        if all(sum(values[i] for i in support) >= d for support, d in inequalities):
            cost = sum((c * v for c, v in zip(costs, values, strict=True)), Fraction(0))
            best = cost if best is None else min(best, cost)
    return best


def sufficient_arcs(
    system: PlainSystem, neighbors: Neighbors, dimensions: Sequence[int], *, share: str
) -> bool:
    """Whether no mode is fixed over this graph: δ_s ≤ Σ n_i over N_s∖s for every s."""
    outputs = share != "states"
    return all(
        sum(dimensions[i] for i in support) >= d
        for support, d in demands(system, neighbors, outputs=outputs)
    )


def fewest_arcs(
    system: PlainSystem, neighbors: Neighbors, dimensions: Sequence[int], *, share: str
) -> int | None:
    """The least number of arcs to add so that no mode is fixed, or None."""
    m = system.m
    missing = [(j, i) for j in range(m) for i in range(m) if j != i and j not in neighbors[i]]
    for count in range(len(missing) + 1):
        for added in itertools.combinations(missing, count):
            wider = [[*neighbors[i], *(j for j, k in added if k == i)] for i in range(m)]
            if sufficient_arcs(system, wider, dimensions, share=share):
                return count
    return None
