"""Answer: whether the neighbor graph of the system is strongly connected."""

from __future__ import annotations

from mcexact.answer.protocol import Answer, answer, claim


@answer("neighbor_graph")
class NeighborGraphVerdict(Answer):
    """The neighbor graph is strongly connected, or not; no witness is needed.

    Attributes
    ----------
    strongly_connected : bool
    """

    strongly_connected: bool = claim()
