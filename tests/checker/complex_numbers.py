"""Complex matrices as certificates have them and in floating point, for formulas beside rules."""

from __future__ import annotations

import random
from typing import Any

from mcexact.checker.core.arithmetic import Matrix

Complex = list[list[complex]]
CLEAR = 1e-4
"""Where both sides of an inequality are so close to each other, rounding decides."""


def drawn(rng: random.Random, nrows: int, ncols: int, near: complex = 0) -> tuple[Any, Complex]:
    """A complex matrix, near a multiple of the identity, in a certificate and as numbers."""
    d = 2**20
    re, im = (
        [
            [round(d * part * (i == j)) + rng.randint(-d // 16, d // 16) for j in range(ncols)]
            for i in range(nrows)
        ]
        for part in (near.real, near.imag)
    )
    pairs = zip(re, im, strict=True)
    numbers = [[complex(x / d, y / d) for x, y in zip(*rows, strict=True)] for rows in pairs]
    return {"denominator": d, "re": re, "im": im}, numbers


def real(rng: random.Random, nrows: int, ncols: int, d: int, least: int = -3) -> Matrix:
    """A matrix of the checker with small entries."""
    return Matrix([[rng.randint(least, 3) for _ in range(ncols)] for _ in range(nrows)], ncols, d)


def numbers(M: Matrix) -> Complex:
    """Its entries."""
    return [[complex(entry / M.denominator) for entry in row] for row in M.rows]


def times(A: Complex, B: Complex) -> Complex:
    """The product."""
    columns = list(zip(*B, strict=True))
    return [[sum(a * b for a, b in zip(row, col, strict=True)) for col in columns] for row in A]


def sizes(A: Complex) -> Complex:
    """The absolute values."""
    return [[complex(abs(entry)) for entry in row] for row in A]
