"""Discs of regular pencils, compared with their formulas in floating point."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.discs import Pencil, left_inverse, right_inverse
from tests.checker.complex_numbers import CLEAR, drawn, numbers, real, sizes, times


@pytest.mark.parametrize("left", [True, False])
def test_a_disc_is_regular_exactly_where_the_rows_are_small(left: bool) -> None:
    seen = set()
    for seed in range(150):
        rng = random.Random(seed)
        n, more = rng.choice(((1, 0), (2, 0), (2, 1), (1, 2)))
        N = n + more
        d = rng.choice((4, 5))
        Z = real(rng, N if left else n, N, d)
        if left and more:
            Z = Matrix(
                [
                    [-d * (i == j) if i >= n else e for j, e in enumerate(row)]
                    for i, row in enumerate(Z.rows)
                ],
                N,
                d,
            )
        D = real(rng, Z.nrows, N, 40, 0)
        c = complex(rng.randint(-3, 3) / 2, rng.randint(-3, 3) / 2)
        rho = Fraction(rng.randint(0, 6), 16)
        w = [rng.randint(1, 3) for _ in range(N if left else n)]
        near = 1 / (c + 0.3) if rng.random() < 0.8 else 1
        given, V = drawn(rng, N, N if left else n, near)
        rule = left_inverse if left else right_inverse
        found = rule(given, w, "", Pencil(Z, D, n))(Fraction(c.real), Fraction(c.imag), rho)
        E = [[complex(i == j < n) for j in range(N)] for i in range(Z.nrows)]
        cEZ = [
            [c * e - z for e, z in zip(*rows, strict=True)]
            for rows in zip(E, numbers(Z), strict=True)
        ]
        order = [V, cEZ] if left else [cEZ, V]
        M = times(*order)
        bound = times(*([sizes(V), numbers(D)] if left else [numbers(D), sizes(V)]))
        moved = sizes(times(*([V, E] if left else [E, V])))
        rows = [
            sum(
                (abs((i == j) - M[i][j]) + bound[i][j].real + float(rho) * moved[i][j].real) * w[j]
                for j in range(len(w))
            )
            - w[i]
            for i in range(len(w))
        ]
        if min(map(abs, rows)) > CLEAR:
            assert found == (max(rows) < 0), seed
            seen.add(found)
    assert seen == {True, False}


@pytest.mark.parametrize("rule", [left_inverse, right_inverse])
def test_a_disc_stays_clear_of_what_is_tied(rule: Any) -> None:
    """λ − s is regular for all s from −1 to 1 where |λ − 2| is below 1."""
    zero, half = Matrix.zeros(1, 1), {"denominator": 2, "re": [[1]], "im": [[0]]}
    regular = rule(half, [1], "", Pencil(zero, zero, 1, [Matrix([[1]], 1)]))
    assert regular(Fraction(2), Fraction(0), Fraction(9, 10))
    assert not regular(Fraction(2), Fraction(0), Fraction(1))


def test_a_disc_is_regular_beside_signals_without_dynamics() -> None:
    """diag(λ, 1) is regular where |λ − 1| is below 1."""
    unit = {"denominator": 1, "re": [[1, 0], [0, 1]], "im": [[0, 0], [0, 0]]}
    pencil = Pencil(Matrix([[0, 0], [0, -1]], 2), Matrix.zeros(2, 2), 1)
    regular = left_inverse(unit, [1, 1], "", pencil)
    assert regular(Fraction(1), Fraction(0), Fraction(9, 10))
    assert not regular(Fraction(1), Fraction(0), Fraction(1))


def test_without_dynamics_every_disc_is_regular() -> None:
    one = {"denominator": 1, "re": [[1]], "im": [[0]]}
    regular = left_inverse(one, [1], "", Pencil(Matrix([[-1]], 1), Matrix.zeros(1, 1), 0))
    assert regular(Fraction(5), Fraction(-3), Fraction(100))
