"""Certificate: the least dimensions that agents must share, or that no dimensions suffice."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.certificate.covering import Absence, ConnectivityCut, DeficiencyCut, Tree


@dataclass(frozen=True)
class SharedDimensionsCertificate(Certificate):
    """With these n_i the extended system has no fixed mode, and nothing cheaper has none.

    Attributes
    ----------
    share : str
        ``"outputs+states"`` or ``"states"``.
    bound : Fraction or None
        The rate or radius that a mode must violate to count; None: every mode counts.
    free_assignability : bool
        Whether the extended transfer graph must be strongly connected as well.
    costs : tuple of Fraction
        The positive cost of one dimension of each agent.
    upper : tuple of (int or None)
        Upper bounds of the n_i.
    dimensions : tuple of int, or None
        The optimal n_i; None when nothing suffices.
    cost : Fraction or None
        Σ c_i n_i.
    absence : Absence or None
    cuts : tuple of DeficiencyCut and ConnectivityCut
    tree : Tree
    """

    kind: ClassVar[str] = "shared_dimensions"

    share: str
    bound: Fraction | None
    free_assignability: bool
    costs: tuple[Fraction, ...]
    upper: tuple[int | None, ...]
    dimensions: tuple[int, ...] | None
    cost: Fraction | None
    absence: Absence | None
    cuts: tuple[DeficiencyCut | ConnectivityCut, ...]
    tree: Tree

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "share": self.share,
            "bound": self.bound,
            "free_assignability": self.free_assignability,
            "costs": self.costs,
            "upper": self.upper,
            "feasible": self.dimensions is not None,
            "dimensions": self.dimensions,
            "cost": self.cost,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"absence": self.absence, "cuts": self.cuts, "tree": self.tree}
