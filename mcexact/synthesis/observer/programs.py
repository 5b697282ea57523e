"""Agent programs of distributed observers."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.methods import ChannelController, loop_matrix


def observer_programs(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    feedback: Sequence[Matrix],
    observer_gains: Sequence[Matrix],
    channel: ChannelController,
) -> Controller:
    """Write the observer as agent programs.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
    agent : int
        q, counted from 0.
    feedback : sequence of Matrix
        F_i, p_i×n.
    observer_gains : sequence of Matrix
        [K_i, H_ij, j ∈ N_i∖{i}], n×(q_i + n(|N_i| − 1)), of the open-loop observer.
    channel : ChannelController
        The channel controller, for channel q of the error system.

    Notes
    -----
    Paper, section II-C, equations (10) and (11)::

        ẋ_i = (A + Σ B_jF_j + K_iC_i) x_i − K_i y_i + Σ H_ij (x_i − x_j)  (+ C̄ z for i = q)
        ż   = Ā z + K̄ (C_q x_q − y_q) + Σ H̄_j (x_q − x_j),     u_i = F_i x_i
    """
    n, closed = system.n, loop_matrix(system, tuple(feedback))
    programs = []
    for i in range(system.m):
        others = [j for j in graph.neighborhood(i) if j != i]
        own = observer_gains[i] + channel.D if i == agent else observer_gains[i]
        update = _innovation(system, i, others, own, closed)
        private, private_update = 0, LinearMap()
        if i == agent:
            private = channel.order
            update = LinearMap(update.outputs, update.shared, channel.C)
            driven = _innovation(system, i, others, channel.B, Matrix.zeros(private, n))
            private_update = LinearMap(driven.outputs, driven.shared, channel.A)
        programs.append(
            AgentProgram(
                system.names[i],
                n,
                private,
                update.without_zeros(),
                private_update.without_zeros(),
                LinearMap(shared={i: feedback[i]}).without_zeros(),
            )
        )
    return Controller(system.time, system.digest_of_values(), tuple(programs))


def _innovation(
    system: MultiChannelSystem, i: int, others: Sequence[int], gains: Matrix, own: Matrix
) -> LinearMap:
    """own x_i + K (C_i x_i − y_i) + Σ_j H_j (x_i − x_j) with [K, H_j, …] = gains."""
    n, q = system.n, system.q(i)
    K = gains.take(cols=range(q))
    shared = {}
    total = own + K @ system.C(i)
    for k, j in enumerate(others):
        H = gains.take(cols=range(q + k * n, q + (k + 1) * n))
        total = total + H
        shared[j] = -H
    shared[i] = total
    return LinearMap({i: -K}, shared)
