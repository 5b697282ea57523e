"""The dimensions that agents must share: Theorem 2's bound, and the least, by cut generation."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.analysis.engine import DEFAULT_NODE_LIMIT, CoveringCut, CoveringProgram, zero_transfer
from mcexact.analysis.sharing.cut_generation import CoveringProblem, covering_optimum
from mcexact.analysis.sharing.deficiency import deficiency
from mcexact.analysis.sharing.separation import (
    boundary,
    complement,
    violated_subsets,
    violating_factors,
)
from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.answer.covering import ConnectivityCut
from mcexact.answer.deficiency import Deficiency
from mcexact.answer.shared_dimensions import SharedDimensions
from mcexact.derived.constructions import Share, augmented_outputs, checked_share, extended_system
from mcexact.derived.modular import generator
from mcexact.errors import InputError, UsageError, several
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.matrix import as_requested
from mcexact.exact.rational import Entry
from mcexact.exact.roots import StabilityRegion
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


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
        The number of nodes of the branch tree after which the search ends, at least 1.

    Raises
    ------
    UsageError
        If there is no neighbor graph, the system is a derived one, or a price, an upper limit,
        the rate, the radius or the node limit is out of range.
    LimitReached
        At the node limit, where its ``lower`` and ``upper`` bound the least cost; or if the prices
        are too far apart.

    Notes
    -----
    The extended system has no fixed mode iff Σ n_i over N_s∖s is at least n − rank P_s(λ) for all s
    and λ.  An integer program proposes dimensions.  The fixed spectrum of the extended system
    either confirms them or gives a subset that they violate, which becomes a cut.  The certificate
    proves that the optimum suffices, proves every cut, and excludes a lower cost by a branch tree.
    The problem is NP-hard (it contains vertex cover).  Among optimal dimensions the
    lexicographically least are taken.

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
    system, found = plant_with_graph(system, graph, share)
    program = _program(system.m, costs, upper)
    region = StabilityRegion.asked(system.time, region, rate, radius)
    base, factors = base_system(system, share), violating_factors(system, region)
    rng = generator(base, SharedDimensions.kind)

    def violated(sizes: Sequence[int], extended: MultiChannelSystem) -> list[CoveringCut]:
        cuts = violated_subsets(base, extended, factors, sizes, found, rng)
        return cuts or (_connectivity_cuts(base, extended, found) if free_assignability else [])

    problem = CoveringProblem(
        SharedDimensions.kind,
        program,
        lambda sizes: extended_system(system, sizes, share),
        violated,
        region,
        free_assignability,
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
        absence=least.absence,
        cuts=tuple(cut.evidence for cut in least.cuts),
        tree=least.tree("agent", system.names),
    )


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
    system, found = with_graph(system, graph)
    if system.subject:
        raise UsageError("give the plant, not a system derived from it", where="system")
    return system, found


def _program(
    m: int, costs: Sequence[Entry] | None, upper: Sequence[int | None] | None
) -> CoveringProgram:
    given = [1] * m if costs is None else several(costs, "costs", "numbers")
    prices = tuple(as_requested(c, where=f"costs[{i}]") for i, c in enumerate(given))
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
    found = transfer_graph(extended)
    if found.strongly_connected:
        return []
    closed = next(
        component
        for component in found.components
        if all(i in component for j, i in found.arcs if j in component)
    )
    T = base.indices(closed)
    s = complement(base.m, T)
    rng = generator(base, SharedDimensions.kind)
    zero = zero_transfer(base, T, controllable_subspace(base.A, base.input_matrix(T), rng))
    return [CoveringCut(boundary(graph, s), 1, ConnectivityCut(base.named(s), zero))]
