"""The cheapest communication links to add so that no mode is fixed."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal, get_args

from mcexact.analysis.engine import (
    DEFAULT_NODE_LIMIT,
    CoveringCut,
    CoveringProgram,
    ExactSubspace,
    evidence,
    exact_subspace,
)
from mcexact.analysis.sharing.cut_generation import CoveringProblem, covering_optimum
from mcexact.analysis.sharing.separation import least_minimizers, violating_factors
from mcexact.answer.communication import MinimalCommunication
from mcexact.answer.covering import LinkCut
from mcexact.derived.constructions import (
    Share,
    add_links,
    augmented_outputs,
    extended_system,
    selector,
)
from mcexact.derived.modular import generator
from mcexact.errors import InputError, UsageError, one_of, several, told
from mcexact.exact.matrix import Matrix, as_requested, block_diagonal
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Entry
from mcexact.exact.roots import StabilityRegion
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_links

Edge = tuple[int, int]
Carried = Literal["outputs", "outputs+states", "states"]


@dataclass(frozen=True)
class _Links:
    """A plant with its graph, the signals that a link carries, and the links that may be added."""

    plant: MultiChannelSystem
    share: Carried
    dimensions: tuple[int, ...] | None
    candidates: tuple[Edge, ...]

    def chosen(self, values: Sequence[int]) -> MultiChannelSystem:
        """Return the system over the graph with those candidates added whose value is 1."""
        edges = tuple(itertools.compress(self.candidates, values))
        linked = add_links(self.plant, edges) if edges else self.plant
        if self.dimensions is None:
            return augmented_outputs(linked)
        share: Share = "states" if self.share == "states" else "outputs+states"
        return extended_system(linked, self.dimensions, share)

    def carried(self, j: int) -> Matrix:
        """Return S_j, the rows that a link from j adds to the outputs of the system."""
        outputs = self.plant.C(j)
        if self.dimensions is None:
            return outputs
        E = selector(sum(self.dimensions[:j]), self.dimensions[j], sum(self.dimensions)).T
        none = Matrix.zeros(0, self.plant.n)
        return block_diagonal([none if self.share == "states" else outputs, E])

    def cut(self, subspace: ExactSubspace, p: Polynomial) -> CoveringCut:
        """The cut of an obstruction: candidates j → i with i outside T and S_j U ≠ 0 modulo p."""
        subspace = _trimmed(subspace)
        carried = [(self.carried(j) @ subspace.U) % p for j in range(self.plant.m)]
        breaking = frozenset(
            k
            for k, (j, i) in enumerate(self.candidates)
            if i not in subspace.channels_T and not carried[j].is_zero()
        )
        return CoveringCut(breaking, 1, LinkCut(p, evidence(self.chosen(()), subspace)))


def minimal_communication(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    *,
    dimensions: Sequence[int] | None = None,
    share: Carried | None = None,
    costs: Mapping[tuple[str, str], Entry] | None = None,
    forbidden: Iterable[tuple[str, str]] = (),
    region: StabilityRegion | None = None,
    rate: Entry | None = None,
    radius: Entry | None = None,
    node_limit: int = DEFAULT_NODE_LIMIT,
) -> MinimalCommunication:
    """Compute the cheapest links to add to the neighbor graph so that no mode is fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, not a derived system.
    graph : NeighborGraph, optional
        The links that exist already; overrides ``system.neighbors``.  By default there are none.
    dimensions : sequence of m int, optional
        n_i of the extended system; without them agents share outputs alone.
    share : {"outputs", "outputs+states", "states"}, optional
        The signals that a link carries; by default "outputs" without dimensions, else
        "outputs+states".
    costs : mapping from (from, to) to a positive rational, optional
        Prices of links, 1 by default.
    forbidden : iterable of (from, to)
        Links that must not be added.
    region : StabilityRegion, optional
        Modes inside this region may be fixed; by default no mode may be.
    rate, radius : rational, optional
        The rate (continuous time) or the radius (discrete time) of the region.
    node_limit : int
        Nodes of the branch tree after which to give up, at least 1.

    Raises
    ------
    UsageError
        If a price is not positive, the way of sharing does not fit the dimensions, or the node
        limit is below 1.
    LimitReached
        At the node limit.

    Notes
    -----
    An obstruction (T, U) is removed only by a link j → i with i outside T and S_j U ≠ 0, so one of
    these must be added.  Such cuts are generated as in `minimal_shared_dimensions`, and the
    certificate has the same form.  Among optimal sets of links the first in the order of the
    candidates, last links preferred, is taken.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> minimal_communication(plant, NeighborGraph.empty(plant.names)).added
    (('1', '2'),)
    """
    InputError.require(system, MultiChannelSystem, "system")
    given, found = with_links(system, graph)
    links = _checked(given.with_neighbors(found), found, dimensions, share, forbidden)
    plant, names = links.plant, links.plant.names
    region = StabilityRegion.asked(plant.time, region, rate, radius)
    factors = violating_factors(plant, region)
    rng = generator(links.chosen(()), MinimalCommunication.kind)

    def violated(_: Sequence[int], system: MultiChannelSystem) -> list[CoveringCut]:
        cuts = []
        for p in factors:
            subspaces = (exact_subspace(system, T, p) for T in least_minimizers(system, p, rng))
            subspace = next(filter(None, subspaces), None)
            if subspace is not None:
                cuts.append(links.cut(subspace, p))
        return cuts

    program = CoveringProgram(_prices(links, costs or {}), (1,) * len(links.candidates))
    problem = CoveringProblem(MinimalCommunication.kind, program, links.chosen, violated, region)
    least = covering_optimum(problem, node_limit)
    edges = [(names[j], names[i]) for j, i in links.candidates]
    added = None if least.values is None else tuple(itertools.compress(edges, least.values))
    return MinimalCommunication(
        given,
        share=links.share,
        dimensions=links.dimensions,
        bound=None if region is None else region.edge,
        candidates=tuple((*edge, c) for edge, c in zip(edges, program.costs, strict=True)),
        feasible=added is not None,
        added=added,
        cost=least.cost,
        absence=least.absence,
        cuts=tuple(cut.evidence for cut in least.cuts),
        tree=least.tree("arc", edges),
    )


def _checked(
    plant: MultiChannelSystem,
    graph: NeighborGraph,
    dimensions: Sequence[int] | None,
    share: Carried | None,
    forbidden: Iterable[tuple[str, str]],
) -> _Links:
    if plant.subject:
        raise UsageError("give the plant, not a system derived from it", where="system")
    one_of(share, (None, *get_args(Carried)), "share", InputError)
    carried: Carried = share or ("outputs" if dimensions is None else "outputs+states")
    if (carried == "outputs") != (dimensions is None):
        raise UsageError("sub-states are shared iff their dimensions are given", where="share")
    excluded = {
        _edge(plant, edge, "forbidden") for edge in several(forbidden, "forbidden", "links")
    }
    candidates = tuple(
        (j, i)
        for j in range(plant.m)
        for i in range(plant.m)
        if j not in graph.neighborhood(i) and (j, i) not in excluded
    )
    sizes = None if dimensions is None else several(dimensions, "dimensions", "integers")
    return _Links(plant, carried, sizes, candidates)


def _prices(links: _Links, costs: Mapping[tuple[str, str], Entry]) -> tuple[Fraction, ...]:
    """The price of each candidate, 1 where none is given."""
    InputError.require(costs, Mapping, "costs")
    prices = {
        _edge(links.plant, edge, "costs"): as_requested(price, where="costs")
        for edge, price in costs.items()
    }
    if any(price <= 0 for price in prices.values()):
        raise UsageError("the price of a link must be positive", where="costs")
    return tuple(prices.get(edge, Fraction(1)) for edge in links.candidates)


def _edge(plant: MultiChannelSystem, edge: tuple[str, str], where: str) -> Edge:
    if isinstance(edge, str) or not isinstance(edge, Sequence) or len(edge) != 2:
        raise InputError(
            f"expected links as pairs (sender, receiver) of names, found {told(edge)}", where=where
        )
    sender, receiver = edge
    return plant.index(sender), plant.index(receiver)


def _trimmed(subspace: ExactSubspace) -> ExactSubspace:
    """Reduce a subspace to rank B_T + 1 columns, so that fewer links remove the obstruction."""
    keep = range(len(subspace.pivots) - subspace.deficiency + 1)
    return replace(
        subspace,
        U=subspace.U.take(cols=keep),
        V=subspace.V.take(cols=keep),
        pivots=tuple(subspace.pivots[k] for k in keep),
        deficiency=1,
    )
