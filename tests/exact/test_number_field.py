"""Matrices of polynomials, and null spaces over number fields."""

import pickle
from fractions import Fraction

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import InputError
from mcexact.exact.linear_algebra import (
    PolynomialMatrix,
    characteristic_polynomial,
    field_nullspace,
    field_rank,
    inflate,
    nullspace,
    nullspace_at,
)
from mcexact.exact.linear_algebra import rank as rational_rank
from mcexact.exact.matrix import Matrix, block_diagonal
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from tests.exact.draws import evaluated, matrices, polynomials, small, square_matrices
from tests.wording import refusal

GOLDEN = Polynomial.of(-1, -1, 1)
CUBIC = Polynomial.of(-2, 0, 0, 1)
IRREDUCIBLE = [Polynomial.of("-1/2", 1), Polynomial.of(1, 0, 1), GOLDEN, CUBIC]


@st.composite
def polynomial_matrices(draw, nrows=None, ncols=None):
    """A matrix of polynomials of degree at most two."""
    r = draw(st.integers(0, 3)) if nrows is None else nrows
    c = draw(st.integers(0, 3)) if ncols is None else ncols
    count = draw(st.integers(1, 3))
    return PolynomialMatrix.from_matrices(*(draw(matrices(r, c)) for _ in range(count)))


def at(M: PolynomialMatrix, value) -> Matrix:
    """The rational matrix at a rational point."""
    return sum((E * Fraction(value) ** k for k, E in enumerate(M.matrices)), Matrix.zeros(*M.shape))


@given(st.data())
def test_operations_are_those_at_every_point(data):
    r, k, c = (data.draw(st.integers(0, 2)) for _ in range(3))
    A, D = data.draw(polynomial_matrices(r, k)), data.draw(polynomial_matrices(r, k))
    B, M = data.draw(polynomial_matrices(k, c)), data.draw(matrices(k, c))
    for value in (0, 1, -2, Fraction(1, 3)):
        assert at(A @ B, value) == at(A, value) @ at(B, value)
        assert at(A @ M, value) == at(A, value) @ M
        assert at(M.T @ A.T, value) == M.T @ at(A, value).T
        assert at(A + D, value) == at(A, value) + at(D, value)
        assert at(A - D, value) == at(A, value) - at(D, value)
        assert at(A.times_x(), value) == value * at(A, value)
    assert pickle.loads(pickle.dumps(A)) == A
    assert hash(A + D - D) == hash(A)
    assert (A - A).is_zero()


@given(polynomial_matrices())
def test_the_parts_rebuild_the_matrix(M):
    layers = (Matrix.from_integers(E, M.denominator, M.ncols) for E in M.coefficients)
    assert PolynomialMatrix(tuple(layers)) == M
    entries = [[M.entry(i, j) for j in range(M.ncols)] for i in range(M.nrows)]
    assert PolynomialMatrix.from_polynomials(entries, ncols=M.ncols) == M
    assert M.T.T == M
    assert M + Matrix.zeros(*M.shape) == M


@given(polynomial_matrices(2, 2), st.sampled_from(IRREDUCIBLE))
def test_reduction_is_the_remainder_entry_by_entry(M, p):
    reduced = M % p
    for i in range(2):
        for j in range(2):
            assert reduced.entry(i, j) == M.entry(i, j) % p
    assert M % (3 * p) == reduced


@given(polynomial_matrices(), st.integers(0, 1000))
def test_values_modulo_a_prime(M, mu):
    assert M.at_residue(mu, 1_000_003) == residues(at(M, mu), 1_000_003)


@given(polynomial_matrices(), st.sampled_from(IRREDUCIBLE))
def test_a_null_space_is_annihilated_and_complete(M, p):
    U, pivots = field_nullspace(M, p)
    assert (M @ U % p).is_zero()
    assert U.take(rows=pivots) == PolynomialMatrix.identity(U.ncols)
    assert U % p == U
    assert rational_rank(inflate(M, p)) == p.degree * (M.ncols - U.ncols)
    assert field_rank(M, p) == field_rank(M.T, p) == M.ncols - U.ncols


@given(square_matrices(4, entries=small))
def test_every_eigenvalue_has_as_many_eigenvectors_as_its_factor_says(A):
    n = A.nrows
    for p, multiplicity in characteristic_polynomial(A).factor():
        U, _ = nullspace_at(-A, Matrix.identity(n), p)
        assert p.degree * U.ncols == nullspace(evaluated(p, A)).ncols
        assert 1 <= U.ncols <= multiplicity


@given(polynomials(2), polynomials(2), st.sampled_from(IRREDUCIBLE))
def test_inflation_is_a_homomorphism(a, b, p):
    one = [PolynomialMatrix.from_polynomials([[q]]) for q in (a, b)]
    product, total = one[0] @ one[1], one[0] + one[1]
    assert inflate(product, p) == inflate(one[0], p) @ inflate(one[1], p)
    assert inflate(total, p) == inflate(one[0], p) + inflate(one[1], p)


def test_a_null_space_over_a_cubic_field_is_that_of_sympy():
    A = Matrix.from_rows([[0, 0, 2], [1, 0, 0], [0, 1, 0]])
    U, pivots = nullspace_at(-A, Matrix.identity(3), CUBIC)
    root = sympy.cbrt(2)
    vector = sympy.Matrix(
        3, 1, [sympy.sympify(str(U.entry(i, 0))).subs("x", root) for i in range(3)]
    )
    M = sympy.Matrix([[0, 0, 2], [1, 0, 0], [0, 1, 0]])
    assert sympy.simplify(M * vector - root * vector) == sympy.zeros(3, 1)
    assert pivots == (2,)


def test_a_rank_drop_only_modulo_the_probing_prime_is_no_rank_drop():
    ell = next(primes(0, bits=62))
    M = PolynomialMatrix.pencil(Matrix.from_rows([[-ell, 0], [0, 1]]), Matrix.zeros(2, 2))
    U, pivots = field_nullspace(M, GOLDEN)
    assert U.shape == (2, 0)
    assert pivots == ()


def test_other_pivots_modulo_the_probing_prime_give_a_null_space_all_the_same():
    ell = next(primes(0, bits=62))
    M = PolynomialMatrix.from_matrices(Matrix.from_rows([[ell, 1]]))
    U, pivots = field_nullspace(M, CUBIC)
    assert (M @ U % CUBIC).is_zero()
    assert U.take(rows=pivots) == PolynomialMatrix.identity(1)


def test_a_large_field_and_repeated_eigenvalues():
    p = Polynomial.of(3, -1, 0, 2, 0, 0, 0, 1)
    assert p.is_irreducible()
    companion = Matrix.from_rows(
        [[int(i == j + 1) for j in range(6)] + [-p.coefficients[i]] for i in range(7)]
    )
    U, _ = nullspace_at(-block_diagonal([companion] * 3), Matrix.identity(21), p)
    assert U.ncols == 3


@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0)])
def test_matrices_without_entries(shape):
    Z = PolynomialMatrix.from_matrices(Matrix.zeros(*shape))
    U, pivots = field_nullspace(Z, GOLDEN)
    assert PolynomialMatrix.identity(shape[1]) == U
    assert pivots == tuple(range(shape[1]))
    assert field_rank(Z, GOLDEN) == 0
    assert Z.T.shape == shape[::-1]
    assert (Z @ Z.T).shape == (shape[0], shape[0])
    assert Z % GOLDEN == Z
    assert PolynomialMatrix.from_polynomials([[]] * shape[0], ncols=shape[1]) == Z


def test_a_reducible_polynomial_is_refused_where_it_is_no_field():
    M = PolynomialMatrix.pencil(Matrix.from_rows([[-1]]), Matrix.identity(1))
    with refusal(InputError):
        field_nullspace(M, Polynomial.of(-1, 0, 1))


I2 = PolynomialMatrix.identity(2)
ONE = Matrix.identity(1)


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        (
            lambda: field_nullspace(I2, Polynomial.of(1)),
            "expected a polynomial of degree at least 1",
        ),
        (lambda: I2 % Polynomial.of(0), "expected a polynomial of degree at least 1"),
        (lambda: PolynomialMatrix.from_matrices(), "expected at least one coefficient matrix"),
        (
            lambda: PolynomialMatrix.pencil(Matrix.identity(1), Matrix.identity(2)),
            "all of one shape",
        ),
        (lambda: I2 @ PolynomialMatrix.identity(3), "shapes do not match: 2 × 2 @ 3 × 3"),
        (lambda: I2 + PolynomialMatrix.identity(3), "shapes do not match"),
        (
            lambda: PolynomialMatrix.from_polynomials([[Polynomial.x()], []]),
            "expected rows of 1 polynomials",
        ),
        (
            lambda: PolynomialMatrix.from_matrices(Matrix.from_rows([["1/5"]])).at_residue(1, 5),
            "divides a denominator",
        ),
        (lambda: PolynomialMatrix(()), "expected at least one coefficient matrix"),
        (lambda: PolynomialMatrix((ONE, Matrix.zeros(1, 1))), "that is not zero"),
        (lambda: PolynomialMatrix((ONE, Matrix.zeros(1, 2))), "all of one shape"),
    ],
)
def test_what_makes_no_sense_is_refused(operation, message):
    with pytest.raises(InputError, match=message):
        operation()
