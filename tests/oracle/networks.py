"""Networks with delays: what is fixed, controllable and connected, for section V of the paper."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from mcexact.analysis.controllability import joint_controllability, joint_observability
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.structure import JointControllability, TransferGraph
from mcexact.derived.constructions import Share, extended_system, held_system, lifted_system
from mcexact.exact.polynomial import Polynomial
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph


@dataclass(frozen=True)
class NetworkVerdict:
    """What is fixed, controllable, observable and connected in an extended system.

    Attributes
    ----------
    system : MultiChannelSystem
        The extended, lifted or held system.
    spectrum : FixedSpectrum
    controllability, observability : JointControllability
        Of all channels together.
    """

    system: MultiChannelSystem
    spectrum: FixedSpectrum
    controllability: JointControllability
    observability: JointControllability

    @property
    def nothing_fixed(self) -> bool:
        """Whether no mode is fixed: Theorem 2 of the extended, Theorem 4 of the held system."""
        return self.spectrum.empty

    @property
    def only_zero_fixed(self) -> bool:
        """Whether no mode but 0 is fixed: Theorem 3."""
        return is_power_of_x(self.spectrum.polynomial)

    @property
    def only_zero_uncontrollable(self) -> bool:
        """Whether no mode but 0 is uncontrollable: section V-A, before the proof of Theorem 3."""
        return is_power_of_x(self.controllability.uncontrollable_polynomial)

    @property
    def certificates(self) -> tuple[Any, ...]:
        """The evidence for all of it."""
        return (
            self.spectrum,
            self.controllability,
            self.observability,
        )


def is_power_of_x(p: Polynomial) -> bool:
    """Whether a monic polynomial is 1, x, x², ….

    Examples
    --------
    >>> is_power_of_x(Polynomial.of(0, 0, 1)), is_power_of_x(Polynomial.of(1, 1))
    (True, False)
    """
    return not any(p.coefficients[:-1])


def extended_verdict(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    graph: NeighborGraph | None = None,
    share: Share = "outputs+states",
) -> NetworkVerdict:
    """Decide the extended system without delays.

    Parameters
    ----------
    system : MultiChannelSystem
    dimensions : sequence of m int
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    share : {"outputs+states", "states"}

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> alone = extended_verdict(plant, [1, 1, 1], NeighborGraph.empty(plant.names))
    >>> alone.controllability.controllable, alone.observability.controllable
    (True, True)
    >>> alone.nothing_fixed
    False
    """
    return _verdict(extended_system(system, dimensions, share, graph))


def lifted_verdict(
    system: MultiChannelSystem,
    dimensions: Sequence[int],
    graph: NeighborGraph | None = None,
    share: Share = "outputs+states",
) -> NetworkVerdict:
    """Decide the lifted system: Theorem 3 says that at most 0 is fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        In discrete time.
    dimensions : sequence of m int
    graph : NeighborGraph, optional
        With delays; overrides ``system.neighbors``.
    share : {"outputs+states", "states"}

    Examples
    --------
    >>> graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 2), (1, 0, 1)])
    >>> plant = MultiChannelSystem([[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete")
    >>> found = lifted_verdict(plant, [0, 0], graph)
    >>> found.only_zero_fixed, found.only_zero_uncontrollable, found.observability.controllable
    (True, True, True)
    """
    return _verdict(lifted_system(system, dimensions, share, graph))


def held_verdict(
    system: MultiChannelSystem, dimensions: Sequence[int], graph: NeighborGraph | None = None
) -> NetworkVerdict:
    """Decide the held system: Theorem 4 says that nothing is fixed.

    Parameters
    ----------
    system : MultiChannelSystem
        In discrete time.
    dimensions : sequence of m int
    graph : NeighborGraph, optional
        With delays; overrides ``system.neighbors``.
    """
    return _verdict(held_system(system, dimensions, graph))


def _verdict(system: MultiChannelSystem) -> NetworkVerdict:
    return NetworkVerdict(
        system, fixed_spectrum(system), joint_controllability(system), joint_observability(system)
    )


@dataclass(frozen=True)
class ConnectivityComparison:
    """A network's transfer graph beside the union of neighbor graph and transfer graph.

    Attributes
    ----------
    union_connected : bool
        Whether the union is strongly connected.
    network_connected : bool
        Whether the transfer graph of the network is.
    union_contained : bool
        Whether every arc of the union is one of the network's transfer graph.
    plant, network : TransferGraph
    """

    union_connected: bool
    network_connected: bool
    union_contained: bool
    plant: TransferGraph
    network: TransferGraph


def connectivity(
    system: MultiChannelSystem, network: MultiChannelSystem, graph: NeighborGraph | None = None
) -> ConnectivityComparison:
    """Compare the transfer graph of a lifted or held system with the union of the two graphs.

    Parameters
    ----------
    system : MultiChannelSystem
        The plant.
    network : MultiChannelSystem
        Made of it, all dimensions positive.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.

    Notes
    -----
    Paper, section V-B, after Theorem 4: with positive dimensions the held system's transfer graph
    is strongly connected iff the union is.  Section V-A: the union lies in the lifted system's.

    Examples
    --------
    >>> graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 2)])
    >>> plant = MultiChannelSystem([[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete")
    >>> found = connectivity(plant, held_system(plant, [1, 1], graph), graph)
    >>> found.union_connected, found.network_connected, found.union_contained
    (True, True, True)
    """
    system, found = with_graph(system, graph)
    before, after = transfer_graph(system), transfer_graph(network)
    at = {name: place for place, name in enumerate(system.names)}
    union = set(found.edges()) | {(at[j], at[i]) for j, i in before.arcs if j != i}
    joined = NeighborGraph(
        system.names,
        [[j for j in range(system.m) if (j, i) in union] for i in range(system.m)],
    )
    seen = {(at[j], at[i]) for j, i in after.arcs}
    return ConnectivityComparison(
        joined.is_strongly_connected(), after.strongly_connected, union <= seen, before, after
    )
