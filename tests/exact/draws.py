"""What the tests of the exact arithmetic draw, and sympy's view of it."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import sympy
from hypothesis import strategies as st
from sympy.polys.matrices import DomainMatrix

from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial

small = st.integers(-3, 3)
sizes = st.integers(0, 4)
rationals = st.builds(Fraction, st.integers(-9, 9), st.integers(1, 6)) | st.just(
    Fraction(2**70 + 1, 2**65 + 3)
)


@st.composite
def matrices(
    draw: Any,
    nrows: Any = sizes,
    ncols: Any = sizes,
    entries: Any = rationals,
) -> Matrix:
    """A matrix with sizes and entries from these sources."""
    r = draw(nrows) if isinstance(nrows, st.SearchStrategy) else nrows
    c = draw(ncols) if isinstance(ncols, st.SearchStrategy) else ncols
    return Matrix.from_rows([[draw(entries) for _ in range(c)] for _ in range(r)], ncols=c)


@st.composite
def square_matrices(draw: Any, largest: int = 4, entries: Any = rationals) -> Matrix:
    """A square matrix, 0 × 0 included."""
    n = draw(st.integers(0, largest))
    return draw(matrices(n, n, entries))


def polynomials(largest_degree: int = 4, entries: Any = rationals) -> Any:
    """A polynomial, 0 included."""
    return st.lists(entries, max_size=largest_degree + 1).map(Polynomial.from_coefficients)


def domain_matrix(M: Matrix) -> DomainMatrix:
    """The matrix in sympy's second engine."""
    rows = [[sympy.QQ(q.numerator, q.denominator) for q in row] for row in M.rows()]
    return DomainMatrix(rows, M.shape, sympy.QQ)


def from_domain_matrix(M: DomainMatrix) -> Matrix:
    """And back."""
    rows = [[Fraction(int(q.numerator), int(q.denominator)) for q in row] for row in M.to_list()]
    return Matrix.from_rows(rows, ncols=M.shape[1])


def sympy_polynomial(p: Polynomial) -> sympy.Poly:
    """The polynomial in sympy."""
    x = sympy.Symbol("x")
    coefficients = [sympy.Rational(c.numerator, c.denominator) for c in reversed(p.coefficients)]
    return sympy.Poly(coefficients or [0], x, domain="QQ")


def from_sympy_polynomial(p: sympy.Poly) -> Polynomial:
    """And back."""
    return Polynomial.from_coefficients(reversed(p.all_coeffs()))


def evaluated(p, M):
    """p(M) of a square matrix."""
    result = Matrix.zeros(M.nrows, M.nrows)
    for c in reversed(p.coefficients):
        result = result @ M + Matrix.identity(M.nrows) * c
    return result
