"""A plant with further communication links."""

from __future__ import annotations

from collections.abc import Iterable

from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


def add_links(
    system: MultiChannelSystem,
    added: Iterable[tuple[int, int]],
    graph: NeighborGraph | None = None,
) -> MultiChannelSystem:
    """Add edges j → i to the neighbor graph: j joins N_i; A, B and C do not change.

    Parameters
    ----------
    system : MultiChannelSystem
    added : iterable of (j, i)
        Positions of channels; the new links have no delay.  An edge that exists already keeps its
        delay.
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
    >>> add_links(system, [(0, 1)]).neighbors.edges()
    ((0, 1),)
    """
    system, found = with_graph(system, graph)
    added = list(added)
    joined = found.with_edges(added)
    edges = sorted({(j, i) for j, i in added if j not in found.neighborhood(i)})
    return system.derived(
        system.A,
        [channel.B for channel in system.channels],
        [channel.C for channel in system.channels],
        {"construction": "arcs", "added": [[system.names[j], system.names[i]] for j, i in edges]},
        neighbors=joined,
    )
