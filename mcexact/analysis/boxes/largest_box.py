"""How far data may be from their values: a largest certified box, and a plant that fails."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any, get_args

from mcexact.analysis.boxes.box_controllable import ControllabilitySearch
from mcexact.analysis.boxes.box_fixed import FixedModeSearch
from mcexact.analysis.boxes.cover import Outside
from mcexact.analysis.boxes.failing_plants import (
    FailingPlant,
    failing_plant,
    severed_plants,
    tried_sets,
)
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.radii import radii_of
from mcexact.analysis.boxes.two_sided import LargestUncertainty, Search, nearest, two_sided
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.answer.protocol import Answer
from mcexact.answer.reading import constructed
from mcexact.derived.constructions import dual
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix, largest_entry
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.properties import Property
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

_ROUNDS = 2
_GAINS = 50
"""A search for gains counts as much as so many squares that are tested."""
_NEVER_ENOUGH = 1e30
_MORE_GAINS = 4


def largest_uncertainty(
    system: MultiChannelSystem,
    wanted: Property = "no fixed mode",
    *,
    effort: float = 10.0,
) -> LargestUncertainty:
    """Search the largest box of plants with a property, and the nearest plant without it.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.  If it has radii, boxes are multiples of these; otherwise each radius is a part of
        the modulus of its entry, and zeros are certain.
    wanted : {"no fixed mode", "stabilizable", "controllable", "observable"}
        By decentralized linear time-invariant control, each member by a controller of its own.
    effort : float
        About the seconds that the search may take; its work is counted and not timed.

    Returns
    -------
    LargestUncertainty
        Both ends are proved: the lower one for every member of the box, the upper one by a plant
        that fails.  Which ends are found depends on the processor and on the effort.

    Raises
    ------
    UsageError
        If the property is another one, or the system is a derived one.

    Notes
    -----
    Plants that fail are found by sequential linear programs, and plants whose channels do nothing
    fail, too: where radii are parts of the entries, these are within the whole entries.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
    >>> found = largest_uncertainty(plant)
    >>> found.relative, 0.1 < found.lower < found.upper < 0.5
    (True, True)
    """
    InputError.require(system, MultiChannelSystem, "system")
    if wanted not in get_args(Property):
        known = ", ".join(map(repr, get_args(Property)))
        raise UsageError(f"expected one of {known}, found {wanted!r}", where="wanted")
    if system.subject:
        raise UsageError("the box is that of a plant, and not of a derived system")
    relative = system.uncertainty is None
    unit = Box.relative(system, 1).system if relative else system
    with one_thread():
        return two_sided(_searches(unit, wanted), wanted, relative, effort)


def nearest_fixed(system: MultiChannelSystem, tries: int) -> FailingPlant | None:
    """Search a plant near a system that has a fixed mode, which is decided exactly.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant without fixed modes.  Zeros may change, too: distances are parts of the largest
        entries of A, of all B_i and of all C_i.
    tries : int
        How many sets of channels and modes are tried.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[["1e-3"], [1]]], [[[1, 1]]])
    >>> near = nearest_fixed(plant, 4)
    >>> near is not None and near.distance < Fraction(1, 900)
    True
    """
    radii = Radii(*(_of_sizes(given) for given in (system.A, system.B, system.C)))
    with one_thread():
        return nearest(_searches(Box(system, radii).system, "no fixed mode"), tries)[0]


def failing_member(
    system: MultiChannelSystem, wanted: Property = "no fixed mode", tries: int = 8
) -> Answer | None:
    """Search a plant within the radii of a system that lacks a property.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with radii.
    wanted : {"no fixed mode", "stabilizable", "controllable", "observable"}
    tries : int
        How many sets of channels and modes are tried.

    Returns
    -------
    Answer or None
        The exact answer about that plant; None proves nothing.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
    >>> failing = failing_member(Box.relative(plant, "1/2").system)
    >>> failing.empty, Box.relative(plant, "1/2").contains(failing.about.plant)
    (False, True)
    >>> failing_member(Box.relative(plant, "1/10").system) is None
    True
    """
    with one_thread():
        search = _searches(system, wanted)
        known = search.refuted(Box(system).nominal)
        if known is not None:
            return known
        near, refutation = nearest(search, tries)
    return refutation if near is not None and near.distance <= 1 else None


def _of_sizes(given: Any) -> Any:
    """Matrices whose entries are all the largest modulus of one matrix, or of several."""
    several = [given] if isinstance(given, Matrix) else list(given)
    size = largest_entry(several)
    found = [Matrix.from_rows([[size] * M.ncols] * M.nrows, M.ncols) for M in several]
    return found[0] if isinstance(given, Matrix) else found


def _searches(unit: MultiChannelSystem, wanted: str) -> Search:
    """The search for one property."""
    if wanted in ("controllable", "observable"):
        return _controllability(unit, wanted)
    region = StabilityRegion(unit.time) if wanted == "stabilizable" else None
    bound = None if region is None else region.edge
    search = FixedModeSearch(unit, radii_of(unit))

    def failing(tries: int) -> FailingPlant | None:
        return failing_plant(unit, search.radii, tried_sets(unit.m), tries, region)

    def refuted(plant: MultiChannelSystem) -> Answer | None:
        found = fixed_spectrum(plant)
        return None if found.empty or (region is not None and found.stabilizable) else found

    def capacity() -> float:
        outside = Outside(unit.time, bound)
        least = search.prepare(_NEVER_ENOUGH, outside)
        return search.improve(outside, _MORE_GAINS) if search.known else least

    return Search(
        capacity,
        lambda growth: _about(search.cover(growth, bound), growth),
        refuted,
        failing,
        lambda: severed_plants(unit, search.radii),
        lambda: search.tested + _GAINS * len(search.known),
        # What leaves no fixed mode anywhere leaves none outside of a region: where the plant has no
        # mode outside, nothing else tells how far the radii can grow.
        lambda: search.prepare(_NEVER_ENOUGH, Outside(unit.time, None)),
        _ROUNDS,
    )


def _controllability(unit: MultiChannelSystem, wanted: str) -> Search:
    system = dual(unit) if wanted == "observable" else unit
    radii, every = radii_of(system), tuple(range(unit.m))
    search = ControllabilitySearch(system, radii, every)

    def failing(tries: int) -> FailingPlant | None:
        found = failing_plant(system, radii, [()], tries)
        return None if found is None else turned(found)

    def turned(found: FailingPlant) -> FailingPlant:
        """The same for the plant of which the system is the dual."""
        if system is unit:
            return found
        back = dual(found.plant)
        plant = MultiChannelSystem(
            back.A, back.B, back.C, time=unit.time, names=unit.names, neighbors=unit.neighbors
        )
        return replace(found, plant=plant)

    def refuted(plant: MultiChannelSystem) -> Answer | None:
        found = joint_controllability(plant if system is unit else dual(plant))
        return None if found.controllable else found

    return Search(
        lambda: search.capacity(Outside(unit.time, None)),
        lambda growth: _about(search.cover(growth, None), growth),
        refuted,
        failing,
        lambda: (turned(each) for each in severed_plants(system, radii, inputs=True)),
        lambda: search.tested,
    )


def _about(found: Answer | None, growth: Fraction) -> Answer | None:
    """The same answer, about the box whose radii are multiplied by the factor."""
    if found is None:
        return None
    plant = Box(found.about.plant).scaled(growth).system
    return replace(found, about=constructed(plant, found.about.subject))
