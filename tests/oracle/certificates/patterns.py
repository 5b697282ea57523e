"""Structural fixed modes: every path, and what the loops of drawn plants have in common."""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable, Sequence
from typing import Any

from flint import fmpq, fmpq_mat, fmpq_poly

from .algebra import X
from .reading import demand, integer, listed, polynomial, record
from .systems import System

Draw = Callable[[], fmpq]
SIZE = 2**30
"""Drawn numbers are so large that no two polynomials in them meet by chance."""


def structural_fixed_modes(claim: Any, witness: Any, system: System) -> bool:
    """Of drawn plants with the same zeros, and of drawn gains, for each."""
    found = record(claim, "information", "without_feedback", "at_zero", "polynomial")
    demand(found["information"] in ("own", "outputs"), "expected own or outputs")
    own = found["information"] == "own"
    used = [[i] for i in range(system.m)] if own else [list(N) for N in system.graph()]
    states = [integer(a, 0) for a in listed(found["without_feedback"])]
    z = integer(found["at_zero"], 0)
    rng = random.Random(str(claim))
    return (
        states == without_feedback(system, used)
        and z <= system.n
        and polynomial(found["polynomial"], monic=True) == X**z * part(system.A, states)
        and all(
            common(rng, other, used) == X**z * part(other.A, states)
            for other in (redrawn(rng, system) for _ in range(2))
        )
    )


def part(A: fmpq_mat, states: Sequence[int]) -> fmpq_poly:
    """det(xI − A) of some rows and columns."""
    size = len(states)
    return fmpq_mat(size, size, [A[a, b] for a in states for b in states]).charpoly()


def without_feedback(system: System, used: Sequence[Sequence[int]]) -> list[int]:
    """The states from which no path leads to an output, by its agent to an input, and back."""
    n, m = system.n, system.m
    reached = [[bool(system.A[a, b]) or a == b for b in range(n)] for a in range(n)]
    for k, a, b in itertools.product(range(n), repeat=3):
        reached[a][b] = reached[a][b] or (reached[a][k] and reached[k][b])
    acts = [[any(_row(system.B[i], a)) for a in range(n)] for i in range(m)]
    shows = [[any(_row(system.C[i].transpose(), b)) for b in range(n)] for i in range(m)]
    over = [[False] * m for _ in range(m)]  # from what agent i does to what agent j is shown
    for i, j in itertools.product(range(m), repeat=2):
        pairs = itertools.product(range(n), repeat=2)
        over[i][j] = any(acts[i][a] and shows[j][b] and reached[b][a] for a, b in pairs)
    follows = [[any(over[i][j] for j in used[k]) for k in range(m)] for i in range(m)]
    for k, i, j in itertools.product(range(m), repeat=3):
        follows[i][j] = follows[i][j] or (follows[i][k] and follows[k][j])

    def fed(a: int) -> bool:
        into = [i for i in range(m) if any(acts[i][b] and reached[a][b] for b in range(n))]
        out = {j for j in range(m) if any(shows[j][b] and reached[b][a] for b in range(n))}
        users = [k for k in range(m) if out & {*used[k]}]
        return any(k == i or follows[k][i] for k in users for i in into)

    return [a for a in range(n) if not fed(a)]


def _row(M: fmpq_mat, a: int) -> list[Any]:
    return [M[a, k] for k in range(M.ncols())]


def redrawn(rng: random.Random, system: System) -> System:
    """A plant with other numbers at the places of those that are not 0."""

    def other(M: fmpq_mat) -> fmpq_mat:
        drawn = [fmpq(rng.randint(1, SIZE)) if x else fmpq(0) for x in M.entries()]
        return fmpq_mat(M.nrows(), M.ncols(), drawn)

    B, C = (tuple(map(other, each)) for each in (system.B, system.C))
    return System(system.time, other(system.A), system.names, B, C)


def common(rng: random.Random, system: System, used: Sequence[Sequence[int]]) -> fmpq_poly:
    """The monic greatest common divisor of det(xI − A − Σ B_i F_ij C_j) for drawn F_ij."""
    found = fmpq_poly()
    for _ in range(3):
        A = system.A
        for i, B in enumerate(system.B):
            for C in (system.C[j] for j in used[i]):
                size = B.ncols() * C.nrows()
                drawn = [fmpq(rng.randint(-SIZE, SIZE)) for _ in range(size)]
                A = A + B * fmpq_mat(B.ncols(), C.nrows(), drawn) * C
        found = found.gcd(A.charpoly())
    return found


JUDGES = {"structural_fixed_modes": structural_fixed_modes}
"""The judge of each kind."""
