"""Polynomials from their values at 0, 1, …"""

from __future__ import annotations

from fractions import Fraction

import pytest

from mcexact.checker.bivariate import interpolated
from mcexact.checker.core.arithmetic import NotAUnit


def test_values_are_interpolated_over_q_and_modulo_a_number() -> None:
    values = [[Fraction(k * k, 2), Fraction(1)] for k in range(3)]
    assert interpolated(values) == [[0, 0, Fraction(1, 2)], [1]]
    assert interpolated([[k * k % 7] for k in range(3)], 7) == [[0, 0, 1]]
    assert interpolated([[0], [0]]) == [[]]


def test_a_polynomial_has_as_many_coefficients_as_values() -> None:
    cubic = [[Fraction(2 * k**3 - k + 5), Fraction(k)] for k in range(4)]
    assert interpolated(cubic) == [[5, -1, 0, 2], [0, 1]]
    assert interpolated([[int(p[0]) % 11, int(p[1])] for p in cubic], 11) == [[5, 10, 0, 2], [0, 1]]
    assert interpolated([[Fraction(3)]]) == [[3]]
    assert interpolated([[3]], 5) == [[3]]


def test_the_differences_of_the_values_of_t_are_units() -> None:
    values = [[k] for k in range(4)]
    assert interpolated(values, 5) == [[0, 1]]
    with pytest.raises(NotAUnit):
        interpolated(values, 3)
    with pytest.raises(NotAUnit):
        interpolated(values, 4)
