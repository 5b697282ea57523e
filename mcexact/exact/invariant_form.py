"""The rational canonical form: invariant polynomials of a matrix, and a basis that shows them."""

from __future__ import annotations

from random import Random

from mcexact.errors import InternalError
from mcexact.exact.blocks import block_diagonal, hstack, vstack
from mcexact.exact.linear_algebra import kernel, minimal_polynomial, rank
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


def companion(p: Polynomial) -> Matrix:
    """The matrix of multiplication by x modulo a monic p: ones below the diagonal, −p on the right.

    Parameters
    ----------
    p : Polynomial
        Monic of degree d ≥ 1.

    Examples
    --------
    >>> companion(Polynomial.of(3, 2, 1)).numerators
    ((0, -3), (1, -2))
    """
    d = p.degree
    rows = [[int(i == j + 1) for j in range(d - 1)] + [-p.coefficients[i]] for i in range(d)]
    return Matrix.from_rows(rows, ncols=d)


def invariant_form(Z: Matrix, rng: Random) -> tuple[Matrix, tuple[Polynomial, ...]]:
    """Find T with Z T = T diag(companions of f_1, …, f_h), f_1 | f_2 | … | f_h.

    Parameters
    ----------
    Z : Matrix
        b × b.
    rng : Random
        Draws vectors; almost all will do.

    Returns
    -------
    T : Matrix
        b × b, nonsingular.
    polynomials : tuple of Polynomial
        The invariant polynomials of degree at least 1.

    Notes
    -----
    A drawn v generates a space of the dimension d of the minimal polynomial, a drawn row w has
    w Z^{i+j} v nonsingular, and then the kernel of w, wZ, …, wZ^{d−1} is an invariant complement,
    on which it goes on.  Exact.

    Examples
    --------
    >>> from random import Random
    >>> _, found = invariant_form(Matrix.from_rows([[1, 0, 0], [0, 1, 0], [0, 0, 2]]), Random(0))
    >>> [str(f) for f in found]
    ['x - 1', 'x^2 - 3*x + 2']
    """
    b = Z.nrows
    basis, parts, found = Matrix.identity(b), [], []
    while Z.nrows:
        f = minimal_polynomial(Z)
        K, rows = _cyclic_pair(Z, f.degree, rng)
        parts.append(basis @ K)
        found.append(f)
        rest, pivots = kernel(rows)
        basis, Z = basis @ rest, (Z @ rest).take(rows=pivots)
    return hstack(parts[::-1], nrows=b), tuple(found[::-1])


def _cyclic_pair(Z: Matrix, d: int, rng: Random) -> tuple[Matrix, Matrix]:
    """[v, Zv, …, Z^{d−1}v] and [w; wZ; …] of small integers, with a nonsingular product."""
    n = Z.nrows
    for trial in range(10**4):
        bound = 1 + trial // 4
        v = Matrix.column([rng.randint(-bound, bound) for _ in range(n)])
        w = Matrix.column([rng.randint(-bound, bound) for _ in range(n)]).T
        columns, rows = [v], [w]
        for _ in range(d - 1):
            columns.append(Z @ columns[-1])
            rows.append(rows[-1] @ Z)
        K, W = hstack(columns, nrows=n), vstack(rows, ncols=n)
        if rank(W @ K) == d:
            return K, W
    raise InternalError("a generating vector was not found")


def companions(polynomials: tuple[Polynomial, ...]) -> Matrix:
    """The block-diagonal matrix of the companions."""
    return block_diagonal([companion(f) for f in polynomials])
