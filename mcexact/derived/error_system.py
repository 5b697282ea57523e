"""The open-loop error system of the distributed observer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.derived.extended import selector
from mcexact.derived.feedback import checked_gains
from mcexact.errors import InputError
from mcexact.exact.blocks import block, block_diagonal, vstack
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


def error_system(
    system: MultiChannelSystem, gains: Sequence[Any], graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Build the m-channel system of the estimation errors e_i = x_i − x under substitution.

    Parameters
    ----------
    system : MultiChannelSystem
    gains : sequence of m matrices
        The state feedbacks F_i, p_i×n.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        nm states ε = (e_1, …, e_m), n inputs in every channel.  Decentralized static feedback of
        it by [K_i, H_ij, …] is the paper's error system without the channel controller.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If a gain has the wrong shape.

    Notes
    -----
    Paper, section II-D, equations `com.o` and `anal`.  In block form::

        Ã = I_m ⊗ (A + Σ_j B_j F_j) − Q,    Q_ij = B_j F_j,    B̃_i = b_i ⊗ I_n

        C̃_i ε = ( C_i e_i ;  e_i − e_j, j ∈ N_i∖{i}, in the order of the channels )

    b_i is the i-th unit vector of length m.  The block e_i − e_i = 0 that the paper carries along
    is left out.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[3]], [[5]]], neighbors={"1": ["2"]})
    >>> errors = error_system(plant, [[[-2]], [[-7]]])
    >>> errors.A.numerators  # 1 − 2 − 7 on the diagonal, less B_j F_j in column j
    ((-6, 7), (2, -1))
    >>> errors.C(0).numerators, errors.C(1).numerators
    (((3, 0), (1, -1)), ((0, 5),))
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, found = with_graph(system, graph)
    n, m = system.n, system.m
    exact = checked_gains(system, gains, [n] * m)
    driven = [system.B(j) @ exact[j] for j in range(m)]
    closed = sum(driven, system.A)
    A = block_diagonal([closed] * m) - block([driven] * m)
    pick = [selector(i * n, n, n * m).T for i in range(m)]
    C = []
    for i in range(m):
        others = [j for j in found.neighborhood(i) if j != i]
        C.append(vstack([system.C(i) @ pick[i], *(pick[i] - pick[j] for j in others)]))
    return system.derived(
        A,
        [each.T for each in pick],
        C,
        {"construction": "error", "gains": tuple(exact)},
        neighbors=found,
    )
