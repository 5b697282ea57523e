"""Structure by brute force: minors, rank sequences, transfer matrices over Q(x), real roots.

Nothing here imports ``mcexact.exact``.  Determinants are sums over column choices in sympy's ring
of polynomials over Q, every minor of every size once.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from sympy import QQ
from sympy.polys.rings import ring

from tests.oracle.enumeration import (
    Coefficients,
    PlainSystem,
    Rows,
    fixed_factors,
    product,
    rank,
    transfer_arcs,
)

RING, X = ring("x", QQ)
Polynomials = list[list[Any]]


def number(value: Fraction) -> Any:
    """A rational as a constant of the ring."""
    return RING(QQ(value.numerator, value.denominator))


def coefficients(p: Any) -> Coefficients:
    """The coefficients of the monic associate, constant term first; () for 0."""
    if not p:
        return ()
    monic = p.monic()
    values = [monic.coeff(X**k) if k else monic.coeff(1) for k in range(monic.degree() + 1)]
    return tuple(Fraction(int(QQ.numer(c)), int(QQ.denom(c))) for c in values)


def minors_divisor(rows: Polynomials, size: int) -> Any:
    """The greatest common divisor of all minors of one size; 1 for size 0."""
    if size == 0:
        return RING(1)
    width = len(rows[0]) if rows else 0
    minors: dict[tuple[int, ...], dict[tuple[int, ...], Any]] = {(): {(): RING(1)}}
    for _ in range(size):
        larger: dict[tuple[int, ...], dict[tuple[int, ...], Any]] = {}
        for chosen, known in minors.items():
            for r in range(chosen[-1] + 1 if chosen else 0, len(rows)):
                larger[(*chosen, r)] = _expanded(rows[r], known, width)
        minors = larger
    divisor = RING(0)
    for known in minors.values():
        for value in known.values():
            divisor = divisor.gcd(value) if divisor else value
            if divisor and divisor.degree() == 0:
                return RING(1)
    return divisor


def _expanded(row: list[Any], known: dict[tuple[int, ...], Any], width: int) -> dict[Any, Any]:
    """The minors with one more row, by expansion along it; zero minors are left out."""
    found: dict[tuple[int, ...], Any] = {}
    for columns, value in known.items():
        for j in range(width):
            if j not in columns and row[j]:
                place = sum(c < j for c in columns)
                sign = -1 if (len(columns) - place) % 2 else 1
                key = (*columns[:place], j, *columns[place:])
                found[key] = found.get(key, RING(0)) + sign * row[j] * value
    return {key: value for key, value in found.items() if value}


def pencil(system: PlainSystem, s: Sequence[int]) -> Polynomials:
    """[xI − A, B_{m−s}; C_s, 0] in the ring."""
    outside = [i for i in range(system.m) if i not in s]
    rows: Polynomials = []
    for i in range(system.n):
        left = [number(-v) + (X if i == j else 0) for j, v in enumerate(system.A[i])]
        rows.append(left + [number(v) for t in outside for v in system.B[t][i]])
    width = sum(len(system.B[t][0]) for t in outside) if system.n else 0
    for t in s:
        rows += [[number(v) for v in row] + [RING(0)] * width for row in system.C[t]]
    return rows


def remnant(system: PlainSystem, s: Sequence[int]) -> Coefficients:
    """The greatest common divisor of the n×n minors of the pencil of s."""
    return coefficients(minors_divisor(pencil(system, s), system.n))


def index_ranks(A: Rows, B: Rows) -> list[int]:
    """The ranks of [B … A^{k−1}B] until they stop growing."""
    block, rows, ranks = B, [list(row) for row in B], [0]
    while (found := rank(rows)) > ranks[-1]:
        ranks.append(found)
        block = product(A, block)
        rows = [a + b for a, b in zip(rows, block, strict=True)]
    return ranks[1:]


def partition(ranks: Sequence[int]) -> tuple[int, ...]:
    """The controllability indices that belong to ranks: how often each step is exceeded."""
    steps = [b - a for a, b in itertools.pairwise([0, *ranks])]
    return tuple(sum(step > i for step in steps) for i in range(max(steps, default=0)))


def rational_arcs(system: PlainSystem) -> list[tuple[int, int]]:
    """Arcs (j, i) with C_i adj(xI − A) B_j ≠ 0, by cofactors."""
    n = system.n
    resolvent = [
        [number(-v) + (X if i == j else 0) for j, v in enumerate(row)]
        for i, row in enumerate(system.A)
    ]
    adjugate = [[_cofactor(resolvent, j, i) for j in range(n)] for i in range(n)]
    arcs = set()
    for j, i in itertools.product(range(system.m), repeat=2):
        width = len(system.B[j][0]) if n else 0
        for row in system.C[i]:
            for column in range(width):
                total = RING(0)
                for a, b in itertools.product(range(n), repeat=2):
                    if row[a] and system.B[j][b][column]:
                        total += number(row[a]) * adjugate[a][b] * number(system.B[j][b][column])
                if total:
                    arcs.add((j, i))
    return sorted(arcs)


def _cofactor(rows: Polynomials, i: int, j: int) -> Any:
    """(−1)^{i+j} times the minor without row i and column j."""
    known: dict[tuple[int, ...], Any] = {(): RING(1)}
    kept = [row[:j] + row[j + 1 :] for k, row in enumerate(rows) if k != i]
    for row in kept:
        known = _expanded(row, known, len(kept))
    value = known.get(tuple(range(len(kept))), RING(0))
    return -value if (i + j) % 2 else value


def single_channel(system: PlainSystem, q: int) -> bool:
    """Whether some gains make channel q control everything: subsets and reachability."""
    n = system.n
    unit = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    full = PlainSystem(
        system.A, system.B, [unit if i == q else rows for i, rows in enumerate(system.C)]
    )
    arcs, reached = transfer_arcs(system), {q}
    while new := {i for j, i in arcs if j in reached} - reached:
        reached |= new
    reaches = all(i in reached or not any(map(any, rows)) for i, rows in enumerate(system.C))
    return reaches and not fixed_factors(full)


def exceptional(M: Rows, A: Rows, B: Rows, blocks: int) -> Coefficients:
    """The squarefree part of the gcd of the n×n minors of [B, (M+xA)B, …]."""
    n = len(A)
    moving = [[number(M[i][j]) + X * number(A[i][j]) for j in range(n)] for i in range(n)]
    block: Polynomials = [[number(v) for v in row] for row in B]
    rows = [list(row) for row in block]
    for _ in range(blocks - 1):
        columns = list(zip(*block, strict=True))
        block = [
            [sum((a * b for a, b in zip(r, c, strict=True)), RING(0)) for c in columns]
            for r in moving
        ]
        rows = [a + b for a, b in zip(rows, block, strict=True)]
    divisor = minors_divisor(rows, n)
    if not divisor:
        return ()
    return coefficients(divisor.quo(divisor.gcd(divisor.diff(X))))
