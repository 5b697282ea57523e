"""The search for an exact observer: drawn gains, their channel controllers, and the best choice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from math import ceil
from typing import Any

from mcexact.analysis.fixed_modes.completeness import completeness
from mcexact.analysis.fixed_modes.gains import ReachingGains, error_gain_draws, reaching_gains
from mcexact.analysis.structure.controllability import joint_observability
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.wording import refusals as say
from mcexact.derived.modular_system import generator
from mcexact.errors import InputError, LimitReached
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.methods import (
    ChannelController,
    StateFeedback,
    assigning_controllers,
    default_polynomial,
    spectrum_polynomial,
)
from mcexact.synthesis.request import Request

_ROWS_PER_CANDIDATE = 2


@dataclass(frozen=True)
class ObserverTask:
    """The task of an exact observer design, before gains and channel controller are chosen."""

    system: MultiChannelSystem
    graph: NeighborGraph
    agent: int
    feedback: StateFeedback
    error: MultiChannelSystem
    wanted: Mapping[str, Any]
    request: Request
    least: bool

    def polynomial(self, degree: int) -> Polynomial:
        """The prescribed polynomial of the error system, of this degree."""
        if "error" in self.wanted:
            return spectrum_polynomial(self.wanted["error"], degree, where="spectrum.error")
        return default_polynomial(self.request.region, degree)

    def center(self) -> Fraction:
        """The mean of the prescribed numbers; 0 if the number of them is unusual."""
        degree = self.error.n + self.system.m - 1
        try:
            polynomial = self.polynomial(degree)
        except InputError:
            return Fraction(0)
        return -polynomial.coefficients[degree - 1] / degree if degree else Fraction(0)


def _candidates(task: ObserverTask) -> list[ReachingGains]:
    """Find observer gains with which the agent controls and observes all errors."""
    system, agent = task.system, [task.agent]
    draw = error_gain_draws(system, task.graph, task.feedback.gains, task.center())
    # More candidates give shorter numbers, but each costs some n³ operations.
    count = max(32, min(240, 20_000 // max(1, task.error.n) ** 2))
    quick = reaching_gains(task.error, agent, draw, index=system.m, attempts=4 * count)
    found = list(islice(quick, count))
    if found:
        return found
    observable = joint_observability(system)
    if not observable.controllable:
        raise refusal("unreached", observable, told=say.NOT_OBSERVABLE)
    decision = completeness(task.error)
    if not decision.complete:
        raise refusal("not complete", decision)
    found = list(islice(reaching_gains(task.error, agent, draw, attempts=2000), count))
    if not found:
        raise LimitReached("observer gains K_i, H_ij exist, but 2000 draws did not find them")
    return found


def best_channel_controller(
    task: ObserverTask,
) -> tuple[ReachingGains, ChannelController, Polynomial]:
    """Find the observer gains and the channel controller with the shortest and smallest numbers.

    Returns
    -------
    observer_gains : ReachingGains
        [K_i, H_ij …], and the matrix of the error system with them.
    channel : ChannelController
    polynomial : Polynomial
        The characteristic polynomial of the error system with both.

    Raises
    ------
    Impossible
        If there are none; the certificate proves this.
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
    B, C = task.error.B(task.agent), task.error.C(task.agent)
    best: tuple[int, ReachingGains, ChannelController] | None = None
    for k, each in enumerate(candidates):
        if index_of(each) != index:
            continue
        task.request.tell(f"channel controller {k + 1} of {len(candidates)}")
        side = "controllable" if each.controllability_indices[0] <= index else "observable"
        controllers = assigning_controllers(
            each.matrix, B, C, polynomial, index=index, side=side, rng=rng
        )
        for made in islice(controllers, _ROWS_PER_CANDIDATE):
            # Short numbers matter for the proof, small ones for running the controller.
            size = made.bit_length + 8 * ceil(made.largest).bit_length()
            if best is None or size < best[0]:
                best = (size, each, made)
    if best is None:
        raise LimitReached("no channel controller was found among the candidates")
    return best[1], best[2], polynomial
