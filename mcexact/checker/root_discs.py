"""Discs that contain one root each, and the resulting rate; ``proofs/evidence.md``."""

from fractions import Fraction

from . import budget
from .arithmetic import Polynomial, cleared
from .reading import Json, decimal, fields, items, require

Disc = tuple[Fraction, Fraction, Fraction]
"""Real part, imaginary part, radius."""


def root_discs(value: Json, place: str, p: Polynomial) -> list[Disc]:
    """Check discs with exactly one root of p each, all roots together.

    Theorem ``root_discs.root_discs``.
    """
    discs: list[Disc] = []
    longest = 1
    for k, entry in enumerate(items(value, place, len(p) - 1)):
        where = f"{place}[{k}]"
        parts = fields(entry, where, "re", "im", "radius")
        re, im, radius = (decimal(part, where) for part in parts)
        longest = max(longest, budget.limbs_of((re, im, radius)))
        budget.spend(budget.fractions(8 * len(discs) + 8, 2 * longest))
        value_at, slope = _horner(p, re, im)
        budget.spend(budget.products(4, budget.limbs([value_at, slope]), 2 * longest + 1))
        needed = value_at * ((len(p) - 1) * radius.denominator) ** 2
        enough = needed <= radius.numerator**2 * slope
        require(slope > 0 and radius >= 0 and enough, "disc", where, "may hold no root")
        for a, b, r in discs:
            apart = (a - re) ** 2 + (b - im) ** 2 > (r + radius) ** 2
            require(apart, "disc", where, "meets another disc")
        discs.append((re, im, radius))
    return discs


def require_real_or_not(discs: list[Disc], place: str) -> None:
    """Stop unless each disc is centered on the real axis or does not meet it.

    Theorem ``real_discs.real_discs``.
    """
    plain = all(im == 0 or abs(im) > radius for _, im, radius in discs)
    require(plain, "disc", place, "a disc meets the real axis, but not in the middle")


def require_rate(value: Json, place: str, discs: list[Disc], time: str) -> None:
    """Check an interval for minus the largest real part, or the largest modulus, of the roots.

    Theorems ``rate_interval.rate_interval_continuous``, ``rate_interval.rate_interval_discrete``.
    """
    low, high = (decimal(end, place) for end in fields(value, place, "lower", "upper"))
    if time == "continuous":
        lower = all(low <= -(re + radius) for re, _, radius in discs)
        upper = any(high >= -(re - radius) for re, _, radius in discs)
    else:
        lower = any(low <= -r or (low + r) ** 2 <= re**2 + im**2 for re, im, r in discs)
        upper = all(high >= r and (high - r) ** 2 >= re**2 + im**2 for re, im, r in discs)
    require(lower and upper, "rate", place, "not wide enough for the root discs")


def _horner(p: Polynomial, re: Fraction, im: Fraction) -> tuple[int, int]:
    """|p(c)|² and |p'(c)|² at c = re + i·im, both multiplied by the same positive number."""
    (numbers, _), ((x, y), w), d = cleared(p), cleared([re, im]), len(p) - 1
    b = budget.limbs([x, y, w])
    longest = budget.limbs(numbers) + (d + 1) * (b + 1)
    budget.spend(budget.products(16 * len(p), longest, b) + budget.products(8, longest, longest))
    value, slope, power = (0, 0), (0, 0), 1  # of the polynomial with roots larger by w, at x + iy
    for c in reversed(numbers):
        slope = (slope[0] * x - slope[1] * y + value[0], slope[0] * y + slope[1] * x + value[1])
        value = (value[0] * x - value[1] * y + c * power, value[0] * y + value[1] * x)
        power *= w
    return value[0] ** 2 + value[1] ** 2, w**2 * (slope[0] ** 2 + slope[1] ** 2)


def disc_set(value: Json) -> str:
    """Discs in the order of their centers, such as {0 - 1i +- 1/4, 0 + 1i +- 1/4}."""
    texts = []
    discs = (tuple(Fraction(disc[key]) for key in ("re", "im", "radius")) for disc in value)
    budget.spend(100 * len(value))
    for re, im, radius in sorted(discs):
        imaginary = f" {'-' if im < 0 else '+'} {abs(im)}i" if im else ""
        texts.append(f"{re}{imaginary} +- {radius}")
    return "{" + ", ".join(texts) + "}"
