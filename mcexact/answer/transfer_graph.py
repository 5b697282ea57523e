"""Answer: the edges and the strong components of the transfer graph."""

from __future__ import annotations

from functools import cached_property
from typing import Any

from mcexact.answer.evidence import ZeroTransfer
from mcexact.answer.protocol import Answer, answer, claim, shown, witness
from mcexact.plot.graphs import graph


@answer("transfer_graph")
class TransferGraph(Answer):
    """The transfer graph: exactly the edges j → i with C_i (xI − A)⁻¹ B_j ≠ 0.

    Attributes
    ----------
    arcs : tuple of (str, str)
        The edges (from, to) by name, in the order of the channels.
    components : tuple of tuple of str
        The strong components, each in the order of the channels, sorted by first member.
    strongly_connected : bool
        Whether there is at most one component.
    modulus : int
        ℓ ≥ 2, modulo which each edge has a nonzero C_i A^k B_j.
    powers : tuple of int
        k < n, one for each edge.
    zeros : tuple of ZeroTransfer
        Zero transfers for all pairs that are not edges.
    """

    arcs: tuple[tuple[str, str], ...] = claim()
    components: tuple[tuple[str, ...], ...] = claim()
    strongly_connected: bool = claim()
    modulus: int = witness()
    powers: tuple[int, ...] = witness()
    zeros: tuple[ZeroTransfer, ...] = witness()

    @cached_property
    @shown("channels that take part in no feedback")
    def inactive(self) -> tuple[str, ...]:
        """The channels with B_i = 0 or C_i = 0, which cannot take part in any feedback."""
        return tuple(c.name for c in self.about.channels if c.B.is_zero() or c.C.is_zero())

    @cached_property
    def successors(self) -> dict[str, tuple[str, ...]]:
        """For each channel that an edge leaves, the channels at the ends of its edges."""
        found: dict[str, list[str]] = {}
        for j, i in self.arcs:
            found.setdefault(j, []).append(i)
        return {j: tuple(reached) for j, reached in found.items()}

    def plot(self, ax: Any = None) -> Any:
        """Draw the graph; see `mcexact.plot.graph`."""
        return graph(self, ax, title="transfer graph")
