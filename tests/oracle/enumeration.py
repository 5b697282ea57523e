"""Decisions by exhaustive enumeration over all subsets of channels.

Nothing here imports ``mcexact.exact``: matrices are lists of rows of Fractions, ranks come from
sympy's ``DomainMatrix`` over Q, and an eigenvalue with minimal polynomial p is handled by putting
the companion matrix of p in its place, which multiplies every rank by the degree of p.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from sympy import QQ, Poly, Symbol
from sympy.polys.matrices import DomainMatrix

Rows = list[list[Fraction]]
Coefficients = tuple[Fraction, ...]
X = Symbol("x")


@dataclass(frozen=True)
class PlainSystem:
    """A multi-channel system as lists: A is n×n, ``B[i]`` is n×p_i, ``C[i]`` is q_i×n."""

    A: Rows
    B: list[Rows]
    C: list[Rows]

    @property
    def n(self) -> int:
        """Number of states."""
        return len(self.A)

    @property
    def m(self) -> int:
        """Number of channels."""
        return len(self.B)

    @property
    def dual(self) -> PlainSystem:
        """The system (A', C', B')."""
        columns = [[[c[j] for c in rows] for j in range(self.n)] for rows in self.C]
        width = [len(rows[0]) if self.n else 0 for rows in self.B]
        rows = [[[b[j] for b in B] for j in range(w)] for B, w in zip(self.B, width, strict=True)]
        return PlainSystem([list(r) for r in zip(*self.A, strict=True)], columns, rows)


def plain(system: Any) -> PlainSystem:
    """Copy the numbers of a ``MultiChannelSystem`` into lists."""
    return PlainSystem(
        [list(row) for row in system.A.rows()],
        [[list(row) for row in channel.B.rows()] for channel in system.channels],
        [[list(row) for row in channel.C.rows()] for channel in system.channels],
    )


def subsets(m: int) -> Iterator[tuple[int, ...]]:
    """Every subset of the channels 0 … m−1, the smallest first."""
    for size in range(m + 1):
        yield from itertools.combinations(range(m), size)


def rank(rows: Rows) -> int:
    """Rank over Q."""
    if not rows or not rows[0]:
        return 0
    domain_rows = [[QQ(v.numerator, v.denominator) for v in row] for row in rows]
    return int(DomainMatrix(domain_rows, (len(rows), len(rows[0])), QQ).rank())


def characteristic_polynomial(A: Rows) -> Coefficients:
    """Coefficients of det(xI − A), constant term first."""
    if not A:
        return (Fraction(1),)
    rows = [[QQ(v.numerator, v.denominator) for v in row] for row in A]
    found = DomainMatrix(rows, (len(A), len(A)), QQ).charpoly()
    return tuple(Fraction(int(c.numerator), int(c.denominator)) for c in reversed(found))


def _poly(coefficients: Sequence[Fraction]) -> Any:
    return Poly([QQ(c.numerator, c.denominator) for c in reversed(coefficients)], X, domain=QQ)


def _coefficients(poly: Any) -> Coefficients:
    values = reversed(poly.monic().all_coeffs())
    return tuple(Fraction(int(c.p), int(c.q)) for c in values)


def irreducible_factors(coefficients: Coefficients) -> dict[Coefficients, int]:
    """The monic irreducible factors over Q with their multiplicities."""
    _, factors = _poly(coefficients).factor_list()
    return {_coefficients(p): multiplicity for p, multiplicity in factors if p.degree() > 0}


def multiplicity(p: Coefficients, coefficients: Coefficients) -> int:
    """The exponent of p in a nonzero polynomial."""
    divisor, rest, count = _poly(p), _poly(coefficients), 0
    while True:
        quotient, remainder = rest.div(divisor)
        if not remainder.is_zero:
            return count
        rest, count = quotient, count + 1


def at_root(constant: Rows, shifts: set[tuple[int, int]], p: Coefficients) -> Rows:
    """constant + λ·(ones at ``shifts``), with the companion matrix of p in the place of λ."""
    d = len(p) - 1
    companion = [[Fraction(int(i == j + 1)) for j in range(d)] for i in range(d)]
    for i in range(d):
        companion[i][d - 1] = -p[i]
    rows = []
    for i, row in enumerate(constant):
        for k in range(d):
            out: list[Fraction] = []
            for j, value in enumerate(row):
                block = [value if k == j2 else Fraction(0) for j2 in range(d)]
                if (i, j) in shifts:
                    block = [a + b for a, b in zip(block, companion[k], strict=True)]
                out += block
            rows.append(out)
    return rows


def pencil_rank(system: PlainSystem, s: Sequence[int], p: Coefficients) -> int:
    """Rank of [λI − A, B_{m−s}; C_s, 0] at a root λ of the irreducible p."""
    n = system.n
    outside = [i for i in range(system.m) if i not in s]
    rows: Rows = []
    for i in range(n):
        inputs = [value for t in outside for value in system.B[t][i]]
        rows.append([-value for value in system.A[i]] + inputs)
    width = len(rows[0]) if rows else 0
    for t in s:
        rows += [row + [Fraction(0)] * (width - n) for row in system.C[t]]
    inflated = at_root(rows, {(i, i) for i in range(n)}, p)
    return rank(inflated) // (len(p) - 1)


@dataclass(frozen=True)
class Obstruction:
    """A fixed factor: its least pencil rank and the largest subset that attains it."""

    rank: int
    channels: tuple[int, ...]
    multiplicity_in_A: int


def fixed_factors(system: PlainSystem) -> dict[Coefficients, Obstruction]:
    """Every irreducible factor of det(xI − A) whose pencil loses rank for some subset."""
    found: dict[Coefficients, Obstruction] = {}
    for p, exponent in irreducible_factors(characteristic_polynomial(system.A)).items():
        ranks = {s: pencil_rank(system, s, p) for s in subsets(system.m)}
        least = min(ranks.values())
        if least < system.n:
            union = sorted({i for s, value in ranks.items() if value == least for i in s})
            if ranks[tuple(union)] != least:
                message = "the subsets of least rank are not closed under union"
                raise ArithmeticError(message)
            found[p] = Obstruction(least, tuple(union), exponent)
    return found


def deficiency(system: PlainSystem) -> int:
    """The largest n − rank P_s(λ) over all subsets s and all λ."""
    return max((system.n - f.rank for f in fixed_factors(system).values()), default=0)


def product(A: Rows, B: Rows) -> Rows:
    """A·B for lists of rows."""
    columns = list(zip(*B, strict=True))
    return [
        [sum((a * b for a, b in zip(r, c, strict=True)), Fraction(0)) for c in columns] for r in A
    ]


def drawn_closed_loop(system: PlainSystem, rng: random.Random, bound: int = 10**6) -> Rows:
    """A + Σ B_i F_i C_i for integer gains drawn from −bound … bound."""
    n = system.n
    closed = [list(row) for row in system.A]
    for B, C in zip(system.B, system.C, strict=True):
        p = len(B[0]) if n else 0
        if not p or not C:
            continue
        F = [[Fraction(rng.randint(-bound, bound)) for _ in C] for _ in range(p)]
        loop = product(product(B, F), C)
        for i in range(n):
            closed[i] = [a + b for a, b in zip(closed[i], loop[i], strict=True)]
    return closed


def least_multiplicity(system: PlainSystem, p: Coefficients, seed: int = 0) -> int:
    """The least exponent of p in the characteristic polynomials of three drawn closed loops."""
    rng = random.Random(seed)
    drawn = (characteristic_polynomial(drawn_closed_loop(system, rng)) for _ in range(3))
    return min(multiplicity(p, chi) for chi in drawn)


def controllable_dimension(system: PlainSystem, channels: Sequence[int] | None = None) -> int:
    """Rank of [B_T, A B_T, …, A^{n−1} B_T]."""
    chosen = range(system.m) if channels is None else channels
    n = system.n
    block = [[value for t in chosen for value in system.B[t][i]] for i in range(n)]
    if not n or not block[0]:
        return 0
    rows = [list(row) for row in block]
    for _ in range(n - 1):
        block = product(system.A, block)
        rows = [a + b for a, b in zip(rows, block, strict=True)]
    return rank(rows)


def transfer_arcs(system: PlainSystem) -> list[tuple[int, int]]:
    """Arcs (j, i) with some C_i A^k B_j ≠ 0, k < n, sorted."""
    arcs = set()
    for j in range(system.m):
        block = system.B[j]
        for _ in range(system.n):
            if not block[0]:
                break
            for i in range(system.m):
                if any(any(row) for row in product(system.C[i], block)):
                    arcs.add((j, i))
            block = product(system.A, block)
    return sorted(arcs)


def strong_components(m: int, arcs: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Strong components by transitive closure, sorted by first member."""
    reach = [[i == j or (i, j) in set(arcs) for j in range(m)] for i in range(m)]
    for k, i, j in itertools.product(range(m), repeat=3):
        reach[i][j] = reach[i][j] or (reach[i][k] and reach[k][j])
    components: list[list[int]] = []
    for i in range(m):
        if not any(i in c for c in components):
            components.append([j for j in range(m) if reach[i][j] and reach[j][i]])
    return components


def is_complete(system: PlainSystem) -> bool:
    """Strongly connected transfer graph and no fixed mode, all subsets included."""
    connected = len(strong_components(system.m, transfer_arcs(system))) == 1
    return connected and not fixed_factors(system)
