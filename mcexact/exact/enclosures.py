"""Discs and intervals around the roots of a polynomial, with decimal numbers, verified exactly."""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from itertools import combinations
from typing import Any

import flint

from mcexact.errors import InputError, InternalError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import digits_of

# Digits of the first grid after the first nonzero digit of the smallest root below 1.
_DIGITS = 12
# The precision of flint is global, so one thread at a time may change it.
PRECISION = threading.Lock()


@dataclass(frozen=True)
class Disc:
    """The disc |x − (re + i·im)| ≤ radius, its numbers decimal strings without exponent.

    Examples
    --------
    >>> Disc("-1.25", "0", "0.01").exact()
    (Fraction(-5, 4), Fraction(0, 1), Fraction(1, 100))
    """

    re: str
    im: str
    radius: str

    def exact(self) -> tuple[Fraction, Fraction, Fraction]:
        """Real part, imaginary part and radius as rational numbers."""
        return exact_decimal(self.re), exact_decimal(self.im), exact_decimal(self.radius)


@dataclass(frozen=True)
class _GridDisc:
    """A disc whose numbers are integers, counted in units of the grid."""

    re: int
    im: int
    radius: int


def root_discs(p: Polynomial, decimals: int = 0) -> tuple[Disc, ...]:
    """Compute pairwise disjoint discs that each contain exactly one root, and together all roots.

    Parameters
    ----------
    p : Polynomial
        Squarefree, of degree d ≥ 1.
    decimals : int
        The least number of decimals of the grid.

    Returns
    -------
    tuple of d Disc
        Sorted by real part, then imaginary part.  Symmetric to the real axis; the disc of a real
        root has its center on it.  A root on the grid is its disc's center, radius 0.

    Raises
    ------
    InputError
        The polynomial is constant or has a repeated root.

    Notes
    -----
    Centers come from flint; what is returned is verified in exact arithmetic: with c a center,
    p'(c) ≠ 0 and d²|p(c)|² ≤ radius²|p'(c)|², so the disc holds a root because
    Σ 1/(c − r) = p'(c)/p(c); d disjoint discs hold one each.  The grid is decimal, at least 12
    digits of the root of least modulus, and refined until the test passes.

    Examples
    --------
    >>> for disc in root_discs(Polynomial.of(2, 0, 1) * Polynomial.of("-1/4", 1)):
    ...     print(disc.re, disc.im, disc.radius)
    0 -1.4142135623731 0.0000000000001
    0 1.4142135623731 0.0000000000001
    0.25 0 0
    """
    if p.degree < 1:
        raise InputError(f"expected a polynomial of degree at least 1, found {p}")
    if not p.is_squarefree():
        raise InputError(f"expected a polynomial without repeated roots, found {p}")
    digits = max(_first_digits(p), decimals)
    for _ in range(32):
        discs = _on_grid(p, digits)
        if discs is not None and _disjoint(discs):
            break
        digits *= 2
    else:
        raise InternalError(f"no grid separates the roots of {p}")
    discs.sort(key=lambda disc: (disc.re, disc.im))
    return tuple(
        Disc(*(decimal(value, digits) for value in (disc.re, disc.im, disc.radius)))
        for disc in discs
    )


def _first_digits(p: Polynomial) -> int:
    """The number of decimals that show `_DIGITS` digits of every nonzero root below 1."""
    c = [abs(x) for x in p.numerators]
    if not c[0]:
        c = c[1:]
    # Cauchy: every root of the reversed polynomial is at most 1 + max|c_k|/|c_0|.
    largest = 1 + max(c[1:], default=0) // c[0]
    smallest = min(_moduli(p), default=1.0)
    if smallest >= 1:
        return _DIGITS
    return _DIGITS + (
        -math.floor(math.log10(smallest)) if smallest > 0 else len(digits_of(largest))
    )


def _moduli(p: Polynomial) -> list[float]:
    """The moduli of the nonzero roots as floats, far enough from zero to have a logarithm."""
    return [abs(complex(root)) for root in _flint_roots(p, 53) if not root.is_zero()]


def _flint_roots(p: Polynomial, bits: int) -> list[flint.acb]:
    with PRECISION, flint.ctx.workprec(bits):
        pairs: list[Any] = list(p._integer.complex_roots())
    return [root for root, _ in pairs]


def _on_grid(p: Polynomial, digits: int) -> list[_GridDisc] | None:
    """Discs around the roots, rounded to the grid with this many decimals; None if a test fails."""
    size = max(abs(c) for c in p.numerators).bit_length()
    found = []
    for root in _flint_roots(p, 64 + 4 * digits + size):
        re, im = _rounded(root.real, digits), _rounded(root.imag, digits)
        if im < 0 or (im == 0 and not root.imag.is_zero()):
            # its conjugate represents it; a pair that rounds to the axis needs a finer grid
            if im == 0:
                return None
            continue
        radius = _radius(p, re, im, 10**digits)
        if radius is None:
            return None
        found.append(_GridDisc(re, im, radius))
        if im:
            found.append(_GridDisc(re, -im, radius))
    return found if len(found) == p.degree else None


def _rounded(value: flint.arb, digits: int) -> int:
    """The middle of a ball in units of 10^−digits, to the nearest, ties up."""
    mantissa, exponent = value.mid().man_exp()
    doubled = 2 * int(mantissa) * 10**digits
    shift = int(exponent)
    half_units: int = doubled << shift if shift >= 0 else doubled >> -shift
    return (half_units + 1) >> 1


def _radius(p: Polynomial, re: int, im: int, unit: int) -> int | None:
    """The least r with d²|p(c)|² ≤ r²|p'(c)|², in units of the grid; None if p'(c) = 0."""
    value, slope = (0, 0), (0, 0)
    power = 1
    for c in reversed(p.numerators):
        # slope := slope·c + value·unit keeps both at one power of the unit, slope one below
        slope = _times(slope, re, im, value[0] * unit, value[1] * unit)
        value = _times(value, re, im, c * power, 0)
        power *= unit
    below = slope[0] ** 2 + slope[1] ** 2
    if below == 0:
        return None
    # value = unit^d p(c), slope = unit^d p'(c); the radius is in units, hence the factor unit²
    square = Fraction(p.degree**2 * (value[0] ** 2 + value[1] ** 2) * unit**2, below)
    least = math.isqrt(square.numerator // square.denominator)
    return least if least * least >= square else least + 1


def _times(z: tuple[int, int], re: int, im: int, plus_re: int, plus_im: int) -> tuple[int, int]:
    """z·(re + i·im) + (plus_re + i·plus_im)."""
    return z[0] * re - z[1] * im + plus_re, z[0] * im + z[1] * re + plus_im


def _disjoint(discs: list[_GridDisc]) -> bool:
    return all(
        (a.re - b.re) ** 2 + (a.im - b.im) ** 2 > (a.radius + b.radius) ** 2
        for a, b in combinations(discs, 2)
    )


def root_above(square: Fraction, bits: int = 64) -> Fraction:
    """Return a rational number that is at least √square, and at most 2^(2−bits) of it larger.

    Parameters
    ----------
    square : Fraction
        At least 0, of any size.
    bits : int

    Raises
    ------
    InputError
        The number is negative.

    Examples
    --------
    >>> root_above(Fraction(9, 4)), root_above(Fraction(2)) ** 2 > 2
    (Fraction(3, 2), True)
    >>> root_above(Fraction(1, 10**400)) * 10**200 - 1 < Fraction(1, 2**60)
    True
    """
    if square < 0:
        raise InputError(f"expected a number that is not negative, found {square}")
    scale = bits - (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    scaled = square * Fraction(4) ** scale
    whole = -(-scaled.numerator // scaled.denominator)
    root = math.isqrt(whole)
    return (root if root * root == whole else root + 1) * Fraction(2) ** -scale


def decimal(value: int, digits: int) -> str:
    """The decimal value / 10^digits without zeros at its end.

    Examples
    --------
    >>> decimal(-1250, 3), decimal(0, 5), decimal(7, 0)
    ('-1.25', '0', '7')
    """
    whole, rest = divmod(abs(value), 10**digits)
    fraction = digits_of(rest).zfill(digits).rstrip("0") if digits else ""
    number = ("-" if value < 0 else "") + digits_of(whole)
    return f"{number}.{fraction}" if fraction else number


def exact_decimal(text: str) -> Fraction:
    """Read a decimal of any length, as `decimal` writes it."""
    return Fraction(Decimal(text))


def real_root_intervals(p: Polynomial) -> tuple[tuple[Fraction, Fraction], ...]:
    """Compute ascending disjoint intervals that each contain one real root, and together all.

    Parameters
    ----------
    p : Polynomial
        Squarefree, not 0.

    Returns
    -------
    tuple of (Fraction, Fraction)
        Equal ends at a root that is a short decimal.

    Examples
    --------
    >>> [(float(a), float(b)) for a, b in real_root_intervals(Polynomial.of(-2, 0, 1))]
    [(-1.414213562374, -1.414213562372), (1.414213562372, 1.414213562374)]
    >>> real_root_intervals(Polynomial.of(1, 0, 1))
    ()
    """
    if p.degree == 0:
        return ()
    exact = [disc.exact() for disc in root_discs(p)]
    return tuple((re - radius, re + radius) for re, im, radius in exact if im == 0)
