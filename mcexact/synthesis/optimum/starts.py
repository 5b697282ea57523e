"""Gain matrices from which a search starts: controllers that each agent designs for itself."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.regulator import (
    Model,
    gaussian_controller,
    output_gain,
    regulated_covariance,
    regulator,
)
from mcexact.synthesis.optimum.weights import Floats, Weights

Realization = tuple[Floats, Floats, Floats, Floats]
"""A controller ż = A z + B y, u = C z + D y."""

_NEGLIGIBLE = 1e-9
_SLOWER = 8.0
_MUCH = 0.02


@dataclass(frozen=True, eq=False)
class Locality:
    """The part of the plant that one agent takes for the whole.

    Attributes
    ----------
    states : tuple of int
    model : Model
        The states with the agent's own input and output.
    """

    states: tuple[int, ...]
    model: Model


def localities(
    problem: FeedbackProblem, weights: Weights, *, driven: bool = False, much: bool = False
) -> list[Locality]:
    """Return the part of the plant of each agent.

    These are the states that its outputs read and its inputs drive; a state that belongs to nobody
    joins the agent with whose states it is coupled most.

    Parameters
    ----------
    problem : FeedbackProblem
    weights : Weights
    driven : bool
        Take the states that its inputs drive alone; then an output may read states of others, too.
    much : bool
        Take the states on which its inputs have more than a fiftieth of their largest effect: where
        inputs are held between samples, every state near by is driven a little.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.network.networks import decentralized_network
    >>> plant = MultiChannelSystem(
    ...     [[0, 1, 0], [0, 0, 1], [0, 0, 0]], [[[1], [0], [0]], [[0], [0], [1]]],
    ...     [[[1, 0, 0]], [[0, 0, 1]]])
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [0, 0], Weights.unit(plant))
    >>> [each.states for each in localities(problem, Weights.unit(plant))]
    [(0, 1), (2,)]
    """
    n, given = problem.n, problem.network.given
    A, B, C = problem.A[:n, :n], problem.B[:n], problem.C[:, :n]
    sets = []
    for agent in problem.agents:
        effects = np.max(np.abs(B[:, agent.inputs]), axis=1, initial=0.0)
        touched = effects > (_MUCH * np.max(effects, initial=0.0) if much else 0.0)
        if not driven:
            touched = touched | np.any(C[agent.own] != 0, axis=0)
        sets.append(set(map(int, np.flatnonzero(touched))))
    _adopt(np.abs(A) + np.abs(A).T, sets)
    found, start = [], 0
    for i, (agent, states) in enumerate(zip(problem.agents, sets, strict=True)):
        s = np.array(sorted(states), dtype=np.intp)
        square, inputs = np.ix_(s, s), agent.inputs
        outputs = np.arange(start, start + given.q(i))
        start += given.q(i)
        model = Model(
            A[square],
            B[np.ix_(s, inputs)],
            C[np.ix_(agent.own, s)],
            weights.Q[square],
            weights.R[np.ix_(inputs, inputs)],
            weights.W[square],
            weights.V[np.ix_(outputs, outputs)],
            problem.discrete,
        )
        found.append(Locality(tuple(sorted(states)), model))
    return found


def _adopt(coupling: Floats, sets: list[set[int]]) -> None:
    """Add every state that belongs to nobody to the set with which it is coupled most."""
    negligible = _NEGLIGIBLE * float(np.max(coupling, initial=0.0))
    missing = set(range(len(coupling))).difference(*sets)
    grown = True
    while missing and grown:
        grown = False
        for state in sorted(missing):
            strengths = [float(np.sum(coupling[state, sorted(each)])) for each in sets]
            if max(strengths, default=0.0) > negligible:
                sets[int(np.argmax(strengths))].add(state)
                missing.discard(state)
                grown = True


def local_regulators(problem: FeedbackProblem, parts: Sequence[Locality], shift: float) -> Floats:
    """Compute static gains of each agent's own output from the regulators of its own states.

    Parameters
    ----------
    problem : FeedbackProblem
    parts : sequence of Locality
    shift : float
        As in `riccati`.

    Returns
    -------
    ndarray, P × L
        K with u_i = F S C'(C S C')⁺ y_i, S the covariance of the states that F leads to: F itself
        where the outputs determine the states, else what is nearest to it in the mean.
    """
    K = np.zeros(problem.mask.shape)
    for agent, part in zip(problem.agents, parts, strict=True):
        model = part.model
        if not (model.B.any() and model.C.any()):
            continue
        F = regulator(model, shift)
        S = None if F is None else regulated_covariance(model, F)
        gain = None if F is None or S is None else output_gain(F, S, model.C)
        if gain is not None:
            K[np.ix_(agent.inputs, agent.own)] = gain
    return K


def local_observers(parts: Sequence[Locality], shift: float) -> list[Realization | None]:
    """Compute the optimal controller (A, B, C, D) of each agent's own part; None where it fails."""
    return [
        gaussian_controller(part.model, shift)
        if part.model.B.any() and part.model.C.any()
        else None
        for part in parts
    ]


def with_private_parts(
    problem: FeedbackProblem,
    parts: Sequence[Realization | None],
) -> Floats:
    """Return K in which agents use their controllers of their own outputs, and nothing else."""
    K = np.zeros(problem.mask.shape)
    for agent, part in zip(problem.agents, parts, strict=True):
        if part is None:
            continue
        A, B, C, D = part
        K[np.ix_(agent.private_rows, agent.private_columns)] = A
        K[np.ix_(agent.private_rows, agent.own)] = B
        K[np.ix_(agent.inputs, agent.private_columns)] = C
        K[np.ix_(agent.inputs, agent.own)] = D
    return K


def drawn_dynamics(
    problem: FeedbackProblem,
    seed: int,
    static: tuple[FeedbackProblem, Floats] | None = None,
) -> Floats:
    """Draw K with stable dynamics of the agents' states, weakly coupled with their signals.

    Parameters
    ----------
    problem : FeedbackProblem
    seed : int
    static : pair of FeedbackProblem and ndarray, optional
        A gain matrix of a problem with the same agents, whose gains from outputs of the plant to
        its inputs are taken.

    Notes
    -----
    The numbers are drawn by numpy's PCG64, which gives the same ones everywhere.  Higher seeds give
    slower dynamics.
    """
    rng = np.random.Generator(np.random.PCG64(seed))
    K = 0.1 * rng.standard_normal(problem.mask.shape) * problem.scale
    own, slower = rng.random(len(problem.columns_of_states)), _SLOWER ** (seed // 2)
    for row, columns in enumerate(problem.columns_of_states, start=problem.p):
        part = own[row - problem.p]
        K[row, columns] = 0.3 * part if problem.discrete else -(1 + 0.5 * part) / slower
        K[row, columns] *= problem.scale[row, columns]
    for agent in problem.agents:
        for (what, _), columns in agent.signals.items():
            if what == "y":
                K[np.ix_(agent.inputs, columns)] = 0.0
    if static is not None:
        source, gains = static
        for agent, other in zip(problem.agents, source.agents, strict=True):
            for signal, columns in agent.signals.items():
                if signal[0] == "y" and signal in other.signals:
                    taken = gains[np.ix_(other.inputs, other.signals[signal])]
                    K[np.ix_(agent.inputs, columns)] = taken
    return K * problem.mask
