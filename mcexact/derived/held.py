"""The extended system under delays when every agent holds what it sends."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.derived.extended import checked_dimensions, selector
from mcexact.derived.lifted import require_discrete, require_size, shift
from mcexact.exact.blocks import block_diagonal, hstack, kronecker
from mcexact.exact.matrix import Matrix
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


def held_system(
    system: MultiChannelSystem, dimensions: Sequence[int], graph: NeighborGraph | None = None
) -> MultiChannelSystem:
    """Extend the plant by shared sub-states that everybody, their owner too, sees d_i steps late.

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
        With the delays d_ij on its arcs; overrides ``system.neighbors``.

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
    Paper, section V-B, equations `emcsdd-hold` and `emcsdd-hold-mtrx`.  The state is
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
    system, found = with_graph(system, graph)
    require_discrete(system)
    sizes = checked_dimensions(system, dimensions)
    m = system.m
    delays = [found.longest_delay(j) for j in range(m)]
    blocks = [(delays[j] + 1) * sizes[j] for j in range(m)]
    total = sum(blocks)
    require_size(system.n + total)

    def L(j: int, delta: int) -> Matrix:
        return selector(sum(blocks[:j]) + delta * sizes[j], sizes[j], total)

    shifts = [kronecker(shift(delays[j] + 1), Matrix.identity(sizes[j])) for j in range(m)]
    released = [
        hstack([L(j, delays[j]) for j in found.neighborhood(i)], nrows=total).T for i in range(m)
    ]
    return system.derived(
        block_diagonal([system.A, *shifts]),
        [block_diagonal([system.B(i), L(i, 0)]) for i in range(m)],
        [block_diagonal([system.C(i), released[i]]) for i in range(m)],
        {"construction": "held", "dimensions": list(sizes)},
        neighbors=found,
    )
