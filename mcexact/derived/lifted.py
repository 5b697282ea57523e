"""The extended system under delays: every message on the wires is a state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mcexact.derived.extended import Share, checked_dimensions, checked_share, selector
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.blocks import block_diagonal, hstack, kronecker, vstack
from mcexact.exact.matrix import Matrix
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph

LARGEST = 20_000
"""States that a lifted or held system may have; a delay in a file can ask for any number."""


def shift(d: int) -> Matrix:
    """S_d, the d×d shift matrix: ones just below the diagonal.

    Examples
    --------
    >>> shift(3).numerators
    ((0, 0, 0), (1, 0, 0), (0, 1, 0))
    """
    return Matrix.from_integers([[int(i == j + 1) for j in range(d)] for i in range(d)], ncols=d)


def require_discrete(system: MultiChannelSystem) -> None:
    """Refuse continuous time.

    Raises
    ------
    UsageError
        If the system is in continuous time.
    """
    if system.time != "discrete":
        raise UsageError(
            'delays are analyzed in discrete time only; this system has "time": "continuous"'
        )


def require_size(states: int) -> None:
    """Refuse a system of absurdly many states.

    Raises
    ------
    LimitReached
        Beyond `LARGEST` states.
    """
    if states > LARGEST:
        raise LimitReached(
            f"the delays make a system of {states} states, more than {LARGEST}; shorten the delays"
        )


@dataclass(frozen=True)
class _Layout:
    """Where x_j(t−δ) and y_j(t−δ) stand among the states behind x."""

    sizes: tuple[int, ...]
    outputs: tuple[int, ...]
    delays: tuple[int, ...]

    @property
    def total(self) -> int:
        return sum(self._block(j) for j in range(len(self.sizes)))

    def _block(self, j: int) -> int:
        return self.sizes[j] + self.delays[j] * (self.sizes[j] + self.outputs[j])

    def _start(self, j: int) -> int:
        return sum(self._block(k) for k in range(j))

    def H(self, j: int, delta: int) -> Matrix:
        """H_jδ: picks x_j(t−δ), 0 ≤ δ ≤ d_j."""
        return selector(self._start(j) + delta * self.sizes[j], self.sizes[j], self.total)

    def Q(self, j: int, delta: int) -> Matrix:
        """Q_jδ: picks y_j(t−δ), 1 ≤ δ ≤ d_j."""
        behind = (self.delays[j] + 1) * self.sizes[j] + (delta - 1) * self.outputs[j]
        return selector(self._start(j) + behind, self.outputs[j], self.total).T


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
        With the delays d_ij on its arcs; overrides ``system.neighbors``.

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
    Paper, section V-A, equations `emcsdd` and `emcsdd-mtrx`.  The state is
    (x, x_1, w_1, x_2, w_2, …), w_j = (x_j(t−1), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j)), and w_j
    is empty when d_j = 0.  In block form::

            ⎡ A  0 ⎤            ⎡ B_i    0   ⎤            ⎡ C_{N⁰_i}     0     ⎤
        Ã = ⎣ G  K ⎦ ,    B̃_i = ⎣  0   H_{i0} ⎦ ,   C̃_i = ⎢    0      Q_{N⁺_i} ⎥
                                                          ⎣    0      H'_{N_i}  ⎦

        K = diag(S_{d_1+1} ⊗ I_{n_1},  S_{d_1} ⊗ I_{q_1},  S_{d_2+1} ⊗ I_{n_2},  …)
        G = (G_1; …; G_m),  G_j = (0_{(d_j+1)n_j×n}; C_j; 0_{(d_j−1)q_j×n})  for d_j ≥ 1
                            G_j = 0_{n_j×n}                                 for d_j = 0

    N⁰_i are the neighbors with d_ij = 0 and N⁺_i those with d_ij > 0, so that i sees undelayed
    outputs first, then the delayed ones, then all sub-states.  H_jδ picks x_j(t−δ) and Q_jδ picks
    y_j(t−δ); H_{N_i} = [H_{j d_ij}], Q_{N⁺_i} = (Q_{j d_ij}), in the order of the channels.  The
    paper's G_j would have −1 block rows when d_j = 0.  With ``share="states"`` (the remark after
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
    system, found = with_graph(system, graph)
    require_discrete(system)
    sizes = checked_dimensions(system, dimensions)
    checked_share(share)
    m, both = system.m, share == "outputs+states"
    outputs = tuple(system.q(j) if both else 0 for j in range(m))
    layout = _Layout(sizes, outputs, tuple(found.longest_delay(j) for j in range(m)))
    require_size(system.n + layout.total)
    G, K = [], []
    for j in range(m):
        d, n_j, q_j = layout.delays[j], sizes[j], outputs[j]
        K += [kronecker(shift(d + 1), Matrix.identity(n_j))]
        K += [kronecker(shift(d), Matrix.identity(q_j))]
        G.append(Matrix.zeros((d + 1) * n_j, system.n))
        if d and both:
            G += [system.C(j), Matrix.zeros((d - 1) * q_j, system.n)]
    A = vstack(
        [
            hstack([system.A, Matrix.zeros(system.n, layout.total)]),
            hstack([vstack(G, ncols=system.n), block_diagonal(K)]),
        ]
    )
    return system.derived(
        A,
        [block_diagonal([system.B(i), layout.H(i, 0)]) for i in range(m)],
        [_seen(system, found, layout, i, both) for i in range(m)],
        {"construction": "lifted", "share": share, "dimensions": list(sizes)},
        neighbors=found,
    )


def _seen(
    system: MultiChannelSystem, graph: NeighborGraph, layout: _Layout, i: int, both: bool
) -> Matrix:
    """C̃_i."""
    heard = graph.neighborhood(i)
    at_once = [j for j in heard if not graph.delay(i, j)] if both else [i]
    late = [j for j in heard if graph.delay(i, j)] if both else []
    lower = vstack(
        [
            *(layout.Q(j, graph.delay(i, j)) for j in late),
            *(layout.H(j, graph.delay(i, j)).T for j in heard),
        ],
        ncols=layout.total,
    )
    return block_diagonal([system.output_matrix(at_once), lower])
