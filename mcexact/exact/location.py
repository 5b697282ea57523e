"""Time domains, stability regions, and exact decisions whether roots of polynomials lie in them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal, get_args

import flint

from mcexact.arguments import one_of
from mcexact.errors import InputError, UsageError
from mcexact.exact.floats import as_requested
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import written
from mcexact.exact.sector import turned

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
    moved, power = Polynomial.of(), Polynomial.of(1)
    for c in reversed(p.coefficients):
        moved, power = moved * plus + power * c, power * minus
    return moved.degree == p.degree and is_hurwitz(moved)


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
            given = getattr(self, name)
            if given is None:
                continue
            limit, most = as_requested(given, where=name), 1 if name == "damping" else None
            if discrete:
                told = "damping ratio" if name == "damping" else "largest modulus"
                raise UsageError(f"a {told} is certified in continuous time only", where=name)
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
        given = {"rate": rate, "radius": radius, "bound": bound}
        given = {name: entry for name, entry in given.items() if entry is not None}
        if other in given:
            elsewhere = TIMES[not discrete]
            raise UsageError(f"a {other} is for {elsewhere} time; give a {own}")
        if len(given) > 1:
            raise UsageError(f"give a bound or a {own}, not both")
        for name, entry in given.items():
            found = as_requested(entry, where=name)
            return cls(time, None if name == "bound" and not discrete and found == 0 else found)
        return cls(time)

    @classmethod
    def asked(
        cls, time: str, region: StabilityRegion | None, rate: Any = None, radius: Any = None
    ) -> StabilityRegion | None:
        """Return the region that is given, or that of a rate or a radius; None without any.

        Raises
        ------
        UsageError
            If a region is given with a number, or belongs to the other time domain; or as in `of`.
        """
        if region is None:
            return None if rate is None and radius is None else cls.of(time, rate, radius)
        InputError.require(region, StabilityRegion, "region")
        if region.time != time or rate is not None or radius is not None:
            raise UsageError("give a region of the same time domain, or a rate or a radius")
        return region

    def limited(self, damping: Any = None, largest_modulus: Any = None) -> StabilityRegion:
        """Return the part of the region with a damping ratio, or below a largest modulus.

        Raises
        ------
        UsageError
            As for the region itself.
        """
        return replace(self, damping=damping, largest_modulus=largest_modulus)

    @property
    def limits(self) -> dict[str, Fraction]:
        """The damping ratio and the largest modulus, as far as they are given."""
        given = {name: getattr(self, name) for name in LIMITS}
        return {name: limit for name, limit in given.items() if limit is not None}

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
        """Return the inequalities of the region, each as what is compared, and the number."""
        found = [(f"{self.measure} <", self.limit)]
        if self.largest_modulus is not None:
            found.append(("|λ| <", self.largest_modulus))
        if self.damping is not None:
            found.append(("damping ratio >", self.damping))
        return found

    def __str__(self) -> str:
        *others, last = [f"{compared} {written(number)}" for compared, number in self.bounds()]
        return f"{', '.join(others)} and {last}" if others else last
