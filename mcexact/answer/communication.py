"""Answer: the cheapest communication links to add, or that no candidates suffice."""

from __future__ import annotations

from fractions import Fraction

from mcexact.answer.covering import Absence, BlocksAbsence, LinkCut, Tree
from mcexact.answer.protocol import Answer, answer, claim, witness


@answer("communication")
class MinimalCommunication(Answer):
    """The cheapest links with which no mode is fixed, or that no candidates suffice.

    Attributes
    ----------
    share : str
        The signals that a link carries: ``"outputs"``, ``"outputs+states"`` or ``"states"``.
    dimensions : tuple of int, or None
        The n_i of the extended system; None if only outputs are shared.
    bound : Fraction or None
        A rate or radius: only modes that violate it are considered.  None means all modes.
    candidates : tuple of (str, str, Fraction)
        The links (from, to) that may be added, with their positive costs.
    feasible : bool
        Whether all candidates together suffice.
    added : tuple of (str, str), or None
        The links (from, to) to add; None if no candidates suffice.
    cost : Fraction or None
    absence : BlocksAbsence, Absence or None
    cuts : tuple of LinkCut
    tree : Tree
    """

    share: str = claim()
    dimensions: tuple[int, ...] | None = claim()
    bound: Fraction | None = claim()
    candidates: tuple[tuple[str, str, Fraction], ...] = claim()
    feasible: bool = claim()
    added: tuple[tuple[str, str], ...] | None = claim()
    cost: Fraction | None = claim()
    absence: BlocksAbsence | Absence | None = witness()
    cuts: tuple[LinkCut, ...] = witness()
    tree: Tree = witness()
