"""The distributed observer: Theorem 1 as a program, from a system to m certified agent programs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import islice
from math import ceil
from random import Random
from typing import TYPE_CHECKING, Any, Literal, overload

from mcexact.analysis.completeness import completeness
from mcexact.analysis.controllability import joint_observability
from mcexact.analysis.gains import ReachingGains, error_gain_draws, reaching_gains
from mcexact.analysis.modular_system import generator
from mcexact.derived.error_system import error_system
from mcexact.derived.feedback import checked_gains
from mcexact.errors import Impossible, InputError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import Controller
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.synthesis.channel_controller import (
    ChannelController,
    channel_controller,
    observing_rows,
    transposed,
)
from mcexact.synthesis.gate import CertifiedClosedLoop, certify_observer
from mcexact.synthesis.observer_programs import observer_programs
from mcexact.synthesis.spectrum import (
    convergence_bound,
    default_polynomial,
    spectrum_polynomial,
)
from mcexact.synthesis.state_feedback import (
    StateFeedback,
    given_feedback,
    state_feedback,
)

if TYPE_CHECKING:
    from mcexact.synthesis.observer_float import FloatObserverDesign

_ROWS_PER_CANDIDATE = 2
Progress = Callable[[str], None]


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
    """

    controller: Controller
    loop: CertifiedClosedLoop
    agent: str
    feedback: StateFeedback
    error: Polynomial
    lists: tuple[Matrix, ...]
    channel: ChannelController

    @property
    def certificate(self) -> Any:
        """The certificate of the loop."""
        return self.loop.certificate

    @property
    def height(self) -> int:
        """Bits of the longest numerator or denominator in the controller."""
        return self.controller.height()

    @property
    def largest_entry(self) -> Fraction:
        """The largest absolute value of an entry of the closed loop."""
        M = self.loop.matrix
        return Fraction(
            max((abs(x) for row in M.numerators for x in row), default=0), M.denominator
        )


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
        F_i (p_i×n) from outside; then ``spectrum`` has no ``"feedback"``.
    order : {"least"}, optional
        A channel controller of order one less than the smaller of the two indices; by default it
        has order m − 1.
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
    mcexact.errors.Impossible: the error system for these F_i is not complete: no lists K_i, H_ij \
let one agent control and observe all estimation errors
    """
    system, found = with_graph(system, graph)
    if system.subject:
        raise UsageError("a controller is designed for a plant, not for a derived system")
    if found.delays:
        raise UsageError(
            "the distributed observer has no delays on its wires; remove them, or design with an "
            "extended system"
        )
    bound = convergence_bound(system.time, rate, radius, needed=spectrum is None)
    if order not in (None, "least"):
        raise UsageError(f'expected order "least" or none, found {order!r}', where="order")
    if arithmetic not in ("exact", "float"):
        raise UsageError(f'expected "exact" or "float", found {arithmetic!r}', where="arithmetic")
    tell = progress or (lambda _: None)
    wanted = _checked_spectrum(spectrum, gains)
    agent = 0 if q is None else system.index(q)
    if arithmetic == "float":
        return _in_floating_point(
            system, found, agent, bound, gains, tell, not wanted and not order
        )
    tell("state feedback")
    feedback = _feedback(system, wanted.get("feedback"), bound, gains)
    tell("lists K, H for the error system")
    error = error_system(system, feedback.gains, found)
    least = order == "least"
    task = _Task(system, found, agent, feedback, error, wanted, bound, least, tell)
    return _best_design(task, _candidates(task))


def _in_floating_point(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    bound: Fraction | None,
    gains: Sequence[Any] | None,
    tell: Progress,
    rate_alone: bool,
) -> FloatObserverDesign:
    """The road of `design_observer_float`, which takes a rate or a radius and nothing else."""
    from mcexact.synthesis.observer_float import design_observer_float

    if bound is None or not rate_alone:
        raise UsageError(
            "a design in floating point takes a rate or a radius; a spectrum or an order needs "
            'arithmetic "exact"'
        )
    given = None if gains is None else checked_gains(system, gains, [system.n] * system.m)
    return design_observer_float(system, graph, agent, bound, gains=given, progress=tell)


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
    bound: Fraction | None,
    gains: Sequence[Any] | None,
) -> StateFeedback:
    """F_i with the prescribed polynomial, one for the bound, or the gains from outside."""
    if gains is not None:
        return given_feedback(system, tuple(checked_gains(system, gains, [system.n] * system.m)))
    if wanted is None and bound is not None:
        polynomial = default_polynomial(system.time, bound, system.n)
    else:
        polynomial = spectrum_polynomial(wanted, system.n, where="spectrum.feedback")
    return state_feedback(system, polynomial)


@dataclass(frozen=True)
class _Task:
    """What has been settled before the lists and the channel controller are chosen."""

    system: MultiChannelSystem
    graph: NeighborGraph
    agent: int
    feedback: StateFeedback
    error: MultiChannelSystem
    wanted: Mapping[str, Any]
    bound: Fraction | None
    least: bool
    tell: Progress

    def polynomial(self, degree: int) -> Polynomial:
        """The prescribed polynomial of the error system, of this degree."""
        if "error" in self.wanted:
            return spectrum_polynomial(self.wanted["error"], degree, where="spectrum.error")
        return default_polynomial(self.system.time, self.bound or Fraction(0), degree)

    def center(self) -> Fraction:
        """The mean of the prescribed numbers; 0 where their number is not the usual one."""
        degree = self.error.n + self.system.m - 1
        try:
            polynomial = self.polynomial(degree)
        except InputError:
            return Fraction(0)
        return -polynomial.coefficients[degree - 1] / degree if degree else Fraction(0)


def _candidates(task: _Task) -> list[ReachingGains]:
    """Lists with which the agent reaches all errors, or the obstruction that no list overcomes."""
    system, agent = task.system, [task.agent]
    draw = error_gain_draws(system, task.graph, task.feedback.gains, task.center())
    # More candidates give shorter numbers; each costs some n³ operations on longer ones.
    count = max(32, min(240, 20_000 // max(1, task.error.n) ** 2))
    quick = reaching_gains(task.error, agent, draw, index=system.m, attempts=4 * count)
    found = list(islice(quick, count))
    if found:
        return found
    observable = joint_observability(system)
    if not observable.controllable:
        raise Impossible(
            f"the roots of {observable.uncontrollable_polynomial} are not observable by all "
            "channels together: no distributed observer can see them",
            observable.certificate,
        )
    decision = completeness(task.error)
    if not decision.complete:
        raise Impossible(
            "the error system for these F_i is not complete: no lists K_i, H_ij let one agent "
            "control and observe all estimation errors",
            decision.certificate,
        )
    found = list(islice(reaching_gains(task.error, agent, draw, attempts=2000), count))
    if not found:
        raise LimitReached("lists K_i, H_ij exist, but 2000 draws did not find them")
    return found


def _best_design(task: _Task, candidates: list[ReachingGains]) -> ObserverDesign:
    """Make channel controllers for each candidate, keep the best one, assemble and certify."""

    def index_of(each: ReachingGains) -> int:
        (seen,) = each.observability_indices
        (reached,) = each.controllability_indices
        return min(reached, seen) if task.least else reached

    index = min(map(index_of, candidates))
    polynomial = task.polynomial(task.error.n + index - 1)
    rng = generator(task.error, "channel_controller")
    best: tuple[int, ReachingGains, ChannelController] | None = None
    for k, each in enumerate(candidates):
        if index_of(each) != index:
            continue
        task.tell(f"channel controller {k + 1} of {len(candidates)}")
        for made in _channel_controllers(task, each, polynomial, index, rng):
            # Short numbers matter for the proof, small ones for whoever runs the controller.
            size = made.height + 8 * ceil(made.largest).bit_length()
            if best is None or size < best[0]:
                best = (size, each, made)
    if best is None:
        raise LimitReached("no channel controller was found among the candidates")
    _, each, made = best
    task.tell("certificate")
    controller = observer_programs(
        task.system, task.graph, task.agent, task.feedback.gains, each.gains, made
    )
    loop = certify_observer(
        task.system,
        controller,
        task.feedback.polynomial,
        polynomial,
        bound=task.bound,
        graph=task.graph,
    )
    return ObserverDesign(
        controller,
        loop,
        task.system.names[task.agent],
        task.feedback,
        polynomial,
        each.gains,
        made,
    )


def _channel_controllers(
    task: _Task, each: ReachingGains, polynomial: Polynomial, index: int, rng: Random
) -> list[ChannelController]:
    """Channel controllers for one candidate, from a few rows h each."""
    B, C = task.error.B(task.agent), task.error.C(task.agent)
    made = []
    if each.controllability_indices[0] <= index:
        for h in islice(observing_rows(each.matrix, C, rng), _ROWS_PER_CANDIDATE):
            made.append(channel_controller(each.matrix, B, C, polynomial, index=index, row=h))
        return made
    for h in islice(observing_rows(each.matrix.T, B.T, rng), _ROWS_PER_CANDIDATE):
        turned = channel_controller(each.matrix.T, C.T, B.T, polynomial, index=index, row=h)
        made.append(transposed(turned))
    return made
