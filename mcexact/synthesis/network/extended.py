"""Distributed control with shared sub-states, by decentralized control of the extended system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any, Literal

from mcexact.analysis.sharing.allocation import minimal_shared_dimensions, shared_dimension_bound
from mcexact.answer.deficiency import Deficiency
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.shared_dimensions import SharedDimensions
from mcexact.derived.extended import Share, checked_dimensions
from mcexact.errors import InputError, UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, as_plant, with_graph
from mcexact.synthesis.design import Design
from mcexact.synthesis.network.network_design import network_design
from mcexact.synthesis.network.networks import DerivedNetwork, NetworkKind, shared_network
from mcexact.synthesis.request import Arithmetic, Progress, Request

Dimensions = str | Sequence[int]
"""``"minimal"``, ``"bound"``, or n_1 … n_m."""


def design_extended(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    agent: str | None = None,
    *,
    dimensions: Dimensions = "minimal",
    share: Share | None = None,
    network: Literal["extended", "lifted", "held"] | None = None,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    free_assignability: bool = False,
    arithmetic: Arithmetic = "exact",
    progress: Progress | None = None,
) -> Design:
    """Design a linear time-invariant distributed controller of least order on an extended system.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system with n states and m channels.
    graph : NeighborGraph, optional
        With delays, in discrete time; overrides ``system.neighbors``.
    agent : str, optional
        The agent with the channel controller; by default the one that needs the least order.
    dimensions : {"minimal", "bound"} or sequence of m int
        n_1 … n_m: the least that suffice, Theorem 2's bound for every agent, or given ones.
    share : {"outputs+states", "states"}, optional
        The signals that agents send; by default both, but with holding sub-states alone.
    network : {"extended", "lifted", "held"}, optional
        With delays, the lifted system, in which only 0 is fixed (the default), or the held one, in
        which no mode is.
    spectrum : polynomial, list of roots, or mapping, optional
        n̄ + k_q prescribed numbers; see `network_proposals`.  The dimensions then suffice for all
        modes to be moved, or if that is impossible, all modes that are not stable.
    rate, radius : rational, optional
        A rate or radius to be certified, instead of a spectrum or in addition to it.  Only modes
        that violate it need to be moved; fixed modes that meet it remain, and are reported.
    free_assignability : bool
        With ``"minimal"``, share enough that the transfer graph of the extended system is strongly
        connected, so that the spectrum does not split.
    arithmetic : {"exact", "float"}
    progress : callable, optional

    Returns
    -------
    Design
        A design of order k_q + Σ n_i; a distributed observer has order nm + m − 1.

    Raises
    ------
    Impossible
        If no dimensions, or not the given ones, allow every mode that is too slow to be moved.

    Notes
    -----
    Paper, sections IV-D, IV-E and V.  The design uses the derived system, and the programs are for
    the network itself, where links have delays and agents hold signals.

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("liu2020-3ch-no-communication")
    >>> ring = NeighborGraph.ring(plant.names)
    >>> found = design_extended(plant, ring, spectrum=[-1, -1, -2, -2])
    >>> found.parts["dimensions"], found.order, found.parts["observer_order"]
    ({'1': 0, '2': 0, '3': 1}, 1, 11)
    >>> design_extended(plant, NeighborGraph.empty(plant.names), rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no shared dimensions allow linear time-invariant control to move \
the modes that are not fast enough: agents 2 and 3 need 1 shared state of other agents, and can \
receive from nobody
    """
    request = Request.of(system, agent, spectrum, rate, radius, arithmetic, progress)
    derived, allocation = sharing_network(
        system,
        graph,
        request,
        dimensions=dimensions,
        share=share,
        network=network,
        free_assignability=free_assignability,
    )
    made = network_design("extended", derived, request)
    if allocation is None:
        return made
    parts = {**made.parts, "allocation": allocation}
    return replace(
        made, certificates={**made.certificates, allocation.kind: allocation}, parts=parts
    )


def sharing_network(
    system: MultiChannelSystem,
    graph: NeighborGraph | None,
    request: Request,
    *,
    dimensions: Dimensions = "minimal",
    share: Share | None = None,
    network: Literal["extended", "lifted", "held"] | None = None,
    free_assignability: bool = False,
) -> tuple[DerivedNetwork, SharedDimensions | Deficiency | None]:
    """Return the network that `design_extended` controls, and the allocation of its dimensions.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    request : Request
    dimensions, share, network, free_assignability
        As in `design_extended`; without ``network`` links with delays give the lifted system.

    Raises
    ------
    UsageError
        If there is no neighbor graph, there is no such network, or it does not fit the delays or
        the way of sharing.
    """
    system, found = with_graph(system, graph)
    kind: NetworkKind = network or ("lifted" if found.delays else "extended")
    if kind not in ("extended", "lifted", "held"):
        raise UsageError(f'expected "extended", "lifted" or "held", found {kind!r}')
    sharing: Share = share or ("states" if kind == "held" else "outputs+states")
    request.tell("shared dimensions")
    allocation, sizes = _sizes(system, dimensions, sharing, request.region, free_assignability)
    return shared_network(system, found, sizes, sharing, kind), allocation


def _sizes(
    system: MultiChannelSystem,
    dimensions: Dimensions,
    share: Share,
    region: StabilityRegion,
    free_assignability: bool,
) -> tuple[SharedDimensions | Deficiency | None, tuple[int, ...]]:
    """Return the dimensions n_1 … n_m, and the answer that determined them."""
    if dimensions == "bound":
        most = shared_dimension_bound(system, share=share)
        return most, (most.deficiency,) * system.m
    if not isinstance(dimensions, str):
        return None, checked_dimensions(system, dimensions)
    if dimensions != "minimal":
        raise InputError(
            f'expected "minimal", "bound" or {system.m} numbers, found {dimensions!r}',
            where="dimensions",
        )
    plant = system if not system.subject else as_plant(system)
    least = minimal_shared_dimensions(
        plant,
        share=share,
        region=None if region.bound is None else region,
        free_assignability=free_assignability,
    )
    if least.dimensions is None and region.bound is None:
        # Not every mode can be moved; the stable ones may be fixed.
        stable = _region_of_stable_modes(system)
        least = minimal_shared_dimensions(
            plant, share=share, region=stable, free_assignability=free_assignability
        )
    if system.subject:
        # The answer is about the system taken for a plant, so it is only followed.  Where no
        # dimensions suffice, neither do as many as there are states.
        return None, least.dimensions or (system.n,) * system.m
    if least.dimensions is None:
        raise refusal("dimensions", least)
    return least, least.dimensions


def _region_of_stable_modes(system: MultiChannelSystem) -> StabilityRegion:
    """Return the region of a rate that every stable mode of A meets, or of the radius 1."""
    region = StabilityRegion(system.time)
    if region.discrete:
        return region
    modes = [p for p, _ in characteristic_polynomial(system.A).factor()]
    stable = [p for p in modes if region.contains_roots_of(p)]
    region, rate = StabilityRegion(system.time, Fraction(1)), Fraction(1)
    while not all(region.contains_roots_of(p) for p in stable):
        rate /= 2
        region = StabilityRegion(system.time, rate)
    return region
