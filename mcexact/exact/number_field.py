"""Linear algebra over K = Q[x]/(p) for irreducible p."""

from __future__ import annotations

from mcexact.errors import InputError, InternalError
from mcexact.exact.blocks import vstack
from mcexact.exact.field_equations import solve_over_field
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import ModularMatrix, polynomial_residues, primes
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
    Exact.  Pivots are found at a root of p modulo a prime, where the rank is never too large.  Then
    the kernel for these pivots is computed over K, and the exact test of M U = 0 modulo p proves
    that the rank is not larger.

    Examples
    --------
    The eigenvectors of [0 2; 1 0] over Q(√2):

    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2], [-1, 0]]), Matrix.identity(2))
    >>> U, pivots = kernel(M, Polynomial.of(-2, 0, 1))
    >>> [str(U.entry(i, 0)) for i in range(2)], pivots
    (['x', '1'], (1,))
    """
    field = monic_modulus(p)
    for ell in primes(0, bits=62):
        if M.denominator * field.denominator % ell == 0:
            continue
        roots = polynomial_residues(field, ell).roots()
        if not roots:
            continue
        found = _kernel_at_pivots(M, field, M.at_residue(min(roots), ell))
        if found is not None and (M @ found[0] % field).is_zero():
            return found
        if not field.is_irreducible():
            raise InputError(f"expected an irreducible polynomial, found {p}")
    raise InternalError("the stream of primes is endless")


def _kernel_at_pivots(
    M: PolynomialMatrix, p: Polynomial, value: ModularMatrix
) -> tuple[PolynomialMatrix, tuple[int, ...]] | None:
    """The candidate for the kernel with the pivots of a value of M; None if these are dependent."""
    bound = value.rref()[1]
    rows = value.take(cols=bound).T.rref()[1]
    free = tuple(sorted(set(range(M.ncols)) - set(bound)))
    X = solve_over_field(M.take(rows, bound), M.take(rows, free), p)
    if X is None:
        return None
    order = {j: i for i, j in enumerate([*bound, *free])}
    both = [
        vstack([-layer, Matrix.identity(len(free)) if k == 0 else Matrix.zeros(*2 * (len(free),))])
        for k, layer in enumerate(X.matrices)
    ]
    U = PolynomialMatrix.from_matrices(*both).take(rows=[order[j] for j in range(M.ncols)])
    return U, free


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
