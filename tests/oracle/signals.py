"""Which roots of a signal polynomial are fixed with internal models, by all sets of channels.

The rank conditions are those of the plant alone: no system with models is made here.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from tests.oracle.enumeration import (
    Coefficients,
    PlainSystem,
    Rows,
    at_root,
    irreducible_factors,
    rank,
    subsets,
)


def rank_with_all_outputs(
    system: PlainSystem, D: Rows, T: Sequence[int], p: Coefficients, kept: Sequence[Rows] | None
) -> int:
    """Rank of [λI − A, −B_T; (S_i C_i, S_i D_iT) for i ∈ T; C_s, D_sT] at a root λ of p.

    ``kept`` are the S_i; None for all outputs.  D has the rows of all outputs and the columns of
    all inputs.
    """
    n = system.n
    widths = [len(B[0]) if n else 0 for B in system.B]
    columns = [sum(widths[:j]) + k for j in T for k in range(widths[j])]
    rows: Rows = [
        [-value for value in system.A[i]] + [-value for j in T for value in system.B[j][i]]
        for i in range(n)
    ]
    start = 0
    for i, C in enumerate(system.C):
        own = [row + [D[start + k][c] for c in columns] for k, row in enumerate(C)]
        start += len(C)
        if kept is not None and i in T:
            own = [
                [sum((s * row[c] for s, row in zip(S, own, strict=True)), Fraction(0))
                 for c in range(n + len(columns))]
                for S in kept[i]
            ]  # fmt: skip
        rows += own
    inflated = at_root(rows, {(i, i) for i in range(n)}, p)
    return rank(inflated) // (len(p) - 1)


def fixed_signals(
    system: PlainSystem,
    D: Rows,
    alpha: Coefficients,
    *,
    shared: bool = False,
    kept: Sequence[Rows] | None = None,
) -> set[Coefficients]:
    """The irreducible factors of α at whose roots the rank is too small for some T.

    With ``shared``, agents share states over a strongly connected graph: T is nothing or all.
    """
    sizes = [len(C) for C in system.C] if kept is None else [len(S) for S in kept]
    found = set()
    for p in irreducible_factors(alpha):
        for T in _sets(system.m, shared):
            wanted = system.n + sum(sizes[i] for i in T)
            if rank_with_all_outputs(system, D, T, p, kept) < wanted:
                found.add(p)
                break
    return found


def _sets(m: int, shared: bool) -> Iterator[tuple[int, ...]]:
    if shared:
        yield from ((), tuple(range(m)))
    else:
        yield from subsets(m)
