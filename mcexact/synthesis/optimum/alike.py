"""Agents that look alike use the same program: few entries to search instead of many."""

from __future__ import annotations

from collections.abc import Hashable

import numpy as np

from mcexact.synthesis.optimum.problem import AgentPlaces, FeedbackProblem
from mcexact.synthesis.optimum.starts import Locality, localities
from mcexact.synthesis.optimum.ties import Places, Ties
from mcexact.synthesis.optimum.weights import Floats, Weights

_SMALL = 0.01
"""Entries below this part of the largest one do not make agents different."""


def tied(problem: FeedbackProblem, weights: Weights) -> FeedbackProblem:
    """Let agents that look alike use the same program.

    Parameters
    ----------
    problem : FeedbackProblem
    weights : Weights
        Of the plant.

    Returns
    -------
    FeedbackProblem
        The given one if no two agents look alike.

    Notes
    -----
    Agents look alike if their matrices have the same shapes, if they receive the same signals from
    agents that stand equally far from them in the order of the channels, around its end, and if the
    parts of the plant that they drive have entries at the same places, small ones aside.  A program
    for all vehicles of a platoon but the first and the last has some ten entries where the programs
    of all have thousands, and its search takes as many fewer steps.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.network.networks import decentralized_network
    >>> plant = MultiChannelSystem(
    ...     [[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> weights = Weights.unit(plant)
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [0, 0], weights)
    >>> alike = tied(problem, weights)
    >>> alike.size, alike.gain(np.array([-3.0])).tolist()
    (1, [[-3.0, 0.0], [0.0, -3.0]])
    """
    alike = _alike(problem, localities(problem, weights, driven=True))
    if len(alike) == len(problem.agents):
        return problem
    number = np.full(problem.mask.shape, -1)
    chosen = np.zeros(problem.mask.shape, dtype=np.bool_)
    start = 0
    for group in alike:
        typical = group[len(group) // 2]
        for i in group:
            agent = problem.agents[i]
            where = np.ix_(agent.rows, _columns(agent, i, len(problem.agents)))
            shape = number[where].shape
            number[where] = start + np.arange(np.prod(shape, dtype=int)).reshape(shape)
            chosen[where] = i == typical
        start = int(np.max(number, initial=-1)) + 1
    return problem.with_ties(Ties(number[problem.mask], chosen[problem.mask]))


def _alike(problem: FeedbackProblem, parts: list[Locality]) -> list[list[int]]:
    """The agents, those together that look alike."""
    found: dict[Hashable, list[int]] = {}
    m = len(problem.agents)
    for i, (agent, part) in enumerate(zip(problem.agents, parts, strict=True)):
        signals = tuple(
            (*_stands(signal, i, m), len(agent.signals[signal])) for signal in agent.signals
        )
        sizes = len(agent.inputs), len(agent.updates), len(agent.private_rows)
        model = part.model
        entries = tuple(map(_pattern, (model.A, model.B, model.C)))
        found.setdefault((sizes, frozenset(signals), entries), []).append(i)
    return [*found.values()]


def _stands(signal: tuple[str, int], i: int, m: int) -> tuple[str, int]:
    """What a signal is, and how far from an agent its sender stands."""
    what, j = signal
    return what, (j - i) % m


def _columns(agent: AgentPlaces, i: int, m: int) -> Places:
    """The columns of everything that an agent uses, in an order that agents alike share."""
    signals = sorted(agent.signals, key=lambda each: _stands(each, i, m))
    return np.concatenate([*(agent.signals[each] for each in signals), agent.private_columns])


def _pattern(M: Floats) -> tuple[tuple[int, ...], bytes]:
    """The shape of a matrix, and where its entries are not small."""
    return M.shape, (np.abs(M) > _SMALL * np.max(np.abs(M), initial=0.0)).tobytes()
