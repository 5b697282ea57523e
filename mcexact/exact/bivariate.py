"""Routines on polynomials in x and t: resultants, null spaces, and arithmetic over Q[t]/(q).

A `Bivariate` is plain data, a list of flint's polynomials in t: the coefficients of the powers of
x, constant first.  Over L = Q[t]/(q) they are reduced modulo q, which is monic and irreducible.
This is one of the two forms of `exact.parametric_polynomials`, through which the rest of the
package uses these routines, except for those modulo a prime.

Characteristic polynomials and norms are computed by values: at enough integers t, by flint over Q,
then interpolated.  Coprimality is tried at a value of t modulo a prime first, since one value
without a common root proves it.

Over L, `factors` is Trager's algorithm: it factors the norm, a polynomial over Q.  Null spaces over
L[x]/(p) (`Tower`) are null spaces of matrices over Q, in which each element is its matrix of
multiplication.  Null spaces over Q(t) (`over_functions`) are interpolated by rational functions
from null spaces at integers, and further values have to agree, which is no proof.

Resultants with respect to x are computed modulo primes, by values at t, of `Residues`: polynomials
in x and t modulo a prime are a type of their own, since flint's for one word are many times faster.
`common_divisor` combines primes until the result no longer changes; that is no proof, and the
callers have to verify it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any

import flint

from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.modular import combine, rationals
from mcexact.exact.polynomial import to_fmpq

# Polynomials in x and t over Q.

Bivariate = list[Any]
"""A polynomial in x, by its coefficients in Q[t]."""

_PRIME, _VALUE = 2**61 - 1, 10**9 + 7


def product(f: Bivariate, g: Bivariate) -> Bivariate:
    """f g, both nonzero."""
    result = [flint.fmpq_poly([])] * (len(f) + len(g) - 1)
    for i, a in enumerate(f):
        for k, b in enumerate(g):
            result[i + k] = result[i + k] + a * b
    return result


def difference(f: Bivariate, g: Bivariate) -> Bivariate:
    """f − g, perhaps with zeros at the end."""
    zero = flint.fmpq_poly([])
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
    """f divided by g as often as g divides it."""
    while len(f) >= len(g):
        quotient, rest = divided(f, g, q)
        if rest:
            break
        f = quotient
    return f


def at(f: Bivariate, t: int | Fraction) -> Any:
    """f at a value of t, a polynomial in x."""
    point = to_fmpq(t)
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


def are_apart_somewhere(polynomials: Sequence[Bivariate]) -> bool:
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


def characteristic(M: PolynomialMatrix) -> Bivariate:
    """det(xI − M(t)), by values."""
    where = points(degree_bound(M) + 1)
    values = []
    for t in where:
        part = M.at(t)
        entries = [flint.fmpq(v, part.denominator) for row in part.numerators for v in row]
        values.append(flint.fmpq_mat(part.nrows, part.ncols, entries).charpoly())
    return [interpolated([v[k] for v in values], where) for k in range(M.nrows + 1)]


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


# Polynomials in x over the number field L = Q[t]/(q), q monic and irreducible.


def reduced(f: Bivariate, q: Any) -> Bivariate:
    """f with its coefficients reduced modulo q."""
    result = [c % q for c in f]
    while result and result[-1] == 0:
        result.pop()
    return result


def monic(f: Bivariate, q: Any) -> Bivariate:
    """f ≠ 0 divided by its leading coefficient."""
    g, u, _ = f[-1].xgcd(q)
    if g.degree() != 0:
        raise InternalError("a modulus that should be irreducible has a factor")
    return [(c * u / g[0]) % q for c in f]


def gcd(f: Bivariate, g: Bivariate, q: Any) -> Bivariate:
    """The monic greatest common divisor, f ≠ 0."""
    while g:
        g = monic(g, q)
        f, g = g, divided(f, g, q)[1]
    return monic(f, q)


def factors(f: Bivariate, q: Any) -> list[Bivariate]:
    """The distinct monic irreducible factors (Trager): those of the norm of f(x + kt), for some k.

    Examples
    --------
    x² − 2 over Q(√2), whose root is t:

    >>> P = flint.fmpq_poly
    >>> [str(p[0]) for p in factors([P([-2]), P([0]), P([1])], P([-2, 0, 1]))]
    ['(-1)*x', 'x']
    """
    f = monic(f, q)
    if len(f) < 2:
        return []
    slope = reduced([k * c for k, c in enumerate(f)][1:], q)
    f = monic(divided(f, gcd(f, slope, q), q)[0], q)
    if len(f) == 2:
        return [f]
    for k in _shifts():
        shifted = _shifted(f, -k, q)
        norm = _norm(shifted, q)
        if norm.gcd(norm.derivative()).degree() == 0:
            break
    result = []
    for p, _ in norm.numer().factor()[1]:
        constant = [flint.fmpq_poly([c]) for c in flint.fmpq_poly(p).coeffs()]
        result.append(monic(_shifted(gcd(shifted, constant, q), k, q), q))
    return sorted(result, key=lambda p: (len(p), str(p)))


def _shifts() -> Iterator[int]:
    k = 0
    while True:
        yield k
        k = -k if k > 0 else 1 - k


def _shifted(f: Bivariate, k: int, q: Any) -> Bivariate:
    """f(x + kt)."""
    shift = flint.fmpq_poly([0, k]) % q
    result: Bivariate = []
    for c in reversed(f):
        raised = [c, *result]
        for i, entry in enumerate(result):
            raised[i] = (raised[i] + shift * entry) % q
        result = raised
    return result


def _norm(f: Bivariate, q: Any) -> Any:
    """Res_t(q, f), a polynomial in x, by values."""
    where = points(int(q.degree()) * (len(f) - 1) + 1)
    values = []
    for x in where:
        value = flint.fmpq_poly([])
        for c in reversed(f):
            value = value * x + c
        values.append(q.resultant(value))
    return interpolated(values, where)


# Null spaces over Q[t]/(q)[x]/(p), and over Q(t)[x]/(p), from matrices of rational numbers.

_CHECKED = 3
"""The number of further points at which interpolated functions are compared."""

Nullspace = tuple[tuple[int, ...], list[list[Bivariate]]]
"""The rows that form the identity, and the columns of a null space."""
X: Bivariate = [flint.fmpq_poly([0]), flint.fmpq_poly([1])]
"""x itself, modulo which nothing depends on x."""


def line(t: int) -> Any:
    """The polynomial whose only root is an integer."""
    return flint.fmpq_poly([-t, 1])


def modulus_at(p: Bivariate, t: int) -> Bivariate | None:
    """p at an integer, or None if it is not irreducible there."""
    value = at(p, t)
    factors = value.numer().factor()[1]
    if len(factors) != 1 or factors[0][1] != 1:
        return None
    return [flint.fmpq_poly([c]) for c in value.coeffs()]


class Tower:
    """K = Q[t]/(q)[x]/(p) with the basis x^k t^j, j < deg q, over Q; a field."""

    def __init__(self, q: Any, p: Bivariate) -> None:
        self.q, self.e, self.f = q, int(q.degree()), len(p) - 1
        self.D = self.e * self.f
        self.p = [c % q for c in p]
        self._columns: dict[str, list[list[Any]]] = {}

    def _coordinates(self, element: Bivariate) -> list[Any]:
        """The coordinates of an element of degree below f in x."""
        parts = [*element, *[flint.fmpq_poly([])] * (self.f - len(element))]
        return [part[j] for part in parts for j in range(self.e)]

    def _times_x(self, element: Bivariate) -> Bivariate:
        parts = [*element, *[flint.fmpq_poly([])] * (self.f - len(element))]
        top = parts[-1]
        raised = [flint.fmpq_poly([]), *parts[:-1]]
        return [(a - top * c) % self.q for a, c in zip(raised, self.p, strict=False)]

    def _multiplication(self, element: Bivariate) -> list[list[Any]]:
        """The columns x^k t^j · element, for an element of degree at most 1 in x."""
        key = str(element)
        if key not in self._columns:
            zero = flint.fmpq_poly([])
            low = [element[0] % self.q]
            first = self._times_x([element[1] % self.q]) if len(element) > 1 else []
            power = [
                a + b
                for a, b in zip(low + [zero] * (self.f - 1), first or [zero] * self.f, strict=True)
            ]
            columns = []
            for _ in range(self.f):
                turned = power
                for _ in range(self.e):
                    columns.append(self._coordinates(turned))
                    turned = [(c * flint.fmpq_poly([0, 1])) % self.q for c in turned]
                power = self._times_x(power)
            self._columns[key] = columns
        return self._columns[key]

    def nullspace(self, rows: list[list[Bivariate]], ncols: int) -> Nullspace:
        """The null space of a matrix with these rows, in echelon form."""
        D = self.D
        table = flint.fmpq_mat(len(rows) * D, ncols * D)
        for i, row in enumerate(rows):
            for j, element in enumerate(row):
                if any(c != 0 for c in element):
                    for k, column in enumerate(self._multiplication(element)):
                        for r, entry in enumerate(column):
                            if entry != 0:
                                table[i * D + r, j * D + k] = entry
        reduced, rank = table.rref()
        bound, position = [], 0
        for r in range(0, rank, D):
            while reduced[r, position] == 0:
                position += 1
            bound.append(position // D)
            position = (bound[-1] + 1) * D
        if rank % D:
            raise InternalError("a modulus that should be irreducible has a factor")
        free = [j for j in range(ncols) if j not in set(bound)]
        zero, one = [flint.fmpq_poly([])] * self.f, flint.fmpq_poly([1])
        columns = []
        for j in free:
            vector = [list(zero) for _ in range(ncols)]
            vector[j][0] = one
            for b, place in enumerate(bound):
                values = [-reduced[b * D + k, j * D] for k in range(D)]
                vector[place] = [
                    flint.fmpq_poly(values[k * self.e : (k + 1) * self.e]) for k in range(self.f)
                ]
            columns.append(vector)
        return tuple(free), columns


def over_functions(sample: Callable[[int], Nullspace | None]) -> Nullspace:
    """The null space over Q(t) with these values, multiplied by the least common denominator."""
    far = [value for t in range(10**4, 10**4 + 60) if (value := sample(t)) is not None][:3]
    if not far:
        raise InternalError("a generic polynomial factors at every point that was tried")
    least = min(len(free) for free, _ in far)
    pattern = next(free for free, _ in far if len(free) == least)
    where: list[int] = []
    values: list[list[Any]] = []
    t, wanted = 1, 4
    while True:
        while len(where) < wanted + _CHECKED:
            t += 1
            basis = sample(t)
            if basis is not None and basis[0] == pattern:
                where.append(t)
                values.append([c[0] for vector in basis[1] for e in vector for c in e])
        functions = _functions(values, where, wanted)
        if functions is not None:
            break
        wanted *= 2
    common = flint.fmpq_poly([1])
    for _, bottom in functions:
        common = common * (bottom // common.gcd(bottom))
    whole = iter([top * (common // bottom) for top, bottom in functions])
    shape = far[0] if far[0][0] == pattern else next(k for k in far if k[0] == pattern)
    return pattern, [[[next(whole) for _ in e] for e in vector] for vector in shape[1]]


def _functions(
    values: list[list[Any]], where: list[int], count: int
) -> list[tuple[Any, Any]] | None:
    """Rational functions with these values at the first points, if they have the others as well."""
    modulus = flint.fmpq_poly([1])
    for t in where[:count]:
        modulus = modulus * flint.fmpq_poly([-t, 1])
    functions = []
    for column in zip(*values, strict=True):
        function = _function(column, where, count, modulus)
        if function is None:
            return None
        functions.append(function)
    return functions


def _function(values: Sequence[Any], where: list[int], count: int, modulus: Any) -> Any:
    """A rational function N/D with these values, D monic (Cauchy interpolation)."""
    one = flint.fmpq_poly([1])
    if len(set(map(str, values))) == 1:
        return flint.fmpq_poly([values[0]]), one
    r0, r1 = modulus, interpolated(values[:count], where[:count])
    v0: Any = flint.fmpq_poly([])
    v1: Any = one
    while r1.degree() > count // 2:
        quotient, rest = divmod(r0, r1)
        r0, r1, v0, v1 = r1, rest, v1, v0 - quotient * v1
    if v1 == 0:
        return None
    common = r1.gcd(v1)
    top, bottom = r1 // common, v1 // common
    lead = bottom[bottom.degree()]
    top, bottom = top / lead, bottom / lead
    for t, value in zip(where, values, strict=True):
        if bottom(t) == 0 or top(t) / bottom(t) != value:
            return None
    return top, bottom


# Resultants with respect to x modulo primes, and the greatest common divisor of two of them.

Residues = list[flint.nmod_poly]
"""Coefficients of the powers of x modulo ℓ, constant first."""


def residues_in_x(f: Bivariate, ell: int) -> Residues:
    """f modulo a prime that divides no denominator."""
    return [residues(c, ell) for c in f]


def resultant_degree_bound(f: Sequence[Any], g: Sequence[Any]) -> int:
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
    >>> resultant_degree_bound([P([0, -1]), P([]), P([1])], [P([]), P([0, -1]), P([1])])
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
    slopes: list[tuple[Fraction | float, int]] = []
    k = len(f) - 1
    while k > 0:
        lines = ((Fraction(degrees[j] - degrees[k], k - j), k - j) for j in range(k) if f[j] != 0)
        slopes.append(max(lines, default=(-math.inf, k)))
        k -= slopes[-1][1]
    return slopes


def characteristic_modulo(M: PolynomialMatrix, ell: int) -> Residues:
    """det(xI − M(t)) modulo a prime that divides no denominator, by values."""
    values = [
        M.at_residue(t, ell).characteristic_polynomial().coefficients
        for t in range(degree_bound(M) + 1)
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
    many = resultant_degree_bound(f, g) + 1
    pairs = zip(_values(f, many, ell), _values(g, many, ell), strict=True)
    return interpolated_modulo([int(a.resultant(b)) for a, b in pairs], ell)


def of_rationals(f: Bivariate, g: Bivariate, ell: int) -> flint.nmod_poly:
    """`resultant_modulo` of polynomials over Q, for a prime that divides no denominator."""
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
    Primes modulo which its degree is larger are left out.  A result on which two products of
    primes agree is returned, and has to be verified.
    """
    product, rows = 1, [[0]]
    before: tuple[list[list[int]], int] | None = None
    for ell in primes:
        common = of_rationals(f, g, ell).gcd(of_rationals(f, h, ell))
        degree = int(common.degree())
        if degree == 0:
            return flint.fmpq_poly([1])
        row = [int(c) for c in common.coeffs()]
        if product == 1 or degree + 1 < len(rows[0]):
            product, rows, before = ell, [row], None
        elif degree + 1 == len(rows[0]):
            product, rows = product * ell, combine(rows, product, [row], ell)
        else:
            continue
        lifted = rationals(rows, product)
        if lifted is not None and lifted == before:
            [numerators], denominator = lifted
            return flint.fmpq_poly(numerators, denominator)
        before = lifted
    raise InternalError("primes have an end")
