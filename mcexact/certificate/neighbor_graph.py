"""Certificate: whether the neighbor graph of the system is strongly connected."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate


@dataclass(frozen=True)
class NeighborGraphCertificate(Certificate):
    """The neighbor graph is strongly connected, or not; no witness is needed.

    Attributes
    ----------
    strongly_connected : bool
    """

    kind: ClassVar[str] = "neighbor_graph"

    strongly_connected: bool

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"strongly_connected": self.strongly_connected}

    def witness(self) -> dict[str, Any]:
        """The evidence: none, the graph is in the system."""
        return {}
