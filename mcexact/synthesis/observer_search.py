"""The search for an exact observer: many small lists, a channel controller for each, the best."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from math import ceil
from random import Random
from typing import Any

from mcexact.analysis.completeness import completeness
from mcexact.analysis.controllability import joint_observability
from mcexact.analysis.gains import ReachingGains, error_gain_draws, reaching_gains
from mcexact.analysis.modular_system import generator
from mcexact.answer.wording import refusals as say
from mcexact.errors import Impossible, InputError, LimitReached
from mcexact.exact.location import StabilityRegion
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.channel_controller import (
    ChannelController,
    channel_controller,
    observing_rows,
    transposed,
)
from mcexact.synthesis.gate import Progress
from mcexact.synthesis.spectrum import default_polynomial, spectrum_polynomial
from mcexact.synthesis.state_feedback import StateFeedback

_ROWS_PER_CANDIDATE = 2


@dataclass(frozen=True)
class ObserverTask:
    """What has been settled before the lists and the channel controller are chosen."""

    system: MultiChannelSystem
    graph: NeighborGraph
    agent: int
    feedback: StateFeedback
    error: MultiChannelSystem
    wanted: Mapping[str, Any]
    region: StabilityRegion
    least: bool
    tell: Progress

    def polynomial(self, degree: int) -> Polynomial:
        """The prescribed polynomial of the error system, of this degree."""
        if "error" in self.wanted:
            return spectrum_polynomial(self.wanted["error"], degree, where="spectrum.error")
        return default_polynomial(self.region, degree)

    def center(self) -> Fraction:
        """The mean of the prescribed numbers; 0 where their number is not the usual one."""
        degree = self.error.n + self.system.m - 1
        try:
            polynomial = self.polynomial(degree)
        except InputError:
            return Fraction(0)
        return -polynomial.coefficients[degree - 1] / degree if degree else Fraction(0)


def _candidates(task: ObserverTask) -> list[ReachingGains]:
    """Lists with which the agent reaches all errors, or the obstruction that no list overcomes."""
    system, agent = task.system, [task.agent]
    draw = error_gain_draws(system, task.graph, task.feedback.gains, task.center())
    # More candidates give shorter numbers; each costs some n³ operations on longer ones.
    count = max(32, min(240, 20_000 // max(1, task.error.n) ** 2))
    quick = reaching_gains(task.error, agent, draw, index=system.m, attempts=4 * count)
    found = list(islice(quick, count))
    if found:
        return found
    observable = joint_observability(system)
    if not observable.controllable:
        raise Impossible(
            say.NOT_OBSERVABLE(p=observable.uncontrollable_polynomial),
            observable.certificate,
        )
    decision = completeness(task.error)
    if not decision.complete:
        raise Impossible(say.ERRORS_NOT_COMPLETE(), decision.certificate)
    found = list(islice(reaching_gains(task.error, agent, draw, attempts=2000), count))
    if not found:
        raise LimitReached("lists K_i, H_ij exist, but 2000 draws did not find them")
    return found


def best_channel_controller(
    task: ObserverTask,
) -> tuple[ReachingGains, ChannelController, Polynomial]:
    """The lists and the channel controller with the shortest and smallest numbers.

    Returns
    -------
    lists : ReachingGains
        [K_i, H_ij …], and the matrix of the error system with them.
    channel : ChannelController
    polynomial : Polynomial
        The characteristic polynomial of the error system with both.

    Raises
    ------
    Impossible
        If no lists exist; the certificate says why.
    InputError
        If the prescribed spectrum has the wrong length.
    """
    candidates = _candidates(task)

    def index_of(each: ReachingGains) -> int:
        (seen,) = each.observability_indices
        (reached,) = each.controllability_indices
        return min(reached, seen) if task.least else reached

    index = min(map(index_of, candidates))
    polynomial = task.polynomial(task.error.n + index - 1)
    rng = generator(task.error, "channel_controller")
    best: tuple[int, ReachingGains, ChannelController] | None = None
    for k, each in enumerate(candidates):
        if index_of(each) != index:
            continue
        task.tell(f"channel controller {k + 1} of {len(candidates)}")
        for made in _channel_controllers(task, each, polynomial, index, rng):
            # Short numbers matter for the proof, small ones for whoever runs the controller.
            size = made.bit_length + 8 * ceil(made.largest).bit_length()
            if best is None or size < best[0]:
                best = (size, each, made)
    if best is None:
        raise LimitReached("no channel controller was found among the candidates")
    return best[1], best[2], polynomial


def _channel_controllers(
    task: ObserverTask, each: ReachingGains, polynomial: Polynomial, index: int, rng: Random
) -> list[ChannelController]:
    """Channel controllers for one candidate, from a few rows h each."""
    B, C = task.error.B(task.agent), task.error.C(task.agent)
    made = []
    if each.controllability_indices[0] <= index:
        for h in islice(observing_rows(each.matrix, C, rng), _ROWS_PER_CANDIDATE):
            made.append(channel_controller(each.matrix, B, C, polynomial, index=index, row=h))
        return made
    for h in islice(observing_rows(each.matrix.T, B.T, rng), _ROWS_PER_CANDIDATE):
        turned = channel_controller(each.matrix.T, C.T, B.T, polynomial, index=index, row=h)
        made.append(transposed(turned))
    return made
