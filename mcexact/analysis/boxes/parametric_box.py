"""Every plant within the ranges of its parameters, whose entries depend on the same parameters."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import Any

from mcexact.analysis.boxes.box_controllable import ControllabilitySearch
from mcexact.analysis.boxes.box_fixed import FixedModeSearch
from mcexact.analysis.boxes.cover import Outside
from mcexact.analysis.boxes.cut_ranges import proofs_of_cells
from mcexact.analysis.boxes.parameter_cells import CellBox
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.answer.parametric_box_controllable import (
    ControlOfCell,
    ParametricBoxControllability,
)
from mcexact.answer.parametric_box_fixed import FixedModesOfCell, ParametricBoxFixedModes
from mcexact.errors import InputError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

_MOST_SQUARES, _MOST_OWN = 200, 1
"""A cell that needs more squares, or gains for more of them, is cut."""


def parametric_box_fixed_modes(
    system: ParametricSystem, *, bound: Any = None, starts: int = 4
) -> ParametricBoxFixedModes:
    """Prove that no mode is fixed at any values of the parameters within their ranges.

    Parameters
    ----------
    system : ParametricSystem
        Every parameter has a range with two ends.
    bound : rational, optional
        A rate from 0 on, or a radius up to 1: fixed modes inside of this region are allowed.
    starts : int
        How many local searches for gains there are at most at a point.

    Raises
    ------
    LimitReached
        If no proof was found; if a mode is fixed at some values, the message names them.

    Notes
    -----
    Proposed in floating point, and tested exactly.  The ranges are cut in half, one parameter after
    the other, until the plants of each cell are proved as those of a box are, in which the slopes
    of all entries with respect to one parameter are added with the same factor.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [["k", 1], [0, "-k"]], [[[0], [1]]], [[[1, 0]]], parameters=["k"], assume={"k": (1, 2)}
    ... )
    >>> parametric_box_fixed_modes(plant).cuts
    (None,)
    >>> parametric_box_fixed_modes(plant.along({"k": "k - 3/2"}, ["k"], {"k": (1, 3)})).bound
    """
    InputError.require(system, ParametricSystem, "system")
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    outside = Outside(system.time, limit)
    before: list[FixedModeSearch] = []

    def proved(box: CellBox) -> FixedModesOfCell | None:
        search = FixedModeSearch(
            box.system,
            box.radii,
            starts,
            _MOST_SQUARES,
            several=False,
            tied=box.tied,
            most_own=_MOST_OWN,
        )
        for other in before[-1:]:
            search.reuse(other)
        before.append(search)
        found = search.cover(Fraction(1), limit) if search.prepare(1.0, outside) > 1 else None
        if found is None:
            return None
        return FixedModesOfCell(found.exterior, found.gains, found.frames, found.cover)

    def failing(plant: MultiChannelSystem) -> bool:
        spectrum = fixed_spectrum(plant)
        if limit is None:
            return not spectrum.empty
        return not spectrum.stabilizable if limit == StabilityRegion(system.time).edge else False

    said = "a mode is fixed" if limit is None else "a mode outside of the region is fixed"
    cuts, parts = proofs_of_cells(system, proved, failing, said)
    return ParametricBoxFixedModes(system, limit, cuts, parts)


def parametric_box_controllability(
    system: ParametricSystem, channels: Iterable[str] | None = None, *, bound: Any = None
) -> ParametricBoxControllability:
    """Prove that channels control every mode at all values of the parameters within their ranges.

    Parameters
    ----------
    system : ParametricSystem
        Every parameter has a range with two ends.
    channels : iterable of str, optional
        Names of channels, by default all.
    bound : rational, optional
        A rate from 0 on, or a radius up to 1: modes inside of this region need not be controlled.

    Raises
    ------
    LimitReached
        If no proof was found; if a mode is not controlled at some values, the message names them.

    Examples
    --------
    >>> plant = ParametricSystem(
    ...     [[1, "k"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["k"], assume={"k": (1, 2)}
    ... )
    >>> parametric_box_controllability(plant).channels
    ('1',)
    """
    InputError.require(system, ParametricSystem, "system")
    chosen = range(system.m) if channels is None else system.indices(channels)
    named = system.named(chosen)
    limit = None if bound is None else StabilityRegion.of(system.time, bound=bound).edge
    outside = Outside(system.time, limit)

    def proved(box: CellBox) -> ControlOfCell | None:
        search = ControllabilitySearch(
            box.system, box.radii, tuple(chosen), _MOST_SQUARES, tied=box.tied
        )
        found = search.cover(Fraction(1), limit) if search.capacity(outside) > 1 else None
        return None if found is None else ControlOfCell(found.exterior, found.frames, found.cover)

    def failing(plant: MultiChannelSystem) -> bool:
        return limit is None and not joint_controllability(plant, named).controllable

    cuts, parts = proofs_of_cells(system, proved, failing, "a mode is not controlled")
    return ParametricBoxControllability(system, named, limit, cuts, parts)
