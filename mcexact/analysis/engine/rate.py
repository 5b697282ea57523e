"""The best decay rate that some modes allow, enclosed to ten significant digits."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import isqrt

from mcexact.answer.evidence import RateInterval, RootDisc
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.rational import digits_of
from mcexact.exact.roots import decimal, exact_decimal, is_discrete, is_hurwitz, root_discs

# The width of an enclosure relative to its ends is at most this.
_RELATIVE_WIDTH = Fraction(1, 10**10)
# The number of significant digits of a modulus that is not a decimal.
_MODULUS_DIGITS = 12


def located(
    time: str, polynomials: Sequence[Polynomial]
) -> tuple[list[tuple[RootDisc, ...]], RateInterval | None]:
    """Compute discs around all roots of some polynomials, and the best rate that these roots allow.

    Parameters
    ----------
    time : {"continuous", "discrete"}
    polynomials : sequence of Polynomial
        Squarefree, of degree at least 1, no two with a common root.

    Returns
    -------
    list of tuples of RootDisc
        For each polynomial, disjoint discs with one root each.
    RateInterval or None
        None if there is no polynomial.

    Notes
    -----
    The discs are made smaller until the interval is at most 10⁻¹⁰ of its ends wide.  If the largest
    real part is 0 and no root there is a decimal, the interval contains 0 in its interior.

    Examples
    --------
    >>> located("discrete", [Polynomial.of(2, -2, 1)])[1]
    RateInterval(lower='1.414213562373', upper='1.414213562374')
    >>> located("continuous", [Polynomial.of(2, 0, 1)])[1]
    RateInterval(lower='-0.000000000001', upper='0.000000000001')
    """
    decimals = 0
    while True:
        discs = [
            tuple(RootDisc(disc.re, disc.im, disc.radius) for disc in root_discs(p, decimals))
            for p in polynomials
        ]
        every = [disc for those in discs for disc in those]
        rate = best_rate(time, every)
        if rate is None or _is_narrow(rate):
            return discs, rate
        if not is_discrete(time) and _ends_on_axis(product(polynomials)):
            return discs, rate
        decimals = 2 * max(_decimals(disc) for disc in every)


def best_rate(time: str, discs: Sequence[RootDisc]) -> RateInterval | None:
    """Enclose minus the largest real part, or the largest modulus, of the roots in some discs.

    Parameters
    ----------
    time : {"continuous", "discrete"}
    discs : sequence of RootDisc
        One root in each.

    Returns
    -------
    RateInterval or None
        As narrow as the discs allow, except for the rounding of moduli; None if there is no disc.

    Examples
    --------
    >>> best_rate("continuous", [RootDisc("-1.5", "0", "0.25"), RootDisc("-3", "0", "0")])
    RateInterval(lower='1.25', upper='1.75')
    >>> best_rate("discrete", [RootDisc("0.3", "0.4", "0.1")])
    RateInterval(lower='0.4', upper='0.6')
    >>> best_rate("discrete", [RootDisc("0.9", "0.4", "0")])
    RateInterval(lower='0.9848857801796', upper='0.9848857801797')
    """
    if not discs:
        return None
    numbers = [(exact_decimal(d.re), exact_decimal(d.im), exact_decimal(d.radius)) for d in discs]
    digits = max(map(_decimals, discs))
    if is_discrete(time):
        digits = max(digits, _decimals_of_moduli(numbers))
        moduli = [(*_root(re, im, digits), radius) for re, im, radius in numbers]
        lower = max(Fraction(0), max(below - radius for below, _, radius in moduli))
        upper = max(above + radius for _, above, radius in moduli)
    else:
        lower = -max(re + radius for re, _, radius in numbers)
        upper = -max(re - radius for re, _, radius in numbers)
    return RateInterval(*(decimal(int(end * 10**digits), digits) for end in (lower, upper)))


def _is_narrow(rate: RateInterval) -> bool:
    """Whether the ends agree in their first digits."""
    lower, upper = exact_decimal(rate.lower), exact_decimal(rate.upper)
    return upper - lower <= _RELATIVE_WIDTH * min(abs(lower), abs(upper))


def _ends_on_axis(p: Polynomial) -> bool:
    """Whether the largest real part of the roots of a squarefree polynomial is 0, exactly.

    Notes ----- g = gcd(p(x), p(−x)) has the roots on the axis, and perhaps pairs ±r of others; g +
    g' is Hurwitz if and only if there is no such pair, because Re g'/g > 0 to the right of roots on
    the axis (Routh's array does the same with a row of zeros).
    """
    g = p.gcd(p.scale(-1))
    return g.degree > 0 and is_hurwitz(p // g) and is_hurwitz(g + g.derivative())


def _decimals(disc: RootDisc) -> int:
    """The number of digits behind the point."""
    return max(len(part.partition(".")[2]) for part in (disc.re, disc.im, disc.radius))


def _decimals_of_moduli(discs: Sequence[tuple[Fraction, Fraction, Fraction]]) -> int:
    """Decimals that show `_MODULUS_DIGITS` digits of the largest modulus."""
    size = max(max(abs(re), abs(im)) for re, im, _ in discs)
    zeros = len(digits_of(int(1 / size))) if 0 < size < 1 else 0
    return _MODULUS_DIGITS + zeros


def _root(re: Fraction, im: Fraction, digits: int) -> tuple[Fraction, Fraction]:
    """√(re² + im²), rounded down and up to decimals."""
    scale = 10**digits
    square = (re * re + im * im) * scale * scale
    below = isqrt(square.numerator // square.denominator)
    above = below if below * below == square else below + 1
    return Fraction(below, scale), Fraction(above, scale)
