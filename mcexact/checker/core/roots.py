"""The location of roots, and discs around them.

Whether all roots lie in a region is decided exactly on the coefficients: by Routh's array for a
half-plane, and after a Möbius map for a disc.  No root is computed.  Discs with one root each, and
the intervals for a rate or a radius, come from the certificate and are verified.
"""

import math
from fractions import Fraction
from itertools import accumulate
from operator import mul

from . import budget
from .arithmetic import Polynomial, cleared
from .reading import Json, decimal, fields, items, require

# The location of the roots of a polynomial, by exact recursions on its coefficients.


def in_stability_region(p: Polynomial, time: str) -> bool:
    """Whether all roots have negative real part (continuous) or modulus below 1 (discrete).

    Theorems ``location.is_hurwitzP``, ``mobius.schur_mobius``.
    """
    return in_region(p, time, Fraction(int(time == "discrete")))


def in_region(p: Polynomial, time: str, bound: Fraction | None) -> bool:
    """Whether all roots have real part below −r (continuous) or modulus below r (discrete).

    No bound: no root counts as inside, so that only a constant is.

    Theorems ``moved_roots.rate_rule``, ``moved_roots.radius_rule``,
    ``moved_roots.region_continuous``, ``moved_roots.region_discrete``,
    ``routh_integers.in_region_continuous``, ``routh_integers.in_region_discrete``.
    """
    if bound is None:
        return len(p) == 1
    (numbers, _), d, u, v = cleared(p), len(p) - 1, bound.numerator, bound.denominator
    a, b = budget.limbs(numbers), budget.limbs([u, v])
    units = budget.products(4 * d + 1, d * b, b) + budget.products(2 * d + 2, a + d * b, d * b + 1)
    budget.spend(units + budget.table(3, d + 1, a + 2 * d * b))
    above, below = (list(accumulate([factor] * d, mul, initial=1)) for factor in (u, v))
    numbers = [c * power for c, power in zip(numbers, reversed(below), strict=True)]  # roots by v
    if time != "continuous":
        return is_schur([c * power for c, power in zip(numbers, above, strict=True)])
    longest = a + d * (2 * b + 1)
    budget.spend(budget.products((d + 1) ** 2, longest, b) + budget.table(2, d + 1, longest))
    shifted: list[int] = []  # with roots larger by u, by Horner's rule
    for c in reversed(numbers):
        shifted = [e - u * f for e, f in zip([c, *shifted], [*shifted, 0], strict=True)]
    return is_hurwitz(shifted)


def is_hurwitz(p: Polynomial) -> bool:
    """Routh's array of p_d, p_{d−2}, … and p_{d−1}, p_{d−3}, …: every first entry is positive.

    Each row is a positive multiple of Routh's: the combination of two rows is divided by the first
    entry of the row before them, which gives integers (minors of the Hurwitz matrix).

    Theorems ``location.is_hurwitzP``, ``routh_integers.is_hurwitz_integers``.
    """
    (numbers, _), d = cleared(p), len(p) - 1
    # x/2^e in place of x shortens the numbers where the denominators are powers of 2
    powers = [(c & -c).bit_length() for c in numbers]
    lost = [max(powers[-1] - power, 0) if power else 0 for power in powers[:d]]
    e = max((-(-power // (d - k)) for k, power in enumerate(lost)), default=0)
    a = budget.limbs(numbers) + e * d // budget.LIMB + 1
    budget.spend(budget.fractions(d + 1, a) + 3 * budget.table(1, d + 1, a), _turns(d, 1, a))
    numbers = [c << e * (d - k) for k, c in enumerate(numbers)]
    common = math.gcd(*numbers) * (1 if numbers[-1] > 0 else -1)
    descending = [c // common for c in reversed(numbers)]
    upper, lower, divisors = descending[0::2], descending[1::2], (1, 1)
    while lower:
        if lower[0] <= 0:
            return False
        longest, turn = budget.limbs([*upper, *lower]), d + 2 - len(upper) - len(lower)
        budget.spend(budget.reductions(2 * len(upper), longest), _turns(d, turn, longest))
        rows = zip(upper[1:], [*lower[1:], 0], strict=False)
        pairs = [divmod(lower[0] * a - upper[0] * b, divisors[0]) for a, b in rows]
        if any(rest for _, rest in pairs):
            raise ArithmeticError("a division in Routh's array is not exact")
        upper, lower, divisors = lower, [entry for entry, _ in pairs], (divisors[1], lower[0])
    return True


def _turns(d: int, turn: int, a: int) -> int:
    """About the units from this turn of Routh's array on, whose entries have a limbs.

    Entries are minors, which grow by as much in every turn.
    """
    return (d + 1 - turn) * budget.reductions(d + 2 - turn, a * d // turn)


def is_schur(p: Polynomial) -> bool:
    """p is Schur iff p(−1) ≠ 0 and (1 − s)^d p((1 + s)/(1 − s)) is Hurwitz.

    s ↦ (1 + s)/(1 − s) maps the left half-plane onto the unit disc; the coefficient of s^d is
    ±p(−1), so that no root is lost to infinity unless −1 is one.

    Theorems ``mobius.schur_mobius``, ``moved_roots.schur_by_moebiusP``.
    """
    numbers, _ = cleared(p)
    a, b = budget.limbs(numbers), len(p) // budget.LIMB + 1
    units = budget.products(len(p) ** 2, a, b) + budget.products(2 * len(p) ** 2, a + 2 * b, 1)
    budget.spend(units + budget.table(3, len(p), a + 2 * b))
    mapped: list[int] = []  # Σ p_k (1 + s)^k (1 − s)^(d−k), by Horner's rule
    power = [1]  # (1 − s)^k
    for c in reversed(numbers):
        grown = [a + b for a, b in zip([*mapped, 0], [0, *mapped], strict=True)]  # times 1 + s
        mapped = [a + c * b for a, b in zip(grown, power, strict=True)]
        power = [a - b for a, b in zip([*power, 0], [0, *power], strict=True)]
    return bool(mapped[-1]) and is_hurwitz(mapped)


# Discs that contain one root each, and the resulting rate; ``proofs/evidence.md``.

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
