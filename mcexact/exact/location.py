"""Where the roots of a polynomial lie, decided exactly; the one place for time domains."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

from mcexact.errors import InputError, UsageError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import written

Time = Literal["continuous", "discrete"]


def is_hurwitz(p: Polynomial) -> bool:
    """Whether every complex root has a negative real part; true of nonzero constants.

    Notes
    -----
    Routh's array in integers, each row divided by its content: all entries of the first column
    must be positive.  O(d²) operations for degree d.

    Examples
    --------
    >>> is_hurwitz(Polynomial.of(1, 1, 1)), is_hurwitz(Polynomial.of(1, 0, 1))
    (True, False)
    """
    descending = _descending(p)
    if min(descending) <= 0:
        return False
    upper, lower = descending[0::2], descending[1::2]
    while lower:
        if lower[0] <= 0:
            return False
        padded = lower + [0] * (len(upper) - len(lower))
        following = [
            lower[0] * upper[k + 1] - upper[0] * padded[k + 1] for k in range(len(upper) - 1)
        ]
        upper, lower = lower, _primitive(following)
    return True


def is_schur(p: Polynomial) -> bool:
    """Whether every complex root has modulus below 1; true of nonzero constants.

    Notes
    -----
    The Schur–Cohn recursion in integers: |p(0)| must be below the leading coefficient, and then
    (p_d p − p_0 p*)/x, p* the reversed polynomial, takes the place of p.

    Examples
    --------
    >>> is_schur(Polynomial.of("1/2", 1, 1)), is_schur(Polynomial.of(1, "1/2", 1))
    (True, False)
    """
    descending = _descending(p)
    while len(descending) > 1:
        first, last = descending[0], descending[-1]
        if abs(last) >= first:
            return False
        mirrored = descending[::-1]
        descending = _primitive(
            [first * a - last * b for a, b in zip(descending, mirrored, strict=True)][:-1]
        )
    return True


def _descending(p: Polynomial) -> list[int]:
    """Integer coefficients from the leading one down, the leading one positive."""
    if p.is_zero():
        raise InputError("expected a nonzero polynomial: every number is a root of 0")
    sign = 1 if p.leading > 0 else -1
    return _primitive([sign * c for c in reversed(p.numerators)])


def _primitive(row: list[int]) -> list[int]:
    content = math.gcd(*row)
    return [entry // content for entry in row] if content > 1 else row


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
