"""Polynomials in x whose coefficients are rational polynomials in a parameter t, as lists of flint.

A list holds the coefficients of the powers of x, constant first.  In ring Q[t]/(q) they are reduced
modulo q.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

import flint

from mcexact.errors import InternalError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, _fmpq, _from_rational
from mcexact.exact.polynomial_matrix import PolynomialMatrix

Coefficient = flint.fmpq_poly
Bivariate = list[Any]


_PRIME, _VALUE = 2**61 - 1, 10**9 + 7


@cache
def _ring() -> Any:
    return flint.fmpq_mpoly_ctx.get(("t", "x"), flint.Ordering.lex)


def from_polynomials(p: Sequence[Polynomial]) -> Bivariate:
    """The polynomial with these coefficients."""
    return [c._rational for c in p]


def polynomials(f: Bivariate) -> tuple[Polynomial, ...]:
    """The coefficients."""
    return tuple(_from_rational(c) for c in f)


def degree(f: Bivariate) -> int:
    """The degree in t, at least 0."""
    return max([int(c.degree()) for c in f] + [0])


def joined(f: Bivariate) -> Any:
    """f as one polynomial of flint in t and x."""
    terms = {(i, k): c for k, part in enumerate(f) for i, c in enumerate(part.coeffs()) if c != 0}
    return _ring().from_dict(terms)


def split(f: Any) -> Bivariate:
    """The coefficients of a polynomial of flint, divided by the leading one, which is constant."""
    rows: dict[int, dict[int, Any]] = {}
    for (i, k), c in f.to_dict().items():
        rows.setdefault(int(k), {})[int(i)] = c
    found = [
        flint.fmpq_poly([row.get(i, 0) for i in range(max(row, default=-1) + 1)])
        for row in (rows.get(k, {}) for k in range(max(rows) + 1))
    ]
    if found[-1].degree() != 0:
        raise InternalError("a factor of a monic polynomial is not monic")
    return [c / found[-1][0] for c in found]


def common_factors(polynomials: Sequence[Bivariate]) -> list[Bivariate]:
    """The irreducible factors of positive degree in x of the greatest common divisor."""
    if _are_apart_somewhere(polynomials):
        return []
    common = joined(polynomials[0])
    for f in polynomials[1:]:
        common = common.gcd(joined(f))
    found = [p for p, _ in common.factor()[1] if p.degrees()[1] > 0]
    return sorted(map(split, found), key=lambda p: (len(p), str(p)))


def product(f: Bivariate, g: Bivariate) -> Bivariate:
    """f g, both nonzero."""
    result = [Coefficient([])] * (len(f) + len(g) - 1)
    for i, a in enumerate(f):
        for k, b in enumerate(g):
            result[i + k] = result[i + k] + a * b
    return result


def difference(f: Bivariate, g: Bivariate) -> Bivariate:
    """f − g, perhaps with zeros at the end."""
    zero = Coefficient([])
    return [a - b for a, b in itertools.zip_longest(f, g, fillvalue=zero)]


def divided(f: Bivariate, g: Bivariate, q: Any = None) -> tuple[Bivariate, Bivariate]:
    """Quotient and remainder by g, which is monic in x; modulo q if it is given."""
    rest, quotient = list(f), []
    while len(rest) >= len(g):
        top = rest.pop()
        quotient.append(top)
        if top != 0:
            for k in range(len(g) - 1):
                place = len(rest) - len(g) + 1 + k
                rest[place] = rest[place] - top * g[k]
                if q is not None:
                    rest[place] = rest[place] % q
    while rest and rest[-1] == 0:
        rest.pop()
    return quotient[::-1], rest


def without(f: Bivariate, g: Bivariate, q: Any = None) -> Bivariate:
    """f divided by g as often as it goes."""
    while len(f) >= len(g):
        quotient, rest = divided(f, g, q)
        if rest:
            break
        f = quotient
    return f


def at(f: Bivariate, t: int | Fraction) -> Any:
    """f at a value of t, a polynomial in x."""
    point = _fmpq(t)
    return flint.fmpq_poly([c(point) for c in f])


def interpolated(values: Sequence[Any], points: Sequence[int]) -> Any:
    """The polynomial with these values at integers (Newton)."""
    slopes = list(values)
    for k in range(1, len(points)):
        for i in range(len(points) - 1, k - 1, -1):
            slopes[i] = (slopes[i] - slopes[i - 1]) / (points[i] - points[i - k])
    result = flint.fmpq_poly([])
    for slope, point in zip(reversed(slopes), reversed(points), strict=True):
        result = result * flint.fmpq_poly([-point, 1]) + flint.fmpq_poly([slope])
    return result


def points(count: int) -> list[int]:
    """0, 1, −1, 2, −2, …"""
    return [(k + 1) // 2 * (1 if k % 2 else -1) for k in range(count)]


def residues(p: Any, ell: int) -> flint.nmod_poly:
    """A rational polynomial modulo a prime that divides no denominator."""
    scale = pow(int(p.denom()), -1, ell)
    return flint.nmod_poly([int(c) * scale % ell for c in p.numer().coeffs()], ell)


def denominators(f: Bivariate) -> list[int]:
    """The denominators of the coefficients."""
    return [int(c.denom()) for c in f]


def roots_modulo(q: Any, p: Bivariate, ell: int) -> Iterator[tuple[int, int]]:
    """Yield the roots of q modulo a prime, each with the roots of p there."""
    for tau in sorted(int(root) for root, _ in residues(q, ell).roots()):
        value = flint.nmod_poly([int(residues(c, ell)(tau)) for c in p], ell)
        for mu in sorted(int(root) for root, _ in value.roots()):
            yield tau, mu


def are_coprime(first: Bivariate, second: Bivariate) -> bool:
    """Whether two polynomials, monic in x, have no common factor."""
    return _are_apart_somewhere([first, second]) or bool(
        joined(first).gcd(joined(second)).is_constant()
    )


def _are_apart_somewhere(polynomials: Sequence[Bivariate]) -> bool:
    """Whether they have no common root at one value of t modulo a prime: then no common factor."""
    if any(d % _PRIME == 0 for f in polynomials for d in denominators(f)):
        return False
    values = [
        flint.nmod_poly([int(residues(c, _PRIME)(_VALUE)) for c in f], _PRIME) for f in polynomials
    ]
    common = values[0]
    for value in values[1:]:
        common = common.gcd(value)
    return bool(common.degree() == 0)


def size(f: Bivariate) -> int:
    """The sum of the absolute values of all coefficients of the least integer multiple."""
    d = math.lcm(*denominators(f))
    return sum(abs(int(v.p)) * (d // int(v.q)) for c in f for v in c.coeffs())


def is_coprime_modulo(q: Any, residue: flint.nmod_poly, ell: int) -> bool:
    """Whether a rational polynomial has no common root with another one modulo a prime."""
    return bool(residues(q, ell).gcd(residue).degree() == 0)


def freed(p: Any, factors: Sequence[Any]) -> Any:
    """p divided by each factor as often as it goes, and by its leading coefficient."""
    for q in factors:
        while (pair := divmod(p, q))[1] == 0:
            p = pair[0]
    return p / p[p.degree()]


def characteristic(M: PolynomialMatrix) -> Bivariate:
    """det(xI − M(t)), by values."""
    where = points(degree_bound(M) + 1)
    values = []
    for t in where:
        part = value_at(M, t)
        entries = [flint.fmpq(v, part.denominator) for row in part.numerators for v in row]
        values.append(flint.fmpq_mat(part.nrows, part.ncols, entries).charpoly())
    return [interpolated([v[k] for v in values], where) for k in range(M.nrows + 1)]


def value_at(M: PolynomialMatrix, t: int | Fraction) -> Matrix:
    """A polynomial matrix at a value of its variable."""
    total = Matrix.zeros(M.nrows, M.ncols)
    for layer in reversed(M.matrices):
        total = total * Fraction(t) + layer
    return total


def degree_bound(M: PolynomialMatrix) -> int:
    """A bound for the degree in t of the coefficients of det(xI − M(t)), by rows and by columns."""
    degrees = [[0] * M.ncols for _ in range(M.nrows)]
    for k, layer in enumerate(M.matrices):
        for i, row in enumerate(layer.numerators):
            for j, entry in enumerate(row):
                if entry:
                    degrees[i][j] = k
    rows: int = sum(max(row) for row in degrees)
    columns: int = sum(max(column) for column in zip(*degrees, strict=True))
    return min(rows, columns)
