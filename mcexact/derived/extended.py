"""The extended system, in which agents share sub-states in addition to their outputs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import accumulate
from typing import Any, Literal, get_args, overload

from mcexact.arguments import one_of, several
from mcexact.derived.links import add_links
from mcexact.derived.moved_entries import moved
from mcexact.errors import InputError, LimitReached
from mcexact.exact.blocks import block, block_diagonal, hstack, kronecker, vstack
from mcexact.exact.matrix import Matrix
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

Share = Literal["outputs+states", "states"]

LARGEST = 20_000
"""The largest number of states of a derived system, since delays in a file may be large."""


def checked_share(share: str) -> str:
    """Check and return the way of sharing.

    Raises
    ------
    InputError
        If it is neither ``"outputs+states"`` nor ``"states"``.
    """
    one_of(share, get_args(Share), "share", InputError)
    return share


def checked_dimensions(system: MultiChannelSystem, dimensions: Sequence[int]) -> tuple[int, ...]:
    """Check and return the dimensions n_1 … n_m of the shared sub-states.

    Raises
    ------
    InputError
        If their number is not m, or one is negative or not an integer.
    """
    found = several(dimensions, "dimensions", "integers")
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

    Examples
    --------
    >>> selector(1, 2, 3).numerators
    ((0, 0), (1, 0), (0, 1))
    """
    return Matrix.from_entries((total, size), [(start + k, k, 1) for k in range(size)])


def shift(d: int) -> Matrix:
    """S_d, the d×d shift matrix: ones just below the diagonal.

    Examples
    --------
    >>> shift(3).numerators
    ((0, 0, 0), (1, 0, 0), (0, 1, 0))
    """
    return Matrix.from_entries((d, d), [(j + 1, j, 1) for j in range(d - 1)])


def require_size(states: int) -> None:
    """Raise an error for a system with too many states.

    Raises
    ------
    LimitReached
        If there are more than `LARGEST` states.
    """
    if states > LARGEST:
        raise LimitReached(
            f"this would be a system of {states} states, more than {LARGEST}; share fewer states, "
            "or shorten the delays"
        )


@overload
def extended_system(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem: ...


@overload
def extended_system(
    system: ParametricSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> ParametricSystem: ...


def extended_system(
    system: MultiChannelSystem | ParametricSystem,
    dimensions: Sequence[int],
    share: Share = "outputs+states",
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem | ParametricSystem:
    """Append to every agent i a shared sub-state x_i of dimension n_i with ẋ_i = v_i.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
    dimensions : sequence of m int
        n_1 … n_m, each ≥ 0.
    share : {"outputs+states", "states"}
        Whether agents receive their neighbors' outputs in addition to their sub-states.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``; a system with parameters has none of its own.

    Returns
    -------
    MultiChannelSystem or ParametricSystem
        n̄ = n + Σ n_i states.  A distributed controller of the plant is a decentralized one of it.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If the dimensions or the way of sharing are not as expected.

    Notes
    -----
    Paper, section IV-C, equation (25), and Remark 2 for ``share="states"``.  In block form, with
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
    if isinstance(system, ParametricSystem):
        links = () if graph is None else graph.edges()
        return moved(
            system,
            lambda bare: extended_system(
                add_links(bare, links) if links else bare, dimensions, share
            ),
        )
    InputError.require(system, MultiChannelSystem, "system")
    system, found = with_graph(system, graph)
    construction = {"construction": "extended", "share": share, "dimensions": dimensions}
    return exchanged(system, found, construction, lambda i, j: 0)


def exchanged(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    construction: Mapping[str, Any],
    delay: Callable[[int, int], int],
) -> MultiChannelSystem:
    """Append shared sub-states and the messages under way, as `lifted_system` draws them.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
    construction : mapping
        Its ``dimensions`` n_1 … n_m, and what agents ``share``, by default sub-states alone.
    delay : function of i and j
        The number of steps after which agent i receives x_j, and y_j if outputs are shared.
    """
    sizes = checked_dimensions(system, construction["dimensions"])
    both = checked_share(construction.get("share", "states")) == "outputs+states"
    n, m = system.n, system.m
    seen = [{j: delay(i, j) for j in graph.neighborhood(i)} for i in range(m)]
    late = [max(steps.get(j, 0) for steps in seen) for j in range(m)]
    sent = [system.q(j) if both else 0 for j in range(m)]
    blocks = [k + d * (k + q) for d, k, q in zip(late, sizes, sent, strict=True)]
    starts = [0, *accumulate(blocks)]
    require_size(n + starts[m])

    def x(j: int, steps: int) -> Matrix:
        return selector(starts[j] + steps * sizes[j], sizes[j], starts[m])

    def y(j: int, steps: int) -> Matrix:
        behind = (late[j] + 1) * sizes[j] + (steps - 1) * sent[j]
        return selector(starts[j] + behind, sent[j], starts[m])

    K, G, C = [], [], []
    for j, d in enumerate(late):
        K += [kronecker(shift(d + 1), Matrix.identity(sizes[j]))]
        K += [kronecker(shift(d), Matrix.identity(sent[j]))]
        entering = system.C(j) if both and d else Matrix.zeros(0, n)
        G += [Matrix.zeros((d + 1) * sizes[j], n), entering]
        G += [Matrix.zeros(d * sent[j] - entering.nrows, n)]
    for i, steps in enumerate(seen):
        at_once = [j for j in steps if not steps[j]] if both else [i]
        under_way = [y(j, steps[j]) for j in steps if steps[j] and both]
        states = [x(j, steps[j]) for j in steps]
        received = hstack([*under_way, *states], nrows=starts[m]).T
        C.append(block_diagonal([system.output_matrix(at_once), received]))
    return system.derived(
        block([[system.A, Matrix.zeros(n, starts[m])], [vstack(G), block_diagonal(K)]]),
        [block_diagonal([system.B(i), x(i, 0)]) for i in range(m)],
        C,
        {**construction, "dimensions": list(sizes)},
        neighbors=graph,
    )
