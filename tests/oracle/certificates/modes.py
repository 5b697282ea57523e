"""Fixed modes by their definition, transfer graphs, and ranks of pencils of all subsets."""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from flint import fmpq, fmpq_mat, fmpq_poly

from . import algebra
from .systems import System


def pencil(system: System, s: Sequence[int]) -> tuple[fmpq_mat, fmpq_mat]:
    """P_s(x) = [xI − A, B_{m−s}; C_s, 0] as a constant matrix and the matrix beside x."""
    n = system.n
    B = system.inputs([i for i in range(system.m) if i not in s])
    C = system.outputs(s)
    p, q = B.ncols(), C.nrows()
    constant = algebra.stacked([[-system.A, B], [C, fmpq_mat(q, p)]], n + q, n + p)
    slope = algebra.stacked(
        [[algebra.identity(n), fmpq_mat(n, p)], [fmpq_mat(q, n), fmpq_mat(q, p)]], n + q, n + p
    )
    return constant, slope


def pencil_rank(system: System, s: Sequence[int], p: fmpq_poly) -> int:
    """The rank of P_s at the roots of an irreducible polynomial."""
    return algebra.rank_at(*pencil(system, s), p)


def subsets(m: int) -> Iterator[tuple[int, ...]]:
    """All subsets of m channels."""
    for size in range(m + 1):
        yield from itertools.combinations(range(m), size)


def drawn_loop(system: System, rng: random.Random, bound: int = 2**40) -> fmpq_mat:
    """A_F for gains drawn from −bound … bound."""
    A = system.A
    for B, C in zip(system.B, system.C, strict=True):
        p, q = B.ncols(), C.nrows()
        F = fmpq_mat(p, q, [fmpq(rng.randint(-bound, bound)) for _ in range(p * q)])
        A = A + B * F * C
    return A


@dataclass(frozen=True)
class FixedMode:
    """An irreducible polynomial whose roots are fixed.

    Attributes
    ----------
    polynomial : fmpq_poly
    ranks : dict
        rank P_s at the roots, under every s.
    in_A, in_every_loop : int
        Its multiplicity in χ_A, and the least in χ_{A_F} over all F.
    """

    polynomial: fmpq_poly
    ranks: dict[tuple[int, ...], int]
    in_A: int
    in_every_loop: int

    @property
    def least(self) -> int:
        """The least rank."""
        return min(self.ranks.values())


def fixed_modes(system: System) -> list[FixedMode]:
    """The eigenvalues of A_F for all F: a loop that lacks one proves that it is not fixed."""
    rng = random.Random(7)
    drawn = [drawn_loop(system, rng).charpoly() for _ in range(2)]
    found = []
    for p, exponent in algebra.irreducible_factors(system.A.charpoly()):
        least = min(algebra.multiplicity(p, chi) for chi in drawn)
        if least:
            ranks = {s: pencil_rank(system, s, p) for s in subsets(system.m)}
            if min(ranks.values()) >= system.n:
                raise ArithmeticError("drawn gains were special")
            found.append(FixedMode(p, ranks, exponent, least))
    return found


def transfer_edges(system: System) -> list[tuple[int, int]]:
    """Edges j → i where C_i A^k B_j ≠ 0 for some k < n, sorted."""
    found = []
    for j in range(system.m):
        K = algebra.krylov(system.A, system.B[j], system.n)
        for i in range(system.m):
            if any(v != 0 for v in (system.C[i] * K).entries()):
                found.append((j, i))
    return found


def components(m: int, edges: Sequence[tuple[int, int]]) -> list[list[int]]:
    """Strong components by transitive closure, sorted by first member."""
    known = set(edges)
    reach = [[i == j or (i, j) in known for j in range(m)] for i in range(m)]
    for k, i, j in itertools.product(range(m), repeat=3):
        reach[i][j] = reach[i][j] or (reach[i][k] and reach[k][j])
    found: list[list[int]] = []
    for i in range(m):
        if not any(i in c for c in found):
            found.append([j for j in range(m) if reach[i][j] and reach[j][i]])
    return found


def connected(system: System) -> bool:
    """Whether the transfer graph is strongly connected."""
    return len(components(system.m, transfer_edges(system))) <= 1
