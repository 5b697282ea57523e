"""The networks of shared sub-states, and the dimensions with which they are controlled."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Literal

from mcexact.analysis.sharing.allocation import minimal_shared_dimensions, shared_dimension_bound
from mcexact.answer.deficiency import Deficiency
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.shared_dimensions import SharedDimensions
from mcexact.arguments import one_of
from mcexact.derived.extended import Share, checked_dimensions
from mcexact.errors import InputError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion
from mcexact.model.linked_system import with_graph
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, as_plant
from mcexact.synthesis.network.networks import DerivedNetwork, NetworkKind, shared_network
from mcexact.synthesis.request import Request

Dimensions = str | Sequence[int]
"""``"minimal"``, ``"bound"``, or n_1 … n_m."""


def sharing_of(kind: NetworkKind, share: Share | None = None) -> Share:
    """Return what agents send: by default both, but with holding sub-states alone."""
    return share or ("states" if kind == "held" else "outputs+states")


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
    one_of(network, (None, "extended", "lifted", "held"), "network")
    kind: NetworkKind = network or ("lifted" if found.delays else "extended")
    sharing = sharing_of(kind, share)
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
    if not isinstance(dimensions, str):
        return None, checked_dimensions(system, dimensions)
    if dimensions == "bound":
        most = shared_dimension_bound(system, share=share)
        return most, (most.deficiency,) * system.m
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
