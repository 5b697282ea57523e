"""`design_observer` designs the distributed observer of Theorem 1 as m certified agent programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

from mcexact.arguments import one_of
from mcexact.derived.feedback import checked_gains
from mcexact.errors import Impossible, InputError, LimitReached, McexactError, UsageError
from mcexact.exact.floats import Rounding
from mcexact.exact.matrix import Matrix
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.agreeing_observer import observers
from mcexact.synthesis.asking import request_for
from mcexact.synthesis.design import Design, designed
from mcexact.synthesis.extended import design_extended
from mcexact.synthesis.optimum.aims import MARGIN
from mcexact.synthesis.optimum.diagnosis import with_diagnosis
from mcexact.synthesis.optimum.loop_figures import plain_figures
from mcexact.synthesis.request import Arithmetic, Progress, Request

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
        wants to control the plant needs no estimate of the whole state in every agent.
        "least" uses a channel controller of order one less than the smaller of the two indices,
        instead of m − 1; in floating point it uses an observer of reduced order instead of nm, if
        it can be certified.
    rounding : {"decimal", "dyadic"}, optional
        How floats in ``gains`` become exact; see `MultiChannelSystem.from_float`.
    arithmetic : {"exact", "float"}
        "exact" assigns the whole spectrum, for small systems.  "float" designs for a rate or a
        radius, with a proof that is exact as well (`float_proposals`).
    progress : callable, optional
        Is told, in a few words, what is being done.

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
    and both polynomials.  A strongly connected graph is sufficient, but not necessary, since the
    question is decided for the error system itself.

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
    mcexact.errors.Impossible: the error system for these F_i is not complete: no constant K_i, \
H_ij let one agent control and observe all estimation errors
    """
    InputError.require(system, MultiChannelSystem, "system")
    one_of(order, (None, "least", "low"), "order")
    system, graph = with_graph(system, graph)
    request = request_for(system, agent, spectrum, rate, radius, arithmetic, progress)
    sizes = [system.n] * system.m
    exact = None if gains is None else checked_gains(system, gains, sizes, rounding=rounding)
    if order != "low":
        return _observer(system, graph, request, exact, order)
    if spectrum is not None or agent is not None or gains is not None:
        raise UsageError("a low order takes a rate or a radius, and no spectrum, agent or gains")
    return _better(system, graph, request)


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


def _better(system: MultiChannelSystem, graph: NeighborGraph, request: Request) -> Design:
    """Design an observer and a controller of low order, and keep the better one.

    Raises
    ------
    Impossible, LimitReached
        That of the observer, if both fail.
    """
    bound: dict[str, Any] = {request.region.word: request.region.edge}
    asked: dict[str, Any] = {"arithmetic": request.arithmetic, "progress": request.tell, **bound}
    ways: dict[str, Callable[[], Design]] = {
        "the observer": lambda: _observer(system, graph, request),
        "a controller of low order": lambda: design_extended(system, graph, **asked),
    }
    found, told, failed = dict[str, Design](), list[str](), list[McexactError]()
    for name, design in ways.items():
        try:
            found[name] = design()
        except (Impossible, LimitReached) as error:
            failed.append(error)
            told.append(f"{name}: {error}")
            continue
        seen = plain_figures(found[name].loop.closed)
        told.append(f"{name}: {seen.order} states, margin {seen.margin:.3g}, cost {seen.cost:.3g}")
    if not found:
        raise failed[0]
    best = min(found, key=lambda name: _price(found[name]))
    note = f"{best} was kept ({'; '.join(told)}; computed)"
    return replace(found[best], notes=(*request.notes, note))


def _price(made: Design) -> tuple[bool, float]:
    """Whether a design is fragile, and its cost, dearer by two percent for each state."""
    seen = plain_figures(made.loop.closed)
    return not seen.margin >= MARGIN, seen.cost * _PRICE_OF_ORDER**seen.order
