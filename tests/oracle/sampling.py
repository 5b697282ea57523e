"""The slow oracle for sampled plants: the exponential at 100 digits, and what is compared with it.

`exponential` takes the exponential of ball arithmetic, which squares what it scales, and whose
balls are far smaller than what is compared with them.
"""

from __future__ import annotations

import random
from fractions import Fraction

from flint import arb, arb_mat, ctx, fmpq

Rows = list[list[Fraction]]
BITS = 600
DIGITS = 100


def exponential(A: Rows, B: Rows, h: Fraction) -> Rows:
    """[A_h, B_h], the first rows of exp(h[A, B; 0, 0]), with errors below 10^−100."""
    n = len(A)
    rows = [[*a, *b] for a, b in zip(A, B, strict=True)]
    size = len(rows[0]) if rows else 0
    rows += [[Fraction(0)] * size for _ in range(size - n)]
    before = ctx.prec
    ctx.prec = BITS
    try:
        balls = arb_mat([[_ball(h * x) for x in row] for row in rows]).exp()
        return [[_middle(balls[i, j]) for j in range(size)] for i in range(n)]
    finally:
        ctx.prec = before


def _ball(x: Fraction) -> arb:
    return arb(fmpq(x.numerator, x.denominator))


def _middle(x: arb) -> Fraction:
    """The center of a ball whose radius is below 10^−100."""
    assert x.rad() < arb(10) ** -DIGITS, x
    mantissa, exponent = x.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def drawn_plant(rng: random.Random, most: int = 5) -> tuple[Rows, Rows, Fraction]:
    """A, B and a step, of few digits or with fractions; some have zeros, chains or fast modes."""
    n, p = rng.randint(1, most), rng.randint(1, 3)
    size, density = rng.choice([1, 1, 3, 10]), rng.choice([0.4, 0.8, 1.0])

    def entry() -> Fraction:
        if rng.random() > density:
            return Fraction(0)
        return Fraction(rng.randint(-100 * size, 100 * size), rng.choice([100, 100, 7, 30]))

    A = [[entry() for _ in range(n)] for _ in range(n)]
    if rng.random() < 0.2:
        A = [[x if j > i else Fraction(0) for j, x in enumerate(row)] for i, row in enumerate(A)]
    B = [[entry() for _ in range(p)] for _ in range(n)]
    return A, B, Fraction(rng.choice(["1/100", "1/10", "1/3", "1/2", "1"]))


def drawn_radii(rng: random.Random, M: Rows) -> Rows:
    """Radii that are parts of the entries, some of which are certain; some zeros are uncertain."""
    part = Fraction(1, rng.choice([10**2, 10**3, 10**6]))
    return [
        [
            abs(x) * part if rng.random() < 0.7 else rng.choice([Fraction(0)] * 9 + [part])
            for x in row
        ]
        for row in M
    ]


def member(rng: random.Random, M: Rows, D: Rows) -> Rows:
    """A matrix within the radii, at a vertex of them or inside."""
    vertex = rng.random() < 0.5
    parts = [Fraction(-1), Fraction(1)] if vertex else [Fraction(k, 8) for k in range(-8, 9)]
    return [
        [x + r * rng.choice(parts) for x, r in zip(*rows, strict=True)]
        for rows in zip(M, D, strict=True)
    ]
