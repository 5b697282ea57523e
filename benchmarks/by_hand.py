"""Controllers that a person makes by hand, with the figures of their loops.

- ``local LQR``: for each agent, the optimal state feedback of its own part of the plant, as if the
  rest were not there, with the gain of its outputs that is nearest to it in the mean;
- ``local LQG``: for each agent, the regulator and the Kalman filter of python-control for its own
  part;
- ``python-control``: the regulator and the Kalman filter of python-control for the whole plant, one
  controller for all agents.

None of them is asked for a rate.  Weights are 1, and 1/100 for the noise of outputs.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import control

from mcexact.derived.constructions import merged
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.figures import Figures, figures_of
from mcexact.synthesis.optimum.problem import FeedbackProblem, Weights, quiet_floats
from mcexact.synthesis.optimum.starts import (
    Model,
    Realization,
    local_regulators,
    localities,
    with_private_parts,
)


def lqg(model: Model) -> Realization | None:
    """The regulator and the filter of python-control; None where one of them fails."""
    A, B, C = model.A, model.B, model.C
    if not (B.any() and C.any()):
        return None
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            if model.discrete:
                F = -np.asarray(control.dlqr(A, B, model.Q, model.R)[0])
                # The gain of the prediction, A times that of the newest output.
                L = np.asarray(control.dlqe(A, np.eye(len(A)), C, model.W, model.V)[0])
            else:
                F = -np.asarray(control.lqr(A, B, model.Q, model.R)[0])
                L = np.asarray(control.lqe(A, np.eye(len(A)), C, model.W, model.V)[0])
    except Exception:  # what fails here is a row of the table, whatever it is called
        return None
    return A + B @ F - L @ C, L, F, np.zeros((len(F), len(C)))


def _local_lqr(system: MultiChannelSystem, weights: Weights) -> Figures:
    problem = FeedbackProblem.of(decentralized_network(system), (0,) * system.m, weights)
    shift = 1.0 if problem.discrete else 0.0
    parts = localities(problem, weights)
    return figures_of(problem, local_regulators(problem, parts, shift))


def _local_lqg(system: MultiChannelSystem, weights: Weights) -> Figures:
    network = decentralized_network(system)
    static = FeedbackProblem.of(network, (0,) * system.m, weights)
    made = [lqg(each.model) for each in localities(static, weights)]
    orders = [0 if each is None else len(each[0]) for each in made]
    problem = FeedbackProblem.of(network, orders, weights)
    return figures_of(problem, with_private_parts(problem, made))


def _whole_lqg(system: MultiChannelSystem, weights: Weights) -> Figures:
    return _local_lqg(merged(system, [list(system.names)]), weights)


METHODS: Mapping[str, Callable[[MultiChannelSystem, Weights], Figures]] = {
    "local LQR": _local_lqr,
    "local LQG": _local_lqg,
    "python-control": _whole_lqg,
}


def made_by_hand(system: MultiChannelSystem, cost: float | None) -> dict[str, Any]:
    """The figures of each method, with costs relative to a given one; None for unstable loops."""
    weights, found = Weights.unit(system), dict[str, Any]()
    with quiet_floats():
        for name, method in METHODS.items():
            seen = method(system, weights)
            found[name] = (
                None
                if not np.isfinite(seen.cost)
                else {
                    "order": seen.order,
                    "gain": seen.largest_gain,
                    "bound": seen.bound,
                    "margin": seen.margin,
                    "cost": seen.cost / cost if cost else None,
                    "peak": seen.peak,
                }
            )
    return found


def told_by_hand(found: Mapping[str, Any]) -> str:
    """Order, largest gain, margin and relative cost of each method."""

    def one(name: str, seen: Mapping[str, Any] | None) -> str:
        if seen is None:
            return f"{name}: not stable"
        cost = "–" if seen["cost"] is None else f"{seen['cost']:.2f}"
        return (
            f"{name}: {seen['order']} / {seen['gain']:.3g} / {seen['margin']:.2f} / {cost}, "
            f"{seen['bound']:.3g}"
        )

    return "; ".join(one(name, seen) for name, seen in found.items())
