"""Controllers as gain matrices, and gain matrices as controllers."""

from __future__ import annotations

import numpy as np

from mcexact.exact.floats import matrix_from_float, matrix_to_float
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import Controller
from mcexact.synthesis.methods import ChannelController
from mcexact.synthesis.network.networks import (
    DerivedNetwork,
    decentralized_network,
    network_programs,
)
from mcexact.synthesis.optimum.problem import FeedbackProblem, Sizes
from mcexact.synthesis.optimum.weights import Floats, Weights

NetworkController = tuple[DerivedNetwork, Controller]
"""A network, and a controller of it."""

single_channel = decentralized_network
"""The network of a plant in which one channel has all inputs and outputs."""


def controller_of(problem: FeedbackProblem, K: Floats) -> Controller:
    """Write the agents' programs of a gain matrix, every entry as its shortest decimal.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.network.networks import decentralized_network
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [0], Weights.unit(plant))
    >>> controller_of(problem, np.array([[-2.5]])).agents[0].input.outputs[0].rows()
    ((Fraction(-5, 2),),)
    """

    def part(rows: Floats) -> Matrix:
        return matrix_from_float(rows, "decimal", where="K")

    gains, channels = [], {}
    for i, agent in enumerate(problem.agents):
        rows = np.concatenate([agent.inputs, agent.updates])
        own, heard, z = agent.private_rows, agent.heard, agent.private_columns
        gains.append(part(K[np.ix_(rows, heard)]))
        if len(own):
            channels[i] = ChannelController(
                part(K[np.ix_(own, z)]),
                part(K[np.ix_(own, heard)]),
                part(K[np.ix_(rows, z)]),
                Matrix.zeros(len(rows), len(heard)),
                None,
            )
    return network_programs(problem.network, gains, channels)


def problem_of(
    network: DerivedNetwork,
    controller: Controller,
    weights: Weights,
    sizes: Sizes | None = None,
) -> tuple[FeedbackProblem, Floats]:
    """Return the problem in which a controller of a network is a gain matrix, and this matrix.

    Parameters
    ----------
    network : DerivedNetwork
    controller : Controller
        Made for the same network, with its dimensions of sub-states.
    weights : Weights
    sizes : Sizes, optional
    """
    orders = [each.private for each in controller.agents]
    problem = FeedbackProblem.of(network, orders, weights, sizes)
    K = np.zeros(problem.mask.shape)
    for program, agent in zip(controller.agents, problem.agents, strict=True):
        rows = agent.updates, agent.private_rows, agent.inputs
        for used, place in zip(program.maps(), rows, strict=True):
            for j, M in used.outputs.items():
                K[np.ix_(place, agent.signals["y", j])] = matrix_to_float(M)
            for j, M in used.shared.items():
                K[np.ix_(place, agent.signals["x", j])] = matrix_to_float(M)
            if used.private is not None:
                K[np.ix_(place, agent.private_columns)] = matrix_to_float(used.private)
    return problem, K


def balanced(problem: FeedbackProblem, K: Floats) -> Floats:
    """Scale every state of the agents by a power of two, so that what enters and leaves it agree.

    Notes
    -----
    Exact in floating point; the eigenvalues of the loop stay.  Agents that look alike could be
    scaled differently, so that nothing is scaled while their entries have to be equal.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.network.networks import decentralized_network
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> problem = FeedbackProblem.of(decentralized_network(plant), [1], Weights.unit(plant))
    >>> balanced(problem, np.array([[-2.0, 64.0], [1.0, -1.0]])).tolist()
    [[-2.0, 8.0], [8.0, -1.0]]
    """
    K = K.copy()
    if problem.ties is not None:
        return K
    for _ in range(5):
        for row, columns in enumerate(problem.columns_of_states, start=problem.p):
            entering, leaving = K[row].copy(), K[:, columns].copy()
            entering[columns], leaving[row] = 0.0, 0.0
            sizes = float(np.linalg.norm(entering)), float(np.linalg.norm(leaving))
            if not min(sizes) > 0:
                continue
            scale = 2.0 ** round(float(np.log2(sizes[0] / sizes[1])) / 2)
            K[row] /= scale
            K[:, columns] *= scale
    return K


def rounded(K: Floats, digits: int) -> Floats:
    """Round every entry to some significant decimal digits.

    Examples
    --------
    >>> rounded(np.array([[-0.12345, 678.9]]), 2).tolist()
    [[-0.12, 680.0]]
    """
    entries = [float(f"{entry:.{digits - 1}e}") for entry in K.ravel()]
    return np.array(entries, dtype=np.float64).reshape(K.shape)
