"""Certificate: the cheapest arcs to add to the neighbor graph, or that none suffice."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.certificate.covering import Absence, ArcCut, Tree


@dataclass(frozen=True)
class CommunicationCertificate(Certificate):
    """With these arcs no mode is fixed, and no cheaper choice of candidates does that.

    Attributes
    ----------
    share : str
        What an arc carries: ``"outputs"``, ``"outputs+states"`` or ``"states"``.
    dimensions : tuple of int, or None
        The n_i of the extended system; None when only outputs are shared.
    bound : Fraction or None
        The rate or radius that a mode must violate to count; None: every mode counts.
    candidates : tuple of (str, str, Fraction)
        Arcs (j, i) that may be added, and their positive costs.
    added : tuple of (str, str), or None
        The optimal arcs; None when all candidates together do not suffice.
    cost : Fraction or None
    absence : Absence or None
    cuts : tuple of ArcCut
    tree : Tree
    """

    kind: ClassVar[str] = "communication"

    share: str
    dimensions: tuple[int, ...] | None
    bound: Fraction | None
    candidates: tuple[tuple[str, str, Fraction], ...]
    added: tuple[tuple[str, str], ...] | None
    cost: Fraction | None
    absence: Absence | None
    cuts: tuple[ArcCut, ...]
    tree: Tree

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "share": self.share,
            "dimensions": self.dimensions,
            "bound": self.bound,
            "candidates": self.candidates,
            "feasible": self.added is not None,
            "added": self.added,
            "cost": self.cost,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"absence": self.absence, "cuts": self.cuts, "tree": self.tree}
