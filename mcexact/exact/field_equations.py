"""Linear equations over K = Q[x]/(p), by their values at points modulo primes."""

from __future__ import annotations

from collections.abc import Iterator
from functools import reduce
from itertools import islice
from operator import add, mul

from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import solve_nonsingular
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    polynomial_residues,
    primes,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix, inflate
from mcexact.exact.reconstruction import combine, rationals

# Fields of less degree are faster as matrices over Q.
_DEGREE = 10


def solve_over_field(
    N: PolynomialMatrix, right: PolynomialMatrix, p: Polynomial
) -> PolynomialMatrix | None:
    """Compute the X with N X = right over Q[x]/(p), entries of degree below deg p.

    Parameters
    ----------
    N : PolynomialMatrix, k × k
    right : PolynomialMatrix, k × u
    p : Polynomial
        Monic, irreducible, of degree at least 1.

    Returns
    -------
    PolynomialMatrix or None
        X, k × u; None if N is found to be singular.

    Notes
    -----
    In a field of small degree every element is its matrix of multiplication, which makes one system
    of k deg p equations over Q.  Otherwise X is found modulo primes until its residues determine
    it, which costs about k⁴ word operations for each prime, whatever the degree of the field is.
    That X agrees with N X = right modulo one prime more, which is no proof: test the equation, or
    what is to follow from it.

    Examples
    --------
    >>> N = PolynomialMatrix.from_polynomials([[Polynomial.x()]])
    >>> X = solve_over_field(N, PolynomialMatrix.identity(1), Polynomial.of(-2, 0, 1))
    >>> str(X.entry(0, 0))
    '1/2*x'
    """
    if p.degree < _DEGREE or not right.ncols:
        return _as_rationals(N, right, p)
    N, right = N % p, right % p
    known: list[list[int]] = []
    modulus = 1
    for ell in primes(0, bits=62):
        if N.denominator * right.denominator * p.denominator % ell == 0:
            continue
        found = _modulo(N, right, p, ell)
        if found is None:
            return None
        guess = rationals(known, modulus) if known else None
        if guess is not None and _agree(*guess, found, ell):
            return _layers(*guess, right.ncols)
        known = combine(known, modulus, found, ell) if known else found
        modulus *= ell
    raise InternalError("the stream of primes is endless")


def _as_rationals(
    N: PolynomialMatrix, right: PolynomialMatrix, p: Polynomial
) -> PolynomialMatrix | None:
    """X by matrices of multiplication, whose first columns are the elements themselves."""
    firsts = [j * p.degree for j in range(right.ncols)]
    X = solve_nonsingular(inflate(N, p), inflate(right, p).take(cols=firsts))
    if X is None:
        return None
    return PolynomialMatrix.from_matrices(
        *(X.take(rows=range(k, X.nrows, p.degree)) for k in range(p.degree))
    )


def _modulo(
    N: PolynomialMatrix, right: PolynomialMatrix, p: Polynomial, ell: int
) -> list[list[int]] | None:
    """X modulo ℓ: row k has the coefficients of x^k of all entries; None if det N is no unit.

    The minors of [N, right] have at most the degree that its rows have together, and are known by
    their values at one point more.
    """
    size = 1 + sum(max(both) for both in zip(_degrees(N), _degrees(right), strict=True))
    values = list(islice(_values(N, right, ell, 2 * size), size))
    if len(values) < size:
        return None
    linear = [ModularPolynomial.from_coefficients([-t, 1], ell) for t, _, _ in values]
    whole = reduce(mul, linear)
    basis = [whole // factor for factor in linear]
    shares = [d * pow(L(t), -1, ell) % ell for L, (t, d, _) in zip(basis, values, strict=True)]
    constants = [ModularPolynomial.from_coefficients([c], ell) for c in shares]
    field = polynomial_residues(p, ell)
    inverse = reduce(add, map(mul, basis, constants)).inverse_modulo(field)
    if inverse is None:
        return None
    weights = [(L * inverse % field).coefficients for L in basis]
    table = [[*weight, *(0,) * (p.degree - len(weight))] for weight in weights]
    scaled = [X * c for c, (_, _, X) in zip(shares, values, strict=True)]
    return [
        reduce(add, (X * w for X, w in zip(scaled, row, strict=True))).entries()
        for row in zip(*table, strict=True)
    ]


def _degrees(M: PolynomialMatrix) -> list[int]:
    """The degree of every row; 0 for a row of zeros."""
    found = [0] * M.nrows
    for k, layer in enumerate(M.matrices):
        for i, row in enumerate(layer.numerators):
            if any(row):
                found[i] = k
    return found


def _values(
    N: PolynomialMatrix, right: PolynomialMatrix, ell: int, end: int
) -> Iterator[tuple[int, int, ModularMatrix]]:
    """t, det N(t) and N(t)⁻¹ right(t) modulo ℓ for the points below ``end`` where it is not 0."""
    for t in range(end):
        at = N.at_residue(t, ell)
        X = at.solve(right.at_residue(t, ell))
        if X is not None:
            yield t, at.determinant(), X


def _agree(numerators: list[list[int]], denominator: int, found: list[list[int]], ell: int) -> bool:
    """Whether rational numbers have these residues."""
    return all(
        (numerator - denominator * residue) % ell == 0
        for row, others in zip(numerators, found, strict=True)
        for numerator, residue in zip(row, others, strict=True)
    )


def _layers(numerators: list[list[int]], denominator: int, ncols: int) -> PolynomialMatrix:
    """The matrix of polynomials whose coefficients of x^k are in row k, entry by entry."""
    return PolynomialMatrix.from_matrices(
        *(
            Matrix.from_integers(
                [row[i : i + ncols] for i in range(0, len(row), ncols)], denominator, ncols
            )
            for row in numerators
        )
    )
