"""The transfer graph, and completeness, for all values of one parameter or several."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import networkx as nx

from mcexact.analysis.engine.mode_hypersurfaces import mode_hypersurfaces
from mcexact.analysis.engine.parameter_lines import Along, in_order
from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.analysis.engine.rank_hypersurfaces import rank_for_all_values
from mcexact.answer.evidence import RootDisc
from mcexact.answer.exceptional_hypersurfaces import (
    ExceptionalHypersurfaces,
    Hypersurface,
    RankHypersurfaces,
)
from mcexact.answer.parameter_values import (
    joined,
    rows_left_out,
    value_text,
    within,
)
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.answer.parametric_rank import ParametricRank, TransferColumn
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import RationalFunction
from mcexact.exact.roots import root_discs
from mcexact.model.parametric import ParametricSystem

Pair = tuple[str, str]
Surface = Polynomial | RationalFunction
"""A polynomial in the parameters, at whose roots something is lost."""


@dataclass(frozen=True)
class ParametricTransferGraph:
    """The transfer graph for all values of a parameter, or for almost all of several.

    Attributes
    ----------
    columns : mapping of (str, str) to ParametricRank or RankHypersurfaces
        For each pair (j, i) of channels the rank, 1 or 0, of the column of all entries of
        C_i A^k B_j, k < n.
    """

    columns: Mapping[Pair, Any]

    @property
    def arcs(self) -> tuple[Pair, ...]:
        """The edges j → i for almost every value."""
        return tuple(pair for pair, found in self.columns.items() if found.rank)

    @property
    def lost(self) -> dict[Pair, tuple[Any, ...]]:
        """The values at which an edge vanishes, for the edges for which there are some."""
        return {pair: each.exceptional for pair, each in self.columns.items() if each.exceptional}

    @property
    def certificates(self) -> tuple[Along, ...]:
        """The answers that prove it, with several parameters those along lines."""
        return tuple(proof for each in self.columns.values() for proof in _proofs(each))

    @property
    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """For each pair of channels where it is an edge."""
        rows = joined((f"{start} -> {end}", each) for (start, end), each in self.columns.items())
        return tuple((at, _as_edge(what), why) for at, what, why in rows)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data: the edges for almost every value."""
        return {"arcs": [[*pair] for pair in self.arcs]}

    @property
    def lost_at(self) -> tuple[Surface, ...]:
        """The polynomials at whose roots an edge vanishes."""
        return tuple({q: None for each in self.columns.values() for q in each.exceptional_at})

    def strongly_connected(self, without: Surface | None = None) -> bool:
        """Whether the edges for almost every value, or for the roots of a polynomial, connect."""
        graph = nx.DiGraph()
        graph.add_nodes_from({name for pair in self.columns for name in pair})
        for pair in self.arcs:
            if without not in self.columns[pair].exceptional_at:
                graph.add_edge(*pair)
        return bool(nx.is_strongly_connected(graph))


def parametric_transfer_graph(system: ParametricSystem) -> ParametricTransferGraph:
    """Decide for every pair of channels for which values of a parameter C_i (xI − A)⁻¹ B_j ≠ 0.

    Examples
    --------
    >>> B, C = [[[1]], [["t"]]], [[[1]], [["t^2 - 2"]]]
    >>> plant = ParametricSystem([["t"]], B, C, parameters=["t"])
    >>> lost = parametric_transfer_graph(plant).lost
    >>> [(pair, [str(each.value) for each in values]) for pair, values in lost.items()]
    [(('1', '2'), ['x^2 - 2']), (('2', '1'), ['x']), (('2', '2'), ['x', 'x^2 - 2'])]
    """
    return ParametricTransferGraph(
        {
            (j, i): rank_for_all_values(system, TransferColumn(j, i))
            for j in system.names
            for i in system.names
        }
    )


@dataclass(frozen=True)
class ParametricCompleteness:
    """For which values of parameters no mode is fixed and the transfer graph connects.

    Attributes
    ----------
    spectrum : ParametricFixedSpectrum or ExceptionalHypersurfaces
    graph : ParametricTransferGraph
    """

    spectrum: ParametricFixedSpectrum | ExceptionalHypersurfaces
    graph: ParametricTransferGraph

    @property
    def generic(self) -> bool:
        """Whether the plant is complete for almost every value; else it is for none."""
        return not self.spectrum.generic and self.graph.strongly_connected()

    @cached_property
    def exceptional(self) -> tuple[Surface, ...]:
        """The polynomials at whose roots it is not, if it is for almost every value."""
        if not self.generic:
            return ()
        cut = [q for q in self.graph.lost_at if not self.graph.strongly_connected(q)]
        found = {*self.spectrum.exceptional_at, *cut}
        surfaces = in_order([q for q in found if isinstance(q, RationalFunction)])
        values = [q for q in found if isinstance(q, Polynomial)]
        return (*surfaces, *sorted(values, key=lambda q: (q.degree, q.coefficients)))

    @property
    def rows(self) -> tuple[tuple[str, str, str], ...]:
        """Where it is complete, in words of the parameters."""
        about = self.spectrum.about
        beyond = any(
            each.left_out.outside for each in (self.spectrum, *self.graph.columns.values())
        )
        names = ", ".join(about.parameters_in_words if beyond else about.parameters)
        some = "almost " if self.exceptional else ""
        said = "complete" if self.generic else "not complete"
        found = [(f"{some}every value of {names}", said, "")]
        for q in self.exceptional:
            found.append((self._at(q), "not complete", ""))
        parts = [self.spectrum, *self.graph.columns.values()]
        return *found, *rows_left_out(each.left_out for each in parts)

    def _at(self, q: Surface) -> str:
        """Where a polynomial in the parameters is 0."""
        about = self.spectrum.about
        if isinstance(q, RationalFunction):
            return Hypersurface(q).inside(about)
        [t], [bounds] = about.parameters, about.ranges
        discs = tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(q))
        return value_text(q, discs, t) + within(True, bounds)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        return {"complete_for_almost_every_value": self.generic}

    @property
    def certificates(self) -> tuple[Along, ...]:
        """The answers that prove it, with several parameters those along lines."""
        return *_proofs(self.spectrum), *self.graph.certificates


def _as_edge(what: str) -> str:
    """A row about the rank of a column in words of edges."""
    for rank, said in ((": rank 1", ": an edge"), (": rank 0", ": no edge")):
        what = what.removesuffix(rank) + said if what.endswith(rank) else what
    return what


def _proofs(
    found: Along | ExceptionalHypersurfaces | RankHypersurfaces,
) -> tuple[Along, ...]:
    """The certificates of an answer: itself, or with several parameters those along lines."""
    if isinstance(found, ParametricFixedSpectrum | ParametricRank):
        return (found,)
    return tuple(found.certificates.values())


def parametric_completeness(
    system: ParametricSystem,
    spectrum: ParametricFixedSpectrum | ExceptionalHypersurfaces | None = None,
    graph: ParametricTransferGraph | None = None,
) -> ParametricCompleteness:
    """Decide for which values of parameters a plant is complete.

    Parameters
    ----------
    system : ParametricSystem
    spectrum, graph : optional
        What is fixed, and the transfer graph, if they are known already.
    """
    if spectrum is None:
        one = len(system.parameters) == 1
        spectrum = (parametric_fixed_spectrum if one else mode_hypersurfaces)(system)
    return ParametricCompleteness(spectrum, graph or parametric_transfer_graph(system))
