"""Roots of polynomials: enclosures, time domains and stability regions.

`root_discs` and `real_root_intervals` enclose the roots: flint proposes centers, and discs and
intervals in short decimals are verified in rational arithmetic, each with exactly one root. They
locate roots; whether all roots lie in a region is decided without them.

`StabilityRegion` says where eigenvalues should lie: a half-plane Re λ < −R in continuous time, a
disc |λ| < R in discrete time, and in continuous time also a least damping ratio and a largest
modulus.  `contains_roots_of` decides exactly, by transforming the polynomial so that the region
becomes a standard one:

- `is_hurwitz`, Routh's array in integers, O(d²) operations for degree d;
- `is_schur`, by the map of the disc to the half-plane, then `is_hurwitz`;
- a damping ratio by `turned`, a polynomial with roots (1 ± i√c)λ, which is Hurwitz iff every λ
  lies in the sector; `lifted` does the same to a matrix.
"""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from itertools import combinations
from typing import Any, Literal, get_args

import flint

from mcexact.errors import InputError, InternalError, UsageError, one_of
from mcexact.exact.matrix import Matrix, as_requested, hstack, vstack
from mcexact.exact.polynomial import Polynomial, to_fmpz_poly
from mcexact.exact.rational import digits_of, written

# Discs and intervals around the roots of a polynomial, with decimal numbers, verified exactly.

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
        pairs: list[Any] = list(to_fmpz_poly(p).complex_roots())
    return [root for root, _ in pairs]


def _on_grid(p: Polynomial, digits: int) -> list[_GridDisc] | None:
    """Discs around the roots, rounded to the grid with this many decimals; None if a test fails."""
    size = max(abs(c) for c in p.numerators).bit_length()
    discs = []
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
        discs.append(_GridDisc(re, im, radius))
        if im:
            discs.append(_GridDisc(re, -im, radius))
    return discs if len(discs) == p.degree else None


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


def cosine_near(angle: Fraction, bits: int = 64, *, quarters: int = 0) -> Fraction:
    """Return a number near cos(angle + quarters · π/2), to about so many bits.

    Examples
    --------
    >>> cosine_near(Fraction(0)), float(cosine_near(Fraction(1), quarters=3))
    (Fraction(1, 1), 0.8414709848078965)
    """
    with PRECISION, flint.ctx.workprec(bits):
        x = flint.arb(flint.fmpq(angle.numerator, angle.denominator))
        value = (x.cos(), -x.sin(), -x.cos(), x.sin())[quarters % 4].mid()
        mantissa, exponent = value.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


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


# The sector of a damping ratio, −Re λ > ζ|λ|, reduced to the stability of a polynomial or matrix.


def turned(p: Polynomial, zeta: Fraction) -> Polynomial:
    """Return a multiple of Π (x − wλ)(x − w̄λ) over the roots λ of p.

    Parameters
    ----------
    p : Polynomial
    zeta : Fraction
        Between 0 and 1.

    Notes
    -----
    w = 1 + i√c, c = ζ²/(1 − ζ²), so that wλ and w̄λ have negative real parts iff λ is in the sector.
    Σ p_k w^(d−k) x^k = U + i√c V, and the result is U² + c V².

    Examples
    --------
    >>> from mcexact.exact.roots import is_hurwitz
    >>> p = Polynomial.of(25, 6, 1)  # -3 + 4i, -3 - 4i: the damping ratio 3/5
    >>> [is_hurwitz(turned(p, Fraction(ratio))) for ratio in ("1/2", "3/5", "7/10")]
    [True, False, False]
    """
    c = zeta**2 / (1 - zeta**2)
    real, other = list[Fraction](), list[Fraction]()
    u, v = Fraction(1), Fraction(0)
    for coefficient in reversed(p.coefficients):
        real.append(coefficient * u)
        other.append(coefficient * v)
        u, v = u - c * v, u + v
    U, V = (Polynomial.of(*reversed(part)) for part in (real, other))
    return U * U + V * V * c


def lifted(M: Matrix, zeta: Fraction) -> Matrix:
    """Return a matrix whose eigenvalues are (1 ± i√c) λ, c = ζ²/(1 − ζ²), for those λ of M.

    ::

        [M  −cM]
        [M    M]

    Parameters
    ----------
    M : Matrix, n × n
    zeta : Fraction
        Between 0 and 1.

    Returns
    -------
    Matrix, 2n × 2n

    Examples
    --------
    >>> lifted(Matrix.from_rows([[-2]]), Fraction(3, 5)).rows()
    ((Fraction(-2, 1), Fraction(9, 8)), (Fraction(-2, 1), Fraction(-2, 1)))
    """
    c = zeta**2 / (1 - zeta**2)
    return vstack([hstack([M, M * -c]), hstack([M, M])])


# Time domains, stability regions, and exact decisions whether roots of polynomials lie in them.

Time = Literal["continuous", "discrete"]


TIMES = get_args(Time)

LIMITS = ("damping", "largest_modulus")
"""The limits on eigenvalues besides a rate, in continuous time."""


def require_time(time: object) -> None:
    """Raise an error unless a time domain is ``"continuous"`` or ``"discrete"``."""
    one_of(time, TIMES, "time", InputError)


def is_discrete(time: str) -> bool:
    """Whether a time domain is the discrete one.

    Raises
    ------
    InputError
        It is neither ``"continuous"`` nor ``"discrete"``.
    """
    require_time(time)
    return time == "discrete"


def steady_point(time: str) -> int:
    """The eigenvalue of a constant: 0 in continuous time, 1 in discrete time.

    An integrator has this eigenvalue, as has the system that generates a constant reference.

    Raises
    ------
    InputError
        If the time domain is neither ``"continuous"`` nor ``"discrete"``.
    """
    return int(is_discrete(time))


def is_hurwitz(p: Polynomial) -> bool:
    """Whether every complex root has a negative real part; true for nonzero constants.

    Notes
    -----
    Routh's array, every first entry of which must be positive, kept in integers by exact divisions:
    the first entry of row k is the Hurwitz determinant Δ_k, so the numbers grow linearly.
    O(d²) operations for degree d.

    Examples
    --------
    >>> is_hurwitz(Polynomial.of(1, 1, 1)), is_hurwitz(Polynomial.of(1, 0, 1))
    (True, False)
    """
    if p.is_zero():
        raise InputError("expected a nonzero polynomial: every number is a root of 0")
    # x/2^e in place of x shortens the numbers where the denominators are powers of 2.
    p = p.monic()
    twos = [(c.denominator & -c.denominator).bit_length() - 1 for c in p.coefficients]
    e = max((-(-power // (p.degree - k)) for k, power in enumerate(twos[:-1])), default=0)
    p = p.scale(Fraction(1, 2**e))
    sign = 1 if p.leading > 0 else -1
    descending = [flint.fmpz(sign * c) for c in reversed(p.numerators)]
    if min(descending) <= 0:
        return False
    upper, lower, divisors = descending[0::2], descending[1::2], (flint.fmpz(1), flint.fmpz(1))
    while lower:
        if lower[0] <= 0:
            return False
        rows = zip(upper[1:], [*lower[1:], flint.fmpz(0)], strict=False)
        following = [(lower[0] * a - upper[0] * b) // divisors[0] for a, b in rows]
        upper, lower, divisors = lower, following, (divisors[1], lower[0])
    return True


def is_schur(p: Polynomial) -> bool:
    """Whether every complex root has modulus below 1; true for nonzero constants.

    Notes
    -----
    p(−1) must not vanish, and then (1 − s)^d p((1 + s)/(1 − s)) must be Hurwitz.  (The Schur–Cohn
    recursion in integers was 130 times slower at degree 60 with word-size coefficients.)

    Examples
    --------
    >>> is_schur(Polynomial.of("1/2", 1, 1)), is_schur(Polynomial.of(1, "1/2", 1))
    (True, False)
    """
    plus, minus = Polynomial.of(1, 1), Polynomial.of(1, -1)
    mapped, power = Polynomial.of(), Polynomial.of(1)
    for c in reversed(p.coefficients):
        mapped, power = mapped * plus + power * c, power * minus
    return mapped.degree == p.degree and is_hurwitz(mapped)


@dataclass(frozen=True)
class StabilityRegion:
    """An open region of the complex plane in which eigenvalues should lie.

    Parameters
    ----------
    time : {"continuous", "discrete"}
        The left half-plane Re λ < 0, or the disc |λ| < 1.
    bound : rational or float, optional
        A rate R > 0 in continuous time: Re λ < −R.  A radius R, 0 < R ≤ 1, in discrete time:
        |λ| < R.
    damping : rational or float, optional
        A damping ratio ζ, 0 < ζ < 1, in continuous time: −Re λ > ζ|λ|.
    largest_modulus : rational or float, optional
        A number M > 0 in continuous time: |λ| < M.

    Raises
    ------
    InputError
        The time is neither.
    UsageError
        A number is out of range, or a limit is given in discrete time, where the eigenvalues of one
        damping ratio are on a spiral, about which no polynomial decides.

    Examples
    --------
    >>> p = Polynomial.from_roots([-1, -3])
    >>> StabilityRegion("continuous").contains_roots_of(p)
    True
    >>> StabilityRegion("continuous", 1).contains_roots_of(p)
    False
    >>> print(StabilityRegion("continuous", damping=0.5, largest_modulus=10))
    Re λ < 0, |λ| < 10 and damping ratio > 1/2
    """

    time: str
    bound: Fraction | None = None
    damping: Fraction | None = None
    largest_modulus: Fraction | None = None

    def __post_init__(self) -> None:
        discrete = is_discrete(self.time)
        self._read_limits(discrete)
        if self.bound is None:
            return
        bound = as_requested(self.bound, where=self.word)
        if not discrete and bound <= 0:
            raise UsageError(f"expected a rate above 0, found {bound}")
        if discrete and not 0 < bound <= 1:
            raise UsageError(f"expected a radius above 0 and at most 1, found {bound}")
        object.__setattr__(self, "bound", bound)

    def _read_limits(self, discrete: bool) -> None:
        """Convert the damping ratio and the largest modulus to rationals in their ranges."""
        for name in LIMITS:
            requested = getattr(self, name)
            if requested is None:
                continue
            limit, most = as_requested(requested, where=name), 1 if name == "damping" else None
            if discrete:
                words = "damping ratio" if name == "damping" else "largest modulus"
                raise UsageError(f"a {words} is certified in continuous time only", where=name)
            if limit <= 0 or (most is not None and limit >= most):
                above = "a number above 0" + (" and below 1" if most else "")
                raise UsageError(f"expected {above}, found {written(limit)}", where=name)
            object.__setattr__(self, name, limit)

    @classmethod
    def of(
        cls, time: str, rate: Any = None, radius: Any = None, *, bound: Any = None
    ) -> StabilityRegion:
        """Return the region of a rate or a radius, by default the stability region.

        Parameters
        ----------
        time : {"continuous", "discrete"}
        rate, radius : rational or float, optional
            A rate in continuous time, a radius in discrete time; 0.1 stands for 1/10.
        bound : rational, optional
            The rate or the radius as in a certificate, instead of the other two; a rate of 0 means
            stability.

        Raises
        ------
        UsageError
            If two of them are given, or one that belongs to the other time domain or is out of
            range.
        InputError
            If a number is not rational.

        Examples
        --------
        >>> str(StabilityRegion.of("continuous", rate="1/2"))
        'Re λ < -1/2'
        >>> StabilityRegion.of("discrete", rate=1)
        Traceback (most recent call last):
            ...
        mcexact.errors.UsageError: a rate is for continuous time; give a radius
        """
        discrete = is_discrete(time)
        own, other = ("radius", "rate") if discrete else ("rate", "radius")
        bounds = {"rate": rate, "radius": radius, "bound": bound}
        bounds = {name: entry for name, entry in bounds.items() if entry is not None}
        if other in bounds:
            elsewhere = TIMES[not discrete]
            raise UsageError(f"a {other} is for {elsewhere} time; give a {own}")
        if len(bounds) > 1:
            raise UsageError(f"give a bound or a {own}, not both")
        for name, entry in bounds.items():
            R = as_requested(entry, where=name)
            return cls(time, None if name == "bound" and not discrete and R == 0 else R)
        return cls(time)

    @classmethod
    def asked(
        cls, time: str, region: StabilityRegion | None, rate: Any = None, radius: Any = None
    ) -> StabilityRegion | None:
        """Return a region, or else that of a rate or a radius; None if there is none of them.

        Raises
        ------
        UsageError
            If there are both a region and a number, or the region belongs to the other time domain;
            or as in `of`.
        """
        if region is None:
            return None if rate is None and radius is None else cls.of(time, rate, radius)
        InputError.require(region, StabilityRegion, "region")
        if region.time != time or rate is not None or radius is not None:
            raise UsageError("give a region of the same time domain, or a rate or a radius")
        return region

    def limited(self, *, damping: Any = None, largest_modulus: Any = None) -> StabilityRegion:
        """Return the part of the region with a damping ratio, or below a largest modulus.

        Raises
        ------
        UsageError
            As for the region itself.
        """
        return replace(self, damping=damping, largest_modulus=largest_modulus)

    @property
    def limits(self) -> dict[str, Fraction]:
        """The damping ratio and the largest modulus, without those that are None."""
        values = {name: getattr(self, name) for name in LIMITS}
        return {name: limit for name, limit in values.items() if limit is not None}

    @property
    def discrete(self) -> bool:
        """Whether the region belongs to discrete time."""
        return is_discrete(self.time)

    @property
    def word(self) -> str:
        """The name of the bound: ``"rate"`` or ``"radius"``."""
        return "radius" if self.discrete else "rate"

    @property
    def measure(self) -> str:
        """The quantity that decides whether a number lies in the region: Re λ or |λ|."""
        return "|λ|" if self.discrete else "Re λ"

    @property
    def edge(self) -> Fraction:
        """The bound, or without one that of stability: the rate 0, the radius 1."""
        return Fraction(self.discrete) if self.bound is None else self.bound

    @property
    def limit(self) -> Fraction:
        """The number below which the real parts, or the moduli, lie."""
        return self.edge if self.discrete else -self.edge

    def tightened(self, margin: Fraction, offset: int = 0) -> StabilityRegion:
        """Return a smaller region: the rate R + margin (R + offset), or the radius R (1 − margin).

        Examples
        --------
        >>> str(StabilityRegion.of("continuous", 2).tightened(Fraction(1, 4)))
        'Re λ < -5/2'
        """
        change = -margin * self.edge if self.discrete else margin * (self.edge + offset)
        return StabilityRegion.of(self.time, bound=self.edge + change).limited(**self.limits)

    def shifted(self, p: Polynomial) -> Polynomial:
        """Return a polynomial that is stable iff all roots of p lie in this region.

        Examples
        --------
        >>> StabilityRegion("continuous", 2).shifted(Polynomial.of(3, 1)).as_json()
        [1, 1]
        >>> StabilityRegion("discrete", Fraction(1, 2)).shifted(Polynomial.of(-1, 4)).as_json()
        [-1, 2]
        """
        if self.bound is None:
            return p
        return p.scale(self.bound) if self.discrete else p.compose_shift(-self.bound)

    def contains_roots_of(self, p: Polynomial) -> bool:
        """Whether every complex root of a nonzero polynomial lies in the region.

        A root on the border, such as the rate itself, is outside.

        Raises
        ------
        InputError
            If the polynomial is 0.

        Examples
        --------
        >>> region = StabilityRegion("continuous", 1)
        >>> [region.contains_roots_of(Polynomial.of(c, 1)) for c in (2, 1)]
        [True, False]
        """
        standard = self.shifted(p)
        inside = is_schur(standard) if self.discrete else is_hurwitz(standard)
        if inside and self.largest_modulus is not None:
            inside = is_schur(p.scale(self.largest_modulus))
        if inside and self.damping is not None:
            inside = is_hurwitz(turned(p, self.damping))
        return inside

    def excludes(self, re: Fraction, im: Fraction, radius: Fraction) -> bool:
        """Whether a whole disc lies outside, by an inequality that decides if the disc is small.

        Examples
        --------
        >>> region = StabilityRegion("continuous", 1, damping=0.5)
        >>> [region.excludes(Fraction(re), Fraction(3), Fraction(1, 10)) for re in (-1, -2)]
        [True, False]
        """
        squared = re**2 + im**2
        if self.discrete:
            return squared >= (self.edge + radius) ** 2
        if re - radius >= -self.edge:
            return True
        most, zeta = self.largest_modulus, self.damping
        if most is not None and squared >= (most + radius) ** 2:
            return True
        if zeta is None:
            return False
        decay = -re + radius * (1 + zeta)
        return decay <= 0 or decay**2 <= zeta**2 * squared

    def bounds(self) -> list[tuple[str, Fraction]]:
        """Return the inequalities of the region, each as left side with sign, and number."""
        inequalities = [(f"{self.measure} <", self.limit)]
        if self.largest_modulus is not None:
            inequalities.append(("|λ| <", self.largest_modulus))
        if self.damping is not None:
            inequalities.append(("damping ratio >", self.damping))
        return inequalities

    def __str__(self) -> str:
        *others, last = [f"{compared} {written(number)}" for compared, number in self.bounds()]
        return f"{', '.join(others)} and {last}" if others else last
