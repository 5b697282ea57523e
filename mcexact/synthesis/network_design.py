"""Decentralized control of a derived network, strong component by strong component, certified."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.single_channel_gains import single_channel_gains
from mcexact.analysis.stability import certify_stability
from mcexact.analysis.transfer_graph import transfer_graph
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.answer.single_channel_gains import SingleChannelGains
from mcexact.answer.stability import StabilityVerdict
from mcexact.answer.wording import refusals as say
from mcexact.errors import Impossible, InputError, InternalError, LimitReached, UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.model.closed_loop import loop_layout
from mcexact.model.controller import Controller
from mcexact.synthesis.channel_parts import drawn_gains
from mcexact.synthesis.gate import CertifiedClosedLoop, certify_spectrum
from mcexact.synthesis.network_candidates import (
    ArithmeticKind,
    NetworkCandidate,
    NetworkTask,
    Progress,
    best_candidate,
)
from mcexact.synthesis.networks import DerivedNetwork, network_programs
from mcexact.synthesis.spectrum import wanted_region

_ATTEMPTS = 96
_MORE_ATTEMPTS = 600


@dataclass(frozen=True)
class AssignedBlock:
    """A strong component of the transfer graph, and the numbers that were assigned to it.

    Attributes
    ----------
    channels : tuple of str
        The component.
    agent : str
        Who carries its channel controller.
    order : int
        The order of that controller.
    polynomial : Polynomial
        Of the degree of the component's subsystem plus the order.
    """

    channels: tuple[str, ...]
    agent: str
    order: int
    polynomial: Polynomial


@dataclass(frozen=True, eq=False)
class NetworkDesign:
    """A certified controller of a network, with what it assigns and what it keeps.

    Attributes
    ----------
    network : DerivedNetwork
        What agents share, and the system whose decentralized control this is.
    controller : Controller
    loop : CertifiedClosedLoop
        Proves the characteristic polynomial of the whole loop.
    stability : StabilityVerdict or None
        Proves the rate or radius, where one was asked for.
    blocks : tuple of AssignedBlock
        One if the transfer graph is strongly connected.
    kept : Polynomial
        The modes that stay, all of them fixed and fast enough; 1 if there is none.
    gains : tuple of Matrix
        F̄_i, before the channel controllers are added.
    spectrum : FixedSpectrum
        Of the network's system.
    arithmetic : {"exact", "float"}
    """

    network: DerivedNetwork
    controller: Controller
    loop: CertifiedClosedLoop
    stability: StabilityVerdict | None
    blocks: tuple[AssignedBlock, ...]
    kept: Polynomial
    gains: tuple[Matrix, ...]
    spectrum: FixedSpectrum
    arithmetic: str

    @property
    def certificate(self) -> Any:
        """The certificate of the closed-loop spectrum."""
        return self.loop.certificate

    @property
    def certificates(self) -> dict[str, Any]:
        """All that was proved, by the name of a file."""
        found: dict[str, Any] = {"closed_loop_spectrum": self.loop.certificate}
        if self.reach is not None:
            found["single_channel_gains"] = self.reach.certificate
        if self.stability is not None:
            found["stability"] = self.stability.certificate
        found["fixed_spectrum"] = self.spectrum.certificate
        return found

    @cached_property
    def reach(self) -> SingleChannelGains | None:
        """The proof that with F̄_i the agent with the channel controller reaches everything.

        None where it does not: modes are kept, or there are several strong components.
        """
        if len(self.blocks) != 1 or self.kept.degree > 0:
            return None
        system, gains = self.network.system, self.gains
        agent = self.blocks[0].agent
        return single_channel_gains(system, agent, cyclic=True, draw=lambda *_: gains)

    @property
    def order(self) -> int:
        """Σ n_i + Σ k_q, the dimension of all agents' states."""
        return self.controller.order

    @property
    def observer_order(self) -> int:
        """nm + m − 1: what a distributed observer of the same plant would have."""
        plant = self.network.plant
        return plant.n * plant.m + plant.m - 1

    @property
    def height(self) -> int:
        """Bits of the longest numerator or denominator in the controller."""
        return self.controller.height()


def design_network(
    network: DerivedNetwork,
    q: str | None = None,
    *,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    arithmetic: ArithmeticKind = "exact",
    progress: Progress | None = None,
) -> NetworkDesign:
    """Design decentralized control of a derived network, one channel controller per component.

    Parameters
    ----------
    network : DerivedNetwork
        Of n̄ states.
    q : str, optional
        An agent that is to carry a channel controller; by default those that need the least order.
    spectrum : polynomial, list of roots, or mapping, optional
        n̄ + k_q numbers (less those of kept modes), if the transfer graph is strongly connected;
        else a mapping from one agent of each strong component to the numbers of that component.
        Either may stand under the key ``"closed_loop"``.  A wrong length names the right one.
    rate, radius : rational, optional
        Instead of a spectrum, or besides it, to be certified.
    arithmetic : {"exact", "float"}
    progress : callable, optional

    Raises
    ------
    Impossible
        If a fixed mode of the network is not fast enough.
    InputError
        If the spectrum has the wrong length or the wrong agents.
    LimitReached
        If the drawn gains did not do it.

    Notes
    -----
    Paper, sections IV-A, IV-E and V-B (Corfmat and Morse 1976; Brasch and Pearson 1970).  Small
    gains F̄_i are drawn.  For each strong component c of the transfer graph, one channel q of it
    controls and observes a part of the loop, which its feedback alone can move, and which feedback
    in another component does not touch, because no path leads there and back.  What no part
    contains must be fixed: that is decided exactly, on the characteristic polynomials.  With one
    component and no fixed mode the part is everything.  A part gets the Brasch–Pearson controller
    of order k_q, one less than the smaller of its indices; in floating point an observer-based one
    from two Riccati equations, of the order of the part.
    """
    region = wanted_region(network.plant.time, rate, radius, spectrum=spectrum)
    prescribed = _prescribed(spectrum)
    if arithmetic == "float" and prescribed is not None:
        raise UsageError(
            "in floating point give a rate or radius; a spectrum needs exact arithmetic"
        )
    if q is not None:
        network.plant.index(q)
    tell = progress or (lambda _: None)
    tell("fixed modes")
    fixed = fixed_spectrum(network.system)
    _require_fast(network, fixed, region)
    components, choices = _choices(network, q)
    task = NetworkTask(network, components, choices, fixed, prescribed, region, arithmetic, tell)
    tell("decentralized gains")
    for attempts in (_ATTEMPTS, _MORE_ATTEMPTS):
        found = best_candidate(task, drawn_gains(network.system, choices, attempts=attempts))
        if found is not None:
            return _certified(task, found)
    if arithmetic == "float":
        raise LimitReached(
            "no Riccati equations of single channels led to a controller in double precision: "
            "share more, ask for less, or design in exact arithmetic"
        )
    raise LimitReached(
        f"gains exist, but {_MORE_ATTEMPTS} draws did not find ones that move every mode that is "
        "not fixed"
    )


def _prescribed(spectrum: Any) -> Any:
    """The value of ``"closed_loop"``, or what stands in its place."""
    if isinstance(spectrum, Mapping) and set(spectrum) == {"closed_loop"}:
        return spectrum["closed_loop"]
    if isinstance(spectrum, Mapping) and set(spectrum) & {"feedback", "error"}:
        raise InputError(
            'expected the key "closed_loop"; "feedback" and "error" are for the observer',
            where="spectrum",
        )
    return spectrum


def _require_fast(network: DerivedNetwork, fixed: FixedSpectrum, region: StabilityRegion) -> None:
    """Refuse a network with a fixed mode that is too slow."""
    slow = fixed.outside(region)
    if not slow:
        return
    told = say.FIXED if network.graph is None else say.FIXED_SHARED
    message = told(
        p=slow[0].polynomial,
        s=slow[0].channels,
        sizes=list(zip(network.plant.names, network.dimensions, strict=False)),
    )
    raise Impossible(message, fixed.certificate)


def _choices(
    network: DerivedNetwork, q: str | None
) -> tuple[tuple[tuple[int, ...], ...], tuple[tuple[int, ...], ...]]:
    """The strong components, and for each the channels that may carry its controller."""
    plant = network.plant
    graph = transfer_graph(network.system)
    components = tuple(tuple(plant.index(name) for name in members) for members in graph.components)
    if q is None:
        return components, components
    chosen = plant.index(q)
    return components, tuple((chosen,) if chosen in c else c for c in components)


def _certified(task: NetworkTask, candidate: NetworkCandidate) -> NetworkDesign:
    """Write the programs, assemble the loop from them, and prove its spectrum."""
    task.tell("certificate")
    network = task.network
    controller = network_programs(network, candidate.gains, candidate.channels)
    layout = loop_layout(network.plant, controller, network.graph)
    order = sum(made.order for made in candidate.channels.values())
    # Messages that no program uses are not part of the loop; each is a mode 0 of the network.
    unused = network.system.n + order - layout.dimension
    whole = product([*candidate.polynomials.values(), candidate.kept])
    if any(whole.coefficients[:unused]):
        raise InternalError("messages that nobody uses are no modes of the network")
    polynomial = Polynomial(whole.coefficients[unused:])
    loop = certify_spectrum(network.plant, controller, polynomial, network.graph)
    stability = None
    if task.region.bound is not None:
        stability = certify_stability(loop.loop, task.region)
        if not stability.stable:
            raise InputError(
                f"the prescribed numbers do not all satisfy {task.region}", where="spectrum"
            )
    names = network.plant.names
    blocks = tuple(
        AssignedBlock(
            tuple(names[i] for i in task.components[task.component_of(channel)]),
            names[channel],
            made.order,
            candidate.polynomials[channel],
        )
        for channel, made in candidate.channels.items()
    )
    return NetworkDesign(
        network,
        controller,
        loop,
        stability,
        blocks,
        candidate.kept,
        candidate.gains,
        task.spectrum,
        task.arithmetic,
    )
