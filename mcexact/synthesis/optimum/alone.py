"""Controllers of low order that each agent finds for its own part of the plant."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.effort import Effort
from mcexact.synthesis.optimum.polish import Target, drafted, inside
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.programs import single_channel
from mcexact.synthesis.optimum.regulator import Model
from mcexact.synthesis.optimum.starts import Locality, Realization, drawn_dynamics
from mcexact.synthesis.optimum.weights import Weights

_SEEDS = 4


def found_alone(
    parts: Sequence[Locality], order: int, target: Target, effort: Effort
) -> list[Realization | None]:
    """Search a controller of each agent's own part, of some order; None where none was found.

    Notes
    -----
    Equal parts are searched once.
    """
    known: dict[bytes, Realization | None] = {}
    found = []
    for part in parts:
        model = part.model
        key = b"|".join(each.tobytes() for each in (model.A, model.B, model.C))
        if key not in known:
            known[key] = _searched(model, order, target, effort)
        found.append(known[key])
    return found


def _searched(model: Model, order: int, target: Target, effort: Effort) -> Realization | None:
    """The best of a few drawn starts, followed for a while."""
    if not (model.B.any() and model.C.any()):
        return None
    plant = MultiChannelSystem.from_float(
        model.A, [model.B], [model.C], rounding="dyadic", time=target.region.time
    )
    weights = Weights(model.Q, model.R, model.W, model.V)
    problem = FeedbackProblem.of(single_channel(plant), (order,), weights)
    best, least = None, np.inf
    for seed in range(_SEEDS):
        start = problem.entries(drawn_dynamics(problem, seed))
        x = inside(problem, start, target, effort.part(0.1))
        if x is None:
            continue
        x, value = drafted(problem, x, target, effort.part(0.1))
        if value < least:
            best, least = problem.gain(x), value
    if best is None:
        return None
    p, q = len(model.B.T), len(model.C)
    return best[p:, q:], best[p:, :q], best[:p, q:], best[:p, :q]
