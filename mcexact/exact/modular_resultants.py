"""Resultants of polynomials in x and t modulo primes, and what two of them have in common."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

import flint

from mcexact.errors import InternalError
from mcexact.exact import two_variables
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.reconstruction import combine, rationals
from mcexact.exact.two_variables import Bivariate, residues

Residues = list[flint.nmod_poly]
"""Coefficients of the powers of x modulo ℓ, constant first."""


def residues_in_x(f: Bivariate, ell: int) -> Residues:
    """f modulo a prime that divides no denominator."""
    return [residues(c, ell) for c in f]


def degree_bound(f: Sequence[Any], g: Sequence[Any]) -> int:
    """A bound for the degree in t of the resultant of f, monic in x, and g.

    Parameters
    ----------
    f, g : sequences of polynomials in t
        The coefficients of the powers of x, constant first.

    Notes
    -----
    The resultant is the product of g(α) over the roots x = α of f, which are series in t at
    infinity; their degrees are the slopes of the Newton polygon.  With g − f for g it is the same,
    and the bound is smaller where the polynomials agree at infinity.

    Examples
    --------
    x² − t and x² − tx: the resultant is t² − t³.

    >>> P = flint.fmpq_poly
    >>> degree_bound([P([0, -1]), P([]), P([1])], [P([]), P([0, -1]), P([1])])
    3
    """
    total: float | Fraction = 0
    for slope, steps in _degrees_of_roots(f):
        values = (int(c.degree()) + (k and k * slope) for k, c in enumerate(g) if c != 0)
        total += steps * max(values, default=-math.inf)
    return int(max(total, 0))


def _degrees_of_roots(f: Sequence[Any]) -> list[tuple[Fraction | float, int]]:
    """The degrees in t of the roots x, each with their number; −∞ for the root 0."""
    degrees = [int(c.degree()) for c in f]
    found: list[tuple[Fraction | float, int]] = []
    k = len(f) - 1
    while k > 0:
        lines = ((Fraction(degrees[j] - degrees[k], k - j), k - j) for j in range(k) if f[j] != 0)
        found.append(max(lines, default=(-math.inf, k)))
        k -= found[-1][1]
    return found


def characteristic_modulo(M: PolynomialMatrix, ell: int) -> Residues:
    """det(xI − M(t)) modulo a prime that divides no denominator, by values."""
    values = [
        M.at_residue(t, ell).characteristic_polynomial().coefficients
        for t in range(two_variables.degree_bound(M) + 1)
    ]
    return [interpolated_modulo(column, ell) for column in zip(*values, strict=True)]


def resultant_modulo(f: Residues, g: Residues, ell: int) -> flint.nmod_poly:
    """The resultant with respect to x of two polynomials that are monic in x.

    Examples
    --------
    >>> f = [flint.nmod_poly([0, -1], 7), flint.nmod_poly([1], 7)]
    >>> g = [flint.nmod_poly([3], 7), flint.nmod_poly([1], 7)]
    >>> str(resultant_modulo(f, g, 7))
    'x + 3'
    """
    many = degree_bound(f, g) + 1
    pairs = zip(_values(f, many, ell), _values(g, many, ell), strict=True)
    return interpolated_modulo([int(a.resultant(b)) for a, b in pairs], ell)


def of_rationals(f: Bivariate, g: Bivariate, ell: int) -> flint.nmod_poly:
    """The same of polynomials over Q, modulo a prime that divides no denominator."""
    return resultant_modulo(residues_in_x(f, ell), residues_in_x(g, ell), ell)


def _values(f: Residues, many: int, ell: int) -> Iterable[flint.nmod_poly]:
    """f at t = 0, 1, …, each a polynomial in x."""
    width = max(int(c.degree()) for c in f) + 1
    powers = []
    for t in range(many):
        power = 1
        for _ in range(width):
            powers.append(power)
            power = power * t % ell
    entries = [int(c[k]) for k in range(width) for c in f]
    table = flint.nmod_mat(many, width, powers, ell) * flint.nmod_mat(width, len(f), entries, ell)
    return (flint.nmod_poly(row, ell) for row in table.tolist())


def interpolated_modulo(values: Sequence[int], ell: int) -> flint.nmod_poly:
    """The polynomial modulo a prime with these values at 0, 1, … (Newton).

    Notes
    -----
    Differences of order k at 0, divided by k!, are the coefficients of one product of polynomials;
    products of neighboring factors t, t − 1, … turn them into coefficients of powers.
    """
    many = len(values)
    factorials = [1]
    for k in range(1, many):
        factorials.append(factorials[-1] * k % ell)
    inverses = [pow(factorials[-1], -1, ell)]
    for k in range(many - 1, 0, -1):
        inverses.append(inverses[-1] * k % ell)
    inverses.reverse()
    scaled = flint.nmod_poly([v * f % ell for v, f in zip(values, inverses, strict=True)], ell)
    signed = flint.nmod_poly([f if k % 2 == 0 else -f % ell for k, f in enumerate(inverses)], ell)
    slopes = scaled.mul_low(signed, many)
    level = [
        (flint.nmod_poly([int(slopes[k])], ell), flint.nmod_poly([-k % ell, 1], ell))
        for k in range(many)
    ]
    while len(level) > 1:
        joined = [
            (low + below * high, below * above)
            for (low, below), (high, above) in zip(level[::2], level[1::2], strict=False)
        ]
        level = joined + level[len(joined) * 2 :]
    return level[0][0]


def common_divisor(
    f: Bivariate, g: Bivariate, h: Bivariate, primes: Iterable[int]
) -> flint.fmpq_poly:
    """The monic greatest common divisor of Res(f, g) ≠ 0 and Res(f, h), by residues.

    Parameters
    ----------
    f, g, h : polynomials
        Monic in x.
    primes : iterable of int
        Without end, and none divides a denominator.

    Notes
    -----
    Primes modulo which its degree is larger are left out.  What two products of primes agree on is
    returned, and has to be verified.
    """
    product, found = 1, [[0]]
    before: tuple[list[list[int]], int] | None = None
    for ell in primes:
        common = of_rationals(f, g, ell).gcd(of_rationals(f, h, ell))
        degree = int(common.degree())
        if degree == 0:
            return flint.fmpq_poly([1])
        row = [int(c) for c in common.coeffs()]
        if product == 1 or degree + 1 < len(found[0]):
            product, found, before = ell, [row], None
        elif degree + 1 == len(found[0]):
            product, found = product * ell, combine(found, product, [row], ell)
        else:
            continue
        known = rationals(found, product)
        if known is not None and known == before:
            [numerators], denominator = known
            return flint.fmpq_poly(numerators, denominator)
        before = known
    raise InternalError("primes have an end")
