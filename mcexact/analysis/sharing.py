"""The least that agents must share, and over which links.

Agents that share outputs or states over a graph act as a system with larger outputs, the extended
system.  Each function decides the least that removes its fixed modes, with a proof that less does
not:

- `shared_dimension_bound`: Theorem 2's dimensions, which suffice for every agent; by `deficiency`,
  the largest n − rank P_s(λ), and without an optimization;
- `minimal_shared_dimensions`: dimensions n_i of least cost Σ c_i n_i; NP-hard;
- `common_dimension`: the least n_i = k for all agents, by Newton's method in at most m steps;
- `minimal_communication`: the cheapest links to add to the graph, by the same search as for
  dimensions;
- `neighbor_graph`: whether the graph is strongly connected.

No subset of channels is enumerated.  The search generates cuts (`covering_optimum`).  A covering
program with the cuts so far proposes a point; the fixed spectrum of the system at this point either
confirms it, or yields a subset of channels or an obstruction, which becomes a cut that every
sufficient point satisfies.  The covering program itself is solved by `covering`, whose branch tree
proves that nothing is cheaper.  Among the cheapest points a fixed order selects one, so the answer
does not depend on the course of the search.

A certificate has the optimum with a proof that it suffices (`absence`), each cut with the evidence
of its subset, and the branch tree.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Literal, get_args

from mcexact.analysis.blocks import free_blocks
from mcexact.analysis.covering import (
    DEFAULT_NODE_LIMIT,
    CoveringCut,
    CoveringProgram,
    Node,
    Tree,
    branch_tree,
    minimize,
    relaxation_bound,
)
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.nested_sets import (
    Inequalities,
    NestedSets,
    largest_lower_bound,
    nested_sets,
)
from mcexact.analysis.structure import (
    suspected_edges,
    transfer_graph,
    witnessed_powers,
    zero_transfer,
)
from mcexact.analysis.subspaces import (
    ExactSubspace,
    Obstruction,
    complement,
    decide,
    evidence,
    exact_subspace,
    obstruction_modulo,
    plain_evidence,
)
from mcexact.answer.evidence import Absence, BlocksAbsence, ConnectivityCut, DeficiencyCut, LinkCut
from mcexact.answer.modes import ByBlocks as FixedByBlocks
from mcexact.answer.sharing import (
    ByBlocks,
    ByCompletion,
    CommonDimension,
    Deficiency,
    MinimalCommunication,
    NeighborGraphVerdict,
    RankLoss,
    SharedDimensions,
)
from mcexact.derived.constructions import (
    Share,
    add_links,
    augmented_outputs,
    checked_share,
    dual,
    extended_system,
    selector,
)
from mcexact.derived.modular import (
    ModularSystem,
    closed_loop,
    drawn_gains,
    generator,
    lifted,
    lifted_gains,
    residue_systems,
)
from mcexact.errors import (
    InputError,
    InternalError,
    LimitReached,
    UsageError,
    one_of,
    several,
    shown_value,
)
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix, as_requested, block_diagonal
from mcexact.exact.modular import polynomial_residues, random_matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import Entry
from mcexact.exact.roots import StabilityRegion
from mcexact.model.graph import NeighborGraph, strong_components
from mcexact.model.system import MultiChannelSystem, with_graph, with_links

# Cuts: subsets of channels that a choice of dimensions violates.

Channels = tuple[int, ...]


def violating_factors(
    system: MultiChannelSystem, region: StabilityRegion | None
) -> tuple[Polynomial, ...]:
    """The irreducible factors of det(xI − A) with a root outside the region; all if it is None.

    Parameters
    ----------
    system : MultiChannelSystem
    region : StabilityRegion or None
        The modes outside of it must not be fixed.

    Examples
    --------
    >>> system = MultiChannelSystem([[1, 0], [0, -1]], [[[1], [1]]], [[[1, 1]]])
    >>> [str(p) for p in violating_factors(system, StabilityRegion("continuous"))]
    ['x - 1']
    """
    factors = [p for p, _ in characteristic_polynomial(system.A).factor()]
    return tuple(p for p in factors if region is None or not region.contains_roots_of(p))


def boundary(graph: NeighborGraph, s: Sequence[int]) -> frozenset[int]:
    """N_s∖s, the agents outside s whose messages agents in s receive.

    The extended system has a fixed mode unless, for every s, the dimensions of their shared
    sub-states sum up to at least the deficiency of P_s.

    Examples
    --------
    >>> ring = NeighborGraph.ring(["1", "2", "3"])
    >>> boundary(ring, [0]), boundary(ring, [0, 1, 2])
    (frozenset({1}), frozenset())
    """
    return frozenset(graph.union(s)) - frozenset(s)


def least_minimizers(
    system: MultiChannelSystem, p: Polynomial, rng: random.Random
) -> Iterator[Channels]:
    """The least T with rank P_s(λ) least and below n, s its complement, prime after prime.

    Yields nothing iff no root of p is fixed.  Each T is correct for all but finitely many primes,
    so that results must be checked exactly.
    """
    for modular in residue_systems(system, rng):
        roots = polynomial_residues(p, modular.modulus).roots()
        if roots:
            obstruction = obstruction_modulo(modular, drawn_gains(modular, rng), min(roots))
            if obstruction is None:
                return
            yield obstruction.channels_T


def _extreme_minimizers(
    system: MultiChannelSystem, p: Polynomial, rng: random.Random
) -> Iterator[tuple[Channels, Channels]]:
    """The least and the greatest T with rank P_s(λ) least and below n, prime after prime.

    The pencil of the dual system for s is the transpose of that of the system for the complement
    of s, so the greatest T is the complement of the dual's least one.
    """
    other = least_minimizers(dual(system), p, rng)
    for T in least_minimizers(system, p, rng):
        yield T, complement(system.m, next(other, ()))


def violated_subsets(
    base: MultiChannelSystem,
    extended: MultiChannelSystem,
    factors: Sequence[Polynomial],
    dimensions: Sequence[int],
    graph: NeighborGraph,
    rng: random.Random,
) -> list[CoveringCut]:
    """Subsets s with Σ n_i over N_s∖s below the deficiency of P_s; empty iff there is none.

    Parameters
    ----------
    base : MultiChannelSystem
        The system with the pencils P_s: the plant, or the plant with augmented outputs.
    extended : MultiChannelSystem
        The extended system with these dimensions.
    factors : sequence of Polynomial
        Irreducible factors of det(xI − A): the modes that count.
    dimensions : sequence of m int
    graph : NeighborGraph
    rng : random.Random
    """
    cuts: list[CoveringCut] = []
    for p in factors:
        for pair in _extreme_minimizers(extended, p, rng):
            here = []
            for T in dict.fromkeys(pair):
                s = complement(base.m, T)
                subspace, around = exact_subspace(base, T, p), boundary(graph, s)
                if subspace and sum(dimensions[i] for i in around) < subspace.deficiency:
                    lost, shrunk = subspace.deficiency, evidence(base.names, subspace)
                    cut = DeficiencyCut(base.named(s), p, lost, shrunk)
                    here.append(CoveringCut(around, lost, cut))
            if here:
                cuts += here
                break
    return cuts


def absence(
    system: MultiChannelSystem,
    region: StabilityRegion | None,
    rng: random.Random,
    *,
    connected: bool = False,
) -> BlocksAbsence | Absence:
    """Prove that no mode outside a region is fixed and, on request, that the graph is connected.

    Parameters
    ----------
    system : MultiChannelSystem
        The extended system at the optimum, or another system without fixed modes outside.
    region : StabilityRegion or None
        Modes inside of it may be fixed; with None no mode may be.
    rng : random.Random
    connected : bool
        Whether to prove also that the transfer graph is strongly connected.

    Raises
    ------
    InternalError
        If some mode outside the region is fixed, or the transfer graph is not connected.
    """
    blocks = free_blocks(system)
    if blocks is not None:
        if not connected:
            return BlocksAbsence(blocks)
        modular = next(residue_systems(system, rng))
        return BlocksAbsence(blocks, modular.modulus, _connecting_edges(modular, rng))
    decision = decide(system, rng)
    allowed = tuple((o.polynomial, o.multiplicity_in_A) for o in decision.obstructions)
    if any(region is None or not region.contains_roots_of(p) for p, _ in allowed):
        raise InternalError("a fixed mode was left after the last cut")
    return Absence(
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        allowed=allowed,
        arcs=_connecting_edges(decision.modular, rng) if connected else None,
    )


def _connecting_edges(
    modular: ModularSystem, rng: random.Random
) -> tuple[tuple[str, str, int], ...]:
    """Edges with a nonzero Markov parameter modulo ℓ, which make the graph strongly connected."""
    system = modular.system
    powers = witnessed_powers(modular, suspected_edges(modular, rng))
    if len(strong_components(system.m, sorted(powers))) > 1:
        raise InternalError("the extended transfer graph is not strongly connected")
    names = system.names
    return tuple((names[j], names[i], k) for (j, i), k in sorted(powers.items()))


# Cut generation: the cheapest point of a covering program whose cuts are generated by an oracle.


@dataclass(frozen=True)
class CoveringProblem:
    """A covering problem whose cuts are generated by an oracle.

    Attributes
    ----------
    kind : str
        The kind of the certificate, which seeds the random draws.
    program : CoveringProgram
        Prices and upper limits of the variables, without cuts.
    system : callable
        A function that makes the system for a point.
    violated : callable
        A function of a point and its system that returns necessary cuts which this point violates;
        none iff the system has the required properties.
    region : StabilityRegion or None
        The region in which modes may be fixed; None if no mode may be.
    connected : bool
        Whether the transfer graph has to be strongly connected as well.
    by_factor : callable
        The inequalities of each factor at whose roots rank is lost, from which nested sets may be
        chosen: for one factor alone they prove the optimum in place of a branch tree.
    bounds : bool
        Whether a lower bound serves at the node limit, where the cheapest point found is not proved
        to be the cheapest.
    """

    kind: str
    program: CoveringProgram
    system: Callable[[Sequence[int]], MultiChannelSystem]
    violated: Callable[[Sequence[int], MultiChannelSystem], list[CoveringCut]]
    region: StabilityRegion | None = None
    connected: bool = False
    by_factor: Callable[[], Sequence[Inequalities]] = tuple
    bounds: bool = False


@dataclass(frozen=True)
class CoveringOptimum:
    """A cheapest point, or None, with the evidence that no point is cheaper.

    Attributes
    ----------
    values : tuple of int, or None
        The point; None if no point satisfies all cuts.
    cost : Fraction or None
    at_least : Fraction or None
        What every point costs at least, if the tree does not prove that none is cheaper.
    absence : BlocksAbsence, Absence or None
        The evidence that the system has the required properties at ``values``.
    cuts : tuple of CoveringCut
    nodes : Tree
        The branch tree, in which cuts are positions in ``cuts``.
    """

    values: tuple[int, ...] | None
    cost: Fraction | None
    at_least: Fraction | None
    absence: BlocksAbsence | Absence | None
    cuts: tuple[CoveringCut, ...]
    nodes: Tree

    def with_cuts_of_leaves(self) -> CoveringOptimum:
        """The same proof without the cuts that no leaf names."""
        named = {node["violated"] for node in self.nodes if "violated" in node}
        named |= {k for node in self.nodes for k, _ in node.get("multipliers", ())}
        named |= {k for node in self.nodes for k, _ in node.get("nested", ())}
        used = sorted(named)
        place = {k: new for new, k in enumerate(used)}

        def renumbered(node: Node) -> Node:
            if "violated" in node:
                return {"violated": place[node["violated"]]}
            if "multipliers" in node:
                return {"multipliers": [[place[k], y] for k, y in node["multipliers"]]}
            if "nested" in node:
                return {"nested": [[place[k], y] for k, y in node["nested"]]}
            return node

        cuts = tuple(self.cuts[k] for k in used)
        return replace(self, cuts=cuts, nodes=tuple(map(renumbered, self.nodes)))

    def tree(self, key: str, labels: Sequence[Any]) -> Tree:
        """The nodes as a certificate has them: variables by their labels under ``key``."""
        return tuple(
            {key: labels[node["variable"]], "at_most": node["at_most"]}
            if "variable" in node
            else node
            for node in self.nodes
        )


def covering_optimum(problem: CoveringProblem, node_limit: int) -> CoveringOptimum:
    """Find the cheapest point that violates nothing, and prove that nothing is cheaper.

    Parameters
    ----------
    problem : CoveringProblem
    node_limit : int
        Nodes of the branch tree after which to give up, at least 1.

    Raises
    ------
    UsageError
        If the node limit is not an integer of at least 1.
    LimitReached
        At the node limit, where its ``lower`` and ``upper`` bound the least cost, unless the
        problem takes a lower bound instead; or if the prices are too far apart.

    Notes
    -----
    A covering program proposes a point; the oracle ``problem.violated`` confirms it, or gives cuts
    that the point violates and every point that suffices satisfies.  Among the cheapest points the
    lexicographically least is taken, once one of them is confirmed.
    """
    if type(node_limit) is not int or node_limit < 1:
        expected = f"expected an integer of at least 1, found {node_limit!r}"
        raise UsageError(expected, where="node_limit")
    program, canonical = problem.program, False
    while True:
        values = minimize(program, canonical=canonical)
        if values is None:
            tree = branch_tree(program, None, node_limit=node_limit)
            return CoveringOptimum(None, None, None, None, program.cuts, tree)
        system = problem.system(values)
        cuts = problem.violated(values, system)
        if canonical and not cuts:
            break
        canonical = canonical or not cuts
        program = replace(program, cuts=(*program.cuts, *cuts))
    cost = program.cost(values)
    proof = _by_nested_sets(problem, program, cost) or _proof(problem, program, cost, node_limit)
    rng = generator(system, problem.kind)
    evidence = absence(system, problem.region, rng, connected=problem.connected)
    return CoveringOptimum(
        values, cost, None if proof.bound == cost else proof.bound, evidence, proof.cuts, proof.tree
    )


@dataclass(frozen=True)
class _Proof:
    """Cuts, and a tree which proves that they leave no cost below a bound."""

    bound: Fraction
    cuts: tuple[CoveringCut, ...]
    tree: Tree

    @classmethod
    def of(cls, proof: NestedSets, most: Fraction) -> _Proof:
        return cls(min(proof.cost, most), proof.cuts, proof.tree)


def _by_nested_sets(
    problem: CoveringProblem, program: CoveringProgram, cost: Fraction
) -> _Proof | None:
    """The nested sets that prove the cost, if one factor alone loses rank."""
    if not cost or any(limit is not None for limit in program.upper):
        return None
    factors = problem.by_factor()
    proof = nested_sets(program, cost, factors[0]) if len(factors) == 1 else None
    return None if proof is None else _Proof.of(proof, cost)


def _proof(
    problem: CoveringProblem, program: CoveringProgram, cost: Fraction, node_limit: int
) -> _Proof:
    """The cuts and the branch tree that prove that nothing is cheaper.

    At the node limit the linear relaxation, and nested sets of each factor, prove lower bounds.
    """
    try:
        return _Proof(cost, program.cuts, branch_tree(program, cost, node_limit=node_limit))
    except LimitReached as error:
        if error.lower is None:
            raise
        if not problem.bounds:
            message = f"{error.message}; the least cost is between {error.lower} and {cost}"
            raise LimitReached(message, lower=error.lower, upper=cost) from None
    bound, tree = relaxation_bound(program, cost)
    one_factor = largest_lower_bound(program, problem.by_factor())
    if one_factor is not None and one_factor.cost > bound:
        return _Proof.of(one_factor, cost)
    return _Proof(min(bound, cost), program.cuts, tree)


# The largest deficiency n − rank P_s(λ): on (A, B_i, C_{N_i}) it is the bound of Theorem 2.

# Up to this size one completed loop is the shorter evidence, and quick to check.
_SMALL = 128


def deficiency(system: MultiChannelSystem) -> Deficiency:
    """Compute the largest n − rank P_s(λ) over all s and all λ.

    Parameters
    ----------
    system : MultiChannelSystem

    Notes
    -----
    Exact.  ρ is the largest dimension of a null space of λI − A_F for gains F that make each of
    them least.  From above: A_F + B_0 C_0 with ρ columns and rows has no eigenvalue of A.  From
    below: a shrunk subspace of deficiency ρ.  For large systems the fixed spectrum proves both
    where its evidence is by blocks.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A, b = [[1, 0], [0, 1]], [[1], [0]]
    >>> deficiency(MultiChannelSystem(A, [b, b], [[[1, 0]], [[0, 1]]])).deficiency
    1
    """
    if system.n > _SMALL:
        found = _by_blocks(system)
        if found is not None:
            return found
    rng = generator(system, "deficiency")
    decision = decide(system, rng)
    worst: Obstruction | None = max(
        decision.obstructions, key=lambda o: o.subspace.deficiency, default=None
    )
    rho = worst.subspace.deficiency if worst else 0
    modular = decision.modular
    n, ell = system.n, modular.modulus
    modes = modular.A.characteristic_polynomial()
    closed = closed_loop(modular, decision.gains)
    while True:
        B0, C0 = random_matrix(n, rho, ell, rng), random_matrix(rho, n, ell, rng)
        if (closed + B0 @ C0).characteristic_polynomial().gcd(modes).degree == 0:
            break
    return Deficiency(
        system,
        deficiency=rho,
        evidence=ByCompletion(
            modulus=ell,
            gains=lifted_gains(modular, decision.gains),
            B0=lifted(B0),
            C0=lifted(C0),
            polynomial=worst.polynomial if worst else None,
            subspace=evidence(system.names, worst.subspace) if worst else None,
        ),
    )


def _by_blocks(system: MultiChannelSystem) -> Deficiency | None:
    """The deficiency that the fixed spectrum proves, if its evidence is by blocks."""
    spectrum = fixed_spectrum(system)
    proof = spectrum.evidence
    if not isinstance(proof, FixedByBlocks):
        return None
    losses = tuple(
        RankLoss(factor.polynomial, system.n - factor.rank, space)
        for factor, space in zip(spectrum.factors, proof.subspaces, strict=True)
    )
    return Deficiency(
        system,
        deficiency=max((loss.deficiency for loss in losses), default=0),
        evidence=ByBlocks(proof.blocks, proof.modulus, losses),
    )


# Dimensions of shared sub-states: the bound of Theorem 2, and the least.


def base_system(system: MultiChannelSystem, share: str) -> MultiChannelSystem:
    """Return the base system: the plant, with augmented outputs if outputs are shared."""
    return augmented_outputs(system) if share == "outputs+states" else system


def shared_dimension_bound(
    system: MultiChannelSystem, graph: NeighborGraph | None = None, share: Share = "outputs+states"
) -> Deficiency:
    """Compute Theorem 2's bound: dimensions that suffice for every agent.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    share : {"outputs+states", "states"}
        Theorem 2's bound (26) or Remark 2's (27).

    Raises
    ------
    UsageError
        If there is no neighbor graph.

    Notes
    -----
    Exact, and no subset is enumerated: ρ is the largest deficiency of (A, B_i, C_{N_i}), or of (A,
    B_i, C_i), over all λ and all subsets, ∅ and all channels included.  These two have deficiency 0
    if the plant is jointly controllable and observable, as the theorem assumes.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> shared_dimension_bound(plant, NeighborGraph.ring(plant.names)).deficiency
    1
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, _ = with_graph(system, graph)
    return deficiency(base_system(system, checked_share(share)))


def minimal_shared_dimensions(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    share: Share = "outputs+states",
    *,
    costs: Sequence[Entry] | None = None,
    upper: Sequence[int | None] | None = None,
    region: StabilityRegion | None = None,
    rate: Entry | None = None,
    radius: Entry | None = None,
    free_assignability: bool = False,
    node_limit: int = DEFAULT_NODE_LIMIT,
) -> SharedDimensions:
    """Compute the least Σ c_i n_i for which the extended system has no fixed mode.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, not a derived system.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    share : {"outputs+states", "states"}
    costs : sequence of m rationals > 0, optional
        The price of one dimension of each agent, 1 by default.
    upper : sequence of m int or None, optional
        Upper limits of the n_i.
    region : StabilityRegion, optional
        Modes inside this region may be fixed; by default no mode may be.
    rate, radius : rational, optional
        The rate (continuous time) or the radius (discrete time) of the region.
    free_assignability : bool
        Require also a strongly connected extended transfer graph, so that the whole closed-loop
        spectrum is freely assignable.
    node_limit : int
        The number of nodes of the branch tree after which the search ends, at least 1.  The answer
        then has dimensions that suffice, and in ``at_least`` a bound below which no cost does; both
        are certified.

    Raises
    ------
    UsageError
        If there is no neighbor graph, the system is a derived one, or a price, an upper limit,
        the rate, the radius or the node limit is out of range.
    LimitReached
        At the node limit if no dimensions suffice, or if the prices are too far apart.

    Notes
    -----
    The extended system has no fixed mode iff Σ n_i over N_s∖s is at least n − rank P_s(λ) for all s
    and λ.  An integer program proposes dimensions.  The fixed spectrum of the extended system
    either confirms them or gives a subset that they violate, which becomes a cut.  The certificate
    proves that the optimum suffices, proves every cut, and excludes a lower cost by a branch tree.
    Where the roots of one irreducible factor alone lose rank, nested sets exclude a lower cost in
    place of the tree (`nested_sets`).  The problem is NP-hard (it contains vertex cover).  Among
    optimal dimensions the lexicographically least are taken.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> ring = NeighborGraph.ring(plant.names)
    >>> minimal_shared_dimensions(plant, ring).dimensions
    (0, 0, 1)
    >>> minimal_shared_dimensions(plant, ring, "states").dimensions
    (1, 0, 1)
    >>> minimal_shared_dimensions(plant, NeighborGraph.empty(plant.names)).feasible
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, neighbors = plant_with_graph(system, graph, share)
    program = _program(system.m, costs, upper)
    region = StabilityRegion.asked(system.time, region, rate, radius)
    base, factors = base_system(system, share), violating_factors(system, region)
    rng = generator(base, SharedDimensions.kind)

    def violated(sizes: Sequence[int], extended: MultiChannelSystem) -> list[CoveringCut]:
        cuts = violated_subsets(base, extended, factors, sizes, neighbors, rng)
        return cuts or (_connectivity_cuts(base, extended, neighbors) if free_assignability else [])

    def extended(sizes: Sequence[int]) -> MultiChannelSystem:
        return extended_system(system, sizes, share)

    def by_factor() -> list[Inequalities]:
        return _by_factor(base, factors, neighbors, extended) if not free_assignability else []

    problem = CoveringProblem(
        SharedDimensions.kind,
        program,
        extended,
        violated,
        region,
        free_assignability,
        by_factor,
        bounds=True,
    )
    least = covering_optimum(problem, node_limit).with_cuts_of_leaves()
    return SharedDimensions(
        system,
        share=share,
        bound=None if region is None else region.edge,
        free_assignability=free_assignability,
        costs=program.costs,
        upper=program.upper,
        feasible=least.values is not None,
        dimensions=least.values,
        cost=least.cost,
        at_least=least.at_least,
        absence=least.absence,
        cuts=tuple(cut.evidence for cut in least.cuts),
        tree=least.tree("agent", system.names),
    )


def _by_factor(
    base: MultiChannelSystem,
    factors: Sequence[Polynomial],
    graph: NeighborGraph,
    extended: Callable[[Sequence[int]], MultiChannelSystem],
) -> list[Inequalities]:
    """The inequalities of each factor at whose roots pencils lose rank."""
    deficient = {each.polynomial for each in decide(base, generator(base, "nested")).obstructions}
    return [_of_factor(base, p, graph, extended) for p in factors if p in deficient]


def _of_factor(
    base: MultiChannelSystem,
    p: Polynomial,
    graph: NeighborGraph,
    extended: Callable[[Sequence[int]], MultiChannelSystem],
) -> Inequalities:
    """The inequalities of one factor."""
    rng = generator(base, "nested")

    def cut(s: Iterable[int]) -> CoveringCut | None:
        members = tuple(sorted(s))
        subspace = exact_subspace(base, complement(base.m, members), p)
        if subspace is None:
            return None
        lost = subspace.deficiency
        shrunk = DeficiencyCut(base.named(members), p, lost, evidence(base.names, subspace))
        return CoveringCut(boundary(graph, members), lost, shrunk)

    def violated(sizes: Sequence[int]) -> list[CoveringCut]:
        return violated_subsets(base, extended(sizes), [p], sizes, graph, rng)

    def subset(known: CoveringCut) -> frozenset[int]:
        return frozenset(base.indices(known.evidence.subset))

    return Inequalities(cut, subset, violated)


def plant_with_graph(
    system: MultiChannelSystem, graph: NeighborGraph | None, share: Share
) -> tuple[MultiChannelSystem, NeighborGraph]:
    """Check the way of sharing, and return a plant with its graph.

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the system is a derived one.
    """
    checked_share(share)
    system, neighbors = with_graph(system, graph)
    if system.subject:
        raise UsageError("give the plant, not a system derived from it", where="system")
    return system, neighbors


def _program(
    m: int, costs: Sequence[Entry] | None, upper: Sequence[int | None] | None
) -> CoveringProgram:
    numbers = [1] * m if costs is None else several(costs, "costs", "numbers")
    prices = tuple(as_requested(c, where=f"costs[{i}]") for i, c in enumerate(numbers))
    if len(prices) != m or any(price <= 0 for price in prices):
        raise UsageError(f"expected {m} positive numbers, one for each agent", where="costs")
    limits = (None,) * m if upper is None else several(upper, "upper", "integers")
    if len(limits) != m or any(u is not None and (type(u) is not int or u < 0) for u in limits):
        raise UsageError(f"expected {m} integers >= 0 or None, one for each agent", where="upper")
    return CoveringProgram(prices, limits)


def _connectivity_cuts(
    base: MultiChannelSystem, extended: MultiChannelSystem, graph: NeighborGraph
) -> list[CoveringCut]:
    """The cut of one strong component that no edge leaves, if there is more than one component."""
    transfers = transfer_graph(extended)
    if transfers.strongly_connected:
        return []
    closed = next(
        component
        for component in transfers.components
        if all(i in component for j, i in transfers.arcs if j in component)
    )
    T = base.indices(closed)
    s = complement(base.m, T)
    rng = generator(base, SharedDimensions.kind)
    zero = zero_transfer(base, T, controllable_subspace(base.A, base.input_matrix(T), rng))
    return [CoveringCut(boundary(graph, s), 1, ConnectivityCut(base.named(s), zero))]


# The least common dimension.


def common_dimension(
    system: MultiChannelSystem, graph: NeighborGraph | None = None, share: Share = "outputs+states"
) -> CommonDimension:
    """Compute the least k such that with n_i = k for all i the extended system has no fixed mode.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant, not a derived system.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    share : {"outputs+states", "states"}

    Raises
    ------
    UsageError
        If there is no neighbor graph, or the system is a derived one.

    Notes
    -----
    Exact, and no subset is enumerated.  With δ_s(λ) = n − rank P_s(λ) the answer is the largest
    ⌈δ_s(λ) / |N_s∖s|⌉ over all s and λ; if δ_s(λ) > 0 and N_s∖s is empty for some s and λ, no k
    suffices. Newton's method: the fixed spectrum of the extended system for k confirms k, or names
    an s with |N_s∖s| k < δ_s(λ), from which the next k is read.  |N_s∖s| falls from step to step
    for each mode, so there are at most m steps.  The certificate has the last s, for which k − 1
    does not suffice; it proves that k suffices as for `minimal_shared_dimensions`.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> common_dimension(plant, NeighborGraph.ring(plant.names)).dimension
    1
    >>> common_dimension(plant, NeighborGraph.empty(plant.names)).feasible
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, neighbors = plant_with_graph(system, graph, share)
    base = base_system(system, share)
    rng = generator(base, CommonDimension.kind)
    factors = [obstruction.polynomial for obstruction in decide(base, rng).obstructions]
    k, cut = 0, None
    while True:
        extended = extended_system(system, [k] * system.m, share)
        cuts = violated_subsets(base, extended, factors, [k] * system.m, neighbors, rng)
        if not cuts:
            proof = absence(extended, None, generator(extended, CommonDimension.kind))
            return CommonDimension(
                system, share=share, feasible=True, dimension=k, absence=proof, cut=cut
            )
        worst = max(cuts, key=lambda cut: (not cut.support, _enough(cut)))
        k, cut = _enough(worst), worst.evidence
        if not worst.support:
            return CommonDimension(
                system, share=share, feasible=False, dimension=None, absence=None, cut=cut
            )


def _enough(cut: CoveringCut) -> int:
    """The least k for which k times the support's size is at least the demand, if there is one."""
    return -(-cut.demand // max(1, len(cut.support)))


# Communication links.

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
        return CoveringCut(breaking, 1, LinkCut(p, plain_evidence(self.plant.names, subspace)))


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
    candidates is taken, where the last links are preferred.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> minimal_communication(plant, NeighborGraph.empty(plant.names)).added
    (('1', '2'),)
    """
    InputError.require(system, MultiChannelSystem, "system")
    linked, neighbors = with_links(system, graph)
    links = _checked(linked.with_neighbors(neighbors), neighbors, dimensions, share, forbidden)
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
        linked,
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
        raise UsageError(
            "links are sought for a plant without feedthrough, not for a system derived from it",
            where="system",
        )
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
    """The price of each candidate, 1 by default."""
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
            f"expected links as pairs (sender, receiver) of names, found {shown_value(edge)}",
            where=where,
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


def neighbor_graph(
    system: MultiChannelSystem, graph: NeighborGraph | None = None
) -> NeighborGraphVerdict:
    """Decide whether the neighbor graph of a system is strongly connected.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Instead of ``system.neighbors``.

    Raises
    ------
    UsageError
        If there is no neighbor graph.
    """
    InputError.require(system, MultiChannelSystem, "system")
    system, graph = with_graph(system, graph)
    return NeighborGraphVerdict(system, strongly_connected=graph.is_strongly_connected())
