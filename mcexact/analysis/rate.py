"""The best decay that is left when some modes cannot be moved, as an enclosure."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from math import isqrt

from mcexact.certificate.evidence import RateInterval, RootDisc
from mcexact.exact.enclosures import decimal, exact_decimal


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
        None if there is no disc.

    Examples
    --------
    >>> best_rate("continuous", [RootDisc("-1.5", "0", "0.25"), RootDisc("-3", "0", "0")])
    RateInterval(lower='1.25', upper='1.75')
    >>> best_rate("discrete", [RootDisc("0.3", "0.4", "0.1")])
    RateInterval(lower='0.4', upper='0.6')
    """
    if not discs:
        return None
    numbers = [(exact_decimal(d.re), exact_decimal(d.im), exact_decimal(d.radius)) for d in discs]
    digits = max(_digits(part) for d in discs for part in (d.re, d.im, d.radius))
    if time == "continuous":
        lower = -max(re + radius for re, _, radius in numbers)
        upper = -max(re - radius for re, _, radius in numbers)
    else:
        moduli = [(_root_below(re, im, digits), radius) for re, im, radius in numbers]
        exact = [
            m * m == re * re + im * im for (m, _), (re, im, _) in zip(moduli, numbers, strict=True)
        ]
        step = Fraction(1, 10**digits)
        lower = max(Fraction(0), max(m - radius for m, radius in moduli))
        upper = max(
            m + radius + (0 if sharp else step)
            for (m, radius), sharp in zip(moduli, exact, strict=True)
        )
    return RateInterval(*(decimal(int(end * 10**digits), digits) for end in (lower, upper)))


def _digits(text: str) -> int:
    """The number of digits behind the point."""
    return len(text.partition(".")[2])


def _root_below(re: Fraction, im: Fraction, digits: int) -> Fraction:
    """√(re² + im²), rounded down to a decimal."""
    scale = 10**digits
    square = (re * re + im * im) * scale * scale
    return Fraction(isqrt(square.numerator // square.denominator), scale)
