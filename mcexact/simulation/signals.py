"""Signals that enter a simulation from outside: set-points and disturbances, in steps and ramps."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any

from mcexact.arguments import several, told
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, Rounding, from_float
from mcexact.exact.rational import as_fraction, is_inexact
from mcexact.simulation.network import Network

Columns = list[Matrix]
"""One column for each channel."""


@dataclass(frozen=True)
class Change:
    """Numbers that are added to a signal from a time on: a step, or a ramp with these slopes.

    Attributes
    ----------
    time : Fraction
    columns : list of Matrix
        For each channel the numbers, or in a ramp the slopes.
    ramp : bool
    """

    time: Fraction
    columns: Columns
    ramp: bool = False


@dataclass(frozen=True)
class Signal:
    """A signal of each channel, a sum of steps and ramps.

    Attributes
    ----------
    zeros : list of Matrix
    changes : tuple of Change
    """

    zeros: Columns
    changes: tuple[Change, ...] = ()

    @property
    def is_constant(self) -> bool:
        """Whether nothing changes after the start."""
        return all(change.time <= 0 and not change.ramp for change in self.changes)

    def at(self, time: Fraction) -> Columns:
        """The values at a time; at the time of a step those after it."""
        return self._sum(
            (change, time - change.time if change.ramp else Fraction(1))
            for change in self.changes
            if change.time <= time
        )

    def slope(self, time: Fraction) -> Columns:
        """The slopes after a time, until the next change."""
        return self._sum(
            (change, Fraction(1)) for change in self.changes if change.ramp and change.time <= time
        )

    def _sum(self, parts: Iterable[tuple[Change, Fraction]]) -> Columns:
        total = self.zeros
        for change, factor in parts:
            total = [a + b * factor for a, b in zip(total, change.columns, strict=True)]
        return total


@dataclass(frozen=True)
class Drive:
    """What enters a network from outside during a run.

    Attributes
    ----------
    references, disturbances : Signal
        r_i, and what is added to u_i at the plant.
    """

    references: Signal
    disturbances: Signal

    @property
    def changes(self) -> tuple[Change, ...]:
        """All steps and ramps."""
        return (*self.references.changes, *self.disturbances.changes)

    @property
    def is_constant(self) -> bool:
        """Whether nothing changes after the start."""
        return self.references.is_constant and self.disturbances.is_constant

    def pieces(self, times: Sequence[Fraction]) -> Iterator[tuple[Fraction, ...]]:
        """Divide times at those where a signal changes.

        Every piece starts where the one before ended, and its last time starts the next one.
        """
        inside = {change.time for change in self.changes if times[0] < change.time < times[-1]}
        ends = [times[0], *sorted(inside), times[-1]]
        for start, end in pairwise(ends):
            yield start, *(t for t in times if start < t < end), end

    def apply(self, network: Network, time: Fraction) -> None:
        """Give a network the values at a time."""
        _give(network, self.references.at(time), self.disturbances.at(time))

    def apply_derivative(
        self, network: Network, time: Fraction, order: int, step: Fraction
    ) -> None:
        """Give a network the derivatives of an order at a time, times the order's power of a step.

        The signals are linear between their changes.
        """
        if order == 0:
            self.apply(network, time)
            return
        factor = step if order == 1 else Fraction(0)
        slopes = self.references.slope(time), self.disturbances.slope(time)
        _give(network, *([M * factor for M in each] for each in slopes))


def _give(network: Network, references: Columns, disturbances: Columns) -> None:
    convert = network.arithmetic.convert
    network.set_signals(list(map(convert, references)), list(map(convert, disturbances)))


def numbers_of(
    values: Sequence[Any], rounding: Rounding | None, where: str
) -> tuple[Fraction, ...]:
    """Convert numbers exactly; floats by a named rounding.

    Parameters
    ----------
    values : sequence
    rounding : {"decimal", "dyadic"} or None
        How floats become exact, as in `MultiChannelSystem.from_float`; None refuses them.
    where : str
        The name of the argument in errors.

    Raises
    ------
    FloatRefused
        If a number is a float and no rounding is given.
    InputError
        If something is not a number.

    Examples
    --------
    >>> numbers_of([1, 0.5, "1/3"], "dyadic", "initial")
    (Fraction(1, 1), Fraction(1, 2), Fraction(1, 3))
    """

    def exact(value: Any, place: str) -> Fraction:
        if rounding is not None and is_inexact(value):
            return from_float(value, rounding, where=place)
        return as_fraction(value, where=place)

    listed = several(values, where, "numbers")
    return tuple(exact(value, f"{where}[{k}]") for k, value in enumerate(listed))


def by_channel(
    values: Sequence[Any], sizes: Sequence[int], rounding: Rounding | None, where: str
) -> Columns:
    """Convert numbers to one column for each channel.

    Parameters
    ----------
    values : sequence of sequences of numbers, or sequence of numbers
        One sequence for each channel, or all numbers in the order of the channels.
    sizes : sequence of int
        How many numbers each channel has.
    rounding : {"decimal", "dyadic"} or None
        As in `numbers_of`.
    where : str

    Raises
    ------
    InputError
        If there are too few or too many numbers.

    Examples
    --------
    >>> [M.rows() for M in by_channel([1, 2, 3], [2, 1], None, "reference")]
    [((Fraction(1, 1),), (Fraction(2, 1),)), ((Fraction(3, 1),),)]
    """
    listed = list(several(values, where, "numbers"))
    if any(_is_listed(each) for each in listed):
        if len(listed) != len(sizes):
            raise InputError(f"expected {len(sizes)} channels, found {len(listed)}", where=where)
        parts = [list(each) if _is_listed(each) else [each] for each in listed]
        for i, (part, size) in enumerate(zip(parts, sizes, strict=True)):
            if len(part) != size:
                raise InputError(
                    f"expected {size} numbers, found {len(part)}", where=f"{where}[{i}]"
                )
        listed = [number for part in parts for number in part]
    if len(listed) != sum(sizes):
        raise InputError(f"expected {sum(sizes)} numbers, found {len(listed)}", where=where)
    exact, columns, start = numbers_of(listed, rounding, where), [], 0
    for size in sizes:
        columns.append(Matrix.column(exact[start : start + size]))
        start += size
    return columns


def _is_listed(value: Any) -> bool:
    return not isinstance(value, str) and hasattr(value, "__len__")


def signal_of(
    sizes: Sequence[int],
    level: Sequence[Any] | None,
    steps: Sequence[tuple[Any, Sequence[Any]]],
    ramps: Sequence[tuple[Any, Sequence[Any]]],
    rounding: Rounding | None,
    where: tuple[str, str, str],
) -> Signal:
    """Make a signal of its parts.

    Parameters
    ----------
    sizes : sequence of int
    level : sequence, optional
        The values from the start on; 0 by default.
    steps, ramps : sequences of (time, numbers)
        What is added from a time on, and with which slopes.
    rounding : {"decimal", "dyadic"} or None
    where : tuple of str
        The names of the three arguments in errors.
    """
    changes = []
    if level is not None:
        changes.append(Change(Fraction(0), by_channel(level, sizes, rounding, where[0])))
    for name, given, ramp in ((where[1], steps, False), (where[2], ramps, True)):
        for k, change in enumerate(several(given, name, "pairs (time, numbers)")):
            place = f"{name}[{k}]"
            if not _is_listed(change) or len(change) != 2:
                raise InputError(
                    f"expected a pair (time, numbers), found {told(change)}", where=place
                )
            time, values = change
            [start] = numbers_of([time], rounding, place)
            if start < 0:
                raise InputError(f"expected a time of at least 0, found {start}", where=place)
            changes.append(Change(start, by_channel(values, sizes, rounding, place), ramp))
    return Signal([Matrix.zeros(size, 1) for size in sizes], tuple(changes))
