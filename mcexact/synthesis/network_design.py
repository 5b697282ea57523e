"""Decentralized control of a network, component by component.

This is the construction of the theorems (Corfmat and Morse 1976), for any network that `networks`
derives from a plant.  Small decentralized gains are drawn; in each strong component of the transfer
graph one channel then controls and observes a part of the loop, and its channel controller moves
this part without touching the others.  Every mode in no part must be fixed, which is decided
exactly from characteristic polynomials; a fixed mode outside the region is a refusal with a
certificate.

In exact arithmetic the channel controllers are Brasch and Pearson's, which have low order and any
prescribed spectrum, and of several draws the one with the shortest numbers is taken.  In floating
point they come from Riccati equations, for a rate or a radius, and the smallest gains win.
`network_design` adds certificates about the network to the certified loop.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import ceil
from typing import Any

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.single_channel import single_channel_gains
from mcexact.analysis.structure import transfer_graph
from mcexact.answer import loops as say
from mcexact.answer.loops import refusal
from mcexact.answer.modes import FixedSpectrum
from mcexact.derived.constructions import closed_by
from mcexact.derived.modular import generator
from mcexact.errors import InputError, InternalError, LimitReached
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import StabilityRegion
from mcexact.synthesis.channel_controller import (
    ChannelController,
    ChannelReach,
    DrawnGains,
    assigning_controllers,
    channel_part,
    drawn_gains,
    riccati_channel_controller,
)
from mcexact.synthesis.design import Design, Method, designed
from mcexact.synthesis.gate import Proposal, Request
from mcexact.synthesis.networks import DerivedNetwork, network_programs
from mcexact.synthesis.state_feedback import scaled_polynomial, spectrum_polynomial

# Candidates: channel controllers for drawn gains in each strong component.

_KEPT = 8
_KEPT_FLOAT = 6
_SMALL_GAIN = 1000


@dataclass(frozen=True)
class NetworkTask:
    """The task of a network design, before gains are drawn."""

    network: DerivedNetwork
    components: tuple[tuple[int, ...], ...]
    choices: tuple[tuple[int, ...], ...]
    spectrum: FixedSpectrum
    prescribed: Any
    request: Request

    def component_of(self, channel: int) -> int:
        return next(c for c, members in enumerate(self.components) if channel in members)

    def polynomial(self, channel: int, own: Polynomial, degree: int, *, only: bool) -> Polynomial:
        """The polynomial to assign to the block of this channel: prescribed, or near its own."""
        if self.prescribed is None:
            return scaled_polynomial(own, self.request.region, degree)
        if only and not isinstance(self.prescribed, Mapping):
            return spectrum_polynomial(self.prescribed, degree, where="spectrum.closed_loop")
        names = self.network.plant.names
        members = [names[i] for i in self.components[self.component_of(channel)]]
        if isinstance(self.prescribed, Mapping):
            named = [name for name in members if name in self.prescribed]
            if len(named) == 1:
                where = f"spectrum.closed_loop.{named[0]}"
                return spectrum_polynomial(self.prescribed[named[0]], degree, where=where)
        raise InputError(
            "the spectrum splits into one set for each strong component of the transfer graph: "
            f"expected {{agent: numbers, …}} with {degree} numbers for one agent of "
            f"{', '.join(members)}",
            where="spectrum.closed_loop",
        )


def best_candidate(task: NetworkTask, drawn: Sequence[DrawnGains]) -> NetworkCandidate | None:
    """Return the best candidate of the most promising draws, or None.

    Exact designs minimize the order, then the length of numbers; in floating point the order is
    given, and the gains are minimized.
    """
    if not drawn:
        return None
    first = drawn[0]
    if task.request.arithmetic == "float":
        alike = [d for d in drawn if d.degree == first.degree][:_KEPT_FLOAT]
    else:
        alike = [d for d in drawn if (d.degree, d.order) == (first.degree, first.order)][:_KEPT]
    best: NetworkCandidate | None = None
    for k, each in enumerate(alike):
        task.request.tell(f"channel controllers, candidate {k + 1}")
        candidate = _candidate(task, each)
        if candidate is not None and (best is None or candidate.cost < best.cost):
            best = candidate
            if task.request.arithmetic == "float" and best.largest <= _SMALL_GAIN:
                break
    return best


@dataclass(frozen=True)
class NetworkCandidate:
    """Gains, channel controllers, the polynomials of the blocks, and the remaining fixed modes."""

    gains: tuple[Matrix, ...]
    channels: Mapping[int, ChannelController]
    polynomials: Mapping[int, Polynomial]
    kept: Polynomial

    @property
    def largest(self) -> Fraction:
        """The largest entry of a channel controller."""
        return max((channel.largest for channel in self.channels.values()), default=Fraction(0))

    @property
    def cost(self) -> int:
        """A measure of the length of numbers, dominated by the largest ones."""
        return sum(
            channel.bit_length + 3 * ceil(channel.largest).bit_length()
            for channel in self.channels.values()
        )


def _candidate(task: NetworkTask, drawn: DrawnGains) -> NetworkCandidate | None:
    """Make channel controllers for drawn gains; None if a mode that is not fixed would remain."""
    system = task.network.system
    rng = generator(system, "channel_controller")
    M = closed_by(system, drawn.gains)
    parts = {
        reach.channel: channel_part(M, system.B(reach.channel), system.C(reach.channel), rng)
        for reach in drawn.reaches
    }
    own = {channel: characteristic_polynomial(part.A) for channel, part in parts.items()}
    moved = product(own.values())
    kept, remainder = divmod(characteristic_polynomial(M), moved)
    if not remainder.is_zero():
        raise InternalError("a part of a loop has modes that the loop does not have")
    if not _only(kept, task.spectrum.polynomial):
        return None
    channels, wanted = {}, {}
    for reach in drawn.reaches:
        if task.request.arithmetic == "float":
            channel, controller = _riccati_controller(task, M, reach)
        else:
            part, channel = parts[reach.channel], reach.channel
            degree = part.A.nrows + reach.index - 1
            polynomial = task.polynomial(channel, own[channel], degree, only=len(parts) == 1)
            controllers = assigning_controllers(
                part.A, part.B, part.C, polynomial, index=reach.index, side=reach.side, rng=rng
            )
            controller = next(controllers, None)
        if controller is None or controller.polynomial is None:
            return None
        channels[channel], wanted[channel] = controller, controller.polynomial
    return NetworkCandidate(drawn.gains, channels, wanted, kept)


def _riccati_controller(
    task: NetworkTask, M: Matrix, reach: ChannelReach
) -> tuple[int, ChannelController | None]:
    """Return the controller with the smallest gains among channels that move equally many modes."""
    system = task.network.system
    rng = generator(system, "channel_controller")
    best: tuple[int, ChannelController | None] = (reach.channel, None)
    for q in next(choice for choice in task.choices if reach.channel in choice):
        part = channel_part(M, system.B(q), system.C(q), rng)
        if part.A.nrows != reach.degree:
            continue
        controller = riccati_channel_controller(part, task.request.region)
        if controller is not None and (best[1] is None or controller.largest < best[1].largest):
            best = (q, controller)
    return best


def _only(p: Polynomial, allowed: Polynomial) -> bool:
    """Whether every root of p is one of the other polynomial."""
    while p.degree > 0:
        common = p.gcd(allowed)
        if common.degree < 1:
            return False
        p = p // common
    return True


# The proposal of the best candidate, and its design.

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
    task = network_task(network, fixed, request, prescribed)
    request.tell("decentralized gains")
    candidate = found_candidate(task)
    if candidate is not None:
        yield _proposal(task, candidate)
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


def network_task(
    network: DerivedNetwork, fixed: FixedSpectrum, request: Request, prescribed: Any = None
) -> NetworkTask:
    """The task of a network with these fixed modes, by the components of its transfer graph."""
    components, choices = _choices(network, request.agent)
    return NetworkTask(network, components, choices, fixed, prescribed, request)


def found_candidate(task: NetworkTask) -> NetworkCandidate | None:
    """Draw gains, and return the best candidate, or None after many draws."""
    for attempts in (_ATTEMPTS, _MORE_ATTEMPTS):
        drawn = drawn_gains(task.network.system, task.choices, attempts=attempts)
        candidate = best_candidate(task, drawn)
        if candidate is not None:
            return candidate
    return None


def assigned_blocks(task: NetworkTask, candidate: NetworkCandidate) -> tuple[AssignedBlock, ...]:
    """The strong components with their channel controllers, and the spectra assigned."""
    names = task.network.plant.names
    return tuple(
        AssignedBlock(
            tuple(names[i] for i in task.components[task.component_of(channel)]),
            names[channel],
            part.order,
            candidate.polynomials[channel],
        )
        for channel, part in candidate.channels.items()
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
        words = say.FIXED if network.graph is None else say.FIXED_SHARED
        raise refusal("fixed", fixed, template=words, region=region)


def _choices(
    network: DerivedNetwork, agent: int | None
) -> tuple[tuple[tuple[int, ...], ...], tuple[tuple[int, ...], ...]]:
    """Return the channels that may have the controller, for each strong component."""
    plant = network.plant
    graph = transfer_graph(network.system)
    components = tuple(tuple(plant.index(name) for name in members) for members in graph.components)
    if agent is None:
        return components, components
    return components, tuple((agent,) if agent in c else c for c in components)


def _proposal(task: NetworkTask, candidate: NetworkCandidate) -> Proposal:
    """Write a candidate as agent programs."""
    network, names = task.network, task.network.plant.names
    parts = {
        "network": network.kind,
        "dimensions": dict(zip(names, network.dimensions, strict=True)),
        "observer_order": network.plant.n * network.plant.m + network.plant.m - 1,
        "blocks": assigned_blocks(task, candidate),
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
    design = designed(method, request, network.plant, network.graph, proposals)
    network_keeps = design.parts["kept"].degree > 0
    certificates = {**design.certificates, "fixed_spectrum": design.parts["fixed_spectrum"]}
    design = replace(design, parts={**design.parts, "kept": _left_in_loop(design, network)})
    blocks, gains = design.parts.get("blocks", ()), design.parts.get("gains", ())
    if len(blocks) == 1 and not network_keeps:
        reach = single_channel_gains(
            network.system, blocks[0].agent, cyclic=True, draw=lambda *_: gains
        )
        certificates["single_channel_gains"] = reach
    return replace(design, certificates=certificates)


def _left_in_loop(design: Design, network: DerivedNetwork) -> Polynomial:
    """The fixed modes of the network that are in the loop, too.

    A network with delays has modes of messages under way, 0, and no loop has those of messages
    that no agent uses.
    """
    kept: Polynomial = design.parts["kept"]
    if network.graph is None or not network.graph.delays or kept.degree < 1:
        return kept
    return kept.gcd(characteristic_polynomial(design.loop.matrix))
