"""Polynomials in x and t, beside those of sympy."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
import sympy

from mcexact.checker.bivariate import (
    characteristic,
    degree,
    determinant,
    difference,
    divide,
    modulo,
    read,
    read_coefficients,
    text,
    without,
)
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused

t, x = sympy.symbols("t x")
PRIME = 1000003


def polynomial(*coefficients: list[Any]) -> list[list[Fraction]]:
    """A polynomial in x and t."""
    return [[Fraction(c) for c in part] for part in coefficients]


def expression(f: Any) -> Any:
    """The same for sympy."""
    return sum(
        sympy.Rational(c.numerator, c.denominator) * t**i * x**k
        for k, part in enumerate(f)
        for i, c in enumerate(map(Fraction, part))
    )


def drawn(rng: random.Random, size: int, length: int, denominator: int = 2) -> list[Matrix]:
    """A square matrix of polynomials in t, some rows and columns of lower degree."""
    rows, columns = ([rng.randint(1, length) for _ in range(size)] for _ in range(2))
    return [
        Matrix(
            [
                [rng.randint(-3, 3) if k < min(rows[i], columns[j]) else 0 for j in range(size)]
                for i in range(size)
            ],
            size,
            denominator,
        )
        for k in range(length)
    ]


def at_t(A: list[Matrix]) -> Any:
    """The same matrix for sympy."""
    return sum(
        (sympy.Matrix(M.nrows, M.ncols, sum(M.rows, [])) / M.denominator * t**k  # noqa: RUF017
         for k, M in enumerate(A)),
        sympy.zeros(A[0].nrows, A[0].ncols),
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(8))
def test_characteristic_polynomials_are_those_of_sympy(seed: int) -> None:
    rng = random.Random(seed)
    A = drawn(rng, seed % 4, 1 + seed % 3)
    expected = (x * sympy.eye(A[0].nrows) - at_t(A)).det(method="berkowitz")
    found = characteristic(A)
    assert sympy.expand(expression(found) - expected) == 0
    assert found[-1] == [1] and not any(c[-1:] == [0] for c in found)
    reduced = [[int(c * 2**8) * pow(2**8, -1, PRIME) % PRIME for c in part] for part in found]
    assert characteristic(A, PRIME) == reduced
    d = determinant(A)
    sign = sympy.expand(expression([d]) - at_t(A).det(method="berkowitz")) == 0
    assert sign or sympy.expand(expression([d]) + at_t(A).det(method="berkowitz")) == 0
    assert determinant(A, PRIME) == [int(c * 8) * pow(8, -1, PRIME) % PRIME for c in d]


def test_degrees_in_t_are_bounded_by_rows_or_by_columns() -> None:
    """t in one row or one column alone has degree 1 in the determinant: modulo 2 two values do."""
    row = [Matrix([[0, 0], [1, 1]], 2), Matrix([[1, 1], [0, 0]], 2)]
    assert characteristic(row, 2) == [[], [1, 1], [1]]
    column = [layer.T for layer in row]
    assert characteristic(column, 2) == [[], [1, 1], [1]]
    assert characteristic([Matrix([[1]], 1)], 2) == [[1], [1]]


def test_division_leaves_what_is_left() -> None:
    f = polynomial([0, 0, -2], [0, 1], [1])  # x² + t x − 2 t² = (x − t)(x + 2 t)
    g = polynomial([0, -1], [1])
    assert divide(f, g) == ([[0, 2], [1]], [])
    assert divide(f, polynomial([1], [1])) == ([[-1, 1], [1]], [[1, -1, -2]])
    assert divide(g, f) == ([], g)
    assert divide(polynomial([], [], [], [1]), polynomial([3], [2], [1])) == (
        [[-2], [1]],
        [[6], [1]],
    )
    cubic = polynomial([1], [], [], [1])
    assert divide(cubic, polynomial([], [], [1])) == ([[], [1]], [[1], []])
    q = [Fraction(c) for c in (-2, 0, 1)]
    assert divide(modulo(f, q), polynomial([2, 1], [1]), q) == ([[-2], [1]], [[0, 2]])
    assert divide(modulo(f, q), polynomial([0, 2], [1]), q) == ([[0, -1], [1]], [])
    assert divide(polynomial([0, -1], [], [1]), g, q) == ([[0, 1], [1]], [[2, -1]])


def test_all_powers_are_divided_out() -> None:
    f = polynomial([0, 0, -1], [0, 3], [-3], [])
    square = polynomial([], [], [1])
    assert without(square, polynomial([], [1])) == [[1]]
    assert without(square, polynomial([1], [1])) == square
    assert without(polynomial([], [], [], [1]), square) == [[], [1]]
    assert without(polynomial([1]), square) == [[1]]
    assert degree(f) == 2 and degree(square) == 0
    # x² − 2 is (x − t)(x + t) modulo t² − 2 alone
    q = [Fraction(c) for c in (-2, 0, 1)]
    two, root = polynomial([-2], [], [1]), polynomial([0, -1], [1])
    assert without(two, root) == two
    assert without(two, root, q) == [[0, 1], [1]]


def test_a_difference_has_the_coefficients_of_both() -> None:
    f, g = polynomial([1, 2], [], [3]), polynomial([1], [0, 1])
    assert difference(f, g) == polynomial([0, 2], [0, -1], [3])
    assert difference(g, f) == polynomial([0, -2], [0, 1], [-3])
    assert not any(difference(f, f))


def test_coefficients_are_reduced() -> None:
    f = polynomial([0, 0, 1], [1, 0, 0, 1], [1])
    assert modulo(f, [Fraction(-2), Fraction(0), Fraction(1)]) == [[2], [1, 2], [1]]
    assert modulo(f, None) == f


@pytest.mark.parametrize(
    ("f", "written"),
    [
        ([[], [1]], "x"),
        ([[-2], [1, 1], [1]], "x^2 + (t + 1)*x + (-2)"),
        ([[0, 1], [], [], [1]], "x^3 + (t)"),
        ([[1], [1], [1]], "x^2 + x + (1)"),
        ([[1], [2], [1]], "x^2 + (2)*x + (1)"),
    ],
)
def test_a_polynomial_is_written_by_powers_of_x(f: Any, written: str) -> None:
    assert text(polynomial(*f), "t") == written


Q = [Fraction(-2), Fraction(0), Fraction(1)]


@pytest.mark.parametrize("value", [[[], [1]], [["1/2", 3], [1]], [[0, 1], [], [1]]])
def test_what_is_monic_and_reduced_is_read(value: Any) -> None:
    assert read(value, "p", Q) == read(value, "p") == polynomial(*value)
    assert read_coefficients(value) == polynomial(*value)


@pytest.mark.parametrize(
    ("value", "alone"),
    [
        ([[0], [1]], False),
        ([[1, 0], [1]], False),
        ([[1]], False),
        ([], False),
        ([[], [2]], False),
        ([[], [1, 1]], False),
        ([[], []], False),
        ([[0, 0, 1], [1]], True),
        ([[0, 0, 0, 1], [1]], True),
        ([["2/4"], [1]], False),
        ([1, [1]], False),
        ("x", False),
    ],
)
def test_what_is_not_is_malformed(value: Any, alone: bool) -> None:
    with pytest.raises(Refused):
        read(value, "p", Q)
    if alone:
        assert read(value, "p") == polynomial(*value)
    else:
        with pytest.raises(Refused):
            read(value, "p")
