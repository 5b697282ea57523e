"""How far data may be from their values: a largest certified box, and a plant that fails."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal, get_args

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
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.structure.controllability import joint_controllability
from mcexact.answer.mode_words import blame
from mcexact.answer.protocol import Answer
from mcexact.answer.reading import constructed
from mcexact.arguments import require_seconds
from mcexact.derived.dual import dual
from mcexact.errors import InputError, UsageError
from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.size import largest_entry
from mcexact.model.box import Box
from mcexact.model.system import MultiChannelSystem
from mcexact.model.uncertainty import Radii
from mcexact.plot.uncertainty import uncertainty
from mcexact.shown import Shown

Property = Literal["no fixed mode", "stabilizable", "controllable", "observable"]

_STEPS, _ROUNDS = 14, 2
_CLOSE = 1.03
_LEAST = 1e-12
"""A computed largest factor below this is reported as 0."""
_SQUARES, _GAINS, _TRIES = 2000, 50, 4
"""For a second of effort: how many squares are tested, how many of them a search for gains counts
for, and how many sets and modes are tried for a plant that fails."""
_MOST_TRIES = 40
_NEVER_ENOUGH = 1e30
_MORE_GAINS = 4


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
        """Say in plain words up to where the property is proved, and where it fails."""
        unit = " of each entry" if self.relative else " times the radii"
        proved = f"{self.wanted}: for every plant within {_number(self.lower, self.relative)}{unit}"
        if not self.lower:
            proved = f"{self.wanted}: not proved for any box"
        if self.upper is None:
            return f"{proved}; no plant that fails was found"
        return f"{proved}; not for a plant within {_number(self.upper, self.relative)}{unit}"

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield labels and texts: the property, and up to where it is proved and where it fails."""
        unit = "" if self.relative else " times the radii"
        yield "property", self.wanted
        proved = f"within {_number(self.lower, self.relative)}{unit}" if self.lower else "no box"
        yield "proved for every plant", proved
        near = "not found" if self.upper is None else f"{_number(self.upper, self.relative)}{unit}"
        yield "a plant fails within", near
        told = self.wanted == "no fixed mode"
        if told and self.channels is not None and self.failing is not None:
            yield "the mode that is fixed there", blame(self.channels, self.failing.names)

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the property, the factors, and the plant that fails."""
        yield from self.rows()
        if self.failing is not None:
            yield "plant that fails", self.failing

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        from mcexact.exact.rational import written

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


def _number(factor: Fraction, relative: bool) -> str:
    """A factor with three digits, as a percentage if it is relative."""
    value = to_float(factor) * (100 if relative else 1)
    return f"{value:.3g}{' %' if relative else ''}"


def _above(factor: Fraction) -> str:
    """A factor rounded up to about six digits, as text."""
    digits = 6
    while factor * 10**digits < 10**5 and digits < 40:
        digits += 1
    return f"{-(-factor.numerator * 10**digits // factor.denominator)}e-{digits}"


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


def _of_sizes(given: Any) -> Any:
    """Matrices whose entries are all the largest modulus of one matrix, or of several."""
    several = [given] if isinstance(given, Matrix) else list(given)
    size = largest_entry(several)
    found = [Matrix.from_rows([[size] * M.ncols] * M.nrows, M.ncols) for M in several]
    return found[0] if isinstance(given, Matrix) else found


def two_sided(search: Search, wanted: str, relative: bool, effort: float) -> LargestUncertainty:
    """Search both ends; see `largest_uncertainty`."""
    require_seconds(effort, "effort")
    near, refutation = nearest(search, min(1 + int(_TRIES * effort), _MOST_TRIES))
    beyond = 1e6 if near is None else to_float(near.distance)
    lower, proof = _largest(search, _SQUARES * effort, beyond)
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


def nearest(search: Search, tries: int) -> tuple[FailingPlant | None, Answer | None]:
    """The nearest plant found that fails, and the exact answer about it."""
    found = search.failing(tries)
    known = [*([] if found is None else [found]), *search.severed()]
    for near in sorted(known, key=lambda each: each.distance):
        refutation = search.refuted(near.plant)
        if refutation is not None:
            return near, refutation
    return None, None


@dataclass
class Search:
    """What is proved for one factor of the radii, and a plant that fails.

    Attributes
    ----------
    capacity : callable
        About how far the radii can grow.
    proof : callable
        The answer for a factor of the radii, or None.
    refuted : callable
        The exact answer about a plant that fails, or None.
    failing : callable
        A plant that is thought to fail, found with so many tries.
    severed : callable
        Plants that may fail as their channels do nothing.
    work : callable
        The work done so far.
    likely : callable
        A factor of the radii for which a proof is likely; it is tried first.
    rounds : int
        How often factors that failed are tried again: a search that learns may prove them then.
    """

    capacity: Callable[[], float]
    proof: Callable[[Fraction], Answer | None]
    refuted: Callable[[MultiChannelSystem], Answer | None]
    failing: Callable[[int], FailingPlant | None]
    severed: Callable[[], Iterable[FailingPlant]]
    work: Callable[[], float]
    likely: Callable[[], float] = lambda: float("inf")
    rounds: int = 1


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


def _largest(search: Search, work: float, beyond: float) -> tuple[Fraction, Answer | None]:
    """Bisect for the largest factor of the radii with a proof; beyond some factor there is none."""
    most = min(search.capacity(), beyond) if beyond > 0 else 0.0
    low, best = Fraction(0), None
    if not most > _LEAST:
        return low, best
    likely = search.likely()
    tried = [0.97 * most, 0.97 * likely] if likely < most else [0.97 * most]
    ended = search.work() + work
    for _ in range(search.rounds):
        began, high = low, most
        for step in range(_STEPS):
            if low and high < _CLOSE * low:
                break
            middle = (float(low) * high) ** 0.5 if low else high * (0.5 if step < 3 else 0.1)
            x = tried.pop() if tried else middle
            growth = short(x)
            found = search.proof(growth) if growth > 0 else None
            if found is None:
                high, tried = x, []
            else:
                low, best = growth, found
            if search.work() > ended or high < _LEAST:
                return low, best
        if low == began:
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
