"""Fixed modes of systems with a parameter by enumeration, at points and modulo primes.

At a point all subsets of channels are tried for every irreducible factor of χ_A: over Q, and over
the field with ℓ elements at all its points, of which some are roots of any polynomial that has
been overlooked.  Nothing here computes a resultant, or a gain.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

import flint

Rows = list[list[Any]]
Plain = tuple[Rows, list[Rows], list[Rows]]
"""A, B_i and C_i as rows of numbers."""
PRIMES = (211, 307, 401)
KNOWN: dict[tuple[int, int], tuple[Any, list[Rows]]] = {}
"""What is known of a system, which is kept so that no other one gets its address."""


def fixed_radical(plain: Plain, ell: int = 0) -> Any:
    """The product of the distinct irreducible factors of χ_A that are fixed; over Q if ℓ is 0."""
    A, _, _ = plain
    n, result = len(A), _polynomial([1], ell)
    chi = _matrix(A, n, n, ell).charpoly()
    parts = (
        chi.factor()[1] if ell else [(flint.fmpq_poly(p), e) for p, e in chi.numer().factor()[1]]
    )
    for p, _ in parts:
        p = p / p[p.degree()] if not ell else p
        if any(_rank(plain, s, p, ell) < n for s in subsets(len(plain[1]))):
            result = result * p
    return result


def subsets(m: int) -> Iterator[tuple[int, ...]]:
    """All sets of channels."""
    for size in range(m + 1):
        yield from itertools.combinations(range(m), size)


def _rank(plain: Plain, s: Sequence[int], p: Any, ell: int) -> int:
    """The rank of [λI − A, B_{m−s}; C_s, 0] at a root of p, whose companion stands for λ."""
    A, B, C = plain
    n, d = len(A), int(p.degree())
    rows = []
    for i in range(n):
        rows.append([-v for v in A[i]] + [v for k in range(len(B)) if k not in s for v in B[k][i]])
    width = len(rows[0]) if rows else 0
    for k in s:
        rows += [[*row, *[0] * (width - n)] for row in C[k]]
    table = [[0] * (width * d) for _ in range(len(rows) * d)]
    for i, row in enumerate(rows):
        for j, v in enumerate(row):
            for k in range(d):
                table[i * d + k][j * d + k] += v
                if i == j < n:
                    if k:
                        table[i * d + k][j * d + k - 1] += 1
                    table[i * d + k][j * d + d - 1] -= _entry(p, k, ell)
    return int(_matrix(table, len(rows) * d, width * d, ell).rank()) // d


def _entry(p: Any, k: int, ell: int) -> Any:
    return int(p[k]) if ell else Fraction(int(p[k].p), int(p[k].q))


def _matrix(rows: Rows, nrows: int, ncols: int, ell: int) -> Any:
    values = [v for row in rows for v in row]
    if ell:
        return flint.nmod_mat(nrows, ncols, [int(v) % ell for v in values], ell)
    return flint.fmpq_mat(nrows, ncols, [_fmpq(v) for v in values])


def _fmpq(v: Any) -> Any:
    return v if isinstance(v, flint.fmpq) else flint.fmpq(v.numerator, v.denominator)


def _polynomial(coefficients: Sequence[Any], ell: int) -> Any:
    if ell:
        return flint.nmod_poly([int(c) % ell for c in coefficients], ell)
    return flint.fmpq_poly(list(map(_fmpq, coefficients)))


def values(system: Any, t: Fraction | int, ell: int = 0) -> Plain | None:
    """The matrices at a point, from the expressions of the entries; None where one is undefined."""

    def at(p: Sequence[Any]) -> Any:
        total: Any = 0
        for c in reversed(p):
            total = total * t + c
        return total % ell if ell else total

    def number(entry: tuple[Any, Any]) -> Any:
        over, under = map(at, entry)
        if under == 0:
            raise ZeroDivisionError
        return over * pow(under, -1, ell) % ell if ell else Fraction(over) / under

    try:
        A, *ports = [
            [[number(e) for e in row] for row in rows] for rows in _coefficients(system, ell)
        ]
    except ZeroDivisionError:
        return None
    return A, ports[0::2], ports[1::2]


def _coefficients(system: Any, ell: int) -> list[Rows]:
    """A, B_1, C_1, … with each entry as the coefficients of a numerator and of a denominator."""
    found = KNOWN.get((id(system), ell))
    if found is None or found[0] is not system:
        if len(KNOWN) > 100:
            KNOWN.clear()
        found = KNOWN[id(system), ell] = system, _converted(system, ell)
    return found[1]


def _converted(system: Any, ell: int) -> list[Rows]:
    tables = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    return [
        [
            [
                tuple([_residue(c, ell) for c in p.coefficients] for p in entry.polynomials())
                for entry in row
            ]
            for row in M.rows
        ]
        for M in tables
    ]


def _residue(c: Fraction, ell: int) -> Any:
    return c.numerator * pow(c.denominator, -1, ell) % ell if ell else c


def claimed_radical(found: Any, t: Fraction | int, ell: int = 0) -> Any:
    """The product of the distinct factors of what an answer claims at a point, times 1/δ."""

    def at(p: Any) -> Any:
        value = sum(_residue(c, ell) * t**k for k, c in enumerate(p.coefficients))
        return value % ell if ell else Fraction(value)

    polynomials = [*found.generic]
    for each in found.exceptional:
        if at(each.value) == 0:
            polynomials += [mode.polynomial for mode in each.modes]
    delta, result = at(found.scale), _polynomial([1], ell)
    for p in polynomials:
        d = len(p) - 1
        # p(δx) / δ^d
        scaled = [at(c) * delta**k for k, c in enumerate(p)]
        over = pow(delta**d, -1, ell) if ell else 1 / delta**d
        result = result * _polynomial([c * over for c in scaled], ell)
    common = result.gcd(result.derivative())
    result = result // common
    return result / result[result.degree()]


def says_nothing(found: Any, t: Fraction | int, ell: int = 0) -> bool:
    """Whether a value is out of the range that is assumed."""
    for each in found.outside:
        value = sum(_residue(c, ell) * t**k for k, c in enumerate(each.value.coefficients))
        if (value % ell if ell else value) == 0:
            return True
    return False


def disagreements(
    system: Any, found: Any, points: Sequence[Fraction | int], primes: Sequence[int] = PRIMES
) -> list[str]:
    """Where an answer and enumeration differ, at rational points and modulo primes."""
    wrong = []
    for t in points:
        plain = values(system, t)
        if plain is not None and not says_nothing(found, t):
            want = fixed_radical(plain)
            if want != claimed_radical(found, t):
                wrong.append(f"t = {t}: {want}, claimed {claimed_radical(found, t)}")
    bad = []
    for ell in primes:
        try:
            if any(_differs(system, found, t, ell) for t in range(ell)):
                bad.append(ell)
        except ValueError:  # the prime divides a denominator
            continue
    if len(bad) > 1:  # one prime may be unlucky
        wrong.append(f"modulo {bad}")
    return wrong


def _differs(system: Any, found: Any, t: int, ell: int) -> bool:
    plain = values(system, t, ell)
    if plain is None or says_nothing(found, t, ell):
        return False
    want, claimed = fixed_radical(plain, ell), claimed_radical(found, t, ell)
    # a claimed polynomial may have multiple roots modulo a prime
    return bool(want != claimed)
