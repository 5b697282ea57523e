"""Controllers that a person makes by hand, with the figures of their loops.

- ``static BFGS``: one static gain for each agent, by scipy's BFGS on the cost itself, from no gain
  and from the local regulators, which a descent of the slowest eigenvalue makes stable first;
- ``local LQR``: for each agent, the optimal state feedback of its own part of the plant, as if the
  rest were not there, with the gain of its outputs that is nearest to it in the mean;
- ``local LQG``: for each agent, the regulator and the Kalman filter of python-control for its own
  part;
- ``python-control``: the regulator and the Kalman filter of python-control for the whole plant, one
  controller for all agents.

None of them is asked for a rate or a margin.  Weights are 1, and 1/100 for the noise of outputs.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

with warnings.catch_warnings():
    warnings.simplefilter("ignore")
    import control
from scipy.optimize import minimize

from mcexact.derived.constructions import merged
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.descent import Target, spectral_descent
from mcexact.synthesis.optimum.figures import MARGINS, Margins, least_cost, quadratic_costs
from mcexact.synthesis.optimum.problem import (
    Effort,
    FeedbackProblem,
    Floats,
    Weights,
    quiet_floats,
)
from mcexact.synthesis.optimum.starts import (
    Model,
    Realization,
    local_regulators,
    localities,
    with_private_parts,
)

MOST_STATES, _STEPS, _UNITS = 60, 200, 6000
"""Larger plants are left out by BFGS, which takes minutes there."""


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


Made = tuple[FeedbackProblem, Floats]


def _local_lqr(system: MultiChannelSystem, weights: Weights) -> Made:
    problem = FeedbackProblem.of(decentralized_network(system), (0,) * system.m, weights)
    shift = 1.0 if problem.discrete else 0.0
    parts = localities(problem, weights)
    return problem, local_regulators(problem, parts, shift)


def _static_bfgs(system: MultiChannelSystem, weights: Weights) -> Made | None:
    problem, local = _local_lqr(system, weights)
    if problem.n > MOST_STATES:
        return None
    edge = 1.0 if problem.discrete else 0.0

    def cost(x: Floats) -> tuple[float, Floats]:
        [(value, G)] = quadratic_costs(problem, problem.gain(x), (edge,))
        return (value, problem.gradient(G)) if np.isfinite(value) else (1e30, np.zeros_like(x))

    found = list[tuple[float, Floats]]()
    target = Target(StabilityRegion(system.time))
    for start in (np.zeros_like(local), local):
        x = problem.entries(start)
        if cost(x)[0] >= 1e30:
            x = spectral_descent(problem, x, target, Effort(_UNITS))
        if cost(x)[0] < 1e30:
            result = minimize(cost, x, jac=True, method="BFGS", options={"maxiter": _STEPS})
            found.append((float(result.fun), problem.gain(result.x)))
    best = min(found, key=lambda each: each[0], default=(np.inf, local))
    return problem, best[1]


def _local_lqg(system: MultiChannelSystem, weights: Weights) -> Made:
    network = decentralized_network(system)
    static = FeedbackProblem.of(network, (0,) * system.m, weights)
    made = [lqg(each.model) for each in localities(static, weights)]
    orders = [0 if each is None else len(each[0]) for each in made]
    problem = FeedbackProblem.of(network, orders, weights)
    return problem, with_private_parts(problem, made)


def _whole_lqg(system: MultiChannelSystem, weights: Weights) -> Made:
    return _local_lqg(merged(system, [list(system.names)]), weights)


METHODS: Mapping[str, Callable[[MultiChannelSystem, Weights], Made | None]] = {
    "static BFGS": _static_bfgs,
    "local LQR": _local_lqr,
    "local LQG": _local_lqg,
    "python-control": _whole_lqg,
}


def made_by_hand(system: MultiChannelSystem) -> dict[str, Any]:
    """The figures of each method; None for loops that are not stable, and no row if left out."""
    weights, found = Weights.unit(system), dict[str, Any]()
    least = least_cost(system, weights)
    with quiet_floats():
        for name, method in METHODS.items():
            made = method(system, weights)
            if made is not None:
                found[name] = _seen(*made, least)
    return found


def _seen(problem: FeedbackProblem, K: Floats, least: float | None) -> dict[str, Any] | None:
    """Order, cost over the bound, and the least disk margin of a single loop."""
    [(cost, _)] = quadratic_costs(problem, K, (1.0 if problem.discrete else 0.0,))
    if not np.isfinite(cost):
        return None
    return {
        "order": problem.order,
        "over bound": None if least is None else cost / least,
        "disk": Margins(problem, K).peaks(MARGINS).disk,
    }


def told_by_hand(found: Mapping[str, Any]) -> str:
    """Order, cost over the bound and disk margin of each method."""

    def one(name: str, seen: Mapping[str, Any] | None) -> str:
        if seen is None:
            return f"{name}: not stable"
        ratio = "–" if seen["over bound"] is None else f"{seen['over bound']:.3g}"
        return f"{name}: {seen['order']} / {ratio} / {seen['disk']:.2f}"

    return "; ".join(one(name, seen) for name, seen in found.items())
