"""The largest family that is certified, from both sides.

Each function grows the uncertainty of a plant about its nominal values, and returns two factors of
the radii, or two parts of the ranges of parameters.  Up to the lower one the property is proved for
every member; within the upper one an explicit member fails, which is decided exactly.  Nothing is
claimed between the two.

- `largest_uncertainty`: no fixed mode, stabilizability, controllability or observability of the
  plant (`boxes.members`);
- `largest_loop_uncertainty`: one controller keeps all loops in a region (`boxes.loops`);
- `largest_loop_ranges`: the same for the ranges of parameters, around their middles.

The first two are carried out by `two_sided`.  First it looks for a member that fails (`Failures`):
those proposed by sequential linear programs (`boxes.failure`) and those whose channels do nothing
are decided exactly, the nearest first.  Then `largest_factor` bisects below the distance of that
member, and below what floating point considers possible, for the largest factor with a proof
(`Proofs`).  `largest_loop_ranges` bisects in the same way, but looks for failing values along rays
from the middle of the ranges.

`nearest_fixed` and `failing_member` run the search for a failing plant alone.  The effort counts
tested squares or parts of the border in place of seconds, so that the load of a machine does not
change the result; another processor or another effort may.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, get_args

import numpy as np

from mcexact.analysis.boxes.cells import Cell, values_in_words, whole_cell
from mcexact.analysis.boxes.corners import PencilFamily, first_to_fail
from mcexact.analysis.boxes.cover import Outside
from mcexact.analysis.boxes.failure import (
    FailingPlant,
    Freedom,
    Uncertain,
    failing_plant,
    severed_plants,
    tried_sets,
)
from mcexact.analysis.boxes.loops import LoopSearch, StabilitySearch, gain_radii
from mcexact.analysis.boxes.members import ControllabilitySearch, FixedModeSearch
from mcexact.analysis.boxes.pencils import Floats, Members, one_thread, radii_of
from mcexact.analysis.boxes.samples import failing_samples
from mcexact.analysis.controllability import joint_controllability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.stability import Method, certify_stability
from mcexact.answer.boxes import (
    BoxControllability,
    BoxFixedModes,
    BoxStability,
    ParametricBoxStability,
)
from mcexact.answer.check import constructed
from mcexact.answer.loops import StabilityVerdict
from mcexact.answer.protocol import Answer
from mcexact.answer.templates import blame
from mcexact.derived.constructions import dual
from mcexact.derived.sampling import is_sampled, resampled
from mcexact.errors import InputError, LimitReached, UsageError, require_seconds
from mcexact.exact.matrix import (
    Matrix,
    largest_entry,
    matrix_from_float,
    matrix_to_float,
    to_float,
)
from mcexact.exact.rational import percent, three_digits, written
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, LoopPencil, closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.properties import Property
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.parameters import uncertainty
from mcexact.shown import Shown

# The bisection for a proof, and its result: proved up to one factor, failing within another.

_STEPS = 14
_CLOSE = 1.03
_SMALL = Fraction(1, 1000)
"""A part of the radii of a plant for which those of its samples are about in proportion."""
_LEAST = 1e-12
"""A computed largest factor below this is reported as 0."""
_SQUARES, _TRIES = 2000, 4
"""For a second of effort: how many squares are tested, and how many sets and modes are tried for a
plant that fails."""
_MOST_TRIES = 40


@dataclass(frozen=True, repr=False)
class LargestUncertainty(Shown):
    """A box for which a property is proved, and a plant outside of it that lacks the property.

    Attributes
    ----------
    wanted : str
        The property.
    relative : bool
        Whether factors are parts of the moduli of entries; otherwise they are multiples of the
        radii that the plant has.
    lower : Fraction
        The factor for which every member has the property; 0 if none is proved.
    proof : Answer or None
        The answer that proves it.
    upper : Fraction or None
        The factor within which a plant lacks it; None if none was found.
    failing : MultiChannelSystem or None
        That plant.
    refutation : Answer or None
        The exact answer about it.
    channels : tuple of str or None
        The channels whose outputs do not show the mode that is fixed there.
    """

    wanted: str
    relative: bool
    lower: Fraction
    proof: Answer | None
    upper: Fraction | None
    failing: MultiChannelSystem | None
    refutation: Answer | None
    channels: tuple[str, ...] | None

    def explain(self) -> str:
        """Say in plain words up to which factor the property is proved, and where it fails."""
        proved = f"{self.wanted}: for every plant within {self.proved_part}"
        if not self.lower:
            proved = f"{self.wanted}: not proved for any box"
        if self.upper is None:
            return f"{proved}; no plant that fails was found"
        near = _number(self.upper, self.relative, up=True)
        return f"{proved}; not for a plant within {near}{self._unit}"

    @property
    def proved_part(self) -> str:
        """The largest factor with a proof, in words: a percentage, or a multiple of the radii."""
        return f"{_number(self.lower, self.relative)}{self._unit}"

    @property
    def _unit(self) -> str:
        return " of each entry" if self.relative else " times the radii"

    @property
    def nearby(self) -> FailingPlant | None:
        """The plant that fails, its distance in the radii of the proof, or else of the plant."""
        if self.failing is None or self.upper is None:
            return None
        distance, channels = self.upper / (self.lower or 1), self.channels or ()
        return FailingPlant(self.failing, distance, complex("nan"), channels, self.refutation)

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield labels and texts: the property, and up to where it is proved and where it fails."""
        unit = "" if self.relative else " times the radii"
        yield "property", self.wanted
        proved = f"within {_number(self.lower, self.relative)}{unit}" if self.lower else "no box"
        yield "proved for every plant", proved
        near = "not found"
        if self.upper is not None:
            near = f"{_number(self.upper, self.relative, up=True)}{unit}"
        yield "a plant fails within", near
        fixed = self.wanted == "no fixed mode"
        if fixed and self.channels is not None and self.failing is not None:
            yield "the mode that is fixed there", blame(self.channels, self.failing.names)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the property, the factors, and the plant that fails."""
        yield from self.rows()
        if self.failing is not None:
            yield "plant that fails", self.failing

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {
            "property": self.wanted,
            "relative": self.relative,
            "lower": written(self.lower),
            "upper": None if self.upper is None else _above(self.upper),
            "failing": None if self.failing is None else self.failing.to_dict(),
            "channels": None if self.channels is None else list(self.channels),
        }

    def plot(self, ax: Any = None) -> Any:
        """Draw the proved part in blue, and where a plant fails in red.

        Parameters
        ----------
        ax : axes of matplotlib, optional

        Returns
        -------
        matplotlib.figure.Figure
        """
        return uncertainty(self, ax)

    def __repr__(self) -> str:
        return f"LargestUncertainty({self.explain()})"


def _number(factor: Fraction, relative: bool, *, up: bool = False) -> str:
    """A factor with three digits, rounded down or up, as a percentage if it is relative."""
    return percent(factor, up=up) if relative else three_digits(factor, up=up)


def _above(factor: Fraction) -> str:
    """A factor rounded up to about six digits, as text."""
    digits = 6
    while factor * 10**digits < 10**5 and digits < 40:
        digits += 1
    return f"{-(-factor.numerator * 10**digits // factor.denominator)}e-{digits}"


@dataclass
class Proofs:
    """The functions by which `largest_factor` proves a property for factors of the radii.

    Attributes
    ----------
    capacity : callable
        About how far the radii can grow.
    proof : callable
        The answer for a factor of the radii, or None.
    work : callable
        The work done so far.
    likely : callable
        A factor of the radii for which a proof is likely; it is tried first.
    rounds : int
        How often the bisection is repeated: gains learned in one round may prove in the next what
        failed before.
    """

    capacity: Callable[[], float]
    proof: Callable[[Fraction], Answer | None]
    work: Callable[[], float]
    likely: Callable[[], float] = lambda: float("inf")
    rounds: int = 1


@dataclass
class Failures:
    """The functions by which `nearest` looks for a plant that lacks a property.

    Attributes
    ----------
    proposed : callable
        A plant that probably fails, searched with so many tries.
    severed : callable
        Plants that may fail because their channels have no effect.
    refuted : callable
        The exact answer about a plant that fails, or None.
    """

    proposed: Callable[[int], FailingPlant | None]
    severed: Callable[[], Iterable[FailingPlant]]
    refuted: Callable[[MultiChannelSystem], Answer | None]


def two_sided(
    proofs: Proofs, failures: Failures, wanted: str, relative: bool, effort: float
) -> LargestUncertainty:
    """Search a failing plant, then the largest factor with a proof; see `largest_uncertainty`."""
    require_seconds(effort, "effort")
    near, refutation = nearest(failures, min(1 + int(_TRIES * effort), _MOST_TRIES))
    beyond = 1e6 if near is None else to_float(near.distance)
    lower, proof = largest_factor(proofs, _SQUARES * effort, beyond)
    return LargestUncertainty(
        wanted,
        relative,
        lower,
        proof,
        None if near is None else near.distance,
        None if near is None else near.plant,
        refutation,
        None if near is None else near.channels,
    )


def nearest(failures: Failures, tries: int) -> tuple[FailingPlant | None, Answer | None]:
    """Return the nearest of the proposed plants that fails, and the exact answer about it."""
    proposed = failures.proposed(tries)
    candidates = [*([] if proposed is None else [proposed]), *failures.severed()]
    for near in sorted(candidates, key=lambda each: each.distance):
        refutation = failures.refuted(near.plant)
        if refutation is not None:
            return near, refutation
    return None, None


def largest_factor(proofs: Proofs, work: float, beyond: float) -> tuple[Fraction, Answer | None]:
    """Bisect for the largest factor of the radii with a proof, below the factor ``beyond``."""
    most = min(proofs.capacity(), beyond) if beyond > 0 else 0.0
    low, best = Fraction(0), None
    if not most > _LEAST:
        return low, best
    likely = proofs.likely()
    first = [0.97 * most, 0.97 * likely] if likely < most else [0.97 * most]
    limit = proofs.work() + work
    for _ in range(proofs.rounds):
        before, high = low, most
        for step in range(_STEPS):
            if low and high < _CLOSE * low:
                break
            middle = (float(low) * high) ** 0.5 if low else high * (0.5 if step < 3 else 0.1)
            x = first.pop() if first else middle
            factor = short(x)
            proof = proofs.proof(factor) if factor > 0 else None
            if proof is None:
                high, first = x, []
            else:
                low, best = factor, proof
            if proofs.work() > limit or high < _LEAST:
                return low, best
        if low == before:
            break
    return low, best


def short(x: float) -> Fraction:
    """A number with three significant digits, rounded down.

    Examples
    --------
    >>> short(0.012345), short(-1.0)
    (Fraction(123, 10000), Fraction(0, 1))
    """
    if not x > 0:
        return Fraction(0)
    exponent = 0
    while x * 10**exponent < 100:
        exponent += 1
    while x * 10.0**exponent >= 1000:
        exponent -= 1
    return Fraction(int(x * 10.0**exponent)) / Fraction(10) ** exponent


# Boxes of plants: fixed modes, stabilizability, controllability and observability.

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
        the modulus of its entry, so that entries that are 0 stay 0.
    wanted : {"no fixed mode", "stabilizable", "controllable", "observable"}
        By decentralized linear time-invariant control, each member by a controller of its own.
    effort : float
        About the seconds that the search may take; its work is counted and not timed.

    Returns
    -------
    LargestUncertainty
        Both factors are proved: the lower one for every member of the box, the upper one by a
        plant that fails.  How near they are depends on the processor and on the effort.

    Raises
    ------
    UsageError
        If the property is another one, or the system is a derived one.

    Notes
    -----
    Sequential linear programs propose plants that fail.  Plants whose channels do nothing are tried
    as well; without radii of the plant, one of them is within the factor 1.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
    >>> largest = largest_uncertainty(plant)
    >>> largest.relative, 0.1 < largest.lower < largest.upper < 0.5
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
        return two_sided(_proofs(unit, wanted), _failures(unit, wanted), wanted, relative, effort)


def nearest_fixed(system: MultiChannelSystem, tries: int) -> FailingPlant | None:
    """Search a plant with a fixed mode near a system; that the mode is fixed is decided exactly.

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
    size_A, size_B, size_C = map(largest_entry, ([system.A], system.B, system.C))
    radii = Radii(
        _constant(system.A, size_A),
        [_constant(B, size_B) for B in system.B],
        [_constant(C, size_C) for C in system.C],
    )
    with one_thread():
        return nearest(_failures(Box(system, radii).system, "no fixed mode"), tries)[0]


def failing_member(
    system: MultiChannelSystem,
    wanted: Property = "no fixed mode",
    tries: int = 8,
    *,
    known: Iterable[MultiChannelSystem] = (),
) -> Answer | None:
    """Search a plant within the radii of a system that lacks a property.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant with radii.
    wanted : {"no fixed mode", "stabilizable", "controllable", "observable"}
    tries : int
        How many sets of channels and modes are tried.
    known : iterable of MultiChannelSystem
        Plants within the radii, which are decided before others are searched.

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
        failures = _failures(system, wanted, Fraction(1))
        for member in (Box(system).nominal, *known):
            refuted = failures.refuted(member)
            if refuted is not None:
                return refuted
        near, refutation = nearest(failures, tries)
    return refutation if near is not None and near.distance <= 1 else None


def _constant(M: Matrix, entry: Fraction) -> Matrix:
    """A matrix of the shape of another, all entries of which are the same."""
    return Matrix.from_rows([[entry] * M.ncols] * M.nrows, M.ncols)


def _decided(unit: MultiChannelSystem, wanted: str) -> MultiChannelSystem:
    """The system of which a property of a plant is decided: the dual one for observability."""
    return dual(unit) if wanted == "observable" else unit


def _region(unit: MultiChannelSystem, wanted: str) -> StabilityRegion | None:
    """The region in which fixed modes are allowed."""
    return StabilityRegion(unit.time) if wanted == "stabilizable" else None


def _proofs(unit: MultiChannelSystem, wanted: str) -> Proofs:
    """The search for a proof of one property."""
    system, region = _decided(unit, wanted), _region(unit, wanted)
    bound = None if region is None else region.edge
    members, outside = Members.of(system), Outside(unit.time, bound)

    def scaled(factor: Fraction) -> MultiChannelSystem:
        """The system with radii that are multiplied by a factor."""
        plant: MultiChannelSystem = constructed(Box(unit).scaled(factor).system, system.subject)
        return plant

    if wanted in ("controllable", "observable"):
        channels = tuple(range(unit.m))
        control = ControllabilitySearch(members, channels)

        def controllable(factor: Fraction) -> Answer | None:
            part, named = control.evidence(factor, outside), system.named(channels)
            if part is None:
                return None
            return BoxControllability(scaled(factor), named, bound, **vars(part))

        return Proofs(lambda: control.capacity(outside), controllable, lambda: control.tested)
    search = FixedModeSearch(members)

    def not_fixed(factor: Fraction) -> Answer | None:
        part = search.evidence(factor, outside)
        return None if part is None else BoxFixedModes(scaled(factor), bound, **vars(part))

    def capacity() -> float:
        least = search.prepare(_NEVER_ENOUGH, outside)
        return search.improve(outside, _MORE_GAINS) if search.known else least

    return Proofs(
        capacity,
        not_fixed,
        lambda: search.tested + _GAINS * len(search.known),
        # Where the plant has no mode outside of the region, only the factor up to which no mode at
        # all is fixed indicates how far the radii can grow.
        lambda: search.prepare(_NEVER_ENOUGH, Outside(unit.time, None)),
        _ROUNDS,
    )


def _failures(unit: MultiChannelSystem, wanted: str, enough: Fraction = Fraction(0)) -> Failures:
    """The search for a plant that lacks one property; one at most so far away ends it."""
    system, region = _decided(unit, wanted), _region(unit, wanted)
    radii = radii_of(system)
    if wanted not in ("controllable", "observable"):

        def fixed(plant: MultiChannelSystem) -> Answer | None:
            spectrum = fixed_spectrum(plant)
            allowed = region is not None and spectrum.stabilizable
            return None if spectrum.empty or allowed else spectrum

        return Failures(
            lambda tries: failing_plant(unit, radii, tried_sets(unit.m), tries, region, enough),
            lambda: severed_plants(unit, radii),
            fixed,
        )

    def near_unit(near: FailingPlant) -> FailingPlant:
        """The plant near ``unit`` whose dual system, or which itself, is near ``system``."""
        if system is unit:
            return near
        back = dual(near.plant)
        plant = MultiChannelSystem(
            back.A, back.B, back.C, time=unit.time, names=unit.names, neighbors=unit.neighbors
        )
        return replace(near, plant=plant)

    def proposed(tries: int) -> FailingPlant | None:
        near = failing_plant(system, radii, [()], tries, enough=enough)
        return None if near is None else near_unit(near)

    def uncontrollable(plant: MultiChannelSystem) -> Answer | None:
        answer = joint_controllability(_decided(plant, wanted))
        return None if answer.controllable else answer

    return Failures(
        proposed, lambda: map(near_unit, severed_plants(system, radii, inputs=True)), uncontrollable
    )


# Boxes of plants with one controller.


def largest_loop_uncertainty(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    gains: bool = False,
    effort: float = 10.0,
) -> LargestUncertainty:
    """Search the largest box in which a controller keeps all loops in a region, and a failure.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, or a sampled one, whose boxes are those of the plant in continuous time.  If it has
        radii, boxes are multiples of these; otherwise each radius is a part of the modulus of its
        entry, so that entries that are 0 stay 0.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    rate, radius : rational, optional
        A rate in continuous time, a radius in discrete time; by default stability is meant.
    gains : bool
        Whether the proof also allows each gain to differ by the same part of its modulus.
    effort : float
        About the seconds that the search may take; its work is counted and not timed.

    Returns
    -------
    LargestUncertainty
        The loop of the failing plant, with unchanged gains, has an eigenvalue on the border of the
        region, or outside of it.  Of a sampled plant the proof is about the exact samples of every
        member, and the failure about the samples of one, to the decimals of the given ones.

    Raises
    ------
    UsageError
        If the system is derived in another way.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> largest = largest_loop_uncertainty(plant, local_controllers(plant, [[[-3]]]))
    >>> 0.2 < largest.lower < largest.upper < 0.4
    True
    """
    InputError.require(system, MultiChannelSystem, "system")
    region = StabilityRegion.of(system.time, rate, radius)
    relative = system.plant.uncertainty is None
    unit = _with_box(system, Box.relative(system.plant, 1)) if relative else system
    loop, wanted = closed_loop(unit, controller, graph), f"every eigenvalue satisfies {region}"
    with one_thread():
        search = _SampledBoxes if is_sampled(system) else _PlantBoxes
        boxes = search(loop, region, gains)
        proofs = Proofs(boxes.capacity, boxes.proof, lambda: boxes.tested)
        return two_sided(proofs, boxes.failures(), wanted, relative, effort)


def _with_box(system: MultiChannelSystem, box: Box) -> MultiChannelSystem:
    """The plant of a box, sampled as the system is."""
    return resampled(system, box.system) if is_sampled(system) else box.system


@dataclass
class _PlantBoxes:
    """Multiples of the box of the plant of a loop: which are proved, and which plants fail.

    Attributes
    ----------
    loop : ClosedLoop
    region : StabilityRegion
    gains : bool
        Whether gains differ by the same part.
    tested : int
        The work so far, as parts of the border.
    """

    loop: ClosedLoop
    region: StabilityRegion
    gains: bool
    tested: int = 0

    def __post_init__(self) -> None:
        self.search = self.searched(self.loop, 1)

    def searched(self, loop: ClosedLoop, factor: Fraction | int) -> StabilitySearch:
        """The search about a loop whose gains differ by a part."""
        radii = gain_radii(loop.controller, factor) if self.gains else None
        return StabilitySearch(loop, self.region, radii)

    def capacity(self) -> float:
        """About how far the radii can grow."""
        return min((each for each, _ in self.search.margins()), default=0.0)

    def border(self, factor: Fraction) -> BoxStability | None:
        """The proof for a multiple of the box, if there is one."""
        return self.search.border(factor)

    def proof(self, factor: Fraction) -> Answer | None:
        """The same, counting the work."""
        answer = self.border(factor)
        self.tested += 100 if answer is None else len(answer.segments)
        return answer

    def near(self, tries: int) -> FailingPlant | None:
        """A plant whose loop seems to fail."""
        return failing_loop(self.search, tries)

    def failures(self) -> Failures:
        """The functions that look for a plant whose loop fails."""
        box = Box(self.loop.plant.plant)
        itself = FailingPlant(box.nominal, Fraction(0), complex("nan"), ())
        return Failures(
            self.near,
            lambda: (itself, *severed_plants(box.system, box.radii)),
            lambda plant: refuted_loop(self.search, plant),
        )


class _SampledBoxes(_PlantBoxes):
    """The same for a sampled plant, whose radii are not in proportion to those of the plant."""

    def capacity(self) -> float:
        """About how far the radii can grow, from how far small ones can."""
        small = StabilitySearch(self._scaled(_SMALL), self.region).margins()
        return float(_SMALL) * min((each for each, _ in small), default=0.0)

    def border(self, factor: Fraction) -> BoxStability | None:
        """The proof for the samples of a multiple of the box."""
        try:
            return self.searched(self._scaled(factor), factor).border(Fraction(1))
        except LimitReached:
            return None

    def near(self, tries: int) -> FailingPlant | None:
        """The nearest plant whose loop is proved to fail."""
        near = failing_samples(self.loop, self.region, tries)
        refuted = (each for each in near if refuted_loop(self.search, each.plant) is not None)
        return next(refuted, None)

    def _scaled(self, factor: Fraction) -> ClosedLoop:
        plant = self.loop.plant
        return replace(self.loop, plant=resampled(plant, Box(plant.plant).scaled(factor).system))


def refuted_loop(search: StabilitySearch, plant: MultiChannelSystem) -> StabilityVerdict | None:
    """The exact answer that the loop of a plant, or of its samples, leaves the region; or None."""
    sampled = search.loop.plant
    about = resampled(sampled, plant) if is_sampled(sampled) else plant
    loop = replace(search.loop, plant=about).system
    # An eigenvalue on the border is for the polynomial alone, which takes long for many states.
    method: Method = "polynomial" if loop.n <= _MOST_EXACT else "lyapunov"
    with suppress(UsageError):
        verdict = certify_stability(loop, search.region, method=method)
        return None if verdict.stable else verdict
    return None


_MOST_EXACT = 60
"""The most states, or signals of a loop, for which an eigenvalue may be on the border itself."""


def failing_loop(search: StabilitySearch, tries: int) -> FailingPlant | None:
    """A plant near the nominal one whose loop has an eigenvalue on the border, or just beyond.

    A plant exactly on the border can differ in numbers of thousands of digits; then one that is
    1e-5 farther is given, which differs in numbers of six digits.  Of large loops it is 1e-3
    farther, and no plant on the border is computed.  Corners of the box are tried as well
    (`boxes.corners`), and one is given if it is nearer: its entries differ by so much, too.

    Parameters
    ----------
    search : StabilitySearch
    tries : int
        How many points of the border are tried, those that seem nearest first.
    """
    loop, nominal = search.loop, Box(search.loop.plant).nominal
    signals = LoopPencil(loop.plant, loop.controller, loop.graph)
    spread = Box(loop.plant).radii
    plant = MultiChannelSystem(spread.A, spread.B, spread.C, time=loop.plant.time)
    D = signals.with_entries(plant, gain_radii(loop.controller, 0), 0)
    pencil = Uncertain(signals.matrix, D, signals.states, signals.dimension - 1)
    freedom: Freedom = "circle" if search.region.discrete else "line"
    best: tuple[Fraction, Matrix, complex] | None = None
    beyond: FailingPlant | None = None

    def farther(change: Matrix, times: float, point: complex) -> FailingPlant | None:
        short = _farther(change, times)
        member = _changed(nominal, signals, short)
        if not _is_outside(replace(loop, plant=member).system.A, search.region):
            return None
        distance = max(abs(short[i, j]) / D[i, j] for i, j, _ in short.nonzero())
        return FailingPlant(member, distance, point, ())

    for _, point in search.margins()[:tries]:
        near = pencil.drop(point, freedom)
        if near is None or (best is not None and near.size >= best[0]):
            continue
        if signals.dimension > _MOST_EXACT:
            member = farther(matrix_from_float(near.change, "dyadic"), _FAR_BEYOND, near.point)
            if beyond is None or (member is not None and member.distance < beyond.distance):
                beyond = member
            continue
        found = pencil.exact(near, freedom)
        if found is not None and (best is None or found[1] < best[0]):
            best = found[1], found[0], near.point
    corner = _failing_corner(search, signals, D)
    known = beyond if best is None else FailingPlant(nominal, best[0], best[2], ())
    if corner is not None and (known is None or corner.distance < _NEARER * known.distance):
        return corner
    if best is None:
        return beyond
    distance, change, point = best
    if _has_long_numbers(change) and (member := farther(change, _BEYOND, point)) is not None:
        return member
    return FailingPlant(_changed(nominal, signals, change), distance, point, ())


_NEARER, _CORNERS, _MOST_MODES = Fraction(999, 1000), 240, 6
"""How much nearer a corner has to be, and how many modes of a loop are followed to corners, times
the dimension of the loop."""


def _failing_corner(search: StabilitySearch, signals: LoopPencil, D: Matrix) -> FailingPlant | None:
    """The plant at the nearest corner that is found, a little beyond where its loop fails."""
    region, nominal = search.region, Box(search.loop.plant).nominal
    Z, radii = matrix_to_float(signals.matrix), matrix_to_float(D)
    family = PencilFamily(Z, radii, signals.states, to_float(region.limit), region.discrete)
    modes = min(_MOST_MODES, max(1, _CORNERS // max(signals.states, 1)))
    for distance, (signs,) in first_to_fail(family, modes)[:1]:
        beyond = _FAR_BEYOND if signals.dimension > _MOST_EXACT else _BEYOND
        factor = Fraction(f"{distance * beyond:.6e}")
        entries = ((i, j, factor * int(signs[i, j]) * D[i, j]) for i, j, _ in D.nonzero())
        change = Matrix.from_entries(D.shape, entries)
        plant = _changed(nominal, signals, change)
        if _is_outside(replace(search.loop, plant=plant).system.A, region):
            return FailingPlant(plant, factor, complex("nan"), ())
    return None


_LONG = 64
"""The bits, of numerator and denominator together, beyond which a number is long."""


def _has_long_numbers(M: Matrix) -> bool:
    entries = (M[i, j] for i, j, _ in M.nonzero())
    return any(x.numerator.bit_length() + x.denominator.bit_length() > _LONG for x in entries)


_BEYOND, _FAR_BEYOND = 1 + 1e-5, 1 + 1e-3
"""How much farther a change goes, so that six digits do, and so that instability is soon proved."""


def _farther(change: Matrix, times: float) -> Matrix:
    """A change that is at least as large everywhere, in numbers of six digits."""
    entries = ((i, j, to_float(change[i, j]) * times) for i, j, _ in change.nonzero())
    return Matrix.from_entries(change.shape, ((i, j, Fraction(f"{x:.5e}")) for i, j, x in entries))


def _is_outside(M: Matrix, region: StabilityRegion) -> bool:
    """Whether the computed eigenvalues are beyond the border, which proves nothing."""
    values = np.linalg.eigvals(matrix_to_float(M))
    sizes = np.abs(values) if region.discrete else values.real
    return bool(max(sizes, default=-np.inf) > to_float(region.limit))


def _changed(plant: MultiChannelSystem, signals: LoopPencil, change: Matrix) -> MultiChannelSystem:
    """The plant whose entries are changed as those of the pencil are."""

    def part(rows: tuple[str, int], cols: tuple[str, int]) -> Matrix:
        (top, height), (left, width) = (signals.blocks[kind, j, 0] for kind, j in (rows, cols))
        return change.take(range(top, top + height), range(left, left + width))

    return MultiChannelSystem(
        plant.A + part(("x", 0), ("x", 0)),
        [B + part(("x", 0), ("u_", j)) for j, B in enumerate(plant.B)],
        [C + part(("y_", j), ("x", 0)) for j, C in enumerate(plant.C)],
        time=plant.time,
        names=plant.names,
        neighbors=plant.neighbors,
    )


# Ranges of parameters with one controller.

_SEGMENTS, _DIRECTIONS, _MOST = 200, 6, 200
"""For a second of effort: how many parts of the border are tested, and how many directions are
tried; and the parts that are tried at most in a cell."""
_MOST_CORNERS, _GRID, _HALVINGS, _DIGITS = 16, 8, 12, 10**4


@dataclass(frozen=True, repr=False)
class LargestRanges(Shown):
    """A part of the ranges in which a loop is proved, and values at which it fails.

    Attributes
    ----------
    wanted : str
        The property of the loop.
    lower : Fraction
        The part of all ranges, around their middles, for which it is proved; 0 if for none.
    proof : ParametricBoxStability or None
        The answer that proves it, about the plant with these smaller ranges.
    upper : Fraction or None
        The part within which the loop fails at some values; None if no such values are known.
    failing : mapping or None
        These values, by the names of the parameters.
    refutation : StabilityVerdict or None
        The exact answer about the loop there.
    """

    wanted: str
    lower: Fraction
    proof: ParametricBoxStability | None
    upper: Fraction | None
    failing: Mapping[str, Fraction] | None
    refutation: StabilityVerdict | None

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield labels and texts: the property, where it is proved, and where it fails."""
        yield "property", self.wanted
        if self.proof is None:
            yield "proved for all values", "of no part of the ranges"
        else:
            ranges = ", ".join(self.proof.about.plant.parameters_in_words)
            part = f"{percent(self.lower)} of the ranges around their middle"
            yield "proved for all values", f"{ranges} ({part})"
        if self.failing is None:
            yield "fails", "at no values that were found"
        else:
            at = values_in_words(tuple(self.failing), tuple(self.failing.values()))
            near = f"within {percent(self.upper or Fraction(0), up=True)} of the ranges"
            yield "fails", f"at {at}, {near if self.upper else 'the middle of the ranges'}"

    def explain(self) -> str:
        """Say in plain words for which part the property is proved, and where it fails."""
        (_, wanted), *rows = self.rows()
        return f"{wanted}: {'; '.join(f'{label} {text}' for label, text in rows)}"

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        yield from self.rows()

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        ranges = None if self.proof is None else self.proof.about.plant.document()["parameters"]
        failing = self.failing
        return {
            "property": self.wanted,
            "lower": written(self.lower),
            "ranges": ranges,
            "upper": None if self.upper is None else written(self.upper),
            "failing": None if failing is None else {k: written(x) for k, x in failing.items()},
        }

    def __repr__(self) -> str:
        return f"LargestRanges({self.explain()})"


def largest_loop_ranges(
    system: ParametricSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    gains: Any = None,
    effort: float = 10.0,
) -> LargestRanges:
    """Search the largest part of ranges in which a loop is stable, and values where it fails.

    Parameters
    ----------
    system : ParametricSystem
        Every parameter has a range with two ends.  Parts are around the middles of the ranges.
    controller : Controller
    graph : NeighborGraph, optional
        The links between agents, without delays; by default there are none.
    rate, radius, gains : optional
        As for `box_stability`.
    effort : float
        About the seconds that the search may take; its work is counted and not timed.

    Returns
    -------
    LargestRanges
        The lower part is proved for all values in it; the loop fails at the stated values, which is
        decided exactly, with unchanged gains.  Both depend on the effort and the processor.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = ParametricSystem(
    ...     [["k"]], [[[1]]], [[[1]]], parameters=["k"], assume={"k": (-4, 8)}
    ... )
    >>> largest = largest_loop_ranges(plant, local_controllers(plant.at({"k": 1}), [[[-3]]]))
    >>> 0 < largest.lower < largest.upper < 1, 3 <= largest.failing["k"] < 4
    (True, True)
    """
    InputError.require(system, ParametricSystem, "system")
    require_seconds(effort, "effort")
    region = StabilityRegion.of(system.time, rate, radius)
    search = LoopSearch(system, controller, graph, region, gains, _MOST)
    with one_thread():
        rays = _Directions(system, search, whole_cell(system))
        failing = rays.nearest(2 + int(_DIRECTIONS * effort))
        lower, proof = _largest_part(system, search, _SEGMENTS * effort, failing)
    wanted = f"every eigenvalue satisfies {region}"
    if failing is None:
        return LargestRanges(wanted, lower, proof, None, None, None)
    part, values, refutation = failing
    return LargestRanges(wanted, lower, proof, part, values, refutation)


Failing = tuple[Fraction, dict[str, Fraction], StabilityVerdict]


def _largest_part(
    system: ParametricSystem, search: LoopSearch, work: float, failing: Failing | None
) -> tuple[Fraction, ParametricBoxStability | None]:
    """The largest part of the ranges with a proof, and the proof."""

    def proof(part: Fraction) -> ParametricBoxStability | None:
        try:
            return search.proof(_scaled(system, part))
        except LimitReached:
            return None

    search.limit = search.tested + work
    whole = proof(Fraction(1)) if failing is None else None
    if whole is not None:
        return Fraction(1), whole
    beyond = 1.0 if failing is None else to_float(failing[0])
    search.limit = search.tested + work
    proofs = Proofs(lambda: 1.0, proof, lambda: search.tested)
    lower, answer = largest_factor(proofs, work, beyond)
    return lower, answer if isinstance(answer, ParametricBoxStability) else None


def _scaled(system: ParametricSystem, part: Fraction) -> ParametricSystem:
    """The system with a part of all ranges, around their middles."""
    if part == 1:
        return system
    ranges = {}
    for name, (low, high) in zip(system.parameters, whole_cell(system), strict=True):
        middle, width = (low + high) / 2, (high - low) / 2
        ranges[name] = middle - part * width, middle + part * width
    return system.along({}, system.parameters, ranges)


@dataclass
class _Directions:
    """Values along rays from the middle of the ranges, and whether the loop fails there."""

    system: ParametricSystem
    search: LoopSearch
    cell: Cell

    def plant(self, direction: Floats, part: Fraction) -> tuple[MultiChannelSystem | None, Any]:
        """The plant at a part of the way along a direction, if it is defined, and the values."""
        values = {}
        for name, (low, high), d in zip(self.system.parameters, self.cell, direction, strict=True):
            share = part * Fraction(round(float(d) * 1024), 1024)
            values[name] = (low + high) / 2 + share * (high - low) / 2
        try:
            return self.system.at(values), values
        except InputError:
            return None, values

    def seems_to_fail(self, direction: Floats, part: Fraction) -> bool:
        """Whether floating point computes an eigenvalue outside of the region."""
        plant, _ = self.plant(direction, part)
        if plant is None:
            return False
        A = matrix_to_float(self.search.loop(plant).system.A)
        if not np.all(np.isfinite(A)):
            return False
        values = np.linalg.eigvals(A)
        edge = to_float(self.search.region.edge)
        sizes = np.abs(values) - edge if self.search.region.discrete else values.real + edge
        return bool(sizes.max(initial=-1.0) >= 0)

    def nearest(self, count: int) -> Failing | None:
        """The nearest of the tried values at which the loop fails, decided exactly."""
        best: Failing | None = None
        for direction in itertools.islice(self.tried(), count):
            most = Fraction(1) if best is None else best[0]
            best = self.along(direction, most) or best
        return best

    def tried(self) -> Iterator[Floats]:
        """The corners of the ranges, the middles of their sides, and drawn directions."""
        size, rng = len(self.cell), np.random.default_rng(0)
        corners = itertools.product((1.0, -1.0), repeat=size)
        yield from map(np.array, itertools.islice(corners, _MOST_CORNERS))
        if size == 1:
            return
        for k in range(size):
            yield np.eye(size)[k]
            yield -np.eye(size)[k]
        while True:
            drawn = rng.uniform(-1, 1, size)
            yield drawn / np.abs(drawn).max()

    def along(self, direction: Floats, most: Fraction) -> Failing | None:
        """The first values along a direction at which the loop fails, decided exactly."""
        grid = [most * k / _GRID for k in range(_GRID + 1)]
        last = next((k for k, x in enumerate(grid) if self.seems_to_fail(direction, x)), None)
        if last is None:
            return None
        low, high = grid[max(last - 1, 0)], grid[last]
        for _ in range(_HALVINGS):
            middle = (low + high) / 2
            low, high = (low, middle) if self.seems_to_fail(direction, middle) else (middle, high)
        # In turn: a part of few digits, the end of the bisection, and a point beyond the border.
        near = Fraction(-(-high.numerator * _DIGITS // high.denominator), _DIGITS)
        for part in (min(near, most), high, grid[last]):
            plant, values = self.plant(direction, part)
            refutation = None if plant is None else self.search.refuted(plant)
            if refutation is not None:
                reached = max(abs(share) for share in self._shares(values))
                return reached, values, refutation
        return None

    def _shares(self, values: Mapping[str, Fraction]) -> Iterator[Fraction]:
        """The parts of half the ranges by which values differ from the middles."""
        for (low, high), value in zip(self.cell, values.values(), strict=True):
            yield (2 * value - low - high) / (high - low) if high > low else Fraction(0)
