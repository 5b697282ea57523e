"""Distributed observers without a channel controller, whose agents are drawn to agree.

The agents use the optimal gains of all outputs together, and estimates that differ are drawn to
each other strongly (Kim, Shim and Cho 2016; Kim, Lee and Shim 2020).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain, product
from typing import Literal

import numpy as np

from mcexact.derived.error_system import error_system
from mcexact.derived.feedback import closed_by
from mcexact.exact.floats import matrix_from_float, matrix_to_float
from mcexact.exact.location import StabilityRegion, is_discrete
from mcexact.exact.matrix import Matrix
from mcexact.floating.margins import is_within
from mcexact.model.loop import closed_loop
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Proposal
from mcexact.synthesis.methods import ChannelController, loop_matrix, split_by_channel
from mcexact.synthesis.network.networks import decentralized_network
from mcexact.synthesis.observer.coordinates import observer_coordinates
from mcexact.synthesis.observer.observer import observer_proposals
from mcexact.synthesis.observer.programs import observer_programs
from mcexact.synthesis.observer.promising import honors, most_promising
from mcexact.synthesis.optimum.aims import MARGIN
from mcexact.synthesis.optimum.cuts import whole_model
from mcexact.synthesis.optimum.figures import Figures, central_optimum, shift_of
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.loop_figures import plain_figures
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.programs import rounded
from mcexact.synthesis.optimum.regulator import estimator, regulator
from mcexact.synthesis.optimum.weights import Floats, Weights
from mcexact.synthesis.request import Request

_STRENGTHS = (10.0, 30.0, 100.0, 3.0, 1.0)
_SHARES, _NOISES = (1.0, 0.5), (1.0, 1e1, 1e2, 1e3, 1e4, 1e5)
_DIGITS = (3, 6, 12)
_FASTER, _FASTER_THAN_STABLE, _ENOUGH = 1.1, 1.02, 1.5
_NEGLIGIBLE = 1e-9


def observers(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    request: Request,
    *,
    gains: Sequence[Matrix] | None = None,
    order: Literal["least"] | None = None,
) -> Iterator[Proposal]:
    """Yield distributed observers, where `best_agreeing` has one first that one.

    Parameters
    ----------
    system, graph, gains, order
        As in `observer_proposals`.
    request : Request
        With an agent, every observer has a channel controller.

    Notes
    -----
    If an observer without a channel controller is fragile, or in discrete time much faster than
    asked, it is compared with some others.
    """
    others = observer_proposals(system, graph, request, gains=gains, order=order)
    first = None
    if request.arithmetic == "float" and request.agent is None and not graph.delays:
        request.tell("estimates that agree")
        first = best_agreeing(system, graph, request.region, gains)
    if first is not None and (first.is_fragile or first.is_hasty):
        both = chain([first.proposal], others)
        yield from most_promising(system, graph, request.region, both, by_order=False)
        return
    if first is not None:
        yield first.proposal
    yield from others


@dataclass(frozen=True)
class Agreeing:
    """An observer without a channel controller, and the figures of its loop.

    Attributes
    ----------
    proposal : Proposal
    figures : Figures
    region : StabilityRegion
        The one asked for.
    """

    proposal: Proposal
    figures: Figures
    region: StabilityRegion

    @property
    def is_hasty(self) -> bool:
        """Whether, in discrete time, the loop is much faster than asked."""
        return not honors(self.region, self.figures.bound)

    @property
    def is_fragile(self) -> bool:
        """Whether the margin is less than designs aim at."""
        return not self.figures.margin >= MARGIN


def best_agreeing(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    gains: Sequence[Matrix] | None = None,
) -> Agreeing | None:
    """Find the observer of least cost whose agents are drawn to agree.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
        Without delays.
    region : StabilityRegion
    gains : sequence of m Matrix, optional
        Given F_i (p_i × n).

    Returns
    -------
    Agreeing or None
        Of several strengths the first with a margin of 0.3 and 1.5 times the cost of one controller
        for all agents; else the cheapest with this margin, or the most robust.  None for graphs
        that are not strongly connected, and where no loop lies in the region.

    Notes
    -----
    In floating point.  With the optimal gains F and L = [L_1 … L_m] of the shifted plant, and the
    weights w_i > 0, Σ w_i = 1, of the left null vector of the Laplacian of the graph::

        ẋ_i = (A + BF) x_i + L_i (y_i − C_i x_i)/w_i + γ Σ_j (x_j − x_i)

    The larger γ, the nearer are all x_i to one estimate with the derivative
    (A + BF) x + L (y − C x), which is that of the optimal controller.  In discrete time they are
    drawn once in each step, by a part of their differences that grows no difference::

        x_i⁺ = (A + BF) x_i + A L_i (y_i − C_i x_i)/w_i + γ A Σ_j (x_j − x_i),    γ ≤ 1/(1 + d)

    with d the largest number of agents that one receives from.  Only slow filters agree then, so
    that L is optimal for several noises, up to 100,000 times those of the outputs; loops that are
    much faster than asked come last.  The states of all agents are nm, half as many as with a
    channel controller.  Gains have 3 decimal digits if these suffice.
    """
    with quiet_floats():
        weights = agreed_weights(graph)
        if weights is None:
            return None
        found = _optimal(system, region, gains)
        if found is None:
            return None
        central = central_optimum(system, Weights.unit(system), region)
        enough = np.inf if central is None else _ENOUGH * central.figures.cost
        made = list[Agreeing]()
        for each in _tried(system, graph, region, weights, *found):
            made.append(each)
            if not each.is_fragile and not each.is_hasty and each.figures.cost <= enough:
                break
        return min(made, key=_rank, default=None)


def _rank(each: Agreeing) -> tuple[bool, bool, float]:
    """Robust ones first, of these the ones as slow as asked, the cheapest first; else by margin."""
    if each.is_fragile:
        return True, True, -each.figures.margin
    return False, each.is_hasty, each.figures.cost


def agreed_weights(graph: NeighborGraph) -> Floats | None:
    """Compute w > 0 with Σ w_i = 1 and w'Λ = 0, Λ the Laplacian; None if there is none.

    Examples
    --------
    >>> agreed_weights(NeighborGraph.from_names(["1", "2"], {"1": ["2"], "2": ["1"]})).tolist()
    [0.5, 0.5]
    >>> agreed_weights(NeighborGraph.from_names(["1", "2"], {"1": [], "2": ["1"]}))
    """
    m = graph.m
    if not graph.is_strongly_connected():
        return None
    laplacian = np.zeros((m, m))
    for i in range(m):
        for j in graph.neighborhood(i):
            laplacian[i, j] -= 1.0
            laplacian[i, i] += 1.0
    # The equations are dependent, and the last of them gives way to the sum.
    system = np.vstack([laplacian.T[:-1], np.ones(m)])
    return np.asarray(np.linalg.solve(system, np.eye(m)[-1]), dtype=np.float64)


def _optimal(
    system: MultiChannelSystem, region: StabilityRegion, gains: Sequence[Matrix] | None
) -> tuple[tuple[Matrix, ...], list[Floats]] | None:
    """The gains F_i, of few digits, and gains L for several noises, of one optimal controller."""
    stable = region.discrete and region.edge == 1
    shift = shift_of(region, _FASTER_THAN_STABLE if stable else _FASTER)
    weights = Weights.unit(system)
    problem = FeedbackProblem.of(decentralized_network(system), (0,) * system.m, weights)
    model = whole_model(problem, weights)
    noises = _NOISES if region.discrete else _NOISES[:1]
    filters = [estimator(replace(model, V=noise * model.V), shift) for noise in noises]
    # In discrete time the gain of the newest output becomes that of the prediction.
    found = [model.A @ L if region.discrete else L for L in filters if L is not None]
    if gains is not None:
        return tuple(gains), found
    F = regulator(model, shift)
    if F is None:
        return None
    for digits in _DIGITS:
        short = _short(F, digits)
        if is_within(model.A + model.B @ short, region):
            return split_by_channel(system, matrix_from_float(short, "decimal", where="F")), found
    return None


def _short(M: Floats, digits: int) -> Floats:
    """Round to some significant digits; what is negligible beside the largest entry becomes 0."""
    largest = float(np.max(np.abs(M), initial=0.0))
    return rounded(np.where(np.abs(M) < _NEGLIGIBLE * largest, 0.0, M), digits)


def _tried(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    weights: Floats,
    feedback: tuple[Matrix, ...],
    filters: Sequence[Floats],
) -> Iterator[Agreeing]:
    """Yield observers inside the region, of several strengths."""
    error = error_system(system, feedback, graph)
    for L, drawn in product(filters, [*_drawn(system, graph, feedback)]):
        for digits in _DIGITS:
            gains = _gains(system, graph, weights, L, drawn, digits)
            if is_within(matrix_to_float(closed_by(error, gains)), region):
                proposal = _proposal(system, graph, feedback, gains)
                loop = closed_loop(system, proposal.controller, graph)
                yield Agreeing(proposal, plain_figures(loop), region)
                break


def _drawn(
    system: MultiChannelSystem, graph: NeighborGraph, feedback: tuple[Matrix, ...]
) -> Iterator[Floats]:
    """Yield γI, or γA in discrete time, for several strengths γ."""
    if is_discrete(system.time):
        most = max(len([j for j in graph.neighborhood(i) if j != i]) for i in range(system.m))
        A = matrix_to_float(system.A)
        yield from (share / (1 + most) * A for share in _SHARES)
        return
    closed = matrix_to_float(loop_matrix(system, feedback))
    pace = float(np.max(np.abs(np.linalg.eigvals(closed)), initial=0.0)) or 1.0
    yield from (strength * pace * np.eye(system.n) for strength in _STRENGTHS)


def _gains(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    weights: Floats,
    L: Floats,
    drawn: Floats,
    digits: int,
) -> tuple[Matrix, ...]:
    """The gains [K_i, H_ij …] = [−L_i/w_i, −D …] that draw by D, rounded to some digits."""
    found, start = [], 0
    for i in range(system.m):
        stop = start + system.q(i)
        others = len([j for j in graph.neighborhood(i) if j != i])
        parts = [-L[:, start:stop] / weights[i], *[-drawn] * others]
        found.append(matrix_from_float(_short(np.hstack(parts), digits), "decimal", where="K"))
        start = stop
    return tuple(found)


def _proposal(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    feedback: tuple[Matrix, ...],
    gains: tuple[Matrix, ...],
) -> Proposal:
    """The agents' programs."""
    n, seen = system.n, gains[0].ncols
    none = ChannelController(
        Matrix.zeros(0, 0), Matrix.zeros(0, seen), Matrix.zeros(n, 0), Matrix.zeros(n, seen), None
    )
    controller = observer_programs(system, graph, 0, feedback, gains, none)
    parts = {
        "channel_order": 0,
        "feedback": feedback,
        "observer_gains": gains,
        "estimated": Matrix.identity(n),
    }
    return Proposal(controller, (), observer_coordinates(n, controller)[-1:], parts)
