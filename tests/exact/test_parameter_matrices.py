"""Determinants and null spaces of matrices of polynomials, against determinants of sympy."""

from __future__ import annotations

import random

import pytest
import sympy

from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.modular import polynomial_residues
from mcexact.exact.parametric_polynomials import (
    ParametricPolynomial,
    determinant,
    determinant_modulo,
    entries_of,
    generic_nullspace,
    matrix_of,
    nullspace_over_field,
)
from mcexact.exact.polynomial import Polynomial

t = sympy.Symbol("t")
PRIME = 1000003


def drawn(rng: random.Random, nrows: int, ncols: int) -> PolynomialMatrix:
    def entry() -> Polynomial:
        return Polynomial.of(*(rng.randint(-3, 3) for _ in range(rng.randint(0, 3))))

    rows = [[entry() for _ in range(ncols)] for _ in range(nrows)]
    return PolynomialMatrix.from_polynomials(rows, ncols=ncols)


@pytest.mark.parametrize("n", range(4))
def test_determinants_are_those_of_sympy(n: int) -> None:
    M = drawn(random.Random(n), n, n)
    entries = [M.entry(i, j).coefficients for i in range(n) for j in range(n)]
    values = [sum(c * t**k for k, c in enumerate(entry)) for entry in entries]
    expected = sympy.Poly(sympy.Matrix(n, n, values).det(), t)
    coefficients = [int(c) for c in reversed(expected.all_coeffs())]
    exact = determinant(M)
    assert exact == Polynomial.of(*coefficients)
    assert determinant_modulo(M, PRIME) == polynomial_residues(exact, PRIME)


def test_null_spaces_are_annihilated_generically_and_at_a_value() -> None:
    M = drawn(random.Random(5), 3, 2) @ drawn(random.Random(6), 2, 4)
    pivots, (columns,) = generic_nullspace([M])
    assert len(pivots) == columns.ncols == 2
    assert (M @ columns).is_zero()
    q = Polynomial.of(-2, 0, 1)
    row = PolynomialMatrix.from_polynomials([[q, Polynomial.of(1)]], ncols=2)
    pivots, (column,) = nullspace_over_field([row], q)
    assert pivots == (0,)
    assert [column.entry(i, 0) for i in range(2)] == [Polynomial.of(1), Polynomial.of()]


def test_a_null_space_at_the_roots_of_a_polynomial_in_x_is_annihilated_there() -> None:
    """[x, −1; −t, x] has (1, x) in its null space where x² = t, for every t and where t² = 2."""
    constant = PolynomialMatrix.from_polynomials(
        [[Polynomial.of(), Polynomial.of(-1)], [Polynomial.of(0, -1), Polynomial.of()]]
    )
    pencil = [constant, PolynomialMatrix.identity(2)]
    p = ParametricPolynomial.from_polynomials(
        [Polynomial.of(0, -1), Polynomial.of(), Polynomial.of(1)], ("t",)
    )
    q = Polynomial.of(-2, 0, 1)
    for pivots, (low, high) in (generic_nullspace(pencil, p), nullspace_over_field(pencil, q, p)):
        assert pivots == (1,) and low.shape == high.shape == (2, 1)
        # (x M_1 + M_0)(low + x high), with t for x²
        t_times_high = high.times_x()
        assert ((constant @ low + t_times_high) % q).is_zero()
        assert ((constant @ high + low) % q).is_zero()
    assert generic_nullspace(pencil[:1])[0] == nullspace_over_field(pencil[:1], q)[0] == ()


def test_entries_go_to_flint_and_back() -> None:
    M = drawn(random.Random(7), 2, 3)
    for each in (M, PolynomialMatrix.identity(0), M.take(rows=()), M.take(cols=())):
        assert matrix_of(entries_of(each), each.ncols) == each
