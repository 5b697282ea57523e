"""Common factors of polynomials in several parameters, so that quotients have lowest terms.

Remainders in one parameter after another, whose coefficients are polynomials in the others, grow
without bound where nothing is common.  So a value of the others modulo a prime is tried first:
where the leading coefficient of one polynomial stays and nothing is common there, no common factor
contains this parameter, and what is common is that of all coefficients.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable
from fractions import Fraction
from typing import Protocol

from .arithmetic import Polynomial, coprime, stripped
from .budget import fractions, limbs_of, reductions, spend

Terms = dict[tuple[int, ...], Fraction]
"""A polynomial: its coefficients, none of which is 0, by the exponents of the parameters."""
PRIME = 2**61 - 1
SEED = 61


class Arithmetic(Protocol):
    """Products and sums that are charged."""

    def times(self, a: Terms, b: Terms) -> Terms:
        """The product."""
        ...

    def plus(self, a: Terms, b: Terms, sign: str) -> Terms:
        """The sum, or the difference."""
        ...


def common_factor(a: Terms, b: Terms, by: Arithmetic) -> Terms:
    """The greatest common divisor of a and b ≠ 0, whose leading coefficient is 1.

    Open: see ``proofs/OPEN.md``.
    """
    if not a or is_constant(a) or is_constant(b):
        return monic(b) if not a else one_of(b)
    width, least = len(next(iter(b))), 0
    chosen = -1
    for v in range(width):
        sides = degree(a, v), degree(b, v)
        if max(sides) == 0:
            continue
        if min(sides) == 0 or _apart(a, b, v):
            return _of_all([*coefficients(a, v).values(), *coefficients(b, v).values()], by)
        if chosen < 0 or min(sides) < least:
            chosen, least = v, min(sides)
    (first, p), (second, q) = (_primitive(each, chosen, by) for each in (a, b))
    common = common_factor(first, second, by)
    while q:
        if degree(q, chosen) == 0:
            p = one_of(p)
            break
        rest = _remainder(p, q, chosen, by)
        p, q = q, _primitive(rest, chosen, by)[1] if rest else rest
    return monic(by.times(common, p))


def divided(a: Terms, b: Terms, by: Arithmetic) -> Terms:
    """The quotient of a by b ≠ 0, which divides it."""
    if is_constant(b):
        [c] = b.values()
        spend(fractions(len(a), limbs_of([*a.values(), c])))
        return {e: d / c for e, d in a.items()}
    lead, rest, quotient = max(b), a, Terms()
    while rest:
        top = max(rest)
        key = tuple(e - f for e, f in zip(top, lead, strict=True))
        term = {key: rest[top] / b[lead]}
        quotient |= term
        rest = by.plus(rest, by.times(term, b), "-")
    return quotient


def is_constant(p: Terms) -> bool:
    """Whether no parameter occurs."""
    return not any(map(any, p))


def one_of(p: Terms) -> Terms:
    """The constant 1, in as many parameters."""
    return {(0,) * len(next(iter(p))): Fraction(1)}


def monic(p: Terms) -> Terms:
    """The polynomial divided by its leading coefficient."""
    spend(fractions(len(p), 2 * limbs_of(p.values())))
    c = p[max(p)]
    return {e: d / c for e, d in p.items()}


def degree(p: Terms, v: int) -> int:
    """The degree in the parameter of position v, 0 of 0."""
    spend(10 * len(p))
    return max((e[v] for e in p), default=0)


def coefficients(p: Terms, v: int) -> dict[int, Terms]:
    """The coefficients of the powers of a parameter, which are polynomials in the others."""
    spend(fractions(len(p), 1))
    found: dict[int, Terms] = {}
    for e, c in p.items():
        found.setdefault(e[v], {})[(*e[:v], 0, *e[v + 1 :])] = c
    return found


def _of_all(polynomials: Iterable[Terms], by: Arithmetic) -> Terms:
    """The greatest common divisor of some polynomials, the shortest first."""
    first, *others = sorted(polynomials, key=lambda p: (len(p), sorted(p)))
    found = monic(first)
    for p in others:
        if is_constant(found):
            break
        found = common_factor(p, found, by)
    return found


def _primitive(p: Terms, v: int, by: Arithmetic) -> tuple[Terms, Terms]:
    """The greatest common divisor of the coefficients of a parameter, and p divided by it."""
    inside = _of_all(coefficients(p, v).values(), by)
    return inside, divided(p, inside, by)


def _remainder(p: Terms, q: Terms, v: int, by: Arithmetic) -> Terms:
    """The remainder of p, times a power of the leading coefficient of q, by q."""
    known = coefficients(q, v)
    size = max(known)
    while p and degree(p, v) >= size:
        own = coefficients(p, v)
        top = max(own)
        power = {tuple((top - size) * (i == v) for i in range(len(next(iter(p))))): Fraction(1)}
        turned = by.times(by.times(own[top], power), q)
        p = by.plus(by.times(known[size], p), turned, "-")
    return p


def _apart(a: Terms, b: Terms, v: int) -> bool:
    """Whether a value of the other parameters modulo a prime shows that no common factor has v."""
    rng = random.Random(SEED)
    values = [rng.randrange(1, PRIME) for _ in next(iter(b))]
    first, second = (_at(p, v, values) for p in (a, b))
    kept = len(first) > degree(a, v) or len(second) > degree(b, v)
    return kept and coprime(first, second, PRIME)


def _at(p: Terms, v: int, values: list[int]) -> Polynomial:
    """A multiple of p at values of all parameters but one, modulo the prime."""
    spend(fractions(len(p), limbs_of(p.values())) + reductions(40 * len(p) * len(values), 3))
    d = math.lcm(*(c.denominator for c in p.values()))
    found = [0] * (degree(p, v) + 1)
    for exponents, c in p.items():
        term = int(c * d) % PRIME
        for i, (value, e) in enumerate(zip(values, exponents, strict=True)):
            if e and i != v:
                term = term * pow(value, e, PRIME) % PRIME
        found[exponents[v]] = (found[exponents[v]] + term) % PRIME
    return stripped(found)
