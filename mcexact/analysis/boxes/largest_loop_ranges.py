"""How much of the ranges of parameters a controller is stable for, from both sides."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from mcexact.analysis.boxes.cut_ranges import values_in_words
from mcexact.analysis.boxes.float_pencils import Floats
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.parameter_cells import Cell, whole_cell
from mcexact.analysis.boxes.parametric_box_stable import LoopSearch
from mcexact.analysis.boxes.two_sided import Search, largest_factor
from mcexact.answer.parametric_box_stable import ParametricBoxStability
from mcexact.answer.stability import StabilityVerdict
from mcexact.errors import InputError, LimitReached, require_seconds
from mcexact.exact.matrix import matrix_to_float, to_float
from mcexact.exact.rational import percent, written
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.shown import Shown

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
        The part within which the loop fails at some values; None if no such values were found.
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
        """Say in plain words where the property is proved, and where it fails."""
        (_, wanted), *told = self.rows()
        return f"{wanted}: {'; '.join(f'{label} {text}' for label, text in told)}"

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
        The part is proved for all values, and the values at which the loop fails are decided
        exactly, with the gains as they are.  Which are found depends on the effort and the
        processor.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = ParametricSystem(
    ...     [["k"]], [[[1]]], [[[1]]], parameters=["k"], assume={"k": (-4, 8)}
    ... )
    >>> found = largest_loop_ranges(plant, local_controllers(plant.at({"k": 1}), [[[-3]]]))
    >>> 0 < found.lower < found.upper < 1, 3 <= found.failing["k"] < 4
    (True, True)
    """
    InputError.require(system, ParametricSystem, "system")
    require_seconds(effort, "effort")
    region = StabilityRegion.of(system.time, rate, radius)
    search = LoopSearch(system, controller, graph, region, gains, _MOST)
    with one_thread():
        failing = _Directions(search, whole_cell(system)).nearest(2 + int(_DIRECTIONS * effort))
        lower, proof = _largest_part(search, _SEGMENTS * effort, failing)
    wanted = f"every eigenvalue satisfies {region}"
    if failing is None:
        return LargestRanges(wanted, lower, proof, None, None, None)
    part, values, refutation = failing
    return LargestRanges(wanted, lower, proof, part, values, refutation)


Failing = tuple[Fraction, dict[str, Fraction], StabilityVerdict]


def _largest_part(
    search: LoopSearch, work: float, failing: Failing | None
) -> tuple[Fraction, ParametricBoxStability | None]:
    """The largest part of the ranges with a proof, and the proof."""

    def proof(part: Fraction) -> ParametricBoxStability | None:
        try:
            return search.proof(_scaled(search.system, part))
        except LimitReached:
            return None

    search.limit = search.tested + work
    whole = proof(Fraction(1)) if failing is None else None
    if whole is not None:
        return Fraction(1), whole
    beyond = 1.0 if failing is None else to_float(failing[0])
    # severed plants and other plants that fail are a matter of boxes: here values are tried
    wanted = Search(
        lambda: 1.0, proof, lambda _: None, lambda _: None, lambda: (), lambda: search.tested
    )
    search.limit = search.tested + work
    lower, found = largest_factor(wanted, work, beyond)
    return lower, found if isinstance(found, ParametricBoxStability) else None


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

    search: LoopSearch
    cell: Cell

    def plant(self, direction: Floats, part: Fraction) -> tuple[MultiChannelSystem | None, Any]:
        """The plant at a part of the way along a direction, if it is defined, and the values."""
        values = {}
        for name, (low, high), d in zip(
            self.search.system.parameters, self.cell, direction, strict=True
        ):
            share = part * Fraction(round(float(d) * 1024), 1024)
            values[name] = (low + high) / 2 + share * (high - low) / 2
        try:
            return self.search.system.at(values), values
        except InputError:
            return None, values

    def seems_to_fail(self, direction: Floats, part: Fraction) -> bool:
        """Whether floating point sees an eigenvalue outside of the region."""
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
        """The values nearest to the middle at which the loop was found to fail."""
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
        # A part with few digits is tried first; at the last one floating point saw no border near.
        near = Fraction(-(-high.numerator * _DIGITS // high.denominator), _DIGITS)
        for part in (min(near, most), high, grid[last]):
            plant, values = self.plant(direction, part)
            found = None if plant is None else self.search.refuted(plant)
            if found is not None:
                reached = max(abs(share) for share in self._shares(values))
                return reached, values, found
        return None

    def _shares(self, values: Mapping[str, Fraction]) -> Iterator[Fraction]:
        """The parts of half the ranges by which values differ from the middles."""
        for (low, high), value in zip(self.cell, values.values(), strict=True):
            yield (2 * value - low - high) / (high - low) if high > low else Fraction(0)
