"""How far a plant may be from its values before a controller fails, with a small effort.

`every_loop` looks from both sides: for a box of plants around the given one for which every loop is
proved stable, and for a plant nearby whose loop is exactly proved not to be.  Where the plant has
radii, these are the box; otherwise parts of what seems to be the largest box relative to the
entries are tried, first those for which gains may differ as well.  The effort is counted in parts
of the border of stability, not in seconds.  Designs show this at once; `largest_loop_uncertainty`
finds larger boxes and nearer plants with more work.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, Literal

from mcexact.analysis.boxes.failure import FailingPlant, severed_plants
from mcexact.analysis.boxes.largest import failing_loop, refuted_loop, short
from mcexact.analysis.boxes.loops import StabilitySearch, gain_radii
from mcexact.analysis.boxes.margins import SIDES, margin_in_box
from mcexact.analysis.boxes.pencils import one_thread
from mcexact.analysis.boxes.samples import failing_samples
from mcexact.answer.boxes import BoxStability
from mcexact.derived.sampling import is_sampled, resampled
from mcexact.errors import LimitReached, require_seconds
from mcexact.exact.rational import percent, written
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.loop import ClosedLoop
from mcexact.model.units import Units, loop_in, system_in
from mcexact.shown import Shown

WithinRadii = Literal["proved", "open", "refuted"]
"""What is known of all loops within the radii."""
SIX_DIGITS = Fraction(1, 100_000)
"""The largest relative change of a number that is rounded to six digits, up or down."""
_PARTS, _SURE, _BOLD = (0.9, 0.6, 0.3, 0.1), (0.3, 0.1), (0.75,)
"""The parts of the apparently largest box that are tried, those tried with little work, and the one
before these where the work is enough for both."""
_POINTS = 2
_MOST_SIGNALS, _MOST_SEGMENTS, _USUAL = 160, 600, 30
"""Loops with more states, outputs and inputs are left out; for each box at most so many parts of
the border are tried."""
_PER_SECOND = 170
"""How many parts of the border of a loop with the usual number of signals are tried in a second."""
_SMALL = Fraction(1, 1000)
"""A part of the entries of a plant for which the radii of its samples are about in proportion."""
_HALF = Fraction(1, 2)
"""The part of a proved box in which disk margins are proved; at its end little is left of them."""
_LEFT, _FEWEST = 800, 10
"""The parts of the border that are tried for disk margins, and the fewest for one side."""
MOST_SECONDS = 5.0
"""About how long the checker may take for the disk margins of one side."""
_LITTLE, _SCARCE = 300, 150
"""With fewer parts of the border than these, only the boxes that likely have a proof are tried."""
_LATE = "the time limit ended the search of a proof"
_ASK = "; `mcexact certify --uncertainty 0.1%` asks about one box with more work"
_ASK_OWN = "; `mcexact certify` asks about them with more work"


@dataclass(frozen=True, repr=False)
class EveryLoop(Shown):
    """What is proved for all loops in a box around one loop, and a plant nearby whose loop fails.

    Attributes
    ----------
    region : StabilityRegion
        Where the eigenvalues of all loops are to be.
    proof : BoxStability or None
    gains : Fraction or None
        The part of their moduli by which gains may differ in the proof; None if they are certain.
    failing : FailingPlant or None
        A plant whose loop is not stable, with its distance in the radii of the plant, or else as a
        part of its entries.
    reason : str
        Why there is no proof.
    margins : mapping
        Proofs of disk margins of single inputs and outputs in a box, by "inputs" and "outputs".
    """

    region: StabilityRegion
    proof: BoxStability | None
    gains: Fraction | None
    failing: FailingPlant | None
    reason: str = ""
    margins: Mapping[str, BoxStability] = field(default_factory=dict)

    @property
    def part(self) -> Fraction | None:
        """The radius of each entry in the proof, divided by the modulus of the entry."""
        return None if self.proof is None else Box(self.proof.about.plant).part

    @property
    def within_radii(self) -> WithinRadii:
        """Whether every loop within the radii of the plant is stable, if the plant has radii."""
        return known_within(self.proof, self.failing)

    def rows(self) -> Iterator[tuple[str, str]]:
        """Yield a label and a text: why there is no proof."""
        if self.proof is None:
            yield "eigenvalues of every loop", self.reason

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield the proof, and the plant that fails."""
        yield "every loop", self.reason if self.proof is None else self.proof
        if self.failing is not None:
            yield "plant whose loop fails", self.failing.plant

    def explain(self) -> str:
        """Say in plain words what is proved."""
        return f"every loop: {self.reason}" if self.proof is None else self.proof.explain()

    def __repr__(self) -> str:
        known = "not proved" if self.proof is None else "proved"
        box = "" if self.part is None else f" within {percent(self.part)} of each entry"
        return f"EveryLoop({known}: {self.region}{box})"

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        known, failing = self.part, self.failing
        return {
            "certified": self.proof is not None,
            "region": str(self.region),
            "part": None if known is None else written(known),
            "gains": None if self.gains is None else written(self.gains),
            "fails_within": None if failing is None else written(failing.distance),
            "failing": None if failing is None else failing.plant.to_dict(),
            "margins": margins_view(self.margins),
            "reason": self.reason or None,
        }


@dataclass
class _Work:
    """The number of parts of the border that may still be tried, for each box and in all.

    Attributes
    ----------
    each, left : int
    parts : tuple of float
        The parts of what seems to be the largest box that are tried.
    asked : Fraction or None
        The part of all entries that is tried before these.
    first : int
        The number for the first box, if it is another one; otherwise 0.
    deadline : float or None
        The time of `time.monotonic` after which nothing else is tried.
    """

    each: int
    left: int
    parts: tuple[float, ...]
    asked: Fraction | None = None
    deadline: float | None = None
    first: int = 0

    @classmethod
    def of(
        cls, effort: float, size: int, asked: Fraction | None = None, deadline: float | None = None
    ) -> _Work:
        """The work of some seconds for a loop with some number of signals."""
        total = int(min(effort * _PER_SECOND * (_USUAL / max(size, 1)) ** 2, 1e6))
        if total < _LITTLE:
            bold = _BOLD if total >= _SCARCE and asked is None else ()
            first = total // 2 if asked is not None else total // 3 if bold else 0
            # what likely has a proof is tried with as much work as without the first box
            return cls(2 * total // 3, total + first + 2, (*bold, *_SURE), asked, deadline, first)
        return cls(min(total // 3, _MOST_SEGMENTS), total, _PARTS, asked, deadline)

    def boxes(self, largest: float) -> Iterator[Fraction]:
        """The parts of all entries that are tried, where so many of them seem to be the most."""
        if self.asked is not None:
            yield self.asked
        for times in self.parts:
            if part := short(times * min(largest, 1e6)):
                yield part

    @property
    def late(self) -> bool:
        """Whether the deadline has passed."""
        return self.deadline is not None and time.monotonic() >= self.deadline

    def proof(
        self, loop: ClosedLoop, region: StabilityRegion, gains: Fraction | None
    ) -> BoxStability | None:
        """A proof for the box of the plant, if it is found soon."""
        most, self.first = self.first or self.each, 0
        if self.left < most or not most or self.late:
            return None
        radii = None if gains is None else gain_radii(loop.controller, gains)
        search = StabilitySearch(loop, region, radii, most, deadline=self.deadline)
        border = search.border(Fraction(1))
        self.left -= search.tested
        return border


def every_loop(
    loop: ClosedLoop,
    region: StabilityRegion,
    effort: float = 5.0,
    deadline: float | None = None,
    part: Fraction | None = None,
) -> EveryLoop:
    """Search a proof for all loops in a box around one loop, and a plant whose loop fails.

    Parameters
    ----------
    loop : ClosedLoop
        Of a plant.  Where it has radii, these are the box, and the region is tried before mere
        stability; otherwise a large part of all entries is searched within which every loop is
        stable.
    region : StabilityRegion
        Where the eigenvalues of the loop are.
    effort : float
        About the seconds that the search of a proof may take; its work is counted and not timed.
    deadline : float, optional
        The time of `time.monotonic` after which no further work is begun.
    part : Fraction, optional
        The part of all entries that is tried first, where the plant has no radii.

    Notes
    -----
    Little work is done: `largest_loop_uncertainty` finds larger boxes and nearer plants.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[[-3]]]))
    >>> loops = every_loop(loop, StabilityRegion("continuous"))
    >>> 0.2 < loops.part < loops.failing.distance < 0.4, loops.gains == SIX_DIGITS
    (True, True)
    """
    whole = StabilityRegion(loop.plant.time)
    if loop.plant.subject and not is_sampled(loop.plant):
        return EveryLoop(whole, None, None, None, "not tried, as the system is a derived one")
    require_seconds(effort, "effort")
    ports = sum(loop.plant.p(i) + loop.plant.q(i) for i in range(loop.plant.m))
    size = loop.matrix.nrows + ports
    if size > _MOST_SIGNALS:
        return EveryLoop(
            whole, None, None, None, f"not tried, as the loop has {size} signals{_ASK}"
        )
    units, work = Units.of(loop.plant), _Work.of(effort, size, part, deadline)
    try:
        if is_sampled(loop.plant):
            return _searched_at_samples(loop, region, work)
        if units is None:
            return _searched(loop, region, work)
        found = _searched(loop_in(units, loop), region, work)
        moved = _in_file_units(found, loop, units, deadline)
        return moved or _searched(loop, region, _Work.of(effort, size, part, deadline))
    except LimitReached as reached:
        return EveryLoop(whole, None, None, None, f"not tried: {reached.message}")


def _in_file_units(
    found: EveryLoop, loop: ClosedLoop, units: Units, deadline: float | None
) -> EveryLoop | None:
    """The same box and the same failing plant in the units of the file; None without a proof."""
    back, failing, proof = units.inverse(), found.failing, found.proof
    if failing is not None:
        own = loop.plant.uncertainty is not None
        unit = loop.plant if own else Box.relative(loop.plant, 1).system
        search = StabilitySearch(replace(loop, plant=unit), StabilityRegion(loop.plant.time))
        plant = system_in(back, failing.plant)
        refutation = refuted_loop(search, plant)
        failing = None
        if refutation is not None and found.failing is not None:
            failing = replace(found.failing, plant=plant, refutation=refutation)
    if proof is not None:
        box = replace(loop, plant=system_in(back, proof.about.plant))
        gains = None if found.gains is None else gain_radii(loop.controller, found.gains)
        with one_thread():
            again = StabilitySearch(box, found.region, gains, _MOST_SEGMENTS, deadline=deadline)
            proof = again.border(Fraction(1))
        if proof is None:
            return None
    margins = dict[str, BoxStability]()
    if proof is not None and found.margins:
        about = _for_margins(replace(loop, plant=proof.about.plant), loop)
        margins = _same_margins(about, found.margins, deadline)
    return replace(found, proof=proof, failing=failing, margins=margins)


def _same_margins(
    loop: ClosedLoop, known: Mapping[str, BoxStability], deadline: float | None
) -> dict[str, BoxStability]:
    """The same disk margins as were proved in other units, where they are proved again."""
    margins = dict[str, BoxStability]()
    for at in SIDES:
        disk = known[at].disk if at in known else None
        if disk is not None:
            proof = margin_in_box(loop, at, disk.margin, _MOST_SEGMENTS, deadline)
            if proof is not None:
                margins[at] = proof
    return margins


def _for_margins(about: ClosedLoop, loop: ClosedLoop) -> ClosedLoop:
    """The loop of the box in which margins are proved: own radii, or half of what was found."""
    if loop.plant.uncertainty is not None:
        return about
    return replace(about, plant=Box(about.plant).scaled(_HALF).system)


def margins_view(margins: Mapping[str, BoxStability]) -> dict[str, Any] | None:
    """The disk margins in a box, and the part of each entry that the box has, as plain data."""
    if not margins:
        return None
    part = margins_part(margins)
    sizes = {at: each.disk.margin for at, each in margins.items() if each.disk is not None}
    return {
        "part": None if part is None else written(part),
        **{at: written(sizes[at]) if at in sizes else None for at in SIDES},
    }


def margins_part(margins: Mapping[str, BoxStability]) -> Fraction | None:
    """The radius of each entry of the plant, as a part of its modulus; None for own radii."""
    return next((Box(each.about.plant).part for each in margins.values()), None)


def margin_answers(margins: Mapping[str, BoxStability]) -> dict[str, BoxStability]:
    """The proofs by the names under which sentences cite them."""
    return {f"box_{at.removesuffix('s')}_margin": each for at, each in margins.items()}


def margins_within(
    loop: ClosedLoop, left: int = _LEFT, deadline: float | None = None
) -> dict[str, BoxStability]:
    """Search disk margins of single inputs and outputs for all plants of a box, with little work.

    Parameters
    ----------
    loop : ClosedLoop
        Of a plant with radii.
    left : int
        How many parts of the border may be tried, times the number of ports.
    deadline : float, optional
        The time of `time.monotonic` after which no further work is begun.
    """
    found: dict[str, BoxStability] = {}
    plant = loop.plant
    sizes = {"inputs": plant.p, "outputs": plant.q}
    for at in SIDES:
        ports = sum(sizes[at](i) for i in range(plant.m))
        most = min(left // max(2 * ports, 1), _MOST_SEGMENTS)
        late = deadline is not None and time.monotonic() >= deadline
        if most < _FEWEST or late:
            continue
        proof = margin_in_box(loop, at, most=most, deadline=deadline, seconds=MOST_SECONDS)
        if proof is not None:
            found[at] = proof
    return found


def known_within(proof: BoxStability | None, failing: FailingPlant | None) -> WithinRadii:
    """Whether all loops within radii are stable, by a proof or a plant whose loop fails."""
    if proof is not None:
        return "proved"
    return "open" if failing is None or failing.distance > 1 else "refuted"


def failing_plant(loop: ClosedLoop) -> FailingPlant | None:
    """Search a plant whose loop is not stable, near in the radii of the plant of a loop.

    Parameters
    ----------
    loop : ClosedLoop
        Of a plant with radii, or of its samples.

    Returns
    -------
    FailingPlant or None
        None if none was found, which proves nothing.
    """
    region = StabilityRegion(loop.plant.time)
    if is_sampled(loop.plant):
        with one_thread():
            return _failing_at_samples(loop, region)
    units = Units.of(loop.plant)
    measured = loop if units is None else loop_in(units, loop)
    with one_thread():
        failing = _failing(StabilitySearch(measured, region))
        if failing is None or units is None:
            return failing
        plant = system_in(units.inverse(), failing.plant)
        refutation = refuted_loop(StabilitySearch(loop, region), plant)
    return None if refutation is None else replace(failing, plant=plant, refutation=refutation)


def _searched(loop: ClosedLoop, region: StabilityRegion, work: _Work) -> EveryLoop:
    """As `every_loop`, for a loop that is not too large."""
    whole, own = StabilityRegion(loop.plant.time), loop.plant.uncertainty is not None
    unit = loop.plant if own else Box.relative(loop.plant, 1).system
    with one_thread():
        search = StabilitySearch(replace(loop, plant=unit), whole)
        failing = None if work.late else _failing(search)
        if own:
            boxes = [(loop, each) for each in (StabilityRegion(whole.time, region.bound), whole)]
            tried = [(*each, gains) for each in boxes for gains in (SIX_DIGITS, None)]
        else:
            # A smaller box in which gains may be rounded is worth more than a larger one.
            smaller = [*_smaller(search, work)]
            tried = [(each, whole, gains) for gains in (SIX_DIGITS, None) for each in smaller]
        for about, wanted, gains in dict.fromkeys(tried):
            proof = work.proof(about, wanted, gains)
            if proof is not None:
                narrow = _for_margins(about, loop)
                margins = margins_within(narrow, work.left, work.deadline)
                return EveryLoop(wanted, proof, gains, failing, margins=margins)
    if work.late:
        return EveryLoop(whole, None, None, failing, _LATE)
    box = f"every plant within the radii{_ASK_OWN}" if own else f"any box{_ASK}"
    return EveryLoop(whole, None, None, failing, f"{whole} is not proved for {box}")


def _searched_at_samples(loop: ClosedLoop, region: StabilityRegion, work: _Work) -> EveryLoop:
    """As `_searched`, for a sampled plant: the boxes are those of the plant that was sampled.

    The radii of the samples grow faster than those of the plant, about in proportion where they
    are small.  The last box that is tried is the plant alone, whose samples are not rational.
    """
    whole, plant = StabilityRegion(loop.plant.time), loop.plant.plant
    own = plant.uncertainty is not None
    with one_thread():
        failing = None
        if not work.late:
            failing = _failing_at_samples(loop if own else _with_part(loop, Fraction(1)), whole)
        boxes: list[tuple[Fraction | None, StabilityRegion]]
        if own:
            boxes = [(None, StabilityRegion(whole.time, region.bound)), (None, whole)]
        else:
            unit = _with_part(loop, _SMALL)
            largest = min((each for each, _ in StabilitySearch(unit, whole).margins()), default=0.0)
            parts = work.boxes(float(_SMALL) * largest)
            boxes = [(part, whole) for part in (*parts, Fraction(0))]
        tried = [(*each, gains) for gains in (SIX_DIGITS, None) for each in boxes]
        for size, wanted, gains in tried:
            about = loop if size is None else _with_part(loop, size)
            proof = work.proof(about, wanted, gains)
            if proof is not None:
                part = Box(about.plant.plant).part or Fraction(0)
                inside = about if own else _with_part(loop, part * _HALF)
                margins = margins_within(inside, work.left, work.deadline)
                return EveryLoop(wanted, proof, gains, failing, margins=margins)
    if work.late:
        return EveryLoop(whole, None, None, failing, _LATE)
    box = f"every plant within the radii{_ASK_OWN}" if own else f"the exact samples{_ASK}"
    return EveryLoop(whole, None, None, failing, f"{whole} is not proved for {box}")


def _with_part(loop: ClosedLoop, part: Fraction) -> ClosedLoop:
    """The loop of a sampled plant whose entries differ by at most a part of their moduli."""
    plant = Box.relative(loop.plant.plant, part).system
    return replace(loop, plant=resampled(loop.plant, plant))


def _smaller(search: StabilitySearch, work: _Work) -> Iterator[ClosedLoop]:
    """The loop with radii that are smaller and smaller parts of the entries."""
    largest = min((each for each, _ in search.margins()), default=0.0)
    for part in work.boxes(largest):
        yield replace(search.loop, plant=Box(search.loop.plant).scaled(part).system)


def _failing_at_samples(loop: ClosedLoop, region: StabilityRegion) -> FailingPlant | None:
    """As `_failing`, for a sampled plant: a plant in continuous time whose samples fail."""
    search, box = StabilitySearch(loop, region), Box(loop.plant.plant)
    known = [*failing_samples(loop, region, _POINTS), *severed_plants(box.system, box.radii)]
    return _refuted(search, known)


def _failing(search: StabilitySearch) -> FailingPlant | None:
    """A plant nearby whose loop is not stable, which is decided exactly."""
    nearest = failing_loop(search, _POINTS)
    plant = search.loop.plant
    known = [*([] if nearest is None else [nearest]), *severed_plants(plant, Box(plant).radii)]
    return _refuted(search, known)


def _refuted(search: StabilitySearch, known: list[FailingPlant]) -> FailingPlant | None:
    """The nearest of some plants whose loop is decided not to be stable."""
    for near in sorted(known, key=lambda each: each.distance):
        refutation = refuted_loop(search, near.plant)
        if refutation is not None:
            return replace(near, refutation=refutation)
    return None
