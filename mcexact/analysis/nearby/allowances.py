"""What the data of a plant allow its entries to differ by.

`rounding` is what may have been lost when an entry was computed: 16 units in the last place of a
float, or 10⁻¹² of an entry with fewer digits.  `typed` is half a unit of the last digit of an entry
with 3 to 12 digits, and `rounding` of others: integers, fractions, and numbers of one or two digits
count as exact.  Both depend on values alone, as digests do: 19/40 is 0.475.

`distance` compares two plants in these units.  `counts_as_exact` says of a plant that its entries
are too short for anything to be near: it is no use to look for a plant beside it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from typing import Literal

from mcexact.model.system import MultiChannelSystem

Unit = Callable[[Fraction], Fraction]
Allowance = Literal["rounding", "digits"]

_ULPS = 16
_EXACT_PART = Fraction(1, 10**12)
CERTAIN = Fraction(_ULPS, 2**53)
"""Rounding errors may have changed every entry by this part."""
FEWEST, MOST = 3, 12
"""Decimals of so many significant digits were typed; those with fewer count as exact."""
_FLOATS = 16
"""A decimal with so many digits or more was a float."""
FARTHEST = Fraction(1, 10**6)
"""The part of every entry up to which plants are told of that the data do not allow."""
_NUMERATOR, _DENOMINATOR = 1000, 100
"""Fractions with a numerator and a denominator up to these are short."""


def digits(x: Fraction) -> int:
    """The number of significant digits of a decimal; 0 of another fraction.

    Examples
    --------
    >>> digits(Fraction("0.0475")), digits(Fraction(1200)), digits(Fraction(1, 3))
    (3, 2, 0)
    """
    if x.denominator == 1:
        return len(str(abs(x.numerator)).rstrip("0"))
    twos = (x.denominator & -x.denominator).bit_length() - 1
    odd = x.denominator >> twos
    fives = round(math.log(odd, 5))
    places = max(twos, fives)
    if 5**fives != odd or places - twos > 300:
        return 0
    # No factor 10 is left: the fraction is in lowest terms.
    return len(str(abs(x.numerator) * 2 ** (places - twos) * 5 ** (places - fives)))


def rounding(x: Fraction) -> Fraction:
    """What rounding errors may have changed an entry by.

    Examples
    --------
    >>> rounding(Fraction("0.30000000000000004")) == 16 * Fraction(math.ulp(0.3))
    True
    >>> rounding(Fraction(1, 3)), rounding(Fraction(0))
    (Fraction(1, 3000000000000), Fraction(0, 1))
    """
    value = in_floats(x)
    if digits(x) >= _FLOATS and value and x in (Fraction(value), Fraction(repr(value))):
        return _ULPS * Fraction(math.ulp(value))
    return abs(x) * _EXACT_PART


def typed(x: Fraction) -> Fraction:
    """What an entry may differ by that has the same digits.

    Examples
    --------
    >>> typed(Fraction("0.475")), typed(Fraction("0.5")) == rounding(Fraction("0.5"))
    (Fraction(1, 2000), True)
    """
    if not is_typed(x):
        return rounding(x)
    unit, k = x.denominator, 0
    while 10**k % unit:
        k += 1
    return Fraction(1, 2 * 10**k)


def is_typed(x: Fraction) -> bool:
    """Whether an entry counts as a decimal whose further digits are unknown."""
    return x.denominator != 1 and FEWEST <= digits(x) <= MOST


def in_floats(x: Fraction) -> float:
    """The float that is nearest, or 0 beyond the range of floats."""
    try:
        return float(x)
    except OverflowError:
        return 0.0


def explained(pairs: Iterable[tuple[Fraction, Fraction]]) -> tuple[Fraction, Allowance | None]:
    """The largest part of an entry by which it differs, and what explains all differences.

    Parameters
    ----------
    pairs : iterable of (Fraction, Fraction)
        Entries that are not 0, and what they differ by.

    Examples
    --------
    >>> explained([(Fraction("0.475"), Fraction(1, 2000))])
    (Fraction(1, 950), 'digits')
    >>> explained([(Fraction("0.5"), Fraction(1, 2000))])
    (Fraction(1, 1000), None)
    """
    listed = [*pairs]
    part = max((abs(moved / x) for x, moved in listed), default=Fraction(0))
    if part <= CERTAIN or all(abs(moved) <= rounding(x) for x, moved in listed):
        return part, "rounding"
    within = all(abs(moved) <= typed(x) for x, moved in listed)
    return part, "digits" if within else None


def distance(
    system: MultiChannelSystem, near: MultiChannelSystem
) -> tuple[Fraction, Allowance | None] | None:
    """How far another plant is, as in `explained`; None if an entry is 0 in one plant alone.

    Parameters
    ----------
    system, near : MultiChannelSystem
        Plants; None as well if their time, channels or sizes differ.
    """
    parts = ("time", "names", "neighbors", "n", "sizes")
    if any(getattr(system, part) != getattr(near, part) for part in parts):
        return None
    own, other = ({(k, i, j): x for k, i, j, x in _entries(each)} for each in (system, near))
    if own.keys() != other.keys():
        return None
    return explained((x, other[at] - x) for at, x in own.items() if other[at] != x)


def counts_as_exact(system: MultiChannelSystem) -> bool:
    """Whether all entries are short and exact: integers, fractions, or decimals of two digits.

    Examples
    --------
    >>> plant = MultiChannelSystem([["1/3", "0.5"], [-2, 0]], [[[1], [0]]], [[[0, 1]]])
    >>> counts_as_exact(plant)
    True
    >>> counts_as_exact(MultiChannelSystem([["0.475"]], [[[1]]], [[[1]]]))
    False
    """
    return all(
        abs(x.numerator) <= _NUMERATOR and x.denominator <= _DENOMINATOR and not is_typed(x)
        for *_, x in _entries(system)
    )


def _entries(system: MultiChannelSystem) -> Iterator[tuple[int, int, int, Fraction]]:
    """The entries of A, all B_i and all C_i that are not 0, by matrix, row and column."""
    for k, M in enumerate((system.A, *system.B, *system.C)):
        for i, j, x in M.nonzero():
            yield k, i, j, Fraction(x, M.denominator)
