"""The optimal controller of all agents together, cut to what each agent knows, as a start."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from mcexact.synthesis.optimum.problem import AgentPlaces, FeedbackProblem
from mcexact.synthesis.optimum.regulator import (
    Model,
    estimator,
    output_gain,
    regulated_covariance,
    regulator,
)
from mcexact.synthesis.optimum.starts import Locality, drawn_dynamics
from mcexact.synthesis.optimum.ties import Places
from mcexact.synthesis.optimum.weights import Floats, Weights


def whole_model(problem: FeedbackProblem, weights: Weights) -> Model:
    """Return the plant with all inputs and all outputs, in the order of the channels.

    Parameters
    ----------
    problem : FeedbackProblem
    weights : Weights
    """
    n = problem.n
    C = [problem.C[agent.own][:, :n] for agent in problem.agents]
    return Model(
        problem.A[:n, :n],
        problem.B[:n, : problem.p],
        np.vstack([np.zeros((0, n)), *C]),
        weights.Q,
        weights.R,
        weights.W,
        weights.V,
        problem.discrete,
    )


def cut_gains(problem: FeedbackProblem, model: Model, shift: float) -> Floats | None:
    """Compute static gains of what each agent receives from the regulator of the whole plant.

    Parameters
    ----------
    problem : FeedbackProblem
    model : Model
        See `whole_model`.
    shift : float
        As in `riccati`.

    Returns
    -------
    ndarray, P × L, or None
        K with u_i = F_i S C̄_i'(C̄_i S C̄_i')⁺ ȳ_i, F the regulator, S the covariance of the states
        that it leads to, and ȳ_i the outputs that agent i receives; None without a regulator.
    """
    F = regulator(model, shift)
    S = None if F is None else regulated_covariance(model, F)
    if F is None or S is None:
        return None
    K = np.zeros(problem.mask.shape)
    for agent in problem.agents:
        outputs = _outputs(agent)
        gain = output_gain(F[agent.inputs], S, problem.C[outputs][:, : problem.n])
        if gain is None:
            return None
        K[np.ix_(agent.inputs, outputs)] = gain
    return K


def _outputs(agent: AgentPlaces) -> Places:
    """The columns of the outputs of the plant that an agent receives."""
    found = [columns for (what, _), columns in agent.signals.items() if what == "y"]
    return np.concatenate([np.zeros(0, dtype=np.intp), *found])


def held_states(parts: Sequence[Locality]) -> list[tuple[int, ...]]:
    """Give each state of some parts of the plant to the first agent that has it."""
    given: set[int] = set()
    found = []
    for part in parts:
        own = tuple(each for each in part.states if each not in given)
        given.update(own)
        found.append(own)
    return found


def cut_observers(
    problem: FeedbackProblem, held: Sequence[tuple[int, ...]], model: Model, shift: float
) -> Floats | None:
    """Compute K in which the agents estimate all states together, each some of them.

    Parameters
    ----------
    problem : FeedbackProblem
        Each agent has as many states as it estimates, or more; these have drawn dynamics.
    held : sequence of m tuple of int
        The states of the plant that each agent estimates, no state twice.
    model : Model
        See `whole_model`.
    shift : float
        As in `riccati`.

    Returns
    -------
    ndarray, P × L, or None
        With gains F and L of the optimal controller, in continuous time
        ẋ̂ = (A + BF) x̂ + L(y − C x̂) and u = F x̂, without the products of what an agent does not
        receive.  In discrete time x̂ is the prediction, and x̂ + L(y − C x̂) takes its place in
        u and in the next one.  None without such gains.
    """
    F, L = regulator(model, shift), estimator(model, shift)
    if F is None or L is None:
        return None
    K, updates = drawn_dynamics(problem, 0), _updates(problem)
    measured = [int(column) for agent in problem.agents for column in agent.own]
    number = {column: k for k, column in enumerate(measured)}
    for i, agent in enumerate(problem.agents):
        known = _known(problem, held, i)
        states, places = _places(known), _places(known.values())
        heard = _places(c for c in map(int, _outputs(agent)) if c in number)
        seen = _places(number[int(c)] for c in heard)
        rows, own = updates[i][: len(held[i])], _places(held[i])
        K[rows] = 0.0
        K[agent.inputs] = 0.0
        C, driven = model.C[np.ix_(seen, states)], (model.A + model.B @ F)[np.ix_(own, states)]
        used = F[np.ix_(agent.inputs, states)]
        if model.discrete:
            correction = L[np.ix_(states, seen)]
            newest = np.eye(len(states)) - correction @ C
            K[np.ix_(rows, places)] = driven @ newest
            K[np.ix_(rows, heard)] = driven @ correction
            K[np.ix_(agent.inputs, places)] = used @ newest
            K[np.ix_(agent.inputs, heard)] = used @ correction
        else:
            K[np.ix_(rows, places)] = driven - L[np.ix_(own, seen)] @ C
            K[np.ix_(rows, heard)] = L[np.ix_(own, seen)]
            K[np.ix_(agent.inputs, places)] = used
    return K * problem.mask


def _places(numbers: Iterable[int]) -> Places:
    return np.array([*numbers], dtype=np.intp)


def _updates(problem: FeedbackProblem) -> list[Places]:
    """The rows of the updates of each agent's states, those that it sends first."""
    return [np.concatenate([each.updates, each.private_rows]) for each in problem.agents]


def _known(problem: FeedbackProblem, held: Sequence[tuple[int, ...]], i: int) -> dict[int, int]:
    """The columns of the estimates that agent i knows: its own, and those that it receives."""
    agent, found = problem.agents[i], dict[int, int]()
    for (what, j), columns in agent.signals.items():
        if what == "x" and j != i:
            found |= dict(zip(held[j], map(int, columns), strict=False))
    own = agent.signals.get(("x", i), np.zeros(0, dtype=np.intp))
    places = np.concatenate([own, agent.private_columns])
    return found | dict(zip(held[i], map(int, places), strict=False))
