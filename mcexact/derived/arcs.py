"""The same plant with more wires."""

from __future__ import annotations

from collections.abc import Iterable

from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


def add_arcs(
    system: MultiChannelSystem,
    added: Iterable[tuple[int, int]],
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem:
    """Let j join N_i for every added arc j → i; A, B and C stay.

    Parameters
    ----------
    system : MultiChannelSystem
    added : iterable of (j, i)
        Positions of channels; the new wires have no delay.  An arc that is there already stays as
        it is.
    graph : NeighborGraph, optional
        The graph that they are added to; overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    InputError
        If a position is out of range.

    Examples
    --------
    >>> system = MultiChannelSystem([[0]], [[[1]], [[1]]], [[[1]], [[1]]], neighbors={})
    >>> add_arcs(system, [(0, 1)]).neighbors.arcs()
    ((0, 1),)
    """
    system, found = with_graph(system, graph)
    added = list(added)
    joined = found.with_arcs(added)
    arcs = sorted({(j, i) for j, i in added if j not in found.neighborhood(i)})
    return system.derived(
        system.A,
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        {"construction": "arcs", "added": [[system.names[j], system.names[i]] for j, i in arcs]},
        neighbors=joined,
    )
