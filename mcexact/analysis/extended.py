"""The paper's statements about extended systems, as decisions: section IV-D and IV-E."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from mcexact.analysis.allocation import shared_dimension_bound
from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.transfer_graph import transfer_graph
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.answer.transfer_graph import TransferGraph
from mcexact.derived.extended import Share, extended_system
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


@dataclass(frozen=True)
class BoundAttained:
    """Whether one agent alone can be held to Theorem 2's bound.

    Attributes
    ----------
    agent : str
    attained : bool
        Whether some subset s has N_s∖s = {agent} and the largest deficiency: then no extended
        system without fixed modes gives this agent less than the bound.
    spectrum : FixedSpectrum
        That of the extended system where this agent falls short of the bound by one and nobody
        else does: empty iff the bound is not attained.
    """

    agent: str
    attained: bool
    spectrum: FixedSpectrum

    @property
    def certificate(self) -> FixedSpectrum:
        """The evidence either way."""
        return self.spectrum


def bound_attained(
    system: MultiChannelSystem, graph: NeighborGraph | None = None, share: Share = "outputs+states"
) -> tuple[BoundAttained, ...]:
    """Decide for every agent whether it alone can be held to the bound of Theorem 2.

    Parameters
    ----------
    system : MultiChannelSystem
        Jointly controllable and observable.
    graph : NeighborGraph, optional
        Strongly connected; overrides ``system.neighbors``.
    share : {"outputs+states", "states"}

    Returns
    -------
    tuple of BoundAttained
        One for each agent; empty when the bound ρ is 0, where there is nothing to attain.

    Notes
    -----
    Paper, after Theorem 2.  Give every other agent ρ and this one ρ − 1.  A subset s violates that
    iff Σ n_i over N_s∖s is below its deficiency, which is at most ρ: iff N_s∖s holds no other agent
    (it is not empty, the graph being strongly connected) and the deficiency is ρ.  So one fixed
    spectrum decides, and no subset is enumerated.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> ring = NeighborGraph.ring(plant.names)
    >>> [(found.agent, found.attained) for found in bound_attained(plant, ring)]
    [('1', False), ('2', False), ('3', True)]
    """
    system, _ = with_graph(system, graph)
    bound = shared_dimension_bound(system, share=share).deficiency
    if bound == 0:
        return ()
    found = []
    for i, agent in enumerate(system.names):
        sizes = [bound - int(i == j) for j in range(system.m)]
        spectrum = fixed_spectrum(extended_system(system, sizes, share))
        found.append(BoundAttained(agent, not spectrum.empty, spectrum))
    return tuple(found)


@dataclass(frozen=True)
class GraphInclusion:
    """Whether the extended transfer graph contains the neighbor graph and the transfer graph.

    Attributes
    ----------
    holds : bool
    missing : tuple of (str, str)
        Arcs of the union that the extended transfer graph lacks.
    plant, extended : TransferGraph
    """

    holds: bool
    missing: tuple[tuple[str, str], ...]
    plant: TransferGraph
    extended: TransferGraph


def graph_inclusion(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    graph: NeighborGraph | None = None,
    share: Share = "outputs+states",
) -> GraphInclusion:
    """Decide whether the union of neighbor and transfer graphs lies in the extended transfer graph.

    Parameters
    ----------
    system : MultiChannelSystem
    dimensions : sequence of m int
        Proposition 3 says yes whenever all of them are positive.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    share : {"outputs+states", "states"}

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> ring = NeighborGraph.ring(plant.names)
    >>> graph_inclusion(plant, [1, 1, 1], ring).holds
    True
    >>> graph_inclusion(plant, [0, 0, 0], ring).missing
    (('3', '2'),)
    """
    system, found = with_graph(system, graph)
    before = transfer_graph(system)
    after = transfer_graph(extended_system(system, dimensions, share))
    names = system.names
    union = {(names[j], names[i]) for j, i in found.edges()} | set(before.arcs)
    order = {name: place for place, name in enumerate(names)}
    missing = sorted(union - set(after.arcs), key=lambda arc: (order[arc[0]], order[arc[1]]))
    return GraphInclusion(not missing, tuple(missing), before, after)
