"""Proposals of the distributed observer of Theorem 1, exactly or in floating point."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Literal

from mcexact.analysis.structure.controllability import joint_observability
from mcexact.arguments import one_of
from mcexact.derived.error_system import error_system
from mcexact.errors import Impossible, InputError, LimitReached, UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Proposal
from mcexact.synthesis.methods import (
    StateFeedback,
    feedback_for_region,
    given_feedback,
    observable_part,
    spectrum_polynomial,
    state_feedback,
)
from mcexact.synthesis.observer.coordinates import observer_coordinates
from mcexact.synthesis.observer.programs import observer_programs
from mcexact.synthesis.observer.search import ObserverTask, best_channel_controller
from mcexact.synthesis.request import Request


def observer_proposals(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    request: Request,
    *,
    gains: Sequence[Matrix] | None = None,
    order: Literal["least"] | None = None,
) -> Iterator[Proposal]:
    """Yield the proposals of `design_observer` for the gate; exact arithmetic yields one.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
        Without delays.
    request : Request
    gains : sequence of m Matrix, optional
        Given F_i (p_i×n).
    order : {"least"}, optional
        See `design_observer`.

    Raises
    ------
    UsageError
        If links have delays, or there is no such order.
    """
    if graph.delays:
        raise UsageError(
            "the distributed observer has no delays on its links; remove them, or design with an "
            "extended system"
        )
    one_of(order, (None, "least"), "order")
    carrier, region = request.agent or 0, request.region
    if request.arithmetic == "float":
        from mcexact.synthesis.observer.in_floating_point import float_proposals

        yield from float_proposals(
            system, graph, carrier, request, gains=gains, reduced=order == "least"
        )
        return
    wanted = _checked_spectrum(request.spectrum, gains)
    if request.spectrum is None and gains is None:
        hidden = joint_observability(system).uncontrollable_polynomial
        if hidden.degree > 0 and region.contains_roots_of(hidden):
            yield _of_the_observable_part(system, graph, carrier, request, order == "least")
            return
    request.tell("state feedback")
    feedback = _feedback(system, wanted.get("feedback"), region, gains)
    request.tell("observer gains for the error system")
    error = error_system(system, feedback.gains, graph)
    task = ObserverTask(system, graph, carrier, feedback, error, wanted, request, order == "least")
    yield _proposal(task, Matrix.identity(system.n))


def _of_the_observable_part(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    carrier: int,
    request: Request,
    least: bool,
) -> Proposal:
    """Propose agents that estimate the observable part; the unobservable modes are fast enough.

    Raises
    ------
    Impossible
        If there is an obstruction; the certificate is about the system, not about this part of it.
    LimitReached
        If the error system of the part is not complete without a fixed mode outside the region.
    """
    from mcexact.synthesis.observer.in_floating_point import refuse_if_impossible

    refuse_if_impossible(system, graph, request.region)
    part, L = observable_part(system)
    request.tell("state feedback")
    feedback = feedback_for_region(part, request.region)
    request.tell("observer gains for the error system")
    error = error_system(part, feedback.gains, graph)
    task = ObserverTask(part, graph, carrier, feedback, error, {}, request, least)
    try:
        made = _proposal(task, L)
    except Impossible:
        refuse_if_impossible(system, graph, request.region, [F @ L for F in feedback.gains])
        raise LimitReached(
            "for the F_i that were found, no constant K_i, H_ij let one agent control and observe "
            "all errors of the observable part: try floating-point arithmetic"
        ) from None
    controller = replace(made.controller, system=system.digest_of_values())
    return Proposal(controller, parts=made.parts)


def _proposal(task: ObserverTask, estimated: Matrix) -> Proposal:
    """Write the best channel controller as agent programs."""
    found, channel, error = best_channel_controller(task)
    feedback = task.feedback
    controller = observer_programs(
        task.system, task.graph, task.agent, feedback.gains, found.gains, channel
    )
    parts = {
        "agent": task.system.names[task.agent],
        "channel_order": channel.order,
        "feedback": feedback.gains,
        "feedback_polynomial": feedback.polynomial,
        "error_polynomial": error,
        "observer_gains": found.gains,
        "estimated": estimated,
    }
    coordinates = observer_coordinates(task.system.n, controller)[-1:]
    return Proposal(controller, (feedback.polynomial, error), coordinates, parts)


def _checked_spectrum(
    spectrum: Mapping[str, Any] | None, gains: Sequence[Any] | None
) -> Mapping[str, Any]:
    """Check the keys of a prescribed spectrum."""
    if spectrum is None:
        return {}
    if not isinstance(spectrum, Mapping):
        raise InputError(
            'expected {"feedback": …, "error": …}, found ' + type(spectrum).__name__,
            where="spectrum",
        )
    needed = {"error"} if gains is not None else {"feedback", "error"}
    if set(spectrum) != needed:
        raise InputError(
            f"expected the keys {', '.join(sorted(needed))}, "
            f"found {', '.join(sorted(map(str, spectrum)))}",
            where="spectrum",
        )
    return spectrum


def _feedback(
    system: MultiChannelSystem,
    wanted: Any,
    region: StabilityRegion,
    gains: Sequence[Matrix] | None,
) -> StateFeedback:
    """Return F_i with the prescribed polynomial, or for the region, or the given gains."""
    if gains is not None:
        return given_feedback(system, tuple(gains))
    if wanted is None and region.bound is not None:
        return feedback_for_region(system, region)
    return state_feedback(system, spectrum_polynomial(wanted, system.n, where="spectrum.feedback"))
