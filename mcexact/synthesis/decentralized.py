"""Control without communication, and with shared sub-states.

For a rate or a radius, `design_decentralized` and `design_extended` search controllers of low order
in floating point, and fall back to the controller of the theorem if the search finds none: its
dynamics are all in one agent of each strong component, and it is often fragile.  For a prescribed
spectrum, or a named agent, the controller of the theorem is constructed without a search.  A fixed
mode that is too slow is a refusal with a certificate.

Over links with delays, `design_extended` designs for the lifted and for the held network if a
search can use both and none was named, and keeps the cheaper one with a sufficient margin.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf
from typing import Any, Literal

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.derived.constructions import Share
from mcexact.errors import Impossible, InputError, LimitReached, McexactError
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.synthesis.design import Design, with_stays
from mcexact.synthesis.gate import Arithmetic, Progress, Request
from mcexact.synthesis.network_design import network_design
from mcexact.synthesis.networks import (
    Dimensions,
    decentralized_network,
    refuse_what_stays,
    sharing_network,
    sharing_of,
    stays_over,
)
from mcexact.synthesis.optimum.figures import MARGIN, Aims
from mcexact.synthesis.optimum.proposals import Family, searched_proposals
from mcexact.synthesis.rate import at_a_reachable_rate, request_for


def design_decentralized(
    system: MultiChannelSystem,
    agent: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    arithmetic: Arithmetic = "exact",
    aims: Aims | None = None,
    progress: Progress | None = None,
) -> Design:
    """Design a linear time-invariant controller without communication: u_i depends on y_i alone.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system, whose neighbor graph is not used.
    agent : str, optional
        The agent with the channel controller of the theorem, which is then constructed without a
        search.
    spectrum : polynomial, list of roots, or mapping ``{"closed_loop": …}``, optional
        A spectrum to be placed exactly by the controller of the theorem; see `network_proposals`.
    rate, radius : rational, optional
        Every eigenvalue gets real part below −rate (continuous time) or modulus below radius
        (discrete time).  Where no loop of a search has this and margins of 0.4 in every single
        loop and 0.3 at all inputs together, the fastest rate that has them takes its place, which
        `Design.notes` and the assessment say.  Without a spectrum, the default is a search for the
        least cost with these margins, at a slow rate.
    arithmetic : {"exact", "float"}
        The arithmetic of the theorem's controller.  Floating point takes no spectrum.
    aims : Aims, optional
        What the search aims at.
    progress : callable, optional

    Returns
    -------
    Design
        See its ``parts``.

    Raises
    ------
    Impossible
        If a fixed mode is not fast enough; the certificate is that of the fixed spectrum.
        Controllers that vary with time are not excluded.
    LimitReached
        If no controller was found, or already the rate is out of reach for all agents together
        (`OutOfReach`); the message names the mode that is nearest to being fixed, and the sensible
        rate.

    Notes
    -----
    For a rate or a radius, static gains and then controllers of low order are searched by local
    descent, in floating point, and rounded to few digits (`searched_proposals`).  The controller of
    the theorem, whose dynamics are all in one agent of a strong component and which often is
    fragile, is the last resort.  `assess` tells what a controller is good for.

    Examples
    --------
    >>> system = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    >>> design = design_decentralized(system, spectrum=[-1, -2, -3])
    >>> design.order, str(design.parts["kept"])
    (1, '1')
    >>> design_decentralized(system, rate="1/2").parts["optimum"].digits <= 4
    True
    >>> apart = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]])
    >>> design_decentralized(apart, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no linear time-invariant decentralized control moves the mode 1, \
which channel 2 does not control and channel 1 does not observe, and it is not fast enough
    """
    InputError.require(system, MultiChannelSystem, "system")
    arguments = system, agent, spectrum, rate, radius, arithmetic, progress
    request = request_for(*arguments, aims=aims, stays=lambda: fixed_spectrum(system))
    network = decentralized_network(system)

    def attempt(asked: Request) -> Design:
        proposals = searched_proposals(Family(network), asked, aims)
        return network_design("decentralized", network, asked, proposals)

    return at_a_reachable_rate(request, attempt)


SharedNetwork = Literal["extended", "lifted", "held"]
_WITH_DELAYS: tuple[SharedNetwork, ...] = ("lifted", "held")


def design_extended(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    agent: str | None = None,
    *,
    dimensions: Dimensions = "minimal",
    share: Share | None = None,
    network: SharedNetwork | None = None,
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
        With delays, the lifted system, in which only 0 is fixed, or the held one, in which no mode
        is.  By default a search tries both and keeps the cheaper one with a margin of 0.3, which
        `Design.notes` tells with the figures of both; else the system is lifted.
    spectrum : polynomial, list of roots, or mapping, optional
        n̄ + k_q prescribed numbers; see `network_proposals`.  The dimensions then suffice for all
        modes to be moved, or if that is impossible, all modes that are not stable.  It is placed by
        the controller of the theorem, of least order.
    rate, radius : rational, optional
        A rate or radius to be certified, instead of a spectrum or in addition to it.  Only modes
        that violate it need to be moved; fixed modes that meet it remain, and are reported.
        Without a spectrum, the default is the least cost with margins, as in
        `design_decentralized`.
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
    >>> design = design_extended(plant, ring, spectrum=[-1, -1, -2, -2])
    >>> design.parts["dimensions"], design.order, design.parts["observer_order"]
    ({'1': 0, '2': 0, '3': 1}, 1, 11)
    >>> design_extended(plant, NeighborGraph.empty(plant.names), rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no sharing over the neighbor graph lets linear time-invariant \
control move the mode 1, which does not satisfy Re λ < -1: agents 2 and 3 receive from no other \
agent and do not observe it, and agent 1 does not control it
    """
    InputError.require(system, MultiChannelSystem, "system")
    stays = stays_over(*with_graph(system, graph))
    arguments = system, agent, spectrum, rate, radius, arithmetic, progress
    request = request_for(*arguments, aims=aims, stays=lambda: stays)

    def attempt(request: Request) -> Design:
        options = dimensions, share, free_assignability, aims or Aims()
        asked = _Asked(system, graph, request, *options)
        refuse_what_stays(system, stays, request.region)
        compares = network is None and asked.compares
        return with_stays(asked.cheaper() if compares else asked.designed(network), stays)

    return at_a_reachable_rate(request, attempt)


@dataclass(frozen=True)
class _Asked:
    """The arguments of `design_extended`, checked, without the network."""

    system: MultiChannelSystem
    graph: NeighborGraph | None
    request: Request
    dimensions: Dimensions
    share: Share | None
    free_assignability: bool
    aims: Aims

    @property
    def compares(self) -> bool:
        """Whether a search can use the lifted and the held system."""
        _, graph = with_graph(self.system, self.graph)
        searched = self.aims.searched_for(self.request)
        return searched and bool(graph.delays) and self.share != "outputs+states"

    def designed(self, network: SharedNetwork | None) -> Design:
        """Design over one network."""
        derived, allocation = sharing_network(
            self.system,
            self.graph,
            self.request,
            dimensions=self.dimensions,
            share=self.share,
            network=network,
            free_assignability=self.free_assignability,
        )
        family = Family(derived, sharing_of(derived.kind, self.share))
        proposals = searched_proposals(family, self.request, self.aims)
        design = network_design("extended", derived, self.request, proposals)
        if allocation is None:
            return design
        parts = {**design.parts, "allocation": allocation}
        return replace(
            design, certificates={**design.certificates, allocation.kind: allocation}, parts=parts
        )

    def cheaper(self) -> Design:
        """Design over the lifted and over the held network, and keep the cheaper one.

        Raises
        ------
        Impossible, LimitReached
            That of the lifted network, if both fail.
        """
        designs: dict[SharedNetwork, Design] = {}
        outcomes, failed = list[str](), list[McexactError]()
        for network in _WITH_DELAYS:
            self.request.tell(f"the {network} network")
            try:
                design = self.designed(network)
            except (Impossible, LimitReached) as error:
                failed.append(error)
                outcomes.append(f"{network}: {error}")
                continue
            designs[network] = design
            outcomes.append(f"{network}: {_figures(design)}")
        if not designs:
            raise failed[0]
        best = min(designs.values(), key=_price)
        note = f"of the networks with delays, the {best.parts['network']} one was kept"
        return replace(best, notes=(*best.notes, f"{note} ({'; '.join(outcomes)}; computed)"))


def _price(design: Design) -> tuple[bool, float]:
    """Whether a design is fragile, and its cost; without a search both are unknown."""
    optimum = design.parts.get("optimum")
    if optimum is None:
        return True, inf
    return not optimum.figures.margin >= MARGIN, optimum.figures.cost


def _figures(design: Design) -> str:
    """The figures of a design in a few words."""
    optimum = design.parts.get("optimum")
    if optimum is None:
        return f"the controller of the theorem, of order {design.order}"
    seen = optimum.figures
    return f"order {design.order}, margin {seen.margin:.3g}, cost {seen.cost:.3g}"
