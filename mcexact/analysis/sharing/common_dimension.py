"""The least common dimension: if all agents share equally many sub-states, how many suffice."""

from __future__ import annotations

from mcexact.analysis.engine import CoveringCut, decide
from mcexact.analysis.sharing.allocation import base_system, plant_with_graph
from mcexact.analysis.sharing.separation import absence, violated_subsets
from mcexact.answer.common_dimension import CommonDimension
from mcexact.derived.constructions import Share, extended_system
from mcexact.derived.modular import generator
from mcexact.errors import InputError
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


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
    system, found = plant_with_graph(system, graph, share)
    base = base_system(system, share)
    rng = generator(base, CommonDimension.kind)
    factors = [obstruction.polynomial for obstruction in decide(base, rng).obstructions]
    k, cut = 0, None
    while True:
        extended = extended_system(system, [k] * system.m, share)
        cuts = violated_subsets(base, extended, factors, [k] * system.m, found, rng)
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
