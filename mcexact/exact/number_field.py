"""Linear algebra over K = Q[x]/(p) for irreducible p."""

from __future__ import annotations

import math

from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import primes, residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix, monic_modulus


def kernel(M: PolynomialMatrix, p: Polynomial) -> tuple[PolynomialMatrix, tuple[int, ...]]:
    """The kernel of a polynomial matrix over K = Q[x]/(p), in echelon form.

    Parameters
    ----------
    M : PolynomialMatrix, r × c
    p : Polynomial
        Irreducible over Q, of degree at least 1.

    Returns
    -------
    U : PolynomialMatrix, c × u
        M U = 0 modulo p, entries of degree below deg p; u = c − rank of M over K.
    pivots : tuple of int
        The u rows of U that form the identity.

    Raises
    ------
    InputError
        The polynomial is constant, or found to be reducible.

    Notes
    -----
    Exact.  Every element of K is represented by its deg p × deg p matrix of multiplication.  Pivots
    are found modulo a prime, where the rank is never too large.  Then the kernel for these pivots
    is computed over Q, and the exact test of M U = 0 modulo p proves that the rank is not larger.
    About (c deg p)³ word operations, and more for long entries of U.

    Examples
    --------
    The eigenvectors of [0 2; 1 0] over Q(√2):

    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2], [-1, 0]]), Matrix.identity(2))
    >>> U, pivots = kernel(M, Polynomial.of(-2, 0, 1))
    >>> [str(U.entry(i, 0)) for i in range(2)], pivots
    (['x', '1'], (1,))
    """
    inflated = inflate(M, p)
    for ell in primes(0, bits=62):
        pivots = _block_pivots(inflated, p.degree, ell)
        if pivots is not None:
            found = _kernel_at_pivots(inflated, pivots, p.degree, ell)
            if found is not None and (M @ found[0] % p).is_zero():
                return found
        if not p.is_irreducible():
            raise InputError(f"expected an irreducible polynomial, found {p}")
    raise InternalError("the stream of primes is endless")


def _block_pivots(inflated: Matrix, degree: int, ell: int) -> tuple[int, ...] | None:
    """The pivot columns over K, computed modulo a prime; None if they do not form whole blocks."""
    found = residues(_numerators(inflated), ell).rref()[1]
    pivots = tuple(j // degree for j in found[::degree])
    whole = [j * degree + k for j in pivots for k in range(degree)]
    return pivots if list(found) == whole else None


def _kernel_at_pivots(
    inflated: Matrix, pivots: tuple[int, ...], degree: int, ell: int
) -> tuple[PolynomialMatrix, tuple[int, ...]] | None:
    """The candidate for the kernel with these pivots; None if the pivot columns are dependent.

    Column 0 of a block is its element of K in the basis 1, x, …, so each column of the kernel needs
    one solution of the inflated system.
    """
    ncols = inflated.ncols // degree
    bound = [j * degree + k for j in pivots for k in range(degree)]
    free = tuple(sorted(set(range(ncols)) - set(pivots)))
    integer = _numerators(inflated)
    chosen = integer.take(cols=bound)
    rows = residues(chosen.T, ell).rref()[1]
    right = integer.take(rows=rows, cols=[f * degree for f in free])
    X = solve_nonsingular(chosen.take(rows=rows), -right)
    if X is None:
        return None
    position = {j: i for i, j in enumerate(pivots)}
    layers = []
    for k in range(degree):
        table = []
        for j in range(ncols):
            if j in position:
                table.append(X.numerators[position[j] * degree + k])
            else:
                table.append(tuple(X.denominator if f == j and k == 0 else 0 for f in free))
        layers.append(Matrix.from_integers(table, X.denominator, ncols=len(free)))
    return PolynomialMatrix.from_matrices(*layers), free


def _numerators(M: Matrix) -> Matrix:
    """The integer matrix of the numerators: the same kernel, and residues modulo every prime."""
    return M if M.denominator == 1 else M * M.denominator


def kernel_at(M0: Matrix, M1: Matrix, p: Polynomial) -> tuple[PolynomialMatrix, tuple[int, ...]]:
    """The kernel of M0 + x M1 over Q[x]/(p), as `kernel` gives it."""
    return kernel(PolynomialMatrix.pencil(M0, M1), p)


def rank(M: PolynomialMatrix, p: Polynomial) -> int:
    """The rank of a polynomial matrix over Q[x]/(p), p irreducible: its rank at every root of p.

    Examples
    --------
    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2], [-1, 0]]), Matrix.identity(2))
    >>> rank(M, Polynomial.of(-2, 0, 1)), rank(M, Polynomial.of(-3, 0, 1))
    (1, 2)
    """
    if M.nrows < M.ncols:
        M = M.T
    return M.ncols - kernel(M, p)[0].ncols


def inflate(M: PolynomialMatrix, p: Polynomial) -> Matrix:
    """The rational matrix of M over Q, K = Q[x]/(p) in the basis 1, x, …, x^(deg p − 1).

    Parameters
    ----------
    M : PolynomialMatrix, r × c
    p : Polynomial
        Of degree d ≥ 1.

    Returns
    -------
    Matrix, rd × cd
        Block (i, j) is the matrix of multiplication by the entry (i, j); its column k holds the
        coefficients of x^k times the entry.
    """
    degree = monic_modulus(p).degree
    columns = []
    power = M % p
    for k in range(degree):
        columns.append(power.matrices + (Matrix.zeros(*M.shape),) * degree)
        if k + 1 < degree:
            power = power.times_x() % p
    denominator = math.lcm(*(E.denominator for column in columns for E in column))
    scaled = [
        [(E.numerators, denominator // E.denominator) for E in column[:degree]]
        for column in columns
    ]
    rows = [
        [
            factor * table[i][j]
            for j in range(M.ncols)
            for table, factor in (scaled[k][r] for k in range(degree))
        ]
        for i in range(M.nrows)
        for r in range(degree)
    ]
    return Matrix.from_integers(rows, denominator, ncols=M.ncols * degree)
