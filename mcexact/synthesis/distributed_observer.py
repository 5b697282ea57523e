"""Control by a distributed observer.

`design_observer` designs agents that each estimate the whole state of the plant.  There are three
kinds of observers, of which `observers` yields proposals:

- with a channel controller at one agent (Theorem 1; see `observer`): exact arithmetic assigns any
  prescribed spectrum, floating point is for a rate or a radius;
- with a channel controller in each strong component of the transfer graph of the errors, over a
  graph that is not strongly connected (`_by_components`; exact and in floating point);
- without one (`best_agreeing`; Kim, Shim and Cho 2016; Kim, Lee and Shim 2020): the agents use the
  optimal gains of all outputs together, and a strong coupling makes their estimates agree.  It has
  nm states, half as many as with a channel controller of full order, and all agents have programs
  of the same form; but it needs a strongly connected graph, and only floating point makes it.

The last kind comes first in floating point over a strongly connected graph, unless an agent was
named for the channel controller; where its loop is fragile, or in discrete time much faster than
asked, it is compared with some of the first kind.  The gate certifies every loop.  With
``order="low"`` a controller of low order that estimates nothing is designed as well, and the better
one is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from itertools import product as pairs
from typing import Any, Literal

import numpy as np

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.single_channel import drawn_integers
from mcexact.answer import loops as say
from mcexact.answer.loops import refusal
from mcexact.derived.constructions import checked_gains, closed_by, error_system
from mcexact.derived.modular import generator
from mcexact.errors import Impossible, InputError, LimitReached, McexactError, UsageError, one_of
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix, Rounding, matrix_from_float, matrix_to_float
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.floating.margins import is_within
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.design import Design, designed, with_stays
from mcexact.synthesis.gate import Arithmetic, Progress, Proposal, Request
from mcexact.synthesis.network_design import (
    NetworkCandidate,
    NetworkTask,
    assigned_blocks,
    found_candidate,
    network_task,
)
from mcexact.synthesis.networks import (
    DerivedNetwork,
    decentralized_network,
    refuse_what_stays,
    stays_over,
)
from mcexact.synthesis.observer import (
    honors,
    most_promising,
    observer_coordinates,
    observer_programs,
    observer_proposals,
)
from mcexact.synthesis.optimum.diagnosis import (
    least_disk_margin,
    margin_of,
    plain_figures,
    with_diagnosis,
)
from mcexact.synthesis.optimum.figures import DISK, MARGIN, Figures, central_optimum, shift_of
from mcexact.synthesis.optimum.problem import (
    FeedbackProblem,
    Floats,
    Weights,
    quiet_floats,
    rounded,
)
from mcexact.synthesis.optimum.starts import estimator, regulator, whole_model
from mcexact.synthesis.rate import request_for
from mcexact.synthesis.state_feedback import (
    feedback_for_region,
    loop_matrix,
    split_by_channel,
)

# Observers without a channel controller, whose estimates a coupling makes agree.

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
    """Yield proposals of distributed observers; that of `best_agreeing` comes first, if it has one.

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
    plain = request.agent is None and request.spectrum is None and order is None
    if plain and not graph.delays and not graph.is_strongly_connected():
        yield from _by_components(system, graph, request, gains)
        return
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
    """Find the observer of least cost in which a coupling makes all estimates agree.

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
    corrected once in each step, by a part of their differences that lets no difference grow::

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
        optimal = _optimal(system, region, gains)
        if optimal is None:
            return None
        central = central_optimum(system, Weights.unit(system), region)
        enough = np.inf if central is None else _ENOUGH * central.figures.cost
        candidates = list[Agreeing]()
        for each in _tried(system, graph, region, weights, *optimal):
            candidates.append(each)
            if not each.is_fragile and not each.is_hasty and each.figures.cost <= enough:
                break
        return min(candidates, key=_rank, default=None)


def _rank(each: Agreeing) -> tuple[bool, bool, float]:
    """The order: robust loops first, among them those as slow as asked, then by cost or margin."""
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
    """Gains of one optimal controller: F_i, of few digits, and L for several noises of outputs."""
    stable = region.discrete and region.edge == 1
    shift = shift_of(region, _FASTER_THAN_STABLE if stable else _FASTER)
    weights = Weights.unit(system)
    problem = FeedbackProblem.of(decentralized_network(system), (0,) * system.m, weights)
    model = whole_model(problem, weights)
    noises = _NOISES if region.discrete else _NOISES[:1]
    filters = [estimator(replace(model, V=noise * model.V), shift) for noise in noises]
    # In discrete time the gain of the newest output becomes that of the prediction.
    injections = [model.A @ L if region.discrete else L for L in filters if L is not None]
    if gains is not None:
        return tuple(gains), injections
    F = regulator(model, shift)
    if F is None:
        return None
    for digits in _DIGITS:
        short = _short(F, digits)
        if is_within(model.A + model.B @ short, region):
            exact = matrix_from_float(short, "decimal", where="F")
            return split_by_channel(system, exact), injections
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
    for L, drawn in pairs(filters, [*_drawn(system, graph, feedback)]):
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
    """The gains [K_i, H_ij …] = [−L_i/w_i, −D …] with the coupling D, rounded to some digits."""
    gains, start = [], 0
    for i in range(system.m):
        stop = start + system.q(i)
        others = len([j for j in graph.neighborhood(i) if j != i])
        parts = [-L[:, start:stop] / weights[i], *[-drawn] * others]
        gains.append(matrix_from_float(_short(np.hstack(parts), digits), "decimal", where="K"))
        start = stop
    return tuple(gains)


def _proposal(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    feedback: tuple[Matrix, ...],
    gains: tuple[Matrix, ...],
) -> Proposal:
    """The agents' programs."""
    n = system.n
    controller = observer_programs(system, graph, feedback, gains, {})
    parts = {
        "channel_order": 0,
        "feedback": feedback,
        "observer_gains": gains,
        "estimated": Matrix.identity(n),
    }
    return Proposal(controller, (), observer_coordinates(n, controller)[-1:], parts)


# Observers over a graph that is not strongly connected.

_FEEDBACKS = 6


def _by_components(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    request: Request,
    gains: Sequence[Matrix] | None,
) -> Iterator[Proposal]:
    """Yield observers with a channel controller in each strong component of the error system.

    The errors are controlled as any network (`network_design`).  A mode stays fixed for them if it
    stays however much agents share over the graph, and for F_i drawn at random besides these only
    eigenvalues of A + Σ B_i F_i; campaign `any_graph` compares this with ranks of drawn plants.

    Raises
    ------
    Impossible
        If all F_i that were tried leave a mode of the errors fixed that is not fast enough.
    LimitReached
        If gains did not lead to controllers.
    """
    stuck = None
    for feedback in _feedbacks(system, request, gains):
        error = error_system(system, feedback, graph)
        fixed = fixed_spectrum(error)
        if fixed.outside(request.region):
            stuck = fixed if stuck is None else stuck
            continue
        sizes = (system.n,) * system.m
        network = DerivedNetwork("decentralized", system, graph, sizes, error, ())
        task = network_task(network, fixed, replace(request, spectrum=None))
        request.tell("observer gains for the error system")
        candidate = found_candidate(task)
        if candidate is not None:
            yield _controlled(system, graph, feedback, task, candidate)
    if stuck is not None:
        raise refusal("fixed", stuck, template=say.ERRORS_FIXED, region=request.region)
    raise LimitReached(
        "no gains were found with which one agent in each strong component moves the errors: "
        "design with shared states, by `design extended`"
    )


def _controlled(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    feedback: tuple[Matrix, ...],
    task: NetworkTask,
    candidate: NetworkCandidate,
) -> Proposal:
    """Write channel controllers of the errors as agent programs."""
    controller = observer_programs(system, graph, feedback, candidate.gains, candidate.channels)
    parts: dict[str, Any] = {
        "blocks": assigned_blocks(task, candidate),
        "feedback": feedback,
        "observer_gains": candidate.gains,
        "estimated": Matrix.identity(system.n),
    }
    polynomials: tuple[Polynomial, ...] = ()
    if task.request.arithmetic == "exact":
        of_feedback = characteristic_polynomial(loop_matrix(system, feedback))
        of_errors = product([*candidate.polynomials.values(), candidate.kept])
        polynomials = of_feedback, of_errors
        parts |= {"feedback_polynomial": of_feedback, "error_polynomial": of_errors}
    coordinates = observer_coordinates(system.n, controller)[-1:]
    return Proposal(controller, polynomials, coordinates, parts)


def _feedbacks(
    system: MultiChannelSystem, request: Request, gains: Sequence[Matrix] | None
) -> Iterator[tuple[Matrix, ...]]:
    """Yield F_i with A + Σ B_i F_i in the region, with which soon all agents act.

    An agent that does not act moves no mode that others do not observe.  So F_i are drawn, and
    the others added to them.
    """
    if gains is not None:
        yield tuple(gains)
        return
    request.tell("state feedback")
    if request.arithmetic == "float":
        with quiet_floats():
            optimal = _optimal(system, request.region, None)
        if optimal is not None:
            yield optimal[0]
    rng = generator(system, "feedback")
    yield feedback_for_region(system, request.region).gains
    for size in range(1, _FEEDBACKS):
        drawn = [drawn_integers(rng, p, system.n, size, 1.0) for p, _ in system.sizes]
        acting = MultiChannelSystem(
            loop_matrix(system, tuple(drawn)),
            [channel.B for channel in system.channels],
            [channel.C for channel in system.channels],
            time=system.time,
        )
        more = feedback_for_region(acting, request.region).gains
        yield tuple(F + each for F, each in zip(drawn, more, strict=True))


# `design_observer`, with and without a channel controller.

_PRICE_OF_ORDER = 1.02


def design_observer(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    agent: str | None = None,
    *,
    spectrum: Mapping[str, Any] | None = None,
    rate: Any = None,
    radius: Any = None,
    gains: Sequence[Any] | None = None,
    order: Literal["least", "low"] | None = None,
    rounding: Rounding | None = None,
    arithmetic: Arithmetic = "exact",
    progress: Progress | None = None,
) -> Design:
    """Design a distributed observer-based controller, with a proof of its closed-loop spectrum.

    Parameters
    ----------
    system : MultiChannelSystem
        A jointly controllable and observable plant or derived system, with n states and m channels.
    graph : NeighborGraph, optional
        A graph without delays; overrides ``system.neighbors``.
    agent : str, optional
        The agent that carries the channel controller; by default the first, in floating point and
        continuous time none if a loop without one is robust.
    spectrum : mapping, optional
        ``{"feedback": P, "error": P}``: n numbers for A + Σ B_i F_i and mn + m − 1 for the error
        system, see `spectrum_polynomial`.
    rate, radius : rational, optional
        A rate or radius to be certified, instead of a spectrum or in addition to it: every
        eigenvalue has real part below −rate (continuous time), or modulus below radius (discrete
        time).  Without a spectrum, the default is half the sensible rate.
    gains : sequence of m matrices, optional
        Given F_i (p_i×n); then ``spectrum`` has no ``"feedback"``.  With F_i = 0 this is the
        open-loop observer of section II-B, whose agents estimate the state and do not act.
    order : {"least", "low"}, optional
        "low" also designs a controller of low order over the same links, as `design_extended`, and
        keeps the better of both, which `Design.notes` tells with the figures of both: whoever
        wants to control the plant needs no estimate of the whole state in every agent.  Where
        nothing at all is asked, and the observer is fragile, this is done and told.
        "least" uses a channel controller of order one less than the smaller of the two indices,
        instead of m − 1; in floating point it uses an observer of reduced order instead of nm, if
        it can be certified.
    rounding : {"decimal", "dyadic", "simplest"}, optional
        How floats in ``gains`` become exact; see `MultiChannelSystem.from_float`.
    arithmetic : {"exact", "float"}
        "exact" assigns the whole spectrum, for small systems.  "float" designs for a rate or a
        radius, with a proof that is exact as well (`float_proposals`).
    progress : callable, optional
        A function that is called with a short description of each step.

    Returns
    -------
    Design
        See its ``parts``; agent i shares its estimate x_i of the state.

    Raises
    ------
    Impossible
        If all channels together do not control or do not observe a mode, or the error system for
        these F_i has a fixed mode or a cut; the certificate proves this.
    InputError
        If a spectrum has the wrong length; the message states the right one; or if gains are given
        that are not m matrices of p_i rows and n columns.
    LimitReached
        If no observer was found, or none could be certified; the message tells the mode that is
        nearest to being fixed, and the sensible rate.
    UsageError
        If a spectrum, rate and radius contradict each other, or the graph has delays; or if a low
        order is asked for together with a spectrum, an agent or gains.

    Notes
    -----
    Exact; paper, section II and Theorem 1.  F_i by state feedback; small K_i, H_ij with which
    channel q controls the error system with index m and observes it, and its matrix is cyclic; then
    the Brasch–Pearson controller.  Of several draws the one with the shortest numbers is kept.  The
    certificate (`proofs/distributed_observer.md`) contains the controller and proves the separation
    and both polynomials.  Over a graph that is not strongly connected it is decided first whether
    any sharing over it suffices (`stays_over`).  Without a spectrum or a named agent, one agent in
    each strong component of the transfer graph of the errors then has a channel controller.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]],
    ...                            neighbors={"1": ["2"], "2": ["1"]})
    >>> design = design_observer(plant, spectrum={"feedback": [-1], "error": [-1, -2, -3]})
    >>> str(design.parts["error_polynomial"])
    'x^3 + 6*x^2 + 11*x + 6'
    >>> design_observer(plant, {"1": [], "2": []}, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no sharing over the neighbor graph lets linear time-invariant \
control move the mode 1, which does not satisfy Re λ < -1: agent 1 receives from no other agent \
and does not observe it, and agent 2 does not control it
    """
    InputError.require(system, MultiChannelSystem, "system")
    one_of(order, (None, "least", "low"), "order")
    system, graph = with_graph(system, graph)
    arguments = system, agent, spectrum, rate, radius, arithmetic, progress
    stays = stays_over(system, graph)
    request = request_for(*arguments, least_cost=False, stays=lambda: stays)
    refuse_what_stays(system, stays, request.region)
    sizes = [system.n] * system.m
    exact = None if gains is None else checked_gains(system, gains, sizes, rounding=rounding)
    special = spectrum is not None or agent is not None or gains is not None
    if order == "low":
        if special:
            raise UsageError(
                "a low order takes a rate or a radius, and no spectrum, agent or gains"
            )
        return _better(system, graph, request)
    if order is not None or special or not request.notes:
        return with_stays(_observer(system, graph, request, exact, order), stays)
    return with_stays(_unless_fragile(system, graph, request), stays)


def _unless_fragile(system: MultiChannelSystem, graph: NeighborGraph, request: Request) -> Design:
    """Design an observer; where its loop is fragile, or there is none, compare as for low order."""
    try:
        design = _observer(system, graph, request)
    except LimitReached as failed:
        return _better(system, graph, request, failed)
    loop = design.loop.closed
    with quiet_floats():
        margin, disk = margin_of(loop), least_disk_margin(loop)
    if margin >= MARGIN and disk >= DISK:
        return design
    request.tell("a controller of low order")
    better = _better(system, graph, request, design)
    note = (
        f"the observer is fragile, with a disk margin of {disk:.2g} in a single loop and a margin "
        f"of {margin:.2g} at all inputs together (computed), so that `--order low` was tried"
    )
    return replace(better, notes=(*better.notes, note))


def _observer(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    request: Request,
    gains: Sequence[Matrix] | None = None,
    order: Literal["least"] | None = None,
) -> Design:
    """Certify the first observer that passes the gate."""
    proposals = observers(system, graph, request, gains=gains, order=order)
    try:
        return designed("observer", request, system, graph, proposals)
    except LimitReached as limit:
        raise with_diagnosis(limit, system, request.region) from None


def _better(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    request: Request,
    observer: Design | LimitReached | None = None,
) -> Design:
    """Design an observer and a controller of low order, and keep the better one.

    Without a rate the controller of low order is one of least cost.  The observer may be known, or
    why there is none.

    Raises
    ------
    Impossible, LimitReached
        That of the observer, if both fail.
    """
    chosen = bool(request.notes)
    bound: dict[str, Any] = {} if chosen else {request.region.word: request.region.edge}
    asked: dict[str, Any] = {"arithmetic": request.arithmetic, "progress": request.tell, **bound}

    def known() -> Design:
        if isinstance(observer, LimitReached):
            raise observer
        return _observer(system, graph, request) if observer is None else observer

    ways: dict[str, Callable[[], Design]] = {
        "the observer": known,
        "a controller of low order": lambda: design_extended(system, graph, **asked),
    }
    designs, outcomes, failed = dict[str, Design](), list[str](), list[McexactError]()
    for name, design in ways.items():
        try:
            designs[name] = design()
        except (Impossible, LimitReached) as error:
            failed.append(error)
            outcomes.append(f"{name}: {error}")
            continue
        seen = plain_figures(designs[name].loop.closed)
        outcomes.append(
            f"{name}: {seen.order} states, margin {seen.margin:.3g}, cost {seen.cost:.3g}"
        )
    if not designs:
        raise failed[0]
    best = min(designs, key=lambda name: _price(designs[name]))
    note = f"{best} was kept ({'; '.join(outcomes)}; computed)"
    return replace(designs[best], notes=(*designs[best].notes, note))


def _price(design: Design) -> tuple[bool, float]:
    """Whether a design is fragile, and its cost, dearer by two percent for each state."""
    loop = design.loop.closed
    seen = plain_figures(loop)
    fragile = not (seen.margin >= MARGIN and least_disk_margin(loop) >= DISK)
    return fragile, seen.cost * _PRICE_OF_ORDER**seen.order
