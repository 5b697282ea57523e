"""Decentralized control of a derived network, with a controller for each strong component."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.analysis.fixed_modes.single_channel_gains import single_channel_gains
from mcexact.analysis.structure.transfer_graph import transfer_graph
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.answer.rules.refusals import refusal
from mcexact.answer.wording import refusals as say
from mcexact.errors import InputError, LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.location import StabilityRegion
from mcexact.exact.polynomial import Polynomial, product
from mcexact.synthesis.design import Design, Method, designed
from mcexact.synthesis.gate import Proposal
from mcexact.synthesis.methods import drawn_gains
from mcexact.synthesis.network.candidates import NetworkCandidate, NetworkTask, best_candidate
from mcexact.synthesis.network.networks import DerivedNetwork, network_programs
from mcexact.synthesis.request import Request

_ATTEMPTS = 96
_MORE_ATTEMPTS = 600


@dataclass(frozen=True)
class AssignedBlock:
    """A strong component of the transfer graph, with its assigned spectrum.

    Attributes
    ----------
    channels : tuple of str
        The component.
    agent : str
        The agent with its channel controller.
    order : int
        The order of that controller.
    polynomial : Polynomial
        Of the degree of the component's subsystem plus the order.
    """

    channels: tuple[str, ...]
    agent: str
    order: int
    polynomial: Polynomial


def network_proposals(network: DerivedNetwork, request: Request) -> Iterator[Proposal]:
    """Propose a decentralized controller of a derived network.

    Parameters
    ----------
    network : DerivedNetwork
        Of n̄ states.
    request : Request
        If the transfer graph is strongly connected, its spectrum is a polynomial or a list of
        roots, n̄ + k_q numbers (without those of kept modes).  Otherwise it is a mapping from one
        agent of each strong component to the numbers of that component.  Both forms may be the
        value of a key ``"closed_loop"``.  The error for a wrong length states the right one.

    Yields
    ------
    Proposal
        One.

    Raises
    ------
    Impossible
        If a fixed mode of the network is not fast enough.
    InputError
        If the spectrum has the wrong length or the wrong agents.
    LimitReached
        If no drawn gains led to a controller.

    Notes
    -----
    Paper, sections IV-A, IV-E and V-B (Corfmat and Morse 1976; Brasch and Pearson 1970).  Small
    gains F̄_i are drawn.  For each strong component c of the transfer graph, one channel q of it
    controls and observes a part of the loop, which its feedback alone can move, and which feedback
    in another component does not touch, because no path leads there and back.  Modes in no part
    must be fixed, which is decided exactly from the characteristic polynomials.  With one component
    and no fixed mode, the part is the whole loop.  A part gets a Brasch–Pearson controller of order
    k_q, one less than the smaller of its indices; in floating point it gets an observer-based
    controller from two Riccati equations, of the order of the part.
    """
    prescribed = _prescribed(request.spectrum)
    request.tell("fixed modes")
    fixed = fixed_spectrum(network.system)
    require_fast(network, fixed, request.region)
    components, choices = _choices(network, request.agent)
    task = NetworkTask(network, components, choices, fixed, prescribed, request)
    request.tell("decentralized gains")
    for attempts in (_ATTEMPTS, _MORE_ATTEMPTS):
        found = best_candidate(task, drawn_gains(network.system, choices, attempts=attempts))
        if found is not None:
            yield _proposal(task, found)
            return
    if request.arithmetic == "float":
        raise LimitReached(
            "no Riccati equations of single channels led to a controller in double precision: "
            "share more states, require a lower rate, or design in exact arithmetic"
        )
    raise LimitReached(
        f"gains exist, but {_MORE_ATTEMPTS} draws did not find ones that move every mode that is "
        "not fixed"
    )


def _prescribed(spectrum: Any) -> Any:
    """Return the value of ``"closed_loop"``, or the spectrum itself."""
    if isinstance(spectrum, Mapping) and set(spectrum) == {"closed_loop"}:
        return spectrum["closed_loop"]
    if isinstance(spectrum, Mapping) and set(spectrum) & {"feedback", "error"}:
        raise InputError(
            'expected the key "closed_loop"; "feedback" and "error" are for the observer',
            where="spectrum",
        )
    return spectrum


def require_fast(network: DerivedNetwork, fixed: FixedSpectrum, region: StabilityRegion) -> None:
    """Raise an error for a network with a fixed mode that is too slow.

    Parameters
    ----------
    network : DerivedNetwork
    fixed : FixedSpectrum
        Of the system of the network.
    region : StabilityRegion

    Raises
    ------
    Impossible
        With the fixed spectrum as its certificate.
    """
    if fixed.outside(region):
        told = say.FIXED if network.graph is None else say.FIXED_SHARED
        raise refusal("fixed", fixed, told=told, region=region)


def _choices(
    network: DerivedNetwork, agent: int | None
) -> tuple[tuple[tuple[int, ...], ...], tuple[tuple[int, ...], ...]]:
    """Return the channels that may have the controller, for each strong component."""
    plant = network.given
    graph = transfer_graph(network.system)
    components = tuple(tuple(plant.index(name) for name in members) for members in graph.components)
    if agent is None:
        return components, components
    return components, tuple((agent,) if agent in c else c for c in components)


def _proposal(task: NetworkTask, candidate: NetworkCandidate) -> Proposal:
    """Write a candidate as agent programs."""
    network, names = task.network, task.network.given.names
    blocks = tuple(
        AssignedBlock(
            tuple(names[i] for i in task.components[task.component_of(channel)]),
            names[channel],
            made.order,
            candidate.polynomials[channel],
        )
        for channel, made in candidate.channels.items()
    )
    parts = {
        "network": network.kind,
        "dimensions": dict(zip(names, network.dimensions, strict=True)),
        "observer_order": network.given.n * network.given.m + network.given.m - 1,
        "blocks": blocks,
        "kept": candidate.kept,
        "gains": candidate.gains,
        "fixed_spectrum": task.spectrum,
    }
    controller = network_programs(network, candidate.gains, candidate.channels)
    whole = product([*candidate.polynomials.values(), candidate.kept])
    return Proposal(controller, (whole,), parts=parts)


def network_design(
    method: Method, network: DerivedNetwork, request: Request, proposals: Iterable[Proposal]
) -> Design:
    """Certify a proposal for a network, and add certificates about the network.

    These are about the fixed modes and, for a controller of the theorem, if no mode is kept and
    there is one strong component, about the gains F̄_i with which the agent with the channel
    controller controls and observes the network.
    """
    made = designed(method, request, network.given, network.graph, proposals)
    network_keeps = made.parts["kept"].degree > 0
    certificates = {**made.certificates, "fixed_spectrum": made.parts["fixed_spectrum"]}
    made = replace(made, parts={**made.parts, "kept": _left_in_loop(made, network)})
    blocks, gains = made.parts.get("blocks", ()), made.parts.get("gains", ())
    if len(blocks) == 1 and not network_keeps:
        reach = single_channel_gains(
            network.system, blocks[0].agent, cyclic=True, draw=lambda *_: gains
        )
        certificates["single_channel_gains"] = reach
    return replace(made, certificates=certificates)


def _left_in_loop(made: Design, network: DerivedNetwork) -> Polynomial:
    """The fixed modes of the network that are in the loop, too.

    A network with delays has modes of messages under way, 0, and no loop has those of messages
    that no agent uses.
    """
    kept: Polynomial = made.parts["kept"]
    if network.graph is None or not network.graph.delays or kept.degree < 1:
        return kept
    return kept.gcd(characteristic_polynomial(made.loop.matrix))
