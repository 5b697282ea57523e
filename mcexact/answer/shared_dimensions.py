"""Answer: the least dimensions that agents must share, or that no dimensions suffice."""

from __future__ import annotations

from fractions import Fraction

from mcexact.answer.covering import (
    Absence,
    BlocksAbsence,
    ConnectivityCut,
    DeficiencyCut,
    Tree,
)
from mcexact.answer.protocol import Answer, answer, claim, shown, witness


@answer("shared_dimensions")
class SharedDimensions(Answer):
    """The least dimensions for which the extended system has no fixed mode, or that none suffice.

    Attributes
    ----------
    share : str
        ``"outputs+states"`` or ``"states"``.
    bound : Fraction or None
        A rate or radius: only modes that violate it are considered.  None means all modes.
    free_assignability : bool
        Whether the extended transfer graph must also be strongly connected.
    costs : tuple of Fraction
        The positive cost of one dimension of each agent.
    upper : tuple of (int or None)
        Upper limits of the n_i.
    feasible : bool
        Whether some dimensions within the upper limits suffice.
    dimensions : tuple of int, or None
        The optimal n_i; None if no dimensions suffice.
    cost : Fraction or None
        Σ c_i n_i.
    absence : BlocksAbsence, Absence or None
    cuts : tuple of DeficiencyCut and ConnectivityCut
    tree : Tree
    """

    share: str = claim()
    bound: Fraction | None = claim()
    free_assignability: bool = claim()
    costs: tuple[Fraction, ...] = claim()
    upper: tuple[int | None, ...] = claim()
    feasible: bool = claim()
    dimensions: tuple[int, ...] | None = claim()
    cost: Fraction | None = claim()
    absence: BlocksAbsence | Absence | None = witness()
    cuts: tuple[DeficiencyCut | ConnectivityCut, ...] = witness()
    tree: Tree = witness()

    @property
    @shown()
    def total(self) -> int | None:
        """Σ n_i."""
        return None if self.dimensions is None else sum(self.dimensions)
