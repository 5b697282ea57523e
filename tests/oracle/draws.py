"""Small systems drawn at random, among them many with fixed modes, and their exact forms."""

from __future__ import annotations

import random
from fractions import Fraction

from mcexact.model.system import MultiChannelSystem
from tests.oracle.enumeration import PlainSystem, Rows


def exact(system: PlainSystem, time: str = "continuous") -> MultiChannelSystem:
    """The same system as the package holds it."""
    from mcexact.exact.matrix import Matrix

    n = system.n
    B = [Matrix.from_rows(rows, ncols=None if n else 0) for rows in system.B]
    C = [Matrix.from_rows(rows, ncols=n) for rows in system.C]
    return MultiChannelSystem(Matrix.from_rows(system.A, ncols=n), B, C, time=time)


def _entries(rng: random.Random, nrows: int, ncols: int, density: float, values: list[int]) -> Rows:
    return [
        [Fraction(rng.choice(values) if rng.random() < density else 0) for _ in range(ncols)]
        for _ in range(nrows)
    ]


def sparse_system(rng: random.Random, states: int = 5, channels: int = 4) -> PlainSystem:
    """At most so many states and channels, entries −2 … 2, mostly 0.

    A good share has fixed modes; some are not jointly controllable or observable, some channels are
    inactive or have no inputs or outputs at all, some entries are fractions.
    """
    n, m = rng.randint(1, states), rng.randint(1, channels)
    values = rng.choice([[1], [1, -1], [1, 2, -1, -2]])
    A = _entries(rng, n, n, rng.choice([0.2, 0.4, 0.7]), values)
    if rng.random() < 0.5:
        for i in range(n):
            A[i][i] += rng.choice([0, 1])
    if rng.random() < 0.1:
        A = [[value / 2 for value in row] for row in A]
    density = rng.choice([0.3, 0.5, 0.8])
    widths = [[0, 1, 1, 1, 1, 2], [1]][rng.random() < 0.5]
    B = [_entries(rng, n, rng.choice(widths), density, values) for _ in range(m)]
    C = [_entries(rng, rng.choice(widths), n, density, values) for _ in range(m)]
    return PlainSystem(A, B, C)
