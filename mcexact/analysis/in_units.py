"""Costs, bounds, margins, sectors and peaks of a plant and a controller, for users.

They are proved in units near the typical sizes of a plant (`Units`), where its matrices do not
depend on the units of the file, so that neither do the numbers that are proved.  The proofs are
then carried to the units of the file: a matrix P of a loop whose states have the units s becomes
P_ij/(s_i s_j), is rounded again, and is verified again for the same claim.  Peaks after steps need
no other units: their integers have as many bits as the units of the file demand.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, TypeVar, get_args, overload

import numpy as np

from mcexact.analysis.performance import (
    BITS,
    Group,
    Side,
    bound_by,
    bound_of,
    cost_by,
    cost_of,
    default_weights,
    margin_of,
    part_holds,
    response_of,
    rounded_form,
    sector_response,
    sectors_of,
    weights_in,
)
from mcexact.analysis.steps import Steps, steps_of
from mcexact.answer.performance import (
    CostBound,
    CostGraph,
    CostGroup,
    CostWeights,
    DiskMargin,
    LoopCost,
    MarginPart,
    SectorStability,
    StepPeaks,
    Symmetric,
)
from mcexact.errors import InputError, LimitReached, UsageError, one_of
from mcexact.exact.matrix import matrix_to_float, to_float
from mcexact.exact.rational import Entry, as_fraction
from mcexact.exact.roots import is_discrete
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import Units, inverted, loop_in, scaled, system_in


def loop_cost(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    weights: CostWeights | None = None,
) -> LoopCost:
    """Bound the stationary mean of xᵀQx + uᵀRu of a stable loop from above.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    weights : CostWeights, optional
        By default `default_weights`.

    Raises
    ------
    UsageError
        If the cost is infinite, since white noise passes to an input at once.
    LimitReached
        If no proof was found, as for every loop that is not stable.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> found = loop_cost(plant, local_controllers(plant, [[["-1/2"]]]))
    >>> print(f"{float(found.cost):.2f}")
    1.67
    >>> loop_cost(plant, local_controllers(plant, [[[1]]]))
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that the loop is stable with a finite cost
    """
    loop = _closed(system, controller, graph)
    chosen = weights or default_weights(loop.plant)
    found = _calculated(
        loop,
        lambda loop, units: cost_of(loop, chosen if units is None else weights_in(units, chosen)),
    )
    return _proved(found, "the loop is stable with a finite cost")


def cost_bound(
    system: MultiChannelSystem,
    weights: CostWeights | None = None,
    graph: CostGraph | None = None,
) -> CostBound:
    """Bound the stationary mean of xᵀQx + uᵀRu from below for every linear controller.

    Parameters
    ----------
    system : MultiChannelSystem
    weights : CostWeights, optional
        By default `default_weights`.
    graph : CostGraph, optional
        Only controllers are meant by which agents act on each other along its edges alone; see
        `influences`.

    Raises
    ------
    LimitReached
        If no proof was found, as for plants that no controller stabilizes.

    Examples
    --------
    >>> plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete")
    >>> print(f"{float(cost_bound(plant).cost):.2f}")
    1.00
    """
    InputError.require(system, MultiChannelSystem, "system")
    found = bound_in_units(system, weights or default_weights(system), graph)
    return _proved(found, "every controller costs something")


def disk_margin(
    system: MultiChannelSystem,
    controller: Controller,
    at: Side,
    graph: NeighborGraph | None = None,
    *,
    together: bool = False,
    margin: Entry | None = None,
) -> DiskMargin:
    """Prove how far inputs, or outputs, may be from 1 before a stable loop fails.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    at : {"inputs", "outputs"}
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    together : bool
        Whether all of them are multiplied at once, with a number for each; else one at a time.
    margin : rational, optional
        The margin to prove; by default about the largest one.

    Raises
    ------
    LimitReached
        If no proof was found, as for a margin that is larger than the loop's.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> deadbeat = local_controllers(plant, [[[-1]]])
    >>> str(disk_margin(plant, deadbeat, "inputs", margin="3/5").margin)
    '3/5'
    >>> disk_margin(plant, deadbeat, "inputs", margin="7/10")
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that the disk margin is at least 7/10
    """
    loop = _closed(system, controller, graph)
    one_of(at, get_args(Side), "at")
    alpha = None if margin is None else as_fraction(margin)
    found = _calculated(loop, lambda loop, _: margin_of(loop, at, together=together, margin=alpha))
    claim = (
        "the loop has a disk margin" if alpha is None else f"the disk margin is at least {alpha}"
    )
    return _proved(found, claim)


def sector_stability(
    system: MultiChannelSystem,
    controller: Controller,
    sectors: Sequence[tuple[Entry, Entry]],
    graph: NeighborGraph | None = None,
) -> SectorStability:
    """Prove that a loop is stable whatever its inputs pass through, within sectors.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    sectors : sequence of pairs of rationals
        The ends (a, b), a < b, one pair for each input in the order of the channels: the plant
        receives f(t, v) between av and bv for the v that the agent computes.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is not one pair for each input, or if a pair is not in order.
    LimitReached
        If no proof was found.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    >>> deadbeat = local_controllers(plant, [[[-1]]])
    >>> sector_stability(plant, deadbeat, [("1/2", "3/2")]).kind
    'sector'
    """
    loop = _closed(system, controller, graph)
    ends = [(as_fraction(a), as_fraction(b)) for a, b in sectors]
    count = loop.disturbed.U.nrows
    if len(ends) != count or any(a >= b for a, b in ends):
        raise UsageError(
            f"expected {count} pairs (a, b) with a < b, one for each input", where="sectors"
        )
    return _proved(
        _calculated(loop, lambda loop, _: sectors_of(loop, ends)),
        "the loop is stable within these sectors",
    )


def step_peaks(
    system: MultiChannelSystem,
    controller: Controller,
    at: Steps,
    graph: NeighborGraph | None = None,
) -> StepPeaks:
    """Prove how large inputs and outputs become after a step, for a loop that was at rest.

    Parameters
    ----------
    system : MultiChannelSystem
    controller : Controller
    at : {"inputs", "outputs", "setpoints"}
        A constant 1 is added to each of the inputs in turn, or to each of the outputs as agents
        receive them, or each of the set-points changes from 0 to 1.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    StepPeaks
        Bounds of the absolute values of all inputs and outputs, in the units of the file, for each
        step: usually some 0.05 % above the peaks, between samples, too.

    Raises
    ------
    LimitReached
        If no proof was found, as for every loop that is not stable.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> peaks = step_peaks(plant, local_controllers(plant, [[[-3]]]), "inputs")
    >>> print(f"{float(peaks.inputs[0][0]):.3f} {float(peaks.outputs[0][0]):.3f}")
    1.500 0.500
    >>> step_peaks(plant, local_controllers(plant, [[[0]]]), "inputs")
    Traceback (most recent call last):
        ...
    mcexact.errors.LimitReached: no proof was found that the loop stays within bounds
    """
    loop = _closed(system, controller, graph)
    one_of(at, get_args(Steps), "at")
    return _proved(steps_of(loop, at), "the loop stays within bounds")


def _closed(
    system: MultiChannelSystem, controller: Controller, graph: NeighborGraph | None
) -> ClosedLoop:
    """The loop of a plant and a controller, both of the right kind."""
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    return closed_loop(system, controller, graph)


Found = TypeVar("Found")


def _proved(found: Found | None, claim: str) -> Found:
    """An answer; an error where there is none."""
    if found is None:
        raise LimitReached(f"no proof was found that {claim}")
    return found


# From units near the sizes to those of the file.

Performed = TypeVar("Performed", LoopCost, CostBound, DiskMargin, SectorStability)


@overload
def in_file_units(answer: LoopCost, loop: ClosedLoop, units: Units) -> LoopCost | None: ...
@overload
def in_file_units(answer: CostBound, loop: ClosedLoop, units: Units) -> CostBound | None: ...
@overload
def in_file_units(answer: DiskMargin, loop: ClosedLoop, units: Units) -> DiskMargin | None: ...
@overload
def in_file_units(
    answer: SectorStability, loop: ClosedLoop, units: Units
) -> SectorStability | None: ...
def in_file_units(answer: Any, loop: ClosedLoop, units: Units) -> Any:
    """The answer about a loop in the units of the file that says the same as one in other units.

    Parameters
    ----------
    answer : LoopCost, CostBound, DiskMargin or SectorStability
        About the loop or the plant in the units, as `loop_in` and `system_in` make them.
    loop : ClosedLoop
        In the units of the file.
    units : Units

    Returns
    -------
    LoopCost, CostBound, DiskMargin, SectorStability or None
        None if the rounded matrices do not prove the claim.
    """
    if isinstance(answer, LoopCost):
        return _cost(answer, loop, units)
    if isinstance(answer, CostBound):
        return bound_in_file_units(answer, loop.plant, units)
    if isinstance(answer, DiskMargin):
        return _margin(answer, loop, units)
    return _sectors(answer, loop, units)


def states_of(loop: ClosedLoop, units: Units) -> list[Fraction]:
    """The unit of each state of a loop: messages on their way have those of their outputs."""
    one, result = Fraction(1), list[Fraction]()
    for (kind, j, _), (_, size) in loop.blocks.items():
        own = {"x": units.states, "y_": units.outputs[j]}.get(kind)
        result += own if own is not None else [one] * size
    return result


def _forms(P: Symmetric, units: Sequence[Fraction]) -> Iterator[Symmetric]:
    """P_ij/(s_i s_j), rounded to more and more bits."""
    d = np.array([1 / to_float(unit) for unit in units])
    measured = matrix_to_float(P.matrix()) * np.outer(d, d)
    for bits in BITS:
        form = rounded_form(measured, bits)
        if form is not None:
            yield form


def _cost(answer: LoopCost, loop: ClosedLoop, units: Units) -> LoopCost | None:
    weights, states = weights_in(units.inverse(), answer.weights), states_of(loop, units)
    if weights.bandwidth is not None:
        states += units.of_outputs
    for form in _forms(answer.P, states):
        cost = cost_by(loop, weights, form)
        if cost is not None and cost <= answer.cost:
            return LoopCost(loop.system, weights, answer.cost, form)
    return None


def bound_in_file_units(
    answer: CostBound, plant: MultiChannelSystem, units: Units
) -> CostBound | None:
    """As `in_file_units`, for a bound."""
    weights = weights_in(units.inverse(), answer.weights)
    owners = [0] * plant.n
    if answer.graph is not None:
        owners = [plant.index(name) for name in answer.graph.states]
    proofs = []
    for each in answer.groups:
        part = Group(plant, owners, tuple(plant.index(name) for name in each.agents))
        proofs.append([*_groups(each, part, plant, weights, units)])
    for proof in zip(*proofs, strict=True):
        if all(bound is not None for _, bound in proof):
            total = sum((bound for _, bound in proof if bound is not None), Fraction(0))
            if total >= answer.cost:
                groups = tuple(group for group, _ in proof)
                return CostBound(plant, weights, answer.cost, groups=groups, graph=answer.graph)
    return None


def _groups(
    group: CostGroup, part: Group, plant: MultiChannelSystem, weights: CostWeights, units: Units
) -> Iterator[tuple[CostGroup, Fraction | None]]:
    """The proof of a group with more and more bits, and its bound if it holds."""
    x = [units.states[k] for k in part.states]
    u = [units.of_inputs[k] for k in part.inputs]
    y = [units.of_outputs[k] for k in part.outputs]
    W = tuple(w * unit**2 for w, unit in zip(group.disturbances, x, strict=True))
    V = tuple(v * unit**2 for v, unit in zip(group.noise, y, strict=True))
    F = scaled(group.F, u, inverted(x))
    own = part.weights(weights, W, V)
    for P, S in zip(_forms(group.P, x), _forms(group.S, inverted(x)), strict=False):
        proof = P, S, F, group.share
        moved = replace(group, disturbances=W, noise=V, P=P, S=S, F=F)
        yield moved, bound_by(part.exact, own, plant.time, proof)


def _margin(answer: DiskMargin, loop: ClosedLoop, units: Units) -> DiskMargin | None:
    ports = units.of_inputs if answer.at == "inputs" else units.of_outputs
    signals, discrete = response_of(loop, answer.at).exact, is_discrete(loop.plant.time)
    parts = [
        _part(
            each,
            states_of(loop, units),
            ports,
            lambda part: part_holds(signals, part, answer.margin, discrete=discrete),
        )
        for each in answer.parts
    ]
    proved = tuple(part for part in parts if part is not None)
    if len(proved) < len(parts):
        return None
    return DiskMargin(loop.system, answer.at, answer.together, answer.margin, proved)


def _part(
    part: MarginPart,
    states: Sequence[Fraction],
    ports: Sequence[Fraction],
    holds: Callable[[MarginPart], bool],
) -> MarginPart | None:
    """The proof for some ports in the units of the file."""
    scaling = tuple(
        theta / ports[k] ** 2 for theta, k in zip(part.scaling, part.ports, strict=True)
    )
    moved = (MarginPart(part.ports, scaling, form) for form in _forms(part.P, states))
    return next(filter(holds, moved), None)


def _sectors(answer: SectorStability, loop: ClosedLoop, units: Units) -> SectorStability | None:
    response, half = sector_response(loop, answer.sectors)
    ports = range(len(half))

    def holds(part: MarginPart) -> bool:
        own = tuple(t * r**2 for t, r in zip(part.scaling, half, strict=True))
        return part_holds(
            response.exact,
            replace(part, scaling=own),
            Fraction(1),
            discrete=response.discrete,
            direct=Fraction(0),
        )

    part = MarginPart(tuple(ports), answer.scaling, answer.P)
    moved = _part(part, states_of(loop, units), units.of_inputs, holds)
    if moved is None:
        return None
    return SectorStability(loop.system, answer.sectors, moved.scaling, moved.P)


def bound_in_units(
    plant: MultiChannelSystem, weights: CostWeights, graph: CostGraph | None = None
) -> CostBound | None:
    """As `bound_of`, calculated in units near the sizes of the plant."""
    units = Units.of(plant)
    if units is None:
        return bound_of(plant, weights, graph)
    found = bound_of(system_in(units, plant), weights_in(units, weights), graph)
    return None if found is None else bound_in_file_units(found, plant, units)


def _calculated(
    loop: ClosedLoop, prove: Callable[[ClosedLoop, Units | None], Performed | None]
) -> Performed | None:
    """What is proved of a loop in units near the sizes, about the loop of the file."""
    units = Units.of(loop.plant)
    if units is None:
        return prove(loop, None)
    found = prove(loop_in(units, loop), units)
    return None if found is None else in_file_units(found, loop, units)
