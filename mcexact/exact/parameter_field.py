"""Polynomials in x over the number field L = Q[t]/(q), q monic and irreducible."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import flint

from mcexact.errors import InternalError
from mcexact.exact.two_variables import Bivariate, divided, interpolated, points


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
        moved = _shifted(f, -k, q)
        norm = _norm(moved, q)
        if norm.gcd(norm.derivative()).degree() == 0:
            break
    found = []
    for p, _ in norm.numer().factor()[1]:
        constant = [flint.fmpq_poly([c]) for c in flint.fmpq_poly(p).coeffs()]
        found.append(monic(_shifted(gcd(moved, constant, q), k, q), q))
    return sorted(found, key=lambda p: (len(p), str(p)))


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
        moved = [c, *result]
        for i, entry in enumerate(result):
            moved[i] = (moved[i] + shift * entry) % q
        result = moved
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
