"""The extended system with delays, in which every message under way is a state."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.derived.extended import Share, exchanged
from mcexact.errors import InputError
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, require_discrete


def lifted_system(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem:
    """Extend the plant by shared sub-states and by the messages that are under way.

    Agent i receives (y_j(t−d_ij), x_j(t−d_ij)), j ∈ N_i, or x_j(t−d_ij) and its own y_i alone when
    only sub-states are shared.

    Parameters
    ----------
    system : MultiChannelSystem
        In discrete time.
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    share : {"outputs+states", "states"}
    graph : NeighborGraph, optional
        With the delays d_ij on its edges; overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        ñ = n + Σ (n_i + d_i n_i + d_i q_i) states, d_i the largest delay to a follower of i;
        without the d_i q_i when only sub-states are shared.

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the system is in continuous time.
    InputError
        If the dimensions or the way of sharing are not as expected.
    LimitReached
        If there would be more than 20000 states.

    Notes
    -----
    Paper, section V-A, equations (34) and (35).  The state is
    (x, x_1, w_1, x_2, w_2, …), w_j = (x_j(t−1), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j)), and w_j
    is empty when d_j = 0.  In block form::

            ⎡ A  0 ⎤            ⎡ B_i    0   ⎤            ⎡ C_{N⁰_i}     0     ⎤
        Ã = ⎣ G  K ⎦ ,    B̃_i = ⎣  0   H_{i0} ⎦ ,   C̃_i = ⎢    0      Q_{N⁺_i} ⎥
                                                          ⎣    0      H'_{N_i}  ⎦

        K = diag(S_{d_1+1} ⊗ I_{n_1},  S_{d_1} ⊗ I_{q_1},  S_{d_2+1} ⊗ I_{n_2},  …)
        G = (G_1; …; G_m),  G_j = (0_{(d_j+1)n_j×n}; C_j; 0_{(d_j−1)q_j×n})  for d_j ≥ 1
                            G_j = 0_{n_j×n}                                 for d_j = 0

    N⁰_i are the neighbors with d_ij = 0 and N⁺_i those with d_ij > 0, so that i receives undelayed
    outputs first, then the delayed ones, then all sub-states. H_jδ picks x_j(t−δ) and Q_jδ picks
    y_j(t−δ); H_{N_i} = [H_{j d_ij}], Q_{N⁺_i} = (Q_{j d_ij}), in the order of the channels. The
    paper's G_j would have −1 block rows when d_j = 0. With ``share="states"`` (the remark after
    Theorem 3) there are neither y_j(t−δ) nor G, and C̃_i = diag(C_i, H'_{N_i}).

    Examples
    --------
    >>> graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 2)])
    >>> plant = MultiChannelSystem(
    ...     [[1]], [[[1]], [[1]]], [[[3]], [[5]]], time="discrete", neighbors=graph)
    >>> lifted = lifted_system(plant, [0, 1])
    >>> lifted.n  # x, x_2, x_2(t-1), x_2(t-2), y_2(t-1), y_2(t-2)
    6
    >>> lifted.A.numerators[4]  # y_2(t) becomes y_2(t-1)
    (5, 0, 0, 0, 0, 0)
    >>> lifted.C(0).numerators  # agent 1 sees y_1(t), y_2(t-2), x_2(t-2)
    ((3, 0, 0, 0, 0, 0), (0, 0, 0, 0, 0, 1), (0, 0, 0, 1, 0, 0))
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, found = with_graph(system, graph)
    require_discrete(system)
    construction = {"construction": "lifted", "share": share, "dimensions": dimensions}
    return exchanged(system, found, construction, found.delay)


def held_system(
    system: MultiChannelSystem, dimensions: Sequence[int], graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Extend the plant by shared sub-states that all agents, also their owner, use d_i steps late.

    Agent i sends its sub-state to follower k after holding it for d_i − d_ki steps, and keeps it
    from itself for d_i steps, so that all followers use x_i(t−d_i) at the same time.  Measured
    outputs are not sent.

    Parameters
    ----------
    system : MultiChannelSystem
        In discrete time.
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    graph : NeighborGraph, optional
        With the delays d_ij on its edges; overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        n̂ = n + Σ (n_i + d_i n_i) states, d_i the largest delay to a follower of i.

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the system is in continuous time.
    InputError
        If the dimensions are not as expected.
    LimitReached
        If there would be more than 20000 states.

    Notes
    -----
    Paper, section V-B, equations (37) and (38).  The state is
    (x, x_1(t), …, x_1(t−d_1), x_2(t), …, x_m(t−d_m)).  In block form::

        Â = diag(A, S_{d_1+1} ⊗ I_{n_1}, …, S_{d_m+1} ⊗ I_{n_m})

              ⎡ B_i    0   ⎤            ⎡ C_i              0               ⎤
        B̂_i = ⎣  0   L_{i0} ⎦ ,   Ĉ_i = ⎣  0   [L_{j d_j}, j ∈ N_i]'       ⎦

    S_d is the d×d shift matrix and L_jδ picks x_j(t−δ), 0 ≤ δ ≤ d_j; with d_j = 0 the block is
    S_1 ⊗ I = 0, as in the extended system without delays.

    Examples
    --------
    >>> graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 2)])
    >>> plant = MultiChannelSystem(
    ...     [[1]], [[[1]], [[1]]], [[[3]], [[5]]], time="discrete", neighbors=graph)
    >>> held = held_system(plant, [0, 1])
    >>> held.n  # x, x_2, x_2(t-1), x_2(t-2)
    4
    >>> held.C(1).numerators  # agent 2 sees y_2(t) and its own x_2(t-2)
    ((5, 0, 0, 0), (0, 0, 0, 1))
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, found = with_graph(system, graph)
    require_discrete(system)
    late = [found.longest_delay(j) for j in range(system.m)]
    construction = {"construction": "held", "dimensions": dimensions}
    return exchanged(system, found, construction, lambda i, j: late[j])
