"""Kernels over Q[t]/(q)[x]/(p), and over Q(t)[x]/(p), from matrices of rational numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import flint

from mcexact.errors import InternalError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.two_variables import Bivariate, at, interpolated

_CHECKED = 3
"""The number of points at which functions that were found from others are compared."""

Element = list[Any]
"""A polynomial in x, by its coefficients in Q[t]."""
Kernel = tuple[tuple[int, ...], list[list[Element]]]
"""The rows that form the identity, and the columns of a kernel."""
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


def entries_of(M: PolynomialMatrix) -> list[list[Any]]:
    """The entries as polynomials of flint."""
    return [
        [
            flint.fmpq_poly([flint.fmpq(c.numerator, c.denominator) for c in entry.coefficients])
            for entry in (M.entry(i, j) for j in range(M.ncols))
        ]
        for i in range(M.nrows)
    ]


def matrix_of(rows: list[list[Any]], ncols: int) -> PolynomialMatrix:
    """The matrix of polynomials of flint."""
    made = [
        [Polynomial(tuple(Fraction(int(c.p), int(c.q)) for c in entry.coeffs())) for entry in row]
        for row in rows
    ]
    return PolynomialMatrix.from_polynomials(made, ncols=ncols)


class Tower:
    """K = Q[t]/(q)[x]/(p) with the basis x^k t^j, j < deg q, over Q; a field."""

    def __init__(self, q: Any, p: Bivariate) -> None:
        self.q, self.e, self.f = q, int(q.degree()), len(p) - 1
        self.D = self.e * self.f
        self.p = [c % q for c in p]
        self._known: dict[str, list[list[Any]]] = {}

    def _coordinates(self, element: Element) -> list[Any]:
        """The coordinates of an element of degree below f in x."""
        parts = [*element, *[flint.fmpq_poly([])] * (self.f - len(element))]
        return [part[j] for part in parts for j in range(self.e)]

    def _times_x(self, element: Element) -> Element:
        parts = [*element, *[flint.fmpq_poly([])] * (self.f - len(element))]
        top = parts[-1]
        moved = [flint.fmpq_poly([]), *parts[:-1]]
        return [(a - top * c) % self.q for a, c in zip(moved, self.p, strict=False)]

    def _multiplication(self, element: Element) -> list[list[Any]]:
        """The columns x^k t^j · element, for an element of degree at most 1 in x."""
        key = str(element)
        if key not in self._known:
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
            self._known[key] = columns
        return self._known[key]

    def kernel(self, rows: list[list[Element]], ncols: int) -> Kernel:
        """The kernel of a matrix with these rows, in echelon form."""
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


def over_functions(sample: Callable[[int], Kernel | None]) -> Kernel:
    """The kernel over Q(t) that has these values, multiplied by the least common denominator."""
    far = [found for t in range(10**4, 10**4 + 60) if (found := sample(t)) is not None][:3]
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
            found = sample(t)
            if found is not None and found[0] == pattern:
                where.append(t)
                values.append([c[0] for vector in found[1] for e in vector for c in e])
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
    found = []
    for given in zip(*values, strict=True):
        function = _function(given, where, count, modulus)
        if function is None:
            return None
        found.append(function)
    return found


def _function(given: Sequence[Any], where: list[int], count: int, modulus: Any) -> Any:
    """One of them, N/D with D monic (Cauchy interpolation)."""
    one = flint.fmpq_poly([1])
    if len(set(map(str, given))) == 1:
        return flint.fmpq_poly([given[0]]), one
    r0, r1 = modulus, interpolated(given[:count], where[:count])
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
    for t, value in zip(where, given, strict=True):
        if bottom(t) == 0 or top(t) / bottom(t) != value:
            return None
    return top, bottom
