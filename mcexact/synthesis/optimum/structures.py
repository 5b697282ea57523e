"""The structures of decentralized and of extended control, by the order of the agents' states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from mcexact.derived.extended import Share
from mcexact.errors import Impossible, LimitReached
from mcexact.synthesis.network.network_design import network_proposals
from mcexact.synthesis.network.networks import DerivedNetwork, shared_network
from mcexact.synthesis.optimum.problem import Structure
from mcexact.synthesis.optimum.programs import NetworkController
from mcexact.synthesis.request import Request


@dataclass(frozen=True)
class Family:
    """The structures that a search tries, by the order of the agents' states.

    Attributes
    ----------
    network : DerivedNetwork
        That of least dimensions.
    share : {"outputs+states", "states"} or None
        What agents send, if they have a sub-state to share; else their states are private.
    """

    network: DerivedNetwork
    share: Share | None = None

    def of_order(self, order: int | Sequence[int]) -> Structure:
        """Return the structure in which every agent has a state of at least some order."""
        network, none = self.network, (0,) * self.network.given.m
        orders = (order,) * network.given.m if isinstance(order, int) else tuple(order)
        if network.graph is None or self.share is None:
            return network, orders
        if not any(orders):
            return network, none
        sizes = [max(pair) for pair in zip(orders, network.dimensions, strict=True)]
        wider = shared_network(network.given, network.graph, sizes, self.share, network.kind)
        return wider, none

    def theorem(self, request: Request) -> NetworkController | None:
        """Return the controller of the theorem, in floating point; None if there is none."""
        try:
            inexact = replace(request, arithmetic="float")
            proposal = next(network_proposals(self.network, inexact), None)
        except (Impossible, LimitReached):
            return None
        return None if proposal is None else (self.network, proposal.controller)
