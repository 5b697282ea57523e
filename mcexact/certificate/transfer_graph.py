"""Certificate: which channels reach which, and the strong components of that graph."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.answer.evidence import ZeroTransfer
from mcexact.certificate import Certificate


@dataclass(frozen=True)
class TransferGraphCertificate(Certificate):
    """All arcs j → i of the transfer graph, C_i (xI − A)⁻¹ B_j ≠ 0, and no others.

    Attributes
    ----------
    arcs : tuple of (str, str)
        (from, to) by name, sorted by their places in the order of the channels.
    components : tuple of tuple of str
        The strong components, each in the order of the channels, sorted by first member.
    strongly_connected : bool
        Whether there is at most one component.
    modulus : int
        ℓ ≥ 2, modulo which each arc has a nonzero C_i A^k B_j.
    powers : tuple of int
        k < n, one for each arc.
    zeros : tuple of ZeroTransfer
        They cover each pair that is not an arc.
    """

    kind: ClassVar[str] = "transfer_graph"

    arcs: tuple[tuple[str, str], ...]
    components: tuple[tuple[str, ...], ...]
    strongly_connected: bool
    modulus: int
    powers: tuple[int, ...]
    zeros: tuple[ZeroTransfer, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "arcs": self.arcs,
            "components": self.components,
            "strongly_connected": self.strongly_connected,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"modulus": self.modulus, "powers": self.powers, "zeros": self.zeros}
