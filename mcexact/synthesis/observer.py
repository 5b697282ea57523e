"""The distributed observer: Theorem 1 as a program, from a system to m certified agent programs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, overload

from mcexact.analysis.controllability import joint_observability
from mcexact.derived.error_system import error_system
from mcexact.derived.feedback import checked_gains
from mcexact.errors import InputError, UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.model.system_file import digest
from mcexact.synthesis.channel_controller import ChannelController, largest
from mcexact.synthesis.fast_modes import feedback_for_region, observable_part
from mcexact.synthesis.gate import CertifiedClosedLoop, certify_observer, certify_rate
from mcexact.synthesis.observer_programs import observer_programs
from mcexact.synthesis.observer_search import ObserverTask, Progress, best_channel_controller
from mcexact.synthesis.spectrum import spectrum_polynomial, wanted_region
from mcexact.synthesis.state_feedback import (
    StateFeedback,
    given_feedback,
    state_feedback,
)

if TYPE_CHECKING:
    from mcexact.synthesis.observer_float import FloatObserverDesign


@dataclass(frozen=True, eq=False)
class ObserverDesign:
    """A distributed observer-based controller, with the proof of its closed-loop spectrum.

    Attributes
    ----------
    controller : Controller
        m agent programs; agent i shares its estimate x_i of the plant's state.
    loop : CertifiedClosedLoop
    agent : str
        q, whose channel controller assigns the spectrum of the errors.
    feedback : StateFeedback
        F_i and the characteristic polynomial of A + Σ B_i F_i.
    error : Polynomial
        The characteristic polynomial of the error system.
    lists : tuple of Matrix
        [K_i, H_ij …] of the open-loop observer, before the channel controller is added.
    channel : ChannelController
        Ā, [K̄, H̄_j …], C̄ and what is added to [K_q, H_qj …].
    estimated : Matrix
        L, d×n: the agents estimate L x.  The identity, but for designs for a rate where modes that
        are fast enough are not seen by all channels together; ``feedback`` and ``error`` are then
        about the part of the plant that is seen.
    """

    controller: Controller
    loop: CertifiedClosedLoop
    agent: str
    feedback: StateFeedback
    error: Polynomial
    lists: tuple[Matrix, ...]
    channel: ChannelController
    estimated: Matrix

    @property
    def certificate(self) -> Any:
        """The certificate of the loop."""
        return self.loop.certificate

    @property
    def certificates(self) -> dict[str, Any]:
        """All that was proved, by the name of a file."""
        return {self.certificate.kind: self.certificate}

    @property
    def height(self) -> int:
        """Bits of the longest numerator or denominator in the controller."""
        return self.controller.height()

    @property
    def largest_entry(self) -> Fraction:
        """The largest absolute value of an entry of the closed loop."""
        return largest(self.loop.matrix)


@overload
def design_observer(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    q: str | None = None,
    *,
    spectrum: Mapping[str, Any] | None = None,
    rate: Any = None,
    radius: Any = None,
    gains: Sequence[Any] | None = None,
    order: Literal["least"] | None = None,
    arithmetic: Literal["exact"] = "exact",
    progress: Progress | None = None,
) -> ObserverDesign: ...


@overload
def design_observer(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    q: str | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    gains: Sequence[Any] | None = None,
    order: Literal["least"] | None = None,
    arithmetic: Literal["float"],
    progress: Progress | None = None,
) -> FloatObserverDesign: ...


def design_observer(
    system: MultiChannelSystem,
    graph: NeighborGraph | None = None,
    q: str | None = None,
    *,
    spectrum: Mapping[str, Any] | None = None,
    rate: Any = None,
    radius: Any = None,
    gains: Sequence[Any] | None = None,
    order: Literal["least"] | None = None,
    arithmetic: Literal["exact", "float"] = "exact",
    progress: Progress | None = None,
) -> ObserverDesign | FloatObserverDesign:
    """Design a distributed observer-based controller, with a proof of its closed-loop spectrum.

    Parameters
    ----------
    system : MultiChannelSystem
        A jointly controllable and observable plant, n states, m channels.
    graph : NeighborGraph, optional
        Without delays; overrides ``system.neighbors``.
    q : str, optional
        The agent that carries the channel controller; the first by default.
    spectrum : mapping, optional
        ``{"feedback": P, "error": P}``: n numbers for A + Σ B_i F_i and mn + m − 1 for the error
        system, see `spectrum_polynomial`.
    rate, radius : rational, optional
        Instead of a spectrum, or besides it, to be certified: every eigenvalue has real part below
        −rate (continuous time), or modulus below radius (discrete time).
    gains : sequence of m matrices, optional
        F_i (p_i×n) from outside; then ``spectrum`` has no ``"feedback"``.  With F_i = 0 this is the
        open-loop observer of section II-B: the agents estimate and do not act.
    order : {"least"}, optional
        A channel controller of order one less than the smaller of the two indices; by default it
        has order m − 1.  In floating point: nm less what the agent sees of the errors at once,
        where that can be certified, instead of nm.
    arithmetic : {"exact", "float"}
        Exact assigns every number, for small systems; float designs for a rate or a radius alone,
        and the proof is exact as well (`design_observer_float`).
    progress : callable, optional
        Is told, in a few words, what is being done.

    Raises
    ------
    Impossible
        If a mode is not controllable or not observable by all channels together, or the error
        system for these F_i has a fixed mode or a cut; the certificate says which.
    InputError
        If a spectrum has the wrong length; the message states the right one.
    UsageError
        If neither spectrum nor bound is given, or the graph has delays.

    Notes
    -----
    Exact; paper, section II and Theorem 1.  F_i by state feedback; small K_i, H_ij with which
    channel q controls the error system with index m and observes it, and its matrix is cyclic; then
    the Brasch–Pearson controller.  Of several lists the one that leads to the shortest numbers is
    kept.  The certificate (`proofs/distributed_observer.md`) holds the controller and proves the
    separation and both polynomials.  A strongly connected graph is sufficient, not necessary: what
    is decided is the error system itself.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]], [[0]]], [[[0]], [[1]]],
    ...                            neighbors={"1": ["2"], "2": ["1"]})
    >>> design = design_observer(plant, spectrum={"feedback": [-1], "error": [-1, -2, -3]})
    >>> str(design.error)
    'x^3 + 6*x^2 + 11*x + 6'
    >>> design_observer(plant, {"1": [], "2": []}, rate=1)
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: the error system for these F_i is not complete: no constant K_i, \
H_ij let one agent control and observe all estimation errors
    """
    system, found = with_graph(system, graph)
    if system.subject:
        raise UsageError("a controller is designed for a plant, not for a derived system")
    if found.delays:
        raise UsageError(
            "the distributed observer has no delays on its wires; remove them, or design with an "
            "extended system"
        )
    region = wanted_region(system.time, rate, radius, spectrum=spectrum)
    if order not in (None, "least"):
        raise UsageError(f'expected order "least" or none, found {order!r}', where="order")
    if arithmetic not in ("exact", "float"):
        raise UsageError(f'expected "exact" or "float", found {arithmetic!r}', where="arithmetic")
    tell = progress or (lambda _: None)
    wanted = _checked_spectrum(spectrum, gains)
    agent = 0 if q is None else system.index(q)
    if arithmetic == "float":
        if region.bound is None or wanted:
            raise UsageError(
                "a design in floating point takes a rate or a radius; a spectrum needs "
                'arithmetic "exact"'
            )
        return _in_floating_point(system, found, agent, region, gains, order == "least", tell)
    if spectrum is None and gains is None and region.bound is not None:
        hidden = joint_observability(system).uncontrollable_polynomial
        if hidden.degree > 0 and region.contains_roots_of(hidden):
            return _of_the_observable_part(system, found, agent, region, order == "least", tell)
    tell("state feedback")
    feedback = _feedback(system, wanted.get("feedback"), region, gains)
    tell("lists K, H for the error system")
    error = error_system(system, feedback.gains, found)
    least = order == "least"
    return _certified(
        ObserverTask(system, found, agent, feedback, error, wanted, region, least, tell)
    )


def _certified(task: ObserverTask) -> ObserverDesign:
    """Search, write the programs, and pass the gate."""
    _require_bound(task, task.feedback.polynomial, "A + sum B_i F_i")
    lists, made, polynomial = best_channel_controller(task)
    _require_bound(task, polynomial, "the error system")
    task.tell("certificate")
    controller = observer_programs(
        task.system, task.graph, task.agent, task.feedback.gains, lists.gains, made
    )
    loop = certify_observer(
        task.system,
        controller,
        task.feedback.polynomial,
        polynomial,
        region=task.region,
        graph=task.graph,
    )
    agent = task.system.names[task.agent]
    unit = Matrix.identity(task.system.n)
    return ObserverDesign(
        controller, loop, agent, task.feedback, polynomial, lists.gains, made, unit
    )


def _require_bound(task: ObserverTask, polynomial: Polynomial, what: str) -> None:
    """Refuse gains or a spectrum from outside that do not meet a rate or radius given besides."""
    region = task.region
    if region.bound is not None and not region.contains_roots_of(polynomial):
        raise UsageError(
            f"the spectrum of {what} that was asked for is not in the region {region} that was "
            "asked for besides; give the one or the other"
        )


def _in_floating_point(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    region: StabilityRegion,
    gains: Sequence[Any] | None,
    least: bool,
    tell: Progress,
) -> FloatObserverDesign:
    """The road of `design_observer_float`, loaded when it is taken."""
    from mcexact.synthesis.observer_float import design_observer_float

    given = None if gains is None else checked_gains(system, gains, [system.n] * system.m)
    return design_observer_float(
        system, graph, agent, region, gains=given, reduced=least, progress=tell
    )


def _of_the_observable_part(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    region: StabilityRegion,
    least: bool,
    tell: Progress,
) -> ObserverDesign:
    """The design for what all channels together see; what they do not see is fast enough."""
    part, L = observable_part(system)
    feedback = feedback_for_region(part, region)
    error = error_system(part, feedback.gains, graph)
    design = _certified(ObserverTask(part, graph, agent, feedback, error, {}, region, least, tell))
    controller = replace(design.controller, system=digest(system))
    loop = certify_rate(system, controller, region=region, graph=graph, method="polynomial")
    return replace(design, controller=controller, loop=loop, estimated=L)


def _checked_spectrum(
    spectrum: Mapping[str, Any] | None, gains: Sequence[Any] | None
) -> Mapping[str, Any]:
    """The keys of a prescribed spectrum, checked."""
    if spectrum is None:
        return {}
    if not isinstance(spectrum, Mapping):
        raise InputError(
            'expected {"feedback": …, "error": …}, found ' + type(spectrum).__name__,
            where="spectrum",
        )
    needed = {"error"} if gains is not None else {"feedback", "error"}
    if set(spectrum) != needed:
        raise InputError(
            f"expected the keys {', '.join(sorted(needed))}, "
            f"found {', '.join(sorted(map(str, spectrum)))}",
            where="spectrum",
        )
    return spectrum


def _feedback(
    system: MultiChannelSystem,
    wanted: Any,
    region: StabilityRegion,
    gains: Sequence[Any] | None,
) -> StateFeedback:
    """F_i with the prescribed polynomial, one for the bound, or the gains from outside."""
    if gains is not None:
        return given_feedback(system, tuple(checked_gains(system, gains, [system.n] * system.m)))
    if wanted is None and region.bound is not None:
        return feedback_for_region(system, region)
    return state_feedback(system, spectrum_polynomial(wanted, system.n, where="spectrum.feedback"))
