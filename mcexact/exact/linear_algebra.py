"""Linear algebra over the rational numbers."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import flint

from mcexact.errors import InputError
from mcexact.exact.blocks import hstack
from mcexact.exact.matrix import Matrix, from_flint, from_numerators
from mcexact.exact.polynomial import Polynomial

# Full rank modulo this prime is full rank over Q, so ranks are computed modulo it first.
_PROBE = 2**61 - 1


def rank(M: Matrix) -> int:
    """The rank.

    Examples
    --------
    >>> rank(Matrix.from_rows([[1, 2], ["1/2", 1]]))
    1
    """
    below = int(flint.nmod_mat(M._integer, _PROBE).rank())
    if below == min(M.shape):
        return below
    return int(M._integer.rank())


def row_echelon(M: Matrix) -> tuple[Matrix, tuple[int, ...]]:
    """The reduced row echelon form without its zero rows, and its pivot columns.

    Returns
    -------
    R : Matrix, r × ncols
        The same row space as M, r its rank; the columns `pivots` form the identity.
    pivots : tuple of int
        Ascending.

    Examples
    --------
    >>> R, pivots = row_echelon(Matrix.from_rows([[0, 2, 4], [0, 1, 2]]))
    >>> R.numerators, pivots
    (((0, 1, 2),), (1,))
    """
    reduced, denominator, r = M._integer.rref()
    # at rank 0 flint returns no denominator
    whole = from_flint(reduced, int(denominator) if r else 1)
    pivots = []
    j = 0
    for row in whole.numerators[:r]:
        while not row[j]:
            j += 1
        pivots.append(j)
    return whole.take(rows=range(r)), tuple(pivots)


def kernel(M: Matrix) -> tuple[Matrix, tuple[int, ...]]:
    """Compute a basis of {x : Mx = 0}, and the rows of it that form the identity.

    Returns
    -------
    X : Matrix, ncols × (ncols − rank M)
    pivots : tuple of int
        The columns of M that are not pivots of its echelon form, ascending.
    """
    reduced, bound = row_echelon(M)
    free = tuple(sorted(set(range(M.ncols)) - set(bound)))
    position = {j: i for i, j in enumerate(bound)}
    rows = []
    for j in range(M.ncols):
        if j in position:
            row = reduced.numerators[position[j]]
            rows.append(tuple(-row[k] for k in free))
        else:
            rows.append(tuple(reduced.denominator if k == j else 0 for k in free))
    return from_numerators(rows, reduced.denominator, len(free)), free


def nullspace(M: Matrix) -> Matrix:
    """A basis of {x : Mx = 0} as columns, in echelon form (see `kernel`).

    Examples
    --------
    >>> nullspace(Matrix.from_rows([[1, 2]])).numerators
    ((-2,), (1,))
    """
    return kernel(M)[0]


def left_nullspace(M: Matrix) -> Matrix:
    """A basis of {w : wM = 0} as rows, in echelon form.

    Returns
    -------
    Matrix, (nrows − rank M) × nrows

    Examples
    --------
    >>> left_nullspace(Matrix.column([1, 2])).numerators
    ((-2, 1),)
    """
    return nullspace(M.T).T


def solve(M: Matrix, right: Matrix) -> Matrix | None:
    """Compute an X with MX = right whose free unknowns are 0; None if there is none.

    Parameters
    ----------
    M : Matrix, r × c
    right : Matrix, r × k
        One column for each system of equations; all of them must have a solution.

    Returns
    -------
    Matrix or None
        X, c × k.

    Raises
    ------
    InputError
        If M and the right side have different numbers of rows.

    Examples
    --------
    >>> solve(Matrix.from_rows([[2, 1], [4, 2]]), Matrix.column([1, 2])).rows()
    ((Fraction(1, 2),), (Fraction(0, 1),))
    >>> solve(Matrix.from_rows([[2, 1], [4, 2]]), Matrix.column([1, 3])) is None
    True
    """
    if M.nrows != right.nrows:
        raise InputError(f"expected a right side with {M.nrows} rows, found {right.nrows}")
    reduced, pivots = row_echelon(hstack([M, right]))
    if pivots and pivots[-1] >= M.ncols:
        return None
    position = {j: i for i, j in enumerate(pivots)}
    rows = [
        reduced.numerators[position[j]][M.ncols :] if j in position else (0,) * right.ncols
        for j in range(M.ncols)
    ]
    return from_numerators(rows, reduced.denominator, right.ncols)


def solve_nonsingular(M: Matrix, right: Matrix) -> Matrix | None:
    """Compute the X with MX = right for a square M; None if M is singular.

    This is faster than `solve` if the right side has few columns.

    Raises
    ------
    InputError
        If M is not square, or the right side has another number of rows.

    Examples
    --------
    >>> solve_nonsingular(Matrix.from_rows([[2, 0], [0, 4]]), Matrix.column([1, 1])).rows()
    ((Fraction(1, 2),), (Fraction(1, 4),))
    >>> solve_nonsingular(Matrix.from_rows([[2, 1], [4, 2]]), Matrix.column([1, 2])) is None
    True
    """
    _require_square(M)
    if M.nrows != right.nrows:
        raise InputError(f"expected a right side with {M.nrows} rows, found {right.nrows}")
    if rank(M) < M.nrows:
        return None
    if not M.nrows or not right.ncols:
        return Matrix.zeros(*right.shape)
    solution: Any = M._integer.solve(right._integer)
    numerators, denominator = solution.numer_denom()
    # (N/d) X = R/e has the solution N⁻¹R · d/e
    return from_flint(numerators * M.denominator, int(denominator) * right.denominator)


def inverse(M: Matrix) -> Matrix | None:
    """The inverse of a square matrix; None if it is singular.

    Raises
    ------
    InputError
        If the matrix is not square.

    Examples
    --------
    >>> inverse(Matrix.from_rows([[1, 1], [0, 2]])).rows()[0]
    (Fraction(1, 1), Fraction(-1, 2))
    >>> inverse(Matrix.from_rows([[1, 1], [1, 1]])) is None
    True
    """
    _require_square(M)
    return solve(M, Matrix.identity(M.nrows)) if rank(M) == M.nrows else None


def determinant(M: Matrix) -> Fraction:
    """The determinant of a square matrix; 1 if it is 0 × 0.

    Raises
    ------
    InputError
        If the matrix is not square.

    Examples
    --------
    >>> determinant(Matrix.from_rows([["1/2", 1], [1, 4]]))
    Fraction(1, 1)
    """
    _require_square(M)
    return Fraction(int(M._integer.det()), M.denominator**M.nrows)


def characteristic_polynomial(M: Matrix) -> Polynomial:
    """det(xI − M) of a square matrix.

    Examples
    --------
    >>> str(characteristic_polynomial(Matrix.from_rows([[0, "1/2"], [1, 0]])))
    'x^2 - 1/2'
    """
    _require_square(M)
    return _unscaled(M._integer.charpoly(), M.denominator)


def minimal_polynomial(M: Matrix) -> Polynomial:
    """The monic polynomial of least degree that M satisfies; 1 if M is 0 × 0.

    It has the same irreducible factors as the characteristic polynomial.

    Raises
    ------
    InputError
        If the matrix is not square.

    Examples
    --------
    >>> identity = Matrix.identity(3)
    >>> str(minimal_polynomial(identity)), characteristic_polynomial(identity).degree
    ('x - 1', 3)
    """
    _require_square(M)
    if M.nrows == 0:
        return Polynomial.of(1)
    return _unscaled(M._integer.minpoly(), M.denominator)


def _unscaled(p: flint.fmpz_poly, d: int) -> Polynomial:
    """From the monic p of N to that of N/d: p(d x) / d^k for p of degree k."""
    coefficients = [int(c) for c in p.coeffs()]
    degree = len(coefficients) - 1
    return Polynomial(tuple(Fraction(c, d ** (degree - k)) for k, c in enumerate(coefficients)))


def _require_square(M: Matrix) -> None:
    if not M.is_square():
        raise InputError(f"expected a square matrix, found {M.nrows} × {M.ncols}")
