"""Whether the agents can hear each other, directly or through others."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.certificate.neighbor_graph import NeighborGraphCertificate
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.model.system_file import canonical_document


@dataclass(frozen=True)
class NeighborGraphVerdict:
    """Whether the neighbor graph is strongly connected.

    Attributes
    ----------
    strongly_connected : bool
    certificate : NeighborGraphCertificate
    """

    strongly_connected: bool
    certificate: NeighborGraphCertificate


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
    system, graph = with_graph(system, graph)
    connected = graph.is_strongly_connected()
    certificate = NeighborGraphCertificate(
        system=canonical_document(system.plant),
        subject=system.subject,
        strongly_connected=connected,
    )
    return NeighborGraphVerdict(connected, certificate)
