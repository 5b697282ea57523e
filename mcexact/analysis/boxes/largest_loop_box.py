"""How far data may be from their values before a controller fails, from both sides."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from mcexact.analysis.boxes.box_stable import StabilitySearch
from mcexact.analysis.boxes.failing_plants import FailingPlant, severed_plants
from mcexact.analysis.boxes.gain_radii import gain_radii
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.rank_drops import Freedom, Uncertain
from mcexact.analysis.boxes.two_sided import LargestUncertainty, Search, two_sided
from mcexact.analysis.stability.stability import certify_stability
from mcexact.answer.protocol import Answer
from mcexact.answer.stability import StabilityVerdict
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import LoopPencil, closed_loop
from mcexact.model.system import MultiChannelSystem


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
    """Search the largest box in which a controller keeps all loops in a region, and one it fails.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.  If it has radii, boxes are multiples of these; otherwise each radius is a part of
        the modulus of its entry, and zeros are certain.
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
        The loop of the plant that fails, with the gains as they are, has an eigenvalue on the
        border of the region; or outside, if the plant itself fails.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> found = largest_loop_uncertainty(plant, local_controllers(plant, [[[-3]]]))
    >>> 0.2 < found.lower < found.upper < 0.4
    True
    """
    InputError.require(system, MultiChannelSystem, "system")
    region = StabilityRegion.of(system.time, rate, radius)
    relative = system.uncertainty is None
    unit = Box.relative(system, 1).system if relative else system
    loop = closed_loop(unit, controller, graph)

    with one_thread():
        search = StabilitySearch(loop, region, gain_radii(controller, 1) if gains else None)
        tested, itself = [0], FailingPlant(Box(unit).nominal, Fraction(0), complex("nan"), ())

        def proof(growth: Fraction) -> Answer | None:
            found = search.border(growth)
            tested[0] += 100 if found is None else len(found.segments)
            return found

        made = Search(
            lambda: min((each for each, _ in search.margins()), default=0.0),
            proof,
            lambda plant: refuted_loop(search, plant),
            lambda tries: failing_loop(search, tries),
            lambda: (itself, *severed_plants(unit, Box(unit).radii)),
            lambda: tested[0],
        )
        return two_sided(made, f"every eigenvalue satisfies {region}", relative, effort)


def refuted_loop(search: StabilitySearch, plant: MultiChannelSystem) -> StabilityVerdict | None:
    """The exact answer that the loop of a plant has an eigenvalue outside; None if it has none."""
    loop = replace(search.loop, given=plant).system
    # With an eigenvalue on the border only the polynomial decides.
    found = certify_stability(loop, search.region, method="polynomial")
    return None if found.stable else found


def failing_loop(search: StabilitySearch, tries: int) -> FailingPlant | None:
    """A plant near the nominal one whose loop has an eigenvalue on the border.

    Parameters
    ----------
    search : StabilitySearch
    tries : int
        How many points of the border are tried, those that seem nearest first.
    """
    loop, nominal = search.loop, Box(search.loop.given).nominal
    signals = LoopPencil(loop.given, loop.controller, loop.graph)
    spread = Box(loop.given).radii
    plant = MultiChannelSystem(spread.A, spread.B, spread.C, time=loop.given.time)
    D = signals.with_entries(plant, gain_radii(loop.controller, 0), 0)
    pencil = Uncertain(signals.matrix, D, signals.states, signals.dimension - 1)
    freedom: Freedom = "circle" if search.region.discrete else "line"
    best: FailingPlant | None = None
    for _, point in search.margins()[:tries]:
        near = pencil.drop(point, freedom)
        if near is None or (best is not None and near.size >= best.distance):
            continue
        made = pencil.exact(near, freedom)
        if made is not None and (best is None or made[1] < best.distance):
            moved = _changed(nominal, signals, made[0])
            best = FailingPlant(moved, made[1], near.point, ())
    return best


def _changed(plant: MultiChannelSystem, signals: LoopPencil, change: Matrix) -> MultiChannelSystem:
    """The plant whose entries are moved as those of the pencil are."""

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
