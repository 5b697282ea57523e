"""Every loop of one controller and a plant whose parameters are within ranges."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.analysis.boxes.box_stable import StabilitySearch
from mcexact.analysis.boxes.cut_ranges import proofs_of_cells
from mcexact.analysis.boxes.gain_radii import radii_of_gains
from mcexact.analysis.boxes.parameter_cells import CellBox
from mcexact.analysis.stability.stability import certify_stability
from mcexact.answer.parametric_box_stable import ParametricBoxStability, StabilityOfCell
from mcexact.answer.stability import StabilityVerdict
from mcexact.derived.constructions import add_links, looped
from mcexact.errors import InputError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

_MOST_SEGMENTS = 1000
"""The parts of the border that are tried at most; a cell that needs more is cut."""


def parametric_box_stability(
    system: ParametricSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    gains: Any = None,
) -> ParametricBoxStability:
    """Prove that a loop is stable, or fast enough, at all values of parameters within their ranges.

    Parameters
    ----------
    system : ParametricSystem
        Every parameter has a range with two ends.
    controller : Controller
    graph : NeighborGraph, optional
        The links between agents, without delays; by default there are none.
    rate, radius, gains : optional
        As for `box_stability`.

    Raises
    ------
    LimitReached
        If no proof was found; if the loop is unstable at some values, the message names them.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = ParametricSystem(
    ...     [["k"]], [[["k"]]], [[[1]]], parameters=["k"], assume={"k": ("1/2", 2)}
    ... )
    >>> gain = local_controllers(plant.at({"k": 1}), [[[-3]]])
    >>> str(parametric_box_stability(plant, gain, rate="1/2").bound)
    '1/2'
    >>> parametric_box_stability(plant, gain, rate=2)
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: not every eigenvalue has Re λ < -2 at k = 7/8
    """
    InputError.require(system, ParametricSystem, "system")
    region = StabilityRegion.of(system.time, rate, radius)
    return LoopSearch(system, controller, graph, region, gains).proof(system)


@dataclass
class LoopSearch:
    """The search for evidence about one controller, for several ranges of the parameters.

    Attributes
    ----------
    system : ParametricSystem
    controller : Controller
    graph : NeighborGraph or None
        The links between agents, without delays.
    region : StabilityRegion
    gains : rational or Controller, optional
        As for `box_stability`.
    most : int
        The parts of the border that are tried at most in a cell.
    limit : float
        How many parts of the border may be tested; then no cell is proved any more.
    tested : int
        About how many were tested so far.
    """

    system: ParametricSystem
    controller: Controller
    graph: NeighborGraph | None
    region: StabilityRegion
    gains: Any = None
    most: int = _MOST_SEGMENTS
    limit: float = math.inf
    tested: int = 0

    def __post_init__(self) -> None:
        InputError.require(self.controller, Controller, "controller")
        self.radii = radii_of_gains(self.controller, self.gains)

    def loop(self, plant: MultiChannelSystem) -> ClosedLoop:
        """The loop of the plant at some values."""
        if self.graph is not None:
            plant = add_links(plant.with_neighbors({}), self.graph.edges())
        return closed_loop(plant, self.controller)

    def refuted(self, plant: MultiChannelSystem) -> StabilityVerdict | None:
        """The exact answer that a loop has an eigenvalue outside; None if it has none."""
        found = certify_stability(self.loop(plant).system, self.region)
        return None if found.stable else found

    def proof(self, system: ParametricSystem) -> ParametricBoxStability:
        """The answer for the system with these ranges.

        Raises
        ------
        LimitReached
            If no proof was found.
        """
        about = looped(system, lambda plant: self.loop(plant).system)
        cuts, parts = proofs_of_cells(
            system,
            self._of_cell,
            lambda plant: self.refuted(plant) is not None,
            f"not every eigenvalue has {self.region}",
        )
        claimed = None if self.radii is None else self.radii.document()
        return ParametricBoxStability(about, self.region.bound, claimed, cuts, parts)

    def _of_cell(self, box: CellBox) -> StabilityOfCell | None:
        """The evidence about a box around the plants of a cell."""
        if self.tested > self.limit:
            return None
        loop = self.loop(box.system)
        search = StabilitySearch(loop, self.region, self.radii, self.most, box.radii, box.tied)
        # Where floating point sees that the radii are too large, nothing is tested.
        least = min((each for each, _ in search.margins()), default=0.0)
        found = search.evidence(Fraction(1)) if least > 1 else None
        self.tested += 1 if least <= 1 else self.most if found is None else len(found.segments)
        return found
