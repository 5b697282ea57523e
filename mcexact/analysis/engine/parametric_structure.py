"""The transfer graph, and completeness, for all values of a parameter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import networkx as nx

from mcexact.analysis.engine.parametric_minors import parametric_rank
from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.answer.parametric_rank import (
    LowerRank,
    ParametricRank,
    TransferColumn,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.model.parametric import ParametricSystem

Pair = tuple[str, str]


@dataclass(frozen=True)
class ParametricTransferGraph:
    """The transfer graph for all values of a parameter.

    Attributes
    ----------
    columns : mapping of (str, str) to ParametricRank
        For each pair (j, i) of channels the rank, 1 or 0, of the column of all entries of
        C_i A^k B_j, k < n.
    """

    columns: Mapping[Pair, ParametricRank]

    @property
    def arcs(self) -> tuple[Pair, ...]:
        """The edges j → i for almost every value."""
        return tuple(pair for pair, found in self.columns.items() if found.rank)

    @property
    def lost(self) -> dict[Pair, tuple[LowerRank, ...]]:
        """The values at which an edge vanishes, for the edges for which there are some."""
        return {pair: each.exceptional for pair, each in self.columns.items() if each.exceptional}

    @property
    def certificates(self) -> tuple[ParametricRank, ...]:
        """The answers that prove it."""
        return tuple(self.columns.values())

    def strongly_connected(self, without: Polynomial | None = None) -> bool:
        """Whether the edges for almost every value, or for the roots of a polynomial, connect."""
        graph = nx.DiGraph()
        graph.add_nodes_from({name for pair in self.columns for name in pair})
        for pair in self.arcs:
            if all(each.value != without for each in self.columns[pair].exceptional):
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
            (j, i): parametric_rank(system, TransferColumn(j, i))
            for j in system.names
            for i in system.names
        }
    )


@dataclass(frozen=True)
class ParametricCompleteness:
    """For which values of a parameter no mode is fixed and the transfer graph connects.

    Attributes
    ----------
    spectrum : ParametricFixedSpectrum
    graph : ParametricTransferGraph
    """

    spectrum: ParametricFixedSpectrum
    graph: ParametricTransferGraph

    @property
    def generic(self) -> bool:
        """Whether the plant is complete for almost every value; else it is for none."""
        return not self.spectrum.generic and self.graph.strongly_connected()

    @cached_property
    def exceptional(self) -> tuple[Polynomial, ...]:
        """The values at which it is not, if it is for almost every one."""
        if not self.generic:
            return ()
        found = {each.value for each in self.spectrum.exceptional}
        lost = {each.value for values in self.graph.lost.values() for each in values}
        found |= {q for q in lost if not self.graph.strongly_connected(q)}
        return tuple(sorted(found, key=lambda q: (q.degree, q.coefficients)))

    @property
    def certificates(self) -> tuple[ParametricFixedSpectrum | ParametricRank, ...]:
        """The answers that prove it."""
        return self.spectrum, *self.graph.certificates


def parametric_completeness(system: ParametricSystem) -> ParametricCompleteness:
    """Decide for which values of a parameter a plant is complete."""
    return ParametricCompleteness(
        parametric_fixed_spectrum(system), parametric_transfer_graph(system)
    )
