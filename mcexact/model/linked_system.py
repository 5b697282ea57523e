"""The neighbor graph over which the agents of a system communicate."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from mcexact.errors import UsageError
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


def with_graph(
    system: MultiChannelSystem, graph: NeighborGraph | Mapping[str, Iterable[str]] | None = None
) -> tuple[MultiChannelSystem, NeighborGraph]:
    """Return a system with a neighbor graph, and the graph.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph or mapping of names, optional
        Overrides ``system.neighbors``.

    Raises
    ------
    UsageError
        If neither the system nor the argument gives a neighbor graph.
    """
    if graph is not None:
        system = system.with_neighbors(graph)
    if system.neighbors is None:
        raise UsageError(
            "a neighbor graph is needed, and the system has none: add 'neighbors' to it"
        )
    return system, system.neighbors


def with_links(
    system: MultiChannelSystem, graph: NeighborGraph | Mapping[str, Iterable[str]] | None = None
) -> tuple[MultiChannelSystem, NeighborGraph]:
    """Return a system, and the graph over which its controllers communicate.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph or mapping of names, optional
        Overrides ``system.neighbors``.  Without either, the controller graph has no edges; the
        system itself stays without a graph, so that certificates about the closed loop are about
        the user's plant.
    """
    if graph is None and system.neighbors is None:
        return system, NeighborGraph.empty(system.names)
    return with_graph(system, graph)
