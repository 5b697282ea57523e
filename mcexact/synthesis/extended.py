"""Distributed control with shared sub-states, by decentralized control of the extended system."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Literal

from mcexact.derived.extended import Share
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.asking import request_for
from mcexact.synthesis.design import Design
from mcexact.synthesis.network.network_design import network_design
from mcexact.synthesis.network.sharing import Dimensions, sharing_network, sharing_of
from mcexact.synthesis.optimum.aims import Aims
from mcexact.synthesis.optimum.proposals import searched_proposals
from mcexact.synthesis.optimum.structures import Family
from mcexact.synthesis.request import Arithmetic, Progress


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
    aims: Aims | None = None,
    progress: Progress | None = None,
) -> Design:
    """Design a linear time-invariant distributed controller on an extended system.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system with n states and m channels.
    graph : NeighborGraph, optional
        With delays, in discrete time; overrides ``system.neighbors``.
    agent : str, optional
        The agent with the channel controller of the theorem, which is then constructed without a
        search.
    dimensions : {"minimal", "bound"} or sequence of m int
        n_1 … n_m: the least that suffice, Theorem 2's bound for every agent, or given ones.
    share : {"outputs+states", "states"}, optional
        The signals that agents send; by default both, but with holding sub-states alone.
    network : {"extended", "lifted", "held"}, optional
        With delays, the lifted system, in which only 0 is fixed (the default), or the held one, in
        which no mode is.
    spectrum : polynomial, list of roots, or mapping, optional
        n̄ + k_q prescribed numbers; see `network_proposals`.  The dimensions then suffice for all
        modes to be moved, or if that is impossible, all modes that are not stable.  It is placed by
        the controller of the theorem, of least order.
    rate, radius : rational, optional
        A rate or radius to be certified, instead of a spectrum or in addition to it.  Only modes
        that violate it need to be moved; fixed modes that meet it remain, and are reported.
        Without a spectrum, the default is half the sensible rate.
    free_assignability : bool
        With ``"minimal"``, share enough that the transfer graph of the extended system is strongly
        connected, so that the spectrum does not split.
    arithmetic : {"exact", "float"}
        The arithmetic of the theorem's controller.  Floating point takes no spectrum.
    aims : Aims, optional
        What the search aims at.
    progress : callable, optional

    Returns
    -------
    Design
        That of the theorem has order k_q + Σ n_i; a distributed observer has order nm + m − 1.

    Raises
    ------
    Impossible
        If no dimensions, or not the given ones, allow every mode that is too slow to be moved.
    LimitReached
        If no controller was found, or already the rate is out of reach for all agents together
        (`OutOfReach`); the message names the mode that is nearest to being fixed, and the sensible
        rate.

    Notes
    -----
    Paper, sections IV-D, IV-E and V.  For a rate or a radius, controllers of low order are searched
    first, as in `design_decentralized`; agents may then share more sub-states than the least that
    suffice, or none.  The design uses the derived system, and the programs are for
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
    request = request_for(system, agent, spectrum, rate, radius, arithmetic, progress, aims=aims)
    derived, allocation = sharing_network(
        system,
        graph,
        request,
        dimensions=dimensions,
        share=share,
        network=network,
        free_assignability=free_assignability,
    )
    family = Family(derived, sharing_of(derived.kind, share))
    made = network_design("extended", derived, request, searched_proposals(family, request, aims))
    if allocation is None:
        return made
    parts = {**made.parts, "allocation": allocation}
    return replace(
        made, certificates={**made.certificates, allocation.kind: allocation}, parts=parts
    )
