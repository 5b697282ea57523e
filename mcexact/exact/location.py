"""Where the roots of a polynomial lie, decided exactly; the one place for time domains."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import flint

from mcexact.errors import InputError, UsageError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import written

Time = Literal["continuous", "discrete"]


def is_hurwitz(p: Polynomial) -> bool:
    """Whether every complex root has a negative real part; true of nonzero constants.

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
    """Whether every complex root has modulus below 1; true of nonzero constants.

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
    """The open set of the complex plane where closed-loop eigenvalues are wanted.

    Parameters
    ----------
    time : {"continuous", "discrete"}
        The left half-plane Re λ < 0, or the disc |λ| < 1.
    bound : int or Fraction, optional
        A rate R > 0 in continuous time: Re λ < −R.  A radius R, 0 < R ≤ 1, in discrete time:
        |λ| < R.

    Raises
    ------
    InputError
        The time is neither.
    UsageError
        The bound is out of range.

    Examples
    --------
    >>> p = Polynomial.from_roots([-1, -3])
    >>> StabilityRegion("continuous").contains_roots_of(p)
    True
    >>> StabilityRegion("continuous", 1).contains_roots_of(p)
    False
    """

    time: str
    bound: Fraction | None = None

    def __post_init__(self) -> None:
        if self.time not in ("continuous", "discrete"):
            raise InputError(f'expected time "continuous" or "discrete", found {self.time!r}')
        if self.bound is None:
            return
        bound = self.bound
        if type(bound) not in (int, Fraction):
            raise UsageError(f"expected an exact rate or radius, found {bound!r}")
        if self.time == "continuous" and bound <= 0:
            raise UsageError(f"expected a rate above 0, found {bound}")
        if self.time == "discrete" and not 0 < bound <= 1:
            raise UsageError(f"expected a radius above 0 and at most 1, found {bound}")
        object.__setattr__(self, "bound", Fraction(bound))

    def shifted(self, p: Polynomial) -> Polynomial:
        """A polynomial with all roots in the unbounded region iff those of p are in this one.

        Examples
        --------
        >>> StabilityRegion("continuous", 2).shifted(Polynomial.of(3, 1)).as_json()
        [1, 1]
        >>> StabilityRegion("discrete", Fraction(1, 2)).shifted(Polynomial.of(-1, 4)).as_json()
        [-1, 2]
        """
        if self.bound is None:
            return p
        if self.time == "continuous":
            return p.compose_shift(-self.bound)
        return p.scale(self.bound)

    def contains_roots_of(self, p: Polynomial) -> bool:
        """Whether every complex root of a nonzero polynomial lies in the region."""
        standard = self.shifted(p)
        return is_hurwitz(standard) if self.time == "continuous" else is_schur(standard)

    def __str__(self) -> str:
        if self.time == "continuous":
            return f"Re λ < {written(-self.bound) if self.bound else 0}"
        return f"|λ| < {written(self.bound) if self.bound else 1}"


def bounded_region(time: str, bound: Fraction | None) -> StabilityRegion:
    """The region of a bound as certificates write it: a rate ≥ 0, or a radius in (0, 1].

    Raises
    ------
    UsageError
        The bound is out of range.

    Examples
    --------
    >>> str(bounded_region("continuous", Fraction(0))), str(bounded_region("discrete", Fraction(1)))
    ('Re λ < 0', '|λ| < 1')
    """
    return StabilityRegion(time, None if time == "continuous" and bound == 0 else bound)


def in_region(
    p: Polynomial, time: str, rate: Fraction | None = None, radius: Fraction | None = None
) -> bool:
    """Whether every root of p lies in the stability region of the time domain.

    Parameters
    ----------
    p : Polynomial
        Not 0.
    time : {"continuous", "discrete"}
    rate : Fraction, optional
        For continuous time only.
    radius : Fraction, optional
        For discrete time only.
    """
    return region(time, rate, radius).contains_roots_of(p)


def region(
    time: str, rate: Fraction | None = None, radius: Fraction | None = None
) -> StabilityRegion:
    """The stability region of a time domain; a rate or radius for the other one is wrong usage."""
    if time == "continuous" and radius is not None:
        raise UsageError("a radius is for discrete time; give a rate")
    if time == "discrete" and rate is not None:
        raise UsageError("a rate is for continuous time; give a radius")
    return StabilityRegion(time, rate if time == "continuous" else radius)
