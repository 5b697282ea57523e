"""Every plant within the ranges of its parameters, whose entries depend on the same parameters."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable
from fractions import Fraction
from typing import Any, TypeVar

import numpy as np

from mcexact.analysis.boxes.box_controllable import ControllabilitySearch
from mcexact.analysis.boxes.box_fixed import FixedModeSearch
from mcexact.analysis.boxes.cover import Outside
from mcexact.analysis.boxes.float_pencils import independent
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.parameter_cells import Cell, CellBox, box_of_cell, halves, whole_cell
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.answer.parametric_box_controllable import (
    ControlOfCell,
    ParametricBoxControllability,
)
from mcexact.answer.parametric_box_fixed import FixedModesOfCell, ParametricBoxFixedModes
from mcexact.errors import InputError, LimitReached
from mcexact.exact.floats import matrix_to_float
from mcexact.exact.location import StabilityRegion
from mcexact.exact.rational import rational_text
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

P = TypeVar("P")
_CELLS, _DEEPEST = 64, 5
"""The most cells, and how often one is cut for each parameter."""
_MOST_CORNERS = 16
"""How many corners are decided of a cell that is cut no more."""
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
    cuts, parts = _cells(system, proved, failing, said)
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
    chosen = range(system.m) if channels is None else sorted(map(system.index, channels))
    named = tuple(system.names[i] for i in chosen)
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

    cuts, parts = _cells(system, proved, failing, "a mode is not controlled")
    return ParametricBoxControllability(system, named, limit, cuts, parts)


def _cells(
    plant: ParametricSystem,
    proved: Callable[[CellBox], P | None],
    failing: Callable[[MultiChannelSystem], bool],
    said: str,
) -> tuple[tuple[int | None, ...], tuple[P, ...]]:
    """Cut the ranges until each cell is proved; how they are cut, and the proofs."""
    left, cuts, parts = [(whole_cell(plant), 0)], list[int | None](), list[P]()
    with one_thread():
        while left:
            cell, depth = left.pop()
            found = _proof(plant, cell, proved)
            if found is not None:
                cuts.append(None)
                parts.append(found)
                continue
            middle = tuple(map(_middle, cell))
            _require_holds(plant, middle, failing, said)
            if len(parts) + len(left) + 2 > _CELLS or depth == _DEEPEST * len(cell):
                for corner in itertools.islice(itertools.product(*cell), _MOST_CORNERS):
                    _require_holds(plant, corner, failing, said)
                where = _where(plant, middle)
                raise LimitReached(f"no proof was found near {where}; perhaps {said} there")
            k = _widest(plant, cell)
            cuts.append(k)
            left += [(half, depth + 1) for half in halves(cell, k)[::-1]]
    return tuple(cuts), tuple(parts)


def _require_holds(
    plant: ParametricSystem,
    values: tuple[Fraction, ...],
    failing: Callable[[MultiChannelSystem], bool],
    said: str,
) -> None:
    """Refuse values at which the plant fails, which is decided exactly."""
    where = _where(plant, values)
    try:
        member = plant.at(dict(zip(plant.parameters, values, strict=True)))
    except InputError:
        raise LimitReached(f"an entry is undefined at {where}") from None
    if failing(member):
        raise LimitReached(f"{said} at {where}")


def _where(plant: ParametricSystem, values: tuple[Fraction, ...]) -> str:
    """Values of the parameters in words."""
    named = zip(plant.parameters, values, strict=True)
    return ", ".join(f"{name} = {rational_text(x)}" for name, x in named)


def _proof(plant: ParametricSystem, cell: Cell, proved: Callable[[CellBox], P | None]) -> P | None:
    """The proof for a cell, if there is one."""
    try:
        return proved(box_of_cell(plant, cell))
    except LimitReached:
        return None


def _middle(ends: tuple[Fraction, Fraction]) -> Fraction:
    return (ends[0] + ends[1]) / 2


def _widest(plant: ParametricSystem, cell: Cell) -> int:
    """The parameter that moves the entries most, if it is anywhere in the cell and no other is."""

    def moves(k: int) -> tuple[float, Fraction]:
        alone = tuple(ends if i == k else (_middle(ends),) * 2 for i, ends in enumerate(cell))
        low, high = cell[k]
        try:
            box = box_of_cell(plant, alone)
        except LimitReached:
            return np.inf, high - low
        free = independent(box.radii, box.tied)
        values = (box.system.A, *box.system.B, *box.system.C)
        parts = zip(free.matrices(), values, strict=True)
        total = 0.0
        for (_, D), M in parts:
            size = np.linalg.norm(matrix_to_float(M))
            total += float(np.linalg.norm(matrix_to_float(D)) / (size or 1.0))
        return total, high - low

    return max(range(len(cell)), key=moves)
