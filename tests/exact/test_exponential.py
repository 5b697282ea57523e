"""The matrix exponential is rounded to decimals, with a proved error."""

from fractions import Fraction

import pytest

from mcexact.exact.balls import exponential
from mcexact.exact.matrix import Matrix


@pytest.mark.parametrize("decimals", [0, 1, 12, 60])
def test_a_nilpotent_matrix_has_a_polynomial_for_its_exponential(decimals):
    M = Matrix.from_rows([[0, "1/3", 2], [0, 0, "-7/5"], [0, 0, 0]])
    exact = Matrix.identity(3) + M + M @ M * Fraction(1, 2)
    found, unit = exponential(M, decimals), Fraction(1, 10**decimals)
    for i in range(3):
        for j in range(3):
            assert abs(found[i, j] - exact[i, j]) <= Fraction(51, 100) * unit
            assert (found[i, j] / unit).denominator == 1


def test_the_exponential_of_a_sum_of_commuting_matrices_is_a_product():
    M = Matrix.from_rows([["1/2", 1], [-3, "1/4"]])
    once, twice = exponential(M, 40), exponential(M * 2, 40)
    product = once @ once
    assert all(
        abs(product[i, j] - twice[i, j]) < Fraction(1, 10**38) for i in range(2) for j in range(2)
    )


def test_nothing_has_the_exponential_nothing():
    assert exponential(Matrix.zeros(0, 0), 3).shape == (0, 0)
