"""Whether the neighbor graph is strongly connected."""

from __future__ import annotations

from mcexact.answer.neighbor_graph import NeighborGraphVerdict
from mcexact.errors import InputError
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


def neighbor_graph(
    system: MultiChannelSystem, graph: NeighborGraph | None = None
) -> NeighborGraphVerdict:
    """Decide whether the neighbor graph of a system is strongly connected.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Instead of ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    return NeighborGraphVerdict(system, strongly_connected=graph.is_strongly_connected())
