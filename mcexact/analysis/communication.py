"""What must be communicated: the cheapest arcs to add so that no mode is fixed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Literal, get_args

from mcexact.analysis.covering import (
    DEFAULT_NODE_LIMIT,
    CoveringCut,
    CoveringProgram,
    branch_tree,
    checked_node_limit,
    minimize,
)
from mcexact.analysis.fixed_spectrum import evidence
from mcexact.analysis.modular_system import generator
from mcexact.analysis.separation import absence, least_minimizers, violating_factors
from mcexact.analysis.shrunk_subspace import ExactSubspace, exact_subspace
from mcexact.certificate.communication import CommunicationCertificate
from mcexact.certificate.covering import ArcCut
from mcexact.derived.arcs import add_arcs
from mcexact.derived.augmented_outputs import augmented_outputs
from mcexact.derived.extended import Share, extended_system, selector
from mcexact.errors import InputError, UsageError
from mcexact.exact.blocks import block_diagonal
from mcexact.exact.location import StabilityRegion, bounded_region
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Entry, as_fraction
from mcexact.model.names import quoted
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_wires
from mcexact.model.system_file import canonical_document

Arc = tuple[int, int]
Carried = Literal["outputs", "outputs+states", "states"]


@dataclass(frozen=True)
class MinimalCommunication:
    """The cheapest arcs that leave no mode fixed, or that no candidates do.

    Attributes
    ----------
    feasible : bool
    added : tuple of (str, str), or None
        The arcs (from, to) to add; None when all candidates together do not suffice.
    cost : Fraction or None
    cuts, nodes : int
        Number of cuts that the proof uses, and of nodes of its branch tree.
    certificate : CommunicationCertificate
    """

    feasible: bool
    added: tuple[tuple[str, str], ...] | None
    cost: Fraction | None
    cuts: int
    nodes: int
    certificate: CommunicationCertificate


@dataclass(frozen=True)
class _Problem:
    """The plant over its graph, what an arc carries, and the arcs that may be added."""

    given: MultiChannelSystem
    """The plant as the user gave it, perhaps without a graph: the certificate is about this one."""
    plant: MultiChannelSystem
    share: Carried
    dimensions: tuple[int, ...] | None
    region: StabilityRegion | None
    candidates: tuple[Arc, ...]
    costs: tuple[Fraction, ...]

    def system(self, added: Iterable[Arc]) -> MultiChannelSystem:
        """The system over the graph with these arcs added."""
        arcs = tuple(added)
        wired = add_arcs(self.plant, arcs) if arcs else self.plant
        if self.dimensions is None:
            return augmented_outputs(wired)
        share: Share = "states" if self.share == "states" else "outputs+states"
        return extended_system(wired, self.dimensions, share)

    def carried(self, j: int) -> Matrix:
        """S_j, the rows that an arc from j adds to the outputs of the system."""
        if self.dimensions is None:
            return self.plant.C(j)
        total = sum(self.dimensions)
        E = selector(sum(self.dimensions[:j]), self.dimensions[j], total).T
        outputs = self.plant.C(j)
        if self.share == "states":
            outputs = Matrix.zeros(0, self.plant.n)
        return block_diagonal([outputs, E])


def minimal_communication(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    *,
    dimensions: Sequence[int] | None = None,
    share: Carried | None = None,
    costs: Mapping[tuple[str, str], Entry] | None = None,
    forbidden: Iterable[tuple[str, str]] = (),
    bound: Entry | None = None,
    node_limit: int = DEFAULT_NODE_LIMIT,
) -> MinimalCommunication:
    """The cheapest arcs to add to the neighbor graph so that no mode is fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, not a derived system.
    graph : NeighborGraph, optional
        What agents hear already; overrides ``system.neighbors``.  Without either they hear nobody.
    dimensions : sequence of m int, optional
        n_i of the extended system; without them agents share outputs alone.
    share : {"outputs", "outputs+states", "states"}, optional
        What an arc carries: "outputs" without dimensions, else "outputs+states" by default.
    costs : mapping from (from, to) to a positive rational, optional
        Prices of arcs, 1 by default.
    forbidden : iterable of (from, to)
        Arcs that must not be added.
    bound : rational, optional
        A rate or radius: only modes that violate it count.
    node_limit : int
        Nodes of the branch tree after which to give up, at least 1.

    Raises
    ------
    UsageError
        If there is no neighbor graph, a price is not positive, what is shared does not fit, or
        the node limit is below 1.
    LimitReached
        At the node limit.

    Notes
    -----
    An obstruction (T, U) is broken only by an arc j → i with i outside T that carries something of
    U: one of these must be added.  Such cuts are generated as in `minimal_shared_dimensions`; the
    certificate is of the same kind.  Among optimal sets of arcs the first in the order of the
    candidates, last arcs preferred, is taken.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> minimal_communication(plant, NeighborGraph.empty(plant.names)).added
    (('1', '2'),)
    """
    checked_node_limit(node_limit)
    problem = _checked(system, graph, dimensions, share, costs, forbidden, bound)
    cuts: list[tuple[CoveringCut, ArcCut]] = []
    chosen = _generate(problem, cuts)
    program = _program(problem, cuts)
    cost = None if chosen is None else program.cost(chosen)
    tree = branch_tree(program, cost, node_limit=node_limit)
    names = problem.plant.names
    arcs = tuple((names[j], names[i]) for j, i in problem.candidates)
    found = None
    added = None
    if chosen is not None:
        picked = [arc for arc, taken in zip(problem.candidates, chosen, strict=True) if taken]
        added = tuple((names[j], names[i]) for j, i in picked)
        final = problem.system(picked)
        found = absence(final, problem.region, generator(final, CommunicationCertificate.kind))
    certificate = CommunicationCertificate(
        system=canonical_document(problem.given),
        subject=(),
        share=problem.share,
        dimensions=problem.dimensions,
        bound=None if bound is None else as_fraction(bound),
        candidates=tuple((*arc, price) for arc, price in zip(arcs, problem.costs, strict=True)),
        added=added,
        cost=cost,
        absence=found,
        cuts=tuple(cut for _, cut in cuts),
        tree=tree.written("arc", arcs, {k: k for k in range(len(cuts))}),
    )
    return MinimalCommunication(
        feasible=chosen is not None,
        added=added,
        cost=cost,
        cuts=len(cuts),
        nodes=len(tree.nodes),
        certificate=certificate,
    )


def _checked(
    system: MultiChannelSystem,
    graph: NeighborGraph | None,
    dimensions: Sequence[int] | None,
    share: Carried | None,
    costs: Mapping[tuple[str, str], Entry] | None,
    forbidden: Iterable[tuple[str, str]],
    bound: Entry | None,
) -> _Problem:
    given, found = with_wires(system, graph)
    plant = given.with_neighbors(found)
    if plant.subject:
        raise UsageError("give the plant, not a system derived from it", where="system")
    carried: Carried = share or ("outputs" if dimensions is None else "outputs+states")
    if carried not in get_args(Carried):
        raise InputError(
            f'expected "outputs", "outputs+states" or "states", found {quoted(carried)}',
            where="share",
        )
    if (carried == "outputs") != (dimensions is None):
        raise UsageError("sub-states are shared iff their dimensions are given", where="share")
    prices = {_arc(plant, arc): as_fraction(price) for arc, price in (costs or {}).items()}
    if any(price <= 0 for price in prices.values()):
        raise UsageError("the price of an arc must be positive", where="costs")
    excluded = {_arc(plant, arc) for arc in forbidden}
    m = plant.m
    candidates = tuple(
        (j, i)
        for j in range(m)
        for i in range(m)
        if j not in found.neighborhood(i) and (j, i) not in excluded
    )
    return _Problem(
        given=given,
        plant=plant,
        share=carried,
        dimensions=None if dimensions is None else tuple(dimensions),
        region=None
        if bound is None
        else bounded_region(plant.time, as_fraction(bound, where="bound")),
        candidates=candidates,
        costs=tuple(prices.get(arc, Fraction(1)) for arc in candidates),
    )


def _arc(plant: MultiChannelSystem, arc: tuple[str, str]) -> Arc:
    sender, receiver = arc
    return plant.index(sender), plant.index(receiver)


def _program(problem: _Problem, cuts: Sequence[tuple[CoveringCut, ArcCut]]) -> CoveringProgram:
    size = len(problem.candidates)
    return CoveringProgram(problem.costs, (1,) * size, tuple(cut for cut, _ in cuts))


def _generate(problem: _Problem, cuts: list[tuple[CoveringCut, ArcCut]]) -> tuple[int, ...] | None:
    """Add cuts until an optimal set of arcs is broken by none; None if there is no set at all."""
    factors = violating_factors(problem.plant, problem.region)
    rng = generator(problem.system(()), CommunicationCertificate.kind)
    canonical = False
    while True:
        chosen = minimize(_program(problem, cuts), canonical=canonical)
        if chosen is None:
            return None
        picked = [arc for arc, taken in zip(problem.candidates, chosen, strict=True) if taken]
        system = problem.system(picked)
        new = []
        for p in factors:
            for T in least_minimizers(system, p, rng):
                subspace = exact_subspace(system, T, p)
                if subspace is not None:
                    new.append(_cut(problem, subspace, p))
                    break
        if new:
            cuts += new
        elif canonical:
            return chosen
        else:
            canonical = True


def _cut(problem: _Problem, subspace: ExactSubspace, p: Polynomial) -> tuple[CoveringCut, ArcCut]:
    """The candidates that break an obstruction: j → i, i outside T, with S_j U ≠ 0 modulo p."""
    subspace = _trimmed(subspace)
    U = subspace.U
    senders = {j for j in range(problem.plant.m) if not ((problem.carried(j) @ U) % p).is_zero()}
    breaking = frozenset(
        k
        for k, (j, i) in enumerate(problem.candidates)
        if j in senders and i not in subspace.channels_T
    )
    return CoveringCut(breaking, 1), ArcCut(p, evidence(problem.system(()), subspace))


def _trimmed(subspace: ExactSubspace) -> ExactSubspace:
    """The same with rank B_T + 1 columns: the fewer columns, the fewer arcs break it."""
    keep = range(len(subspace.pivots) - subspace.deficiency + 1)
    return replace(
        subspace,
        U=subspace.U.take(cols=keep),
        V=subspace.V.take(cols=keep),
        pivots=tuple(subspace.pivots[k] for k in keep),
        deficiency=1,
    )
