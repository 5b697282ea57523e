"""Polynomials in x whose coefficients are rational polynomials in several parameters, of flint.

They are elements of one ring, in which x is the last variable.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache, reduce
from typing import Any

import flint

from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.rational_function import RationalFunction

Rows = list[list[Any]]
"""A matrix by its rows, whose entries are polynomials in the parameters."""
VARIABLE = "x"


@cache
def ring(parameters: tuple[str, ...]) -> Any:
    """The ring of polynomials in the parameters and x."""
    return flint.fmpq_mpoly_ctx.get((*parameters, VARIABLE), flint.Ordering.lex)


def cleared(M: FunctionMatrix, parameters: tuple[str, ...]) -> tuple[Rows, Any]:
    """M' and δ with M = M'/δ, δ the least common denominator of the entries."""
    inside = ring(parameters)
    entries = [
        [(e.numerator.project_to_context(inside), e.denominator.project_to_context(inside))
         for e in row]
        for row in M.rows
    ]  # fmt: skip
    delta = inside.constant(1)
    for row in entries:
        for _, bottom in row:
            delta = delta * (bottom / delta.gcd(bottom))
    return [[top * (delta / bottom) for top, bottom in row] for row in entries], delta


def product(M: Rows, N: Rows, zero: Any) -> Rows:
    """M N."""
    columns = [*zip(*N, strict=True)]
    return [
        [sum((a * b for a, b in zip(row, column, strict=True) if a and b), zero)
         for column in columns]
        for row in M
    ]  # fmt: skip


def total(M: Rows, N: Rows) -> Rows:
    """M + N."""
    return [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(M, N, strict=True)]


def characteristic(M: Rows, parameters: tuple[str, ...]) -> Any:
    """det(xI − M), by traces (Faddeev and Le Verrier)."""
    inside = ring(parameters)
    x, zero, n = inside.gens()[-1], inside.constant(0), len(M)
    found, coefficient = x**n, inside.constant(1)
    power = [[zero] * n for _ in range(n)]
    for k in range(1, n + 1):
        power = product(M, power, zero)
        for i in range(n):
            power[i][i] = power[i][i] + coefficient
        below = product(M, power, zero)
        coefficient = sum((below[i][i] for i in range(n)), zero) / -k
        found = found + coefficient * x ** (n - k)
    return found


def value(f: Any, point: Sequence[Any]) -> Any:
    """The value of a polynomial without x at a point."""
    return f(*point, 0)


def determinant(M: Rows, parameters: tuple[str, ...]) -> Any:
    """The determinant up to its sign, by elimination without fractions (Bareiss).

    The shortest entry is the pivot, wherever it stands.

    Examples
    --------
    >>> a, b, _ = ring(("a", "b")).gens()
    >>> determinant([[a, b], [b, a]], ("a", "b")) in (a**2 - b**2, b**2 - a**2)
    True
    """
    rows = [list(row) for row in M]
    before = ring(parameters).constant(1)
    for _ in range(len(M) - 1):
        places = [(len(e), i, j) for i, row in enumerate(rows) for j, e in enumerate(row) if e]
        if not places:
            return ring(parameters).constant(0)
        _, i, j = min(places)
        top = rows.pop(i)
        pivot = top[j]
        rows = [
            [
                (pivot * entry - row[j] * above) / before
                for k, (entry, above) in enumerate(zip(row, top, strict=True))
                if k != j
            ]
            for row in rows
        ]
        before = pivot
    return rows[0][0] if rows else before


def degree(f: Any) -> int:
    """The degree in x."""
    return max(int(f.degrees()[-1]), 0)


def factors(f: Any) -> list[Any]:
    """The irreducible factors that are no constants, in a fixed order."""
    return sorted((p for p, _ in f.factor()[1] if not p.is_constant()), key=str)


def without(f: Any, g: Any) -> Any:
    """f divided by g as often as it goes."""
    while True:
        quotient, rest = divmod(f, g)
        if rest != 0:
            return f
        f = quotient


def common_divisor(polynomials: Sequence[Any]) -> Any:
    """The greatest common divisor."""
    return reduce(lambda f, g: f.gcd(g), polynomials)


def is_coprime(f: Any, g: Any) -> bool:
    """Whether two polynomials have no common factor but constants."""
    return bool(f.gcd(g).is_constant())


def resultant_factors(
    f: Sequence[Any], g: Sequence[Any], parameters: tuple[str, ...]
) -> set[RationalFunction]:
    """The irreducible factors of the resultants with respect to x of two lists of polynomials.

    No polynomial of the one list has a factor in common with one of the other, so that no resultant
    is 0.  Their coefficients are coprime integers, the first one positive.
    """
    return {
        in_parameters(h, parameters)
        for a in f
        for b in g
        for h in factors(a.resultant(b, VARIABLE))
    }


def in_parameters(h: Any, parameters: tuple[str, ...]) -> RationalFunction:
    """A polynomial in which x does not occur."""
    one = RationalFunction.constant(1, parameters).numerator
    return RationalFunction(parameters, h.project_to_context(one.context()), one)


def coefficients(p: Any, parameters: tuple[str, ...]) -> tuple[RationalFunction, ...]:
    """The coefficients of a polynomial that is monic in x up to a constant, constant term first."""
    rows: list[dict[tuple[int, ...], Any]] = [{} for _ in range(degree(p) + 1)]
    for exponents, c in p.to_dict().items():
        rows[int(exponents[-1])][tuple(map(int, exponents[:-1]))] = c
    [lead] = rows[-1].values()
    one = RationalFunction.constant(1, parameters).numerator
    return tuple(
        RationalFunction(
            parameters, one.context().from_dict({e: c / lead for e, c in row.items()}), one
        )
        for row in rows
    )
