"""Linear equations over number fields: as equations over Q, and by values modulo primes."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.exact import linear_algebra
from mcexact.exact.linear_algebra import PolynomialMatrix, inflate, rank, solve_over_field
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes
from mcexact.exact.polynomial import Polynomial
from tests.exact.draws import matrices

FIELDS = [
    Polynomial.of("-1/2", 1),
    Polynomial.of(1, 0, 1),
    Polynomial.of("-2/3", 0, 0, 1),
    Polynomial.of(-2, *[0] * 11, 1),
]
WAYS = pytest.mark.parametrize("degree", [1, 99], ids=["by values", "over Q"])


@pytest.fixture
def least_degree(monkeypatch, degree):
    """Let every field be solved in the same way."""
    monkeypatch.setattr(linear_algebra, "_DEGREE", degree)


@st.composite
def equations(draw):
    """A square matrix of polynomials of degree at most two, and a right side."""
    k, u, count = draw(st.integers(0, 3)), draw(st.integers(0, 2)), draw(st.integers(1, 3))
    return tuple(
        PolynomialMatrix.from_matrices(*(draw(matrices(k, width)) for _ in range(count)))
        for width in (k, u)
    )


@given(equations(), st.sampled_from(FIELDS))
def test_both_ways_solve_the_equation_where_the_matrix_is_nonsingular(given_, p):
    N, right = given_
    singular = rank(inflate(N, p)) < N.nrows * p.degree
    found = []
    for degree in (1, 99):
        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(linear_algebra, "_DEGREE", degree)
            found.append(solve_over_field(N, right, p))
    assert found[0] == found[1]
    if singular:
        assert found[0] is None
    else:
        assert ((N @ found[0] - right) % p).is_zero()
        assert found[0] % p == found[0]


@WAYS
def test_long_fractions_are_found_from_several_primes(least_degree):
    p = Polynomial.of(-3, *[0] * 10, 1)
    big = Matrix.from_rows([[10**30 + 57, "1/7"], [3, 10**25 + 13]])
    N = PolynomialMatrix.from_matrices(big, Matrix.from_rows([[0, 1], [1, 0]]))
    X = solve_over_field(N, PolynomialMatrix.identity(2), p)
    assert X.denominator.bit_length() > 500
    assert ((N @ X - Matrix.identity(2)) % p).is_zero()


@WAYS
def test_a_matrix_that_is_singular_only_in_the_field_has_no_solution(least_degree):
    p = FIELDS[-1]
    N = PolynomialMatrix.from_polynomials([[p * Polynomial.of(1, 1)]])
    assert solve_over_field(N, PolynomialMatrix.identity(1), p) is None
    twice = PolynomialMatrix.from_polynomials([[Polynomial.x()] * 2] * 2)
    assert solve_over_field(twice, PolynomialMatrix.identity(2), p) is None


@WAYS
def test_a_prime_that_divides_a_denominator_is_left_out(least_degree):
    first = next(primes(0, bits=62))
    N = PolynomialMatrix.from_matrices(Matrix.from_rows([[f"1/{first}"]]))
    X = solve_over_field(N, PolynomialMatrix.identity(1), FIELDS[-1])
    assert X.matrices == (Matrix.from_rows([[first]]),)


def test_points_where_the_matrix_is_singular_are_left_out(monkeypatch):
    monkeypatch.setattr(linear_algebra, "_DEGREE", 1)
    x = Polynomial.x()
    N = PolynomialMatrix.from_polynomials([[x * (x - Polynomial.of(1))]])
    X = solve_over_field(N, PolynomialMatrix.identity(1), FIELDS[1])
    assert str(X.entry(0, 0)) == "1/2*x - 1/2"
