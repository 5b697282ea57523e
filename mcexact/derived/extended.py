"""The extended system: what agents may share besides their outputs, as states of their own."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate
from typing import Literal, get_args

from mcexact.errors import InputError
from mcexact.exact.blocks import block_diagonal, hstack
from mcexact.exact.matrix import Matrix
from mcexact.model.names import quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph

Share = Literal["outputs+states", "states"]


def checked_share(share: str) -> str:
    """Return the way of sharing, or refuse it."""
    if share not in get_args(Share):
        raise InputError(
            f'expected "outputs+states" or "states", found {quoted(share)}', where="share"
        )
    return share


def checked_dimensions(system: MultiChannelSystem, dimensions: Sequence[int]) -> tuple[int, ...]:
    """Return n_1 … n_m, or refuse them."""
    found = tuple(dimensions)
    if len(found) != system.m:
        raise InputError(
            f"expected {system.m} dimensions, one for each agent, found {len(found)}",
            where="dimensions",
        )
    for i, size in enumerate(found):
        if isinstance(size, bool) or not isinstance(size, int) or size < 0:
            raise InputError(f"expected an integer >= 0, found {size!r}", where=f"dimensions[{i}]")
    return found


def selector(start: int, size: int, total: int) -> Matrix:
    """The ``total``×``size`` matrix with an identity at the rows from ``start``, else zeros.

    This is the paper's E_i, H_iδ, Q_iδ' and L_iδ.
    """
    rows = [[int(row - start == column) for column in range(size)] for row in range(total)]
    return Matrix.from_integers(rows, ncols=size)


def extended_system(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem:
    """Append to every agent i a shared sub-state x_i of dimension n_i with ẋ_i = v_i.

    Parameters
    ----------
    system : MultiChannelSystem
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    share : {"outputs+states", "states"}
        Whether agents receive their neighbors' outputs beside their sub-states.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Returns
    -------
    MultiChannelSystem
        n̄ = n + Σ n_i states.  A distributed controller of the plant is a decentralized one of it.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If the dimensions or the way of sharing are not as expected.

    Notes
    -----
    Paper, section IV-C, equation `emcs`, and Remark 2 for ``share="states"``.  In block form, with
    x̄ = (x, x_1, …, x_m), ū_i = (u_i, v_i) and ȳ_i = (y_j, j ∈ N_i, then x_j, j ∈ N_i), neighbors
    in the order of the channels::

            ⎡ A  0 ⎤            ⎡ B_i   0  ⎤            ⎡ C_{N_i}     0     ⎤
        Ā = ⎣ 0  0 ⎦ ,    B̄_i = ⎣  0   E_i ⎦ ,    C̄_i = ⎣    0     E'_{N_i} ⎦

    E_i, of Σ n_j rows and n_i columns, holds the identity at the rows of x_i, and E_{N_i} = [E_j],
    j ∈ N_i.  With ``share="states"`` C_i stands in place of C_{N_i}.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> cyclic = NeighborGraph.ring(plant.names)
    >>> extended = extended_system(plant, [0, 0, 1], graph=cyclic)
    >>> extended.n, extended.C(1).numerators
    (4, ((0, 1, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))
    """
    system, found = with_graph(system, graph)
    sizes = checked_dimensions(system, dimensions)
    checked_share(share)
    total = sum(sizes)
    starts = [0, *accumulate(sizes)]
    E = [selector(starts[i], sizes[i], total) for i in range(system.m)]
    B = [block_diagonal([system.B(i), E[i]]) for i in range(system.m)]
    C = []
    for i in range(system.m):
        heard = found.neighborhood(i)
        measured = system.output_matrix(heard if share == "outputs+states" else [i])
        C.append(block_diagonal([measured, hstack([E[j] for j in heard], nrows=total).T]))
    return system.derived(
        block_diagonal([system.A, Matrix.zeros(total, total)]),
        B,
        C,
        {"construction": "extended", "share": share, "dimensions": list(sizes)},
        neighbors=found,
    )
