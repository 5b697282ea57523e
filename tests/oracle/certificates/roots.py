"""Where roots of rational polynomials are, decided with certified balls.

Quantities that are compared are algebraic numbers of small degree and height: two that differ
differ long before 4096 bits, so what cannot be told apart there is taken for equal.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from flint import acb, arb, ctx, fmpq, fmpq_poly

from .algebra import X
from .reading import decimal, demand, listed, record

PRECISIONS = (64, 256, 1024, 4096)
T = TypeVar("T")
Sign = Callable[[Any], int]


class _TooCoarse(Exception):
    """A ball that holds 0 has no sign yet."""


def decided(question: Callable[[Sign], T]) -> T:
    """Answer a question that looks at signs of balls, as precisely as it takes."""

    def sign(ball: Any) -> int:
        if ball > 0:
            return 1
        if ball < 0:
            return -1
        if ctx.prec < PRECISIONS[-1] and not ball.is_zero():
            raise _TooCoarse
        return 0

    before = ctx.prec
    try:
        for ctx.prec in PRECISIONS:
            try:
                return question(sign)
            except _TooCoarse:
                continue
    finally:
        ctx.prec = before
    raise ArithmeticError("the last precision decides")


def roots_of(p: Any) -> list[Any]:
    """The roots as balls in the precision of the moment; a multiple root comes once."""
    return [acb(root) for root, _ in p.complex_roots()] if p.degree() > 0 else []


def inside(p: fmpq_poly, time: str, bound: fmpq | None) -> bool:
    """Whether all roots have real parts below −bound, or moduli below bound in discrete time."""
    value = bound if bound is not None else fmpq(int(time == "discrete"))
    # roots on the boundary are found exactly: they are common to p and its mirror image
    if time == "continuous":
        moved = p(X - value)
        mirrored = moved(-X)
    elif value <= 0:
        return p.degree() < 1
    else:
        moved = p(value * X)
        mirrored = fmpq_poly(list(reversed(moved.coeffs())))
    if p.degree() < 1:
        return True
    if moved.gcd(mirrored).degree() > 0:
        return False

    def question(sign: Sign) -> bool:
        found = roots_of(moved)
        if time == "continuous":
            return all(sign(r.real) < 0 for r in found)
        return all(sign(_squared(r) - 1) < 0 for r in found)

    return decided(question)


def damped(p: fmpq_poly, zeta: fmpq) -> bool:
    """Whether −Re λ > ζ|λ| for all roots."""

    def question(sign: Sign) -> bool:
        return all(
            sign(r.real) < 0 and sign(r.real**2 - arb(zeta * zeta) * _squared(r)) > 0
            for r in roots_of(p)
        )

    return decided(question)


def _squared(z: Any) -> Any:
    """|z|²."""
    return z.real * z.real + z.imag * z.imag


def discs_hold(value: Any, p: fmpq_poly, *, real: bool = False) -> bool:
    """As many disjoint discs as p has roots, one root in each.

    Parameters
    ----------
    real : bool
        Whether a disc of a real root must have its center on the real axis, and another must not
        meet it.
    """
    discs = [_disc(d) for d in listed(value)]
    if len(discs) != p.degree():
        return False
    for k, (c, d, r) in enumerate(discs):
        for e, f, s in discs[:k]:
            if (c - e) ** 2 + (d - f) ** 2 <= (r + s) ** 2:
                return False

    def question(sign: Sign) -> bool:
        taken = []
        for root in roots_of(p):
            held = [
                k
                for k, (re, im, radius) in enumerate(discs)
                if sign(_squared(root - acb(arb(re), arb(im))) - arb(radius * radius)) <= 0
            ]
            if len(held) != 1:
                return False
            _, im, radius = discs[held[0]]
            if real and (im != 0 if sign(root.imag) == 0 else im * im <= radius * radius):
                return False
            taken += held
        return len(set(taken)) == len(discs)

    return decided(question)


def _disc(value: Mapping[str, Any]) -> tuple[fmpq, fmpq, fmpq]:
    found = record(value, "re", "im", "radius")
    re, im, radius = (decimal(found[key]) for key in ("re", "im", "radius"))
    demand(radius >= 0, "expected a radius")
    return re, im, radius


def rate_holds(value: Any, polynomials: Sequence[fmpq_poly], time: str) -> bool:
    """An interval around minus the largest real part, or the largest modulus; null without root."""
    if value is None or not polynomials:
        return value is None and not polynomials
    found = record(value, "lower", "upper")
    lower, upper = decimal(found["lower"]), decimal(found["upper"])

    def question(sign: Sign) -> bool:
        roots = [r for p in polynomials for r in roots_of(p)]
        if time == "continuous":
            within = all(sign(r.real + arb(lower)) <= 0 for r in roots)
            return within and any(sign(r.real + arb(upper)) >= 0 for r in roots)
        low = lower <= 0 or any(sign(_squared(r) - arb(lower * lower)) >= 0 for r in roots)
        high = upper >= 0 and all(sign(_squared(r) - arb(upper * upper)) <= 0 for r in roots)
        return low and high

    return lower <= upper and decided(question)
