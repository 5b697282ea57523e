"""Answer: the least dimensions that agents must share, or that no dimensions suffice."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from mcexact.answer.covering import Absence, ConnectivityCut, DeficiencyCut, Tree
from mcexact.answer.protocol import Answer, answer, claim, shown, witness
from mcexact.exact.polynomial import Polynomial
from mcexact.model.system import with_graph


@dataclass(frozen=True)
class BindingSubset:
    """A subset that holds its boundary to its deficiency.

    Attributes
    ----------
    subset : tuple of str
        s, by name.
    boundary : tuple of str
        N_s∖s: the agents that must share.
    mode : Polynomial or None
        p, at whose roots P_s loses rank; None if s is cut off in the transfer graph instead.
    deficiency : int
        Σ n_i over the boundary must be at least this.
    """

    subset: tuple[str, ...]
    boundary: tuple[str, ...]
    mode: Polynomial | None
    deficiency: int


@answer("shared_dimensions")
class SharedDimensions(Answer):
    """The least that must be shared so that the extended system has no fixed mode, if anything is.

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
    feasible : bool
        Whether some dimensions within the upper bounds suffice.
    dimensions : tuple of int, or None
        The optimal n_i; None when nothing suffices.
    cost : Fraction or None
        Σ c_i n_i.
    absence : Absence or None
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
    absence: Absence | None = witness()
    cuts: tuple[DeficiencyCut | ConnectivityCut, ...] = witness()
    tree: Tree = witness()

    @property
    @shown()
    def total(self) -> int | None:
        """Σ n_i."""
        return None if self.dimensions is None else sum(self.dimensions)

    @property
    def binding(self) -> tuple[BindingSubset, ...]:
        """The cuts that the dimensions meet with equality; all where nothing suffices."""
        system, graph = with_graph(self.about)
        found = []
        for cut in self.cuts:
            s = system.indices(cut.subset)
            boundary = set(graph.union(s)) - set(s)
            demand = cut.deficiency if isinstance(cut, DeficiencyCut) else 1
            mode = cut.polynomial if isinstance(cut, DeficiencyCut) else None
            if self.dimensions is None or sum(self.dimensions[i] for i in boundary) <= demand:
                found.append(BindingSubset(cut.subset, system.named(boundary), mode, demand))
        return tuple(found)
