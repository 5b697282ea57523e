"""Linear algebra over Q: defining equations, and sympy beside it."""

from fractions import Fraction

import pytest
from hypothesis import given

from mcexact.errors import InputError
from mcexact.exact import linear_algebra
from mcexact.exact.linear_algebra import (
    characteristic_polynomial,
    determinant,
    inverse,
    left_nullspace,
    minimal_polynomial,
    nullspace,
    nullspace_and_pivots,
    rank,
    row_echelon,
    solve,
    solve_nonsingular,
)
from mcexact.exact.matrix import Matrix, hstack
from mcexact.exact.polynomial import Polynomial
from tests.exact.draws import domain_matrix, evaluated, matrices, small, square_matrices

low_rank = matrices(entries=small)


@given(matrices() | low_rank)
def test_the_rank_is_that_of_sympy(M):
    assert rank(M) == domain_matrix(M).rank()


def test_a_rank_that_drops_modulo_the_probe_is_still_found():
    ell = linear_algebra._PROBE
    assert rank(Matrix.from_rows([[ell, 0], [0, 1]])) == 2


@given(matrices() | low_rank)
def test_echelon_forms_span_the_same_space_with_an_identity_at_the_pivots(M):
    R, pivots = row_echelon(M)
    assert R.take(cols=pivots) == Matrix.identity(rank(M))
    assert M.take(cols=pivots) @ R == M
    assert list(pivots) == sorted(pivots)


@given(matrices() | low_rank)
def test_null_spaces_are_annihilated_and_have_the_right_dimension(M):
    X, pivots = nullspace_and_pivots(M)
    assert (M @ X).is_zero()
    assert X.shape == (M.ncols, M.ncols - rank(M))
    assert X.take(rows=pivots) == Matrix.identity(X.ncols)
    assert nullspace(M) == X
    W = left_nullspace(M)
    assert (W @ M).is_zero()
    assert W.shape == (M.nrows - rank(M), M.nrows)


@given(low_rank, low_rank)
def test_a_solution_solves_and_none_means_that_there_is_none(M, X):
    if M.ncols == X.nrows:
        right = M @ X
        found = solve(M, right)
        assert M @ found == right
    if M.nrows == X.nrows:
        found = solve(M, X)
        if found is None:
            assert rank(hstack([M, X])) > rank(M)
        else:
            assert M @ found == X


@given(square_matrices())
def test_inverses_and_determinants(M):
    found = inverse(M)
    if found is None:
        assert determinant(M) == 0
    else:
        assert found @ M == Matrix.identity(M.nrows) == M @ found
        assert determinant(M) * determinant(found) == 1
    right = Matrix.column(range(M.nrows))
    solved = solve_nonsingular(M, right)
    assert (solved is None) == (found is None)
    assert solved is None or M @ solved == right


@given(square_matrices())
def test_the_characteristic_polynomial_is_that_of_sympy(M):
    p = characteristic_polynomial(M)
    expected = [Fraction(int(c.numerator), int(c.denominator)) for c in domain_matrix(M).charpoly()]
    assert list(p.coefficients) == expected[::-1]
    assert evaluated(p, M).is_zero()
    if M.nrows:
        assert p.coefficients[0] == (-1) ** M.nrows * determinant(M)


@given(square_matrices(entries=small))
def test_the_minimal_polynomial_is_the_least_that_vanishes(M):
    q = minimal_polynomial(M)
    assert q.leading == 1
    assert evaluated(q, M).is_zero()
    assert q.divides(characteristic_polynomial(M))
    for factor, _ in q.factor():
        assert not evaluated(q // factor, M).is_zero()


def test_matrices_without_entries():
    empty = Matrix.zeros(0, 0)
    assert characteristic_polynomial(empty) == minimal_polynomial(empty) == Polynomial.of(1)
    assert determinant(empty) == 1
    assert inverse(empty) == empty
    assert rank(Matrix.zeros(0, 3)) == rank(Matrix.zeros(3, 0)) == 0
    assert nullspace(Matrix.zeros(0, 3)) == Matrix.identity(3)
    assert left_nullspace(Matrix.zeros(3, 0)) == Matrix.identity(3)
    assert nullspace(Matrix.zeros(3, 0)).shape == (0, 0)
    assert solve(Matrix.zeros(0, 2), Matrix.zeros(0, 1)) == Matrix.zeros(2, 1)
    assert solve(Matrix.zeros(2, 0), Matrix.column([1, 0])) is None
    assert solve(Matrix.zeros(2, 0), Matrix.zeros(2, 1)).shape == (0, 1)
    assert solve_nonsingular(empty, Matrix.zeros(0, 2)).shape == (0, 2)


def test_a_number_of_digits_no_float_holds():
    tiny = Fraction(1, 10**40)
    M = Matrix.from_rows([[1, 1], [1, 1 + tiny]])
    assert rank(M) == 2
    assert inverse(M)[0, 0] == (1 + tiny) / tiny


@pytest.mark.parametrize(
    "operation", [determinant, inverse, characteristic_polynomial, minimal_polynomial]
)
def test_a_square_matrix_is_expected(operation):
    with pytest.raises(InputError, match="expected a square matrix, found 1 × 2"):
        operation(Matrix.zeros(1, 2))


@pytest.mark.parametrize("solver", [solve, solve_nonsingular])
def test_a_right_side_of_another_height_is_refused(solver):
    with pytest.raises(InputError, match="expected a right side with 2 rows, found 3"):
        solver(Matrix.identity(2), Matrix.zeros(3, 1))
