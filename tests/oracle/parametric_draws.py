"""Drawn systems with a parameter: planted values, generic fixed modes, larger multiplicities."""

from __future__ import annotations

import random
from typing import Any

from mcexact import ParametricSystem

VALUES = (
    "t", "t - 1", "2*t - 3", "t^2", "(t - 1)*(t + 2)",
    "t^2 - 2", "t^3 - 2", "t^2 + 1", "t^2 + t + 1",
)  # fmt: skip
"""What vanishes at rational and irrational, real and complex values."""
OTHERS = ("t", "t", "t + 1", "1 - t", "t^2", "1/(t - 2)", "t/(t + 1)")


def drawn_parametric(rng: random.Random) -> ParametricSystem:
    """A system of at most four states and three channels."""
    n, m = rng.randint(1, 4), rng.randint(1, 3)

    def rows(nrows: int, ncols: int, density: float) -> list[list[Any]]:
        return [
            [rng.randint(-2, 2) if rng.random() < density else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]

    A = rows(n, n, 0.4)
    B = [rows(n, rng.choice((1, 1, 0, 2)), 0.5) for _ in range(m)]
    C = [rows(rng.choice((1, 1, 2)), n, 0.5) for _ in range(m)]
    kind = rng.random()
    if kind < 0.35 and n > 1:
        _planted(rng, A, B)
    elif kind < 0.6 and n > 1:
        _generic(rng, A, B)
    elif kind < 0.75 and n > 1:
        _multiple(rng, A, B)
    for _ in range(rng.choice((0, 1, 1, 2))):
        M = rng.choice([A, A, *B, *C])
        if M[0]:
            rng.choice(M)[rng.randrange(len(M[0]))] = rng.choice(OTHERS + VALUES)
    bounds = {"t": (0, 1)} if rng.random() < 0.15 else {}
    return ParametricSystem(A, B, C, parameters=["t"], assume=bounds)


def _planted(rng: random.Random, A: list[list[Any]], B: list[list[list[Any]]]) -> None:
    """A state that inputs reach through an entry that vanishes at the planted values alone."""
    n = len(A)
    A[-1] = [0] * (n - 1) + [rng.randint(-2, 2)]
    A[-1][rng.randrange(n - 1)] = rng.choice(VALUES)
    for B_i in B:
        B_i[-1] = [0] * len(B_i[-1])


def _generic(rng: random.Random, A: list[list[Any]], B: list[list[list[Any]]]) -> None:
    """One to three states that no input reaches, and whose modes depend on t."""
    n = len(A)
    k = rng.randint(1, min(3, n - 1))
    for i in range(n - k, n):
        A[i] = [0] * (n - k) + A[i][n - k :]
        A[i][rng.randrange(n - k, n)] = rng.choice(("t", "t + 1", "t^2", "-2*t"))
        for B_i in B:
            B_i[i] = [0] * len(B_i[i])


def _multiple(rng: random.Random, A: list[list[Any]], B: list[list[list[Any]]]) -> None:
    """A fixed mode that meets another one, or one that moves, at the planted values."""
    n = len(A)
    value = rng.choice(VALUES)
    A[-1] = [0] * (n - 1) + [value]
    if rng.random() < 0.5 and n > 2:
        A[-2] = [0] * (n - 2) + [0, rng.choice((0, 1))]
        for B_i in B:
            B_i[-2] = [0] * len(B_i[-2])
    for B_i in B:
        B_i[-1] = [0] * len(B_i[-1])
