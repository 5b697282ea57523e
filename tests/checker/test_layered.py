"""Matrices of polynomials in t, by their coefficients."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from mcexact.checker.bivariate import is_zero, layered_difference, product, reduced
from mcexact.checker.core.arithmetic import Matrix

ONE = Fraction(1)


def numbers(*coefficients: int) -> list[Matrix]:
    """A matrix of one polynomial."""
    return [Matrix([[c]], 1) for c in coefficients]


def values(P: list[Matrix]) -> list[Any]:
    """The first entries of the coefficients."""
    return [Fraction(layer.rows[0][0], layer.denominator) for layer in P]


def test_a_product_is_that_of_polynomials() -> None:
    assert values(product(numbers(1, 2), numbers(3, 0, 1))) == [3, 6, 1, 2]
    assert values(product(numbers(0), numbers(1, 1))) == [0, 0]
    assert values(product(numbers(1, 1), numbers(0))) == [0, 0]
    left = [Matrix([[1, 2]], 2), Matrix([[0, 1]], 2)]
    right = [Matrix([[1, 0, 1], [0, 1, 1]], 3)]
    found = product(left, right)
    assert [layer.rows for layer in found] == [[[1, 2, 3]], [[0, 1, 1]]]
    assert [layer.rows for layer in product([Matrix([[1], [2]], 1)], [Matrix([[3, 4]], 2)])] == [
        [[3, 4], [6, 8]]
    ]


def test_a_product_is_reduced() -> None:
    assert values(product(numbers(0, 1), numbers(0, 1), [-2 * ONE, 0 * ONE, ONE])) == [2, 0]


def test_the_remainder_is_that_of_polynomials() -> None:
    q = [2 * ONE, -ONE, ONE]  # t² − t + 2
    assert values(reduced(numbers(5, 7), q)) == [5, 7]
    assert values(reduced(numbers(0, 0, 1), q)) == [-2, 1]
    assert values(reduced(numbers(1, 0, 0, 1), q)) == [-1, -1]
    assert values(reduced(numbers(1, 2, 3, 4), [-ONE, ONE])) == [10]
    assert values(reduced(numbers(3, 2, 0), [ONE, ONE])) == [1]
    assert values(reduced(numbers(0, 0, 1), [-ONE / 2, 0 * ONE, ONE])) == [ONE / 2, 0]
    assert values(reduced(numbers(1, 2, 3), None)) == [1, 2, 3]


def test_a_difference_has_all_coefficients() -> None:
    assert values(layered_difference(numbers(1, 2), numbers(4))) == [-3, 2]
    assert values(layered_difference(numbers(1), numbers(4, 5))) == [-3, -5]
    assert [
        layer.rows for layer in layered_difference([Matrix([[1, 2]], 2)], [Matrix([[3, 5]], 2)] * 2)
    ] == [
        [[-2, -3]],
        [[-3, -5]],
    ]


def test_a_matrix_is_zero_if_all_coefficients_are() -> None:
    assert is_zero(numbers(0, 0)) and is_zero([])
    assert not is_zero(numbers(0, 1)) and not is_zero(numbers(1, 0))
