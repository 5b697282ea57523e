"""Answer: the cheapest edges to add to the neighbor graph, or that none suffice."""

from __future__ import annotations

from fractions import Fraction

from mcexact.answer.covering import Absence, LinkCut, Tree
from mcexact.answer.protocol import Answer, answer, claim, witness


@answer("communication")
class MinimalCommunication(Answer):
    """The cheapest edges that leave no mode fixed, or that no candidates do.

    Attributes
    ----------
    share : str
        What an edge carries: ``"outputs"``, ``"outputs+states"`` or ``"states"``.
    dimensions : tuple of int, or None
        The n_i of the extended system; None when only outputs are shared.
    bound : Fraction or None
        The rate or radius that a mode must violate to count; None: every mode counts.
    candidates : tuple of (str, str, Fraction)
        Edges (j, i) that may be added, and their positive costs.
    feasible : bool
        Whether all candidates together suffice.
    added : tuple of (str, str), or None
        The edges (from, to) to add; None when nothing suffices.
    cost : Fraction or None
    absence : Absence or None
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
    absence: Absence | None = witness()
    cuts: tuple[LinkCut, ...] = witness()
    tree: Tree = witness()
