"""The location of the roots of a polynomial, by exact recursions on its coefficients."""

import math
from fractions import Fraction

from . import budget
from .arithmetic import Polynomial


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
    bits = max(bound.numerator, bound.denominator).bit_length() + 1
    longest = budget.limbs_of(p) + len(p) * bits // budget.LIMB
    budget.spend(budget.fractions(len(p) ** 2, longest))
    if time == "continuous":
        moved: Polynomial = []  # p(x − bound), by Horner's rule
        for c in reversed(p):
            moved = [a - bound * b for a, b in zip([c, *moved], [*moved, 0], strict=True)]
        return is_hurwitz(moved)
    return is_schur([c * bound**k for k, c in enumerate(p)])


def is_hurwitz(p: Polynomial) -> bool:
    """Routh's array of p_d, p_{d−2}, … and p_{d−1}, p_{d−3}, …: every first entry is positive.

    Each row is a positive multiple of Routh's: the combination of two rows is divided by the first
    entry of the row before them, which gives integers (minors of the Hurwitz matrix).

    Theorems ``location.is_hurwitzP``, ``routh_integers.is_hurwitz_integers``.
    """
    d, a = len(p) - 1, 2 * budget.limbs_of(p)
    budget.spend(budget.fractions(3 * d + 1, a))
    # x/2^e in place of x shortens the numbers where the denominators are powers of 2
    powers = [(q & -q).bit_length() - 1 for q in (Fraction(c / p[-1]).denominator for c in p)]
    e = max((-(-power // (d - k)) for k, power in enumerate(powers[:d])), default=0)
    a += e * d // budget.LIMB
    budget.spend(budget.fractions(4 * d + 1, a) + budget.table(1, d + 1, a))
    p = [c / p[-1] * 2 ** (e * (d - k)) for k, c in enumerate(p)]
    budget.spend(budget.products(d + 1, a * (d + 1), a))
    scale = math.lcm(*(Fraction(c).denominator for c in p))
    a += budget.limbs([scale])
    budget.spend(budget.products(d + 1, a, a) + budget.table(d + 1, 1, a))
    descending = [int(c * scale) for c in reversed(p)]
    upper, lower, divisors = descending[0::2], descending[1::2], (1, 1)
    while lower:
        if lower[0] <= 0:
            return False
        budget.spend(budget.reductions(2 * len(upper), budget.limbs([*upper, *lower])))
        rows = zip(upper[1:], [*lower[1:], 0], strict=False)
        pairs = [divmod(lower[0] * a - upper[0] * b, divisors[0]) for a, b in rows]
        if any(rest for _, rest in pairs):
            raise ArithmeticError("a division in Routh's array is not exact")
        upper, lower, divisors = lower, [entry for entry, _ in pairs], (divisors[1], lower[0])
    return True


def is_schur(p: Polynomial) -> bool:
    """p is Schur iff p(−1) ≠ 0 and (1 − s)^d p((1 + s)/(1 − s)) is Hurwitz.

    s ↦ (1 + s)/(1 − s) maps the left half-plane onto the unit disc; the coefficient of s^d is
    ±p(−1), so that no root is lost to infinity unless −1 is one.

    Theorems ``mobius.schur_mobius``, ``moved_roots.schur_by_moebiusP``.
    """
    longest = budget.limbs_of(p) + len(p) // budget.LIMB
    budget.spend(budget.fractions(2 * len(p) ** 2, longest))
    moved: Polynomial = []  # Σ p_k (1 + s)^k (1 − s)^(d−k), by Horner's rule
    power: Polynomial = [Fraction(1)]  # (1 − s)^k
    for c in reversed(p):
        grown = [a + b for a, b in zip([*moved, 0], [0, *moved], strict=True)]  # times 1 + s
        moved = [a + c * b for a, b in zip(grown, power, strict=True)]
        power = [a - b for a, b in zip([*power, 0], [0, *power], strict=True)]
    return bool(moved[-1]) and is_hurwitz(moved)
