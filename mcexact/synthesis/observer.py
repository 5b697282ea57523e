"""Observer-based control (Theorem 1), exactly and in floating point.

Every agent estimates the whole state.  The estimation errors form a multi-channel system of nm
states, the error system, and one agent q has a channel controller that moves its spectrum
(equations (10) and (11) of the paper).  In the coordinates of `observer_coordinates` the loop is
block upper triangular: state feedback first, then the errors.

- `best_channel_controller`, exact: gains K_i, H_ij are drawn with which agent q controls and
  observes all errors, and the Brasch–Pearson controller of agent q, of order m − 1 as a rule,
  assigns the whole spectrum.  Of several draws the one with the shortest and smallest numbers is
  kept.  If no draw succeeds, joint observability and completeness are decided, and a refusal
  carries the certificate.  For prescribed spectra and small systems.
- `float_proposals`, in floating point: F_i, G and L come from Riccati equations, and the channel
  controller is an observer of the errors, of order nm, or by `reduced_order_observer` of order nm −
  rank C̃.  O((nm)³) operations for each draw.  For a rate or a radius, and larger systems.

Both yield proposals, and nothing is certified here: the gate decides each loop.  `rounds` and
`most_promising` say in which order the proposals of floating point are tried: in discrete time with
up to 60 errors by the figures of their loops, otherwise by the sizes of their gains.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice
from math import ceil
from typing import TYPE_CHECKING, Any, Literal

from mcexact.analysis.controllability import joint_observability
from mcexact.analysis.fixed_modes import completeness, fixed_spectrum
from mcexact.analysis.single_channel import ReachingGains, error_gain_draws, reaching_gains
from mcexact.answer import loops as say
from mcexact.answer.loops import refusal
from mcexact.derived.constructions import closed_by, error_system
from mcexact.derived.modular import generator
from mcexact.errors import Impossible, InputError, InternalError, LimitReached, UsageError, one_of
from mcexact.exact.linear_algebra import inverse, row_echelon
from mcexact.exact.matrix import Matrix, block, dyadic_matrix, matrix_to_float, to_float, vstack
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.floating.margins import is_within
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.channel_controller import (
    ChannelController,
    assigning_controllers,
    riccati_feedback,
)
from mcexact.synthesis.gate import Coordinates, Proposal, Request
from mcexact.synthesis.networks import refuse_joint_modes
from mcexact.synthesis.optimum.diagnosis import plain_figures
from mcexact.synthesis.optimum.figures import MARGIN
from mcexact.synthesis.state_feedback import (
    StateFeedback,
    default_polynomial,
    feedback_for_region,
    given_feedback,
    loop_matrix,
    observable_part,
    spectrum_polynomial,
    split_by_channel,
    state_feedback,
)

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.float64]


def observer_coordinates(
    n: int, controller: Controller, Y: Matrix | None = None
) -> tuple[Coordinates, ...]:
    """Return coordinates in which the loop of a distributed observer may separate.

    Parameters
    ----------
    n : int
    controller : Controller
    Y : Matrix, k × nm, optional
        All z_i together, z, estimate Y e; by default Y is the identity, if the dimensions fit.

    Returns
    -------
    tuple of Coordinates
        The finest first; none if an agent shares something other than a state estimate.

    Notes
    -----
    With e_i = x_i − x, and w = Y e − z, Y = I for an observer of full order::

        (x, e, w):  ⎡ A + Σ B_i F_i     *       *   ⎤      (x, e, z):  ⎡ A + Σ B_i F_i   *  ⎤
                    ⎢      0         E − B̃G     *   ⎥                  ⎣      0         M_E ⎦
                    ⎣      0            0    E − LC̃ ⎦

    The first form applies if channel q has an observer of the errors, the second to every
    distributed observer.
    """
    if any(agent.shared != n for agent in controller.agents):
        return ()
    private = [agent.private for agent in controller.agents]
    if Y is None and sum(private) == n * len(private):
        Y = Matrix.identity(sum(private))
    fine = () if Y is None else (_coordinates(n, private, Y),)
    return (*fine, _coordinates(n, private, None))


def _coordinates(n: int, private: list[int], Y: Matrix | None) -> Coordinates:
    """(x, e, w), or (x, e, z) without Y, for the state (x, x_1, z_1, …)."""
    m, order = len(private), sum(private)
    same = vstack([Matrix.identity(n)] * m, ncols=n)
    x, e, z = Matrix.identity(n), Matrix.identity(n * m), Matrix.identity(order)
    if Y is None:
        lower, sign, driven = Matrix.zeros(order, n * m), z, Matrix.zeros(order, n)
    else:
        lower, sign, driven = Y, -z, -(Y @ same)
    right = [Matrix.zeros(rows, order) for rows in (n, n * m)]
    T = block(
        [
            [x, Matrix.zeros(n, n * m), right[0]],
            [same, e, right[1]],
            [Matrix.zeros(order, n), lower, sign],
        ]
    )
    inverse = block(
        [
            [x, Matrix.zeros(n, n * m), right[0]],
            [-same, e, right[1]],
            [driven, lower, sign],
        ]
    )
    places, hidden = list(range(n)), n + n * m
    for i, k in enumerate(private):
        places += [*range(n + n * i, n + n * (i + 1)), *range(hidden, hidden + k)]
        hidden += k
    sizes = (n, n * m + order) if Y is None else (n, n * m, order)
    return Coordinates(T.take(rows=places), inverse.take(cols=places), sizes)


def observer_programs(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    feedback: Sequence[Matrix],
    observer_gains: Sequence[Matrix],
    channels: Mapping[int, ChannelController],
) -> Controller:
    """Write the observer as agent programs.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
    feedback : sequence of Matrix
        F_i, p_i×n.
    observer_gains : sequence of Matrix
        [K_i, H_ij, j ∈ N_i∖{i}], n×(q_i + n(|N_i| − 1)), of the open-loop observer.
    channels : mapping of int to ChannelController
        The channel controllers, for channels q of the error system.

    Notes
    -----
    Paper, section II-C, equations (10) and (11)::

        ẋ_i = (A + Σ B_jF_j + K_iC_i) x_i − K_i y_i + Σ H_ij (x_i − x_j)  (+ C̄ z for each q)
        ż   = Ā z + K̄ (C_q x_q − y_q) + Σ H̄_j (x_q − x_j),     u_i = F_i x_i
    """
    n, closed = system.n, loop_matrix(system, tuple(feedback))
    programs = []
    for i in range(system.m):
        others = [j for j in graph.neighborhood(i) if j != i]
        channel = channels.get(i)
        own = observer_gains[i] if channel is None else observer_gains[i] + channel.D
        update = _innovation(system, i, others, own, closed)
        private, private_update = 0, LinearMap()
        if channel is not None:
            private = channel.order
            update = LinearMap(update.outputs, update.shared, channel.C)
            driven = _innovation(system, i, others, channel.B, Matrix.zeros(private, n))
            private_update = LinearMap(driven.outputs, driven.shared, channel.A)
        programs.append(
            AgentProgram(
                system.names[i],
                n,
                private,
                update.without_zeros(),
                private_update.without_zeros(),
                LinearMap(shared={i: feedback[i]}).without_zeros(),
            )
        )
    return Controller(system.time, system.digest_of_values(), tuple(programs))


def _innovation(
    system: MultiChannelSystem, i: int, others: Sequence[int], gains: Matrix, own: Matrix
) -> LinearMap:
    """own x_i + K (C_i x_i − y_i) + Σ_j H_j (x_i − x_j) with [K, H_j, …] = gains."""
    n, q = system.n, system.q(i)
    K = gains.take(cols=range(q))
    shared = {}
    total = own + K @ system.C(i)
    for k, j in enumerate(others):
        H = gains.take(cols=range(q + k * n, q + (k + 1) * n))
        total = total + H
        shared[j] = -H
    shared[i] = total
    return LinearMap({i: -K}, shared)


# Channel controllers that observe the estimation errors, of full or of reduced order.

Gain = Callable[[Matrix, Matrix], Matrix | None]


@dataclass(frozen=True)
class ErrorObserver:
    """A channel controller, with the combination of errors that its state estimates.

    Attributes
    ----------
    channel : ChannelController
    Y : Matrix, k×N
        z estimates Y e, and the error Y e − z is autonomous.
    L : Matrix
        The gain of the observer.
    """

    channel: ChannelController
    Y: Matrix
    L: Matrix


def full_order_observer(E: Matrix, B: Matrix, C: Matrix, G: Matrix, L: Matrix) -> ErrorObserver:
    """z' = (E − BG − LC) z + L y, u = −G z: of order N, exact for any G and L.

    Parameters
    ----------
    E : Matrix, N×N
    B, C : Matrix, N×p and q×N
    G, L : Matrix, p×N and N×q
    """
    channel = ChannelController(
        A=E - B @ G - L @ C,
        B=L,
        C=-G,
        D=Matrix.zeros(B.ncols, C.nrows),
        polynomial=None,
    )
    return ErrorObserver(channel, Matrix.identity(E.nrows), L)


def reduced_order_observer(
    E: Matrix, B: Matrix, C: Matrix, G: Matrix, gain: Gain
) -> ErrorObserver | None:
    """Make an observer of reduced order N − rank C, for the states that the outputs do not measure.

    Parameters
    ----------
    E, B, C, G : Matrix
        As in `full_order_observer`.
    gain : callable
        A function that returns L for a pair (E_22, E_12), such that E_22 − L E_12 is fast enough,
        or None.

    Returns
    -------
    ErrorObserver or None
        None if there is no gain.

    Notes
    -----
    With R = XC the echelon form of C, y_1 = Xy = Re and e_2 the entries of e without a pivot,
    e = V_1 y_1 + V_2 e_2; E_ij and B_i are the blocks of E and B in the coordinates (y_1, e_2), and

        z' = (E_22 − L E_12)(z + L y_1) + (E_21 − L E_11) y_1 + (B_2 − L B_1) u,
        u  = −G (V_1 y_1 + V_2 (z + L y_1)),

    so that z estimates Ye with Y e = e_2 − L y_1, and the spectrum of the loop is that of E − BG
    and of E_22 − L E_12 together (Luenberger).
    """
    R, pivots = row_echelon(C)
    X = _combination(C, pivots)
    N, rest = E.nrows, [j for j in range(E.nrows) if j not in set(pivots)]
    identity = Matrix.identity(N)
    V1 = identity.take(cols=list(pivots))
    W = identity.take(rows=rest)
    V2 = W.T - V1 @ R.take(cols=rest)
    L = gain(W @ E @ V2, R @ E @ V2)
    if L is None:
        return None
    Y = W - L @ R
    onto = V1 + V2 @ L
    driven = Y @ B
    feedback = G @ onto
    channel = ChannelController(
        A=Y @ E @ V2 - driven @ G @ V2,
        B=(Y @ E @ onto - driven @ feedback) @ X,
        C=-(G @ V2),
        D=-(feedback @ X),
        polynomial=None,
    )
    return ErrorObserver(channel, Y, L)


def _combination(C: Matrix, pivots: tuple[int, ...]) -> Matrix:
    """X with XC the echelon form of C, from rows of C that are independent."""
    _, independent = row_echelon(C.T)
    square = C.take(rows=list(independent), cols=list(pivots))
    X = inverse(square)
    if X is None:
        raise InternalError("independent rows are singular in their pivots")
    return X @ Matrix.identity(C.nrows).take(rows=list(independent))


# The exact observer: drawn gains, their channel controllers, and the best of these.

_ROWS_PER_CANDIDATE = 2


@dataclass(frozen=True)
class ObserverTask:
    """The task of an exact observer design, before gains and channel controller are chosen."""

    system: MultiChannelSystem
    graph: NeighborGraph
    agent: int
    feedback: StateFeedback
    error: MultiChannelSystem
    wanted: Mapping[str, Any]
    request: Request
    least: bool

    def polynomial(self, degree: int) -> Polynomial:
        """The prescribed polynomial of the error system, of this degree."""
        if "error" in self.wanted:
            return spectrum_polynomial(self.wanted["error"], degree, where="spectrum.error")
        return default_polynomial(self.request.region, degree)

    def center(self) -> Fraction:
        """The mean of the prescribed numbers; 0 if the number of them is unusual."""
        degree = self.error.n + self.system.m - 1
        try:
            polynomial = self.polynomial(degree)
        except InputError:
            return Fraction(0)
        return -polynomial.coefficients[degree - 1] / degree if degree else Fraction(0)


def _candidates(task: ObserverTask) -> list[ReachingGains]:
    """Find observer gains with which the agent controls and observes all errors."""
    system, agent = task.system, [task.agent]
    draw = error_gain_draws(system, task.graph, task.feedback.gains, task.center())
    # More candidates give shorter numbers, but each costs some n³ operations.
    count = max(32, min(240, 20_000 // max(1, task.error.n) ** 2))
    quick = reaching_gains(task.error, agent, draw, index=system.m, attempts=4 * count)
    gains = list(islice(quick, count))
    if gains:
        return gains
    observable = joint_observability(system)
    if not observable.controllable:
        raise refusal("unreached", observable, template=say.NOT_OBSERVABLE)
    decision = completeness(task.error)
    if not decision.complete:
        raise refusal("not complete", decision)
    gains = list(islice(reaching_gains(task.error, agent, draw, attempts=2000), count))
    if not gains:
        raise LimitReached("observer gains K_i, H_ij exist, but 2000 draws did not find them")
    return gains


def best_channel_controller(
    task: ObserverTask,
) -> tuple[ReachingGains, ChannelController, Polynomial]:
    """Find the observer gains and the channel controller with the shortest and smallest numbers.

    Returns
    -------
    observer_gains : ReachingGains
        [K_i, H_ij …], and the matrix of the error system with them.
    channel : ChannelController
    polynomial : Polynomial
        The characteristic polynomial of the error system with both.

    Raises
    ------
    Impossible
        If there are none; the certificate proves this.
    InputError
        If the prescribed spectrum has the wrong length.
    """
    candidates = _candidates(task)

    def index_of(each: ReachingGains) -> int:
        (seen,) = each.observability_indices
        (reached,) = each.controllability_indices
        return min(reached, seen) if task.least else reached

    index = min(map(index_of, candidates))
    polynomial = task.polynomial(task.error.n + index - 1)
    rng = generator(task.error, "channel_controller")
    B, C = task.error.B(task.agent), task.error.C(task.agent)
    best: tuple[int, ReachingGains, ChannelController] | None = None
    for k, each in enumerate(candidates):
        if index_of(each) != index:
            continue
        task.request.tell(f"channel controller {k + 1} of {len(candidates)}")
        side = "controllable" if each.controllability_indices[0] <= index else "observable"
        controllers = assigning_controllers(
            each.matrix, B, C, polynomial, index=index, side=side, rng=rng
        )
        for controller in islice(controllers, _ROWS_PER_CANDIDATE):
            # Short numbers matter for the proof, small ones for running the controller.
            size = controller.bit_length + 8 * ceil(controller.largest).bit_length()
            if best is None or size < best[0]:
                best = (size, each, controller)
    if best is None:
        raise LimitReached("no channel controller was found among the candidates")
    return best[1], best[2], polynomial


# Proposals to the gate; those in floating point are made further below.


def observer_proposals(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    request: Request,
    *,
    gains: Sequence[Matrix] | None = None,
    order: Literal["least"] | None = None,
) -> Iterator[Proposal]:
    """Yield the proposals of `design_observer` for the gate; exact arithmetic yields one.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
        Without delays.
    request : Request
    gains : sequence of m Matrix, optional
        Given F_i (p_i×n).
    order : {"least"}, optional
        See `design_observer`.

    Raises
    ------
    UsageError
        If links have delays, or there is no such order.
    """
    if graph.delays:
        raise UsageError(
            "the distributed observer has no delays on its links; remove them, or design with an "
            "extended system"
        )
    one_of(order, (None, "least"), "order")
    carrier, region = request.agent or 0, request.region
    if request.arithmetic == "float":
        yield from float_proposals(
            system, graph, carrier, request, gains=gains, reduced=order == "least"
        )
        return
    wanted = _checked_spectrum(request.spectrum, gains)
    if request.spectrum is None and gains is None:
        hidden = joint_observability(system).uncontrollable_polynomial
        if hidden.degree > 0 and region.contains_roots_of(hidden):
            yield _of_the_observable_part(system, graph, carrier, request, order == "least")
            return
    request.tell("state feedback")
    feedback = _feedback(system, wanted.get("feedback"), region, gains)
    request.tell("observer gains for the error system")
    error = error_system(system, feedback.gains, graph)
    task = ObserverTask(system, graph, carrier, feedback, error, wanted, request, order == "least")
    yield _proposal(task, Matrix.identity(system.n))


def _of_the_observable_part(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    carrier: int,
    request: Request,
    least: bool,
) -> Proposal:
    """Propose agents that estimate the observable part; the unobservable modes are fast enough.

    Raises
    ------
    Impossible
        If there is an obstruction; the certificate is about the system, not about this part of it.
    LimitReached
        If the error system of the part is not complete without a fixed mode outside the region.
    """

    refuse_if_impossible(system, graph, request.region)
    part, L = observable_part(system)
    request.tell("state feedback")
    feedback = feedback_for_region(part, request.region)
    request.tell("observer gains for the error system")
    error = error_system(part, feedback.gains, graph)
    task = ObserverTask(part, graph, carrier, feedback, error, {}, request, least)
    try:
        proposal = _proposal(task, L)
    except Impossible:
        refuse_if_impossible(system, graph, request.region, [F @ L for F in feedback.gains])
        raise LimitReached(
            "for the F_i that were found, no constant K_i, H_ij let one agent control and observe "
            "all errors of the observable part: try floating-point arithmetic"
        ) from None
    controller = replace(proposal.controller, system=system.digest_of_values())
    return Proposal(controller, parts=proposal.parts)


def _proposal(task: ObserverTask, estimated: Matrix) -> Proposal:
    """Write the best channel controller as agent programs."""
    candidate, channel, error = best_channel_controller(task)
    feedback = task.feedback
    controller = observer_programs(
        task.system, task.graph, feedback.gains, candidate.gains, {task.agent: channel}
    )
    parts = {
        "agent": task.system.names[task.agent],
        "channel_order": channel.order,
        "feedback": feedback.gains,
        "feedback_polynomial": feedback.polynomial,
        "error_polynomial": error,
        "observer_gains": candidate.gains,
        "estimated": estimated,
    }
    coordinates = observer_coordinates(task.system.n, controller)[-1:]
    return Proposal(controller, (feedback.polynomial, error), coordinates, parts)


def _checked_spectrum(
    spectrum: Mapping[str, Any] | None, gains: Sequence[Any] | None
) -> Mapping[str, Any]:
    """Check the keys of a prescribed spectrum."""
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
    gains: Sequence[Matrix] | None,
) -> StateFeedback:
    """Return F_i with the prescribed polynomial, or for the region, or the given gains."""
    if gains is not None:
        return given_feedback(system, tuple(gains))
    if wanted is None and region.bound is not None:
        return feedback_for_region(system, region)
    return state_feedback(system, spectrum_polynomial(wanted, system.n, where="spectrum.feedback"))


# The order in which observers in floating point are tried.

_MARGINS = (Fraction(1, 4), Fraction(1, 16), Fraction(1, 256))
_POWERS, _OF_ONE = (17 / 16, 5 / 4), (0.98, 0.9)
_MUCH_FASTER = 4.0
_EFFORTS = (1.0, 10.0, 100.0)
_SMALL = 60
_SHOWN, _DRAWS = 8, 3


@dataclass(frozen=True)
class Round:
    """Regions for which observers are designed, and how the best of them is found.

    Attributes
    ----------
    targets : tuple of (StabilityRegion, float)
        Each inside the region asked for, with the price of the inputs for the gains F_i.
    ranked : bool
        Whether the observers of this round are sorted by the figures of their loops.
    """

    targets: tuple[tuple[StabilityRegion, float], ...]
    ranked: bool = False

    @property
    def draws(self) -> int | None:
        """The largest number of draws of observer gains for each target; None without a limit."""
        return _DRAWS if self.ranked else None


def rounds(region: StabilityRegion, errors: int) -> Iterator[Round]:
    """Yield the rounds of a search, the most promising first.

    Parameters
    ----------
    region : StabilityRegion
    errors : int
        The dimension of the error system.

    Notes
    -----
    In discrete time a fraction of the radius would make a loop much faster than asked, so that the
    targets are powers of the radius.  High prices of the inputs give F_i that make slow modes no
    faster than asked.

    Examples
    --------
    >>> first, *_ = rounds(StabilityRegion.of("discrete", radius="0.99"), 27)
    >>> [str(target.bound) for target, price in first.targets if price == 1]
    ['98937/100000', '98751/100000']
    """
    if region.discrete:
        edge = to_float(region.edge)
        radii = _OF_ONE if edge == 1.0 else tuple(edge**power for power in _POWERS)
        targets = [
            (StabilityRegion.of(region.time, bound=bound), price)
            for bound in (Fraction(int(1e5 * radius), 10**5) for radius in radii)
            for price in _EFFORTS
            if 0 < bound < region.edge
        ]
        small = errors <= _SMALL
        if targets:
            # Without a comparison, a price in the middle.
            yield Round(tuple(targets if small else targets[1:2]), ranked=small)
    for margin in _MARGINS:
        yield Round(((region.tightened(margin), 1.0),))


def honors(region: StabilityRegion, bound: float) -> bool:
    """Whether a loop is about as slow as asked: its slowest eigenvalue has a modulus above ρ⁴.

    Always true in continuous time, and for the radius 1, which asks for no rate.

    Examples
    --------
    >>> asked = StabilityRegion.of("discrete", radius="0.99")
    >>> honors(asked, 0.98), honors(asked, 0.9)
    (True, False)
    """
    return not region.discrete or region.edge >= 1 or bound >= to_float(region.edge) ** _MUCH_FASTER


def most_promising(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    proposals: Iterable[Proposal],
    *,
    by_order: bool = True,
) -> Iterator[Proposal]:
    """Yield proposals, the first of them sorted by order, margin, radius and cost.

    Parameters
    ----------
    system : MultiChannelSystem
    graph : NeighborGraph
    region : StabilityRegion
        In discrete time loops that `honors` accepts come first.
    proposals : iterable of Proposal
        The first 8 are compared, and sorted.
    by_order : bool
        Whether the order counts.
    """
    rest = iter(proposals)

    def rank(each: Proposal) -> tuple[int, bool, bool, float]:
        seen = plain_figures(closed_loop(system, each.controller, graph))
        order = each.controller.order if by_order else 0
        if not seen.margin >= MARGIN:
            return order, True, True, -seen.margin
        return order, False, not honors(region, seen.bound), seen.cost

    yield from sorted(islice(rest, _SHOWN), key=rank)
    yield from rest


# Distributed observers designed in floating point and certified exactly.

_BITS = (36, 52)
_FLOAT_EFFORTS = (1.0, 1e2, 1e4, 1e-2)
_GRID = 8


@dataclass(frozen=True)
class _Candidate:
    """Observer gains [K_i, H_ij …], with gains for the resulting error system."""

    observer_gains: tuple[Matrix, ...]
    G: Matrix
    observer: ErrorObserver
    size: float


def float_proposals(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    request: Request,
    *,
    gains: Sequence[Matrix] | None = None,
    reduced: bool = False,
) -> Iterator[Proposal]:
    """Propose distributed observers for a region from Riccati equations, the most promising first.

    Parameters
    ----------
    system : MultiChannelSystem
        A system with n states and m channels; modes inside the region need not be controllable or
        observable.
    graph : NeighborGraph
        Without delays.
    agent : int
        q, counted from 0.
    request : Request
    gains : sequence of m Matrix, optional
        Given F_i (p_i×n).
    reduced : bool
        Whether to propose observers of reduced order first.

    Raises
    ------
    Impossible
        At the end, if all channels together do not control or do not observe a mode outside the
        region, or it is fixed for the error system of these F_i; the certificate proves this.
    LimitReached
        At the end, if no such obstruction exists.

    Notes
    -----
    Floating point proposes F_i, K_i, H_ij, G and L; the gate certifies the loop with these rational
    numbers block by block (`observer_coordinates`).  Of several draws of K_i, H_ij the one with the
    smallest G and L comes first.  The channel controller, of order nm, is

        z' = (E − B̃G − LC̃) z + L ỹ,     ũ = −G z,

    with its first matrix exact, so that the separation is exact; for the reduced order nm − rank C̃
    see `reduced_order_observer`.  O((nm)³) operations.  The proposals, and hence the controller and
    its certificate, depend on the processor and on the versions of numpy and scipy.
    """
    _require_doubles(system)
    tried, region = 0, request.region
    for each in rounds(region, system.n * system.m):
        candidates = list[tuple[_Candidate, tuple[Matrix, ...]]]()
        for target, price in each.targets:
            request.tell("state feedback")
            F = _state_feedback(system, target, price) if gains is None else tuple(gains)
            if F is None:
                continue
            error = error_system(system, F, graph)
            for drawn in islice(_drawn_gains(system, graph, error, F), each.draws):
                tried += 1
                request.tell(f"observer gains K, H number {tried}")
                solved = _solved(error, agent, drawn, target, reduced)
                candidates += [(each, F) for each in solved]
        candidates.sort(key=lambda each: (each[0].observer.channel.order, each[0].size))
        proposed = (_float_proposal(system, graph, agent, F, each, tried) for each, F in candidates)
        yield from most_promising(system, graph, region, proposed) if each.ranked else proposed
    refuse_if_impossible(system, graph, region, gains)
    raise LimitReached(
        f"{tried} draws of observer gains K_i, H_ij and their Riccati equations led to no loop "
        f"that could be certified for {region}; try another agent, or a larger region"
    )


def _float_proposal(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    agent: int,
    F: tuple[Matrix, ...],
    each: _Candidate,
    tried: int,
) -> Proposal:
    """A candidate as programs."""
    observer = each.observer
    channels = {agent: observer.channel}
    controller = observer_programs(system, graph, F, each.observer_gains, channels)
    parts = {
        "agent": system.names[agent],
        "channel_order": observer.channel.order,
        "feedback": F,
        "observer_gains": each.observer_gains,
        "G": each.G,
        "L": observer.L,
        "estimated": Matrix.identity(system.n),
        "attempts": tried,
    }
    coordinates = observer_coordinates(system.n, controller, observer.Y)
    return Proposal(controller, (), coordinates, parts)


def _require_doubles(system: MultiChannelSystem) -> None:
    """Raise an error for entries beyond the range of double precision.

    Raises
    ------
    LimitReached
    """
    import numpy as np

    for M in (system.A, system.input_matrix(), system.output_matrix()):
        if not np.all(np.isfinite(matrix_to_float(M))):
            raise LimitReached(
                "the plant has entries beyond the range of double precision: use exact arithmetic"
            )


def _state_feedback(
    system: MultiChannelSystem, target: StabilityRegion, price: float
) -> tuple[Matrix, ...] | None:
    """Compute dyadic F_i from a Riccati equation; None if there is no solution."""
    rounded = _gain(system.A, system.input_matrix(), target, price)
    if rounded is None:
        return None
    return split_by_channel(system, rounded)


def _drawn_gains(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    error: MultiChannelSystem,
    feedback: Sequence[Matrix],
) -> Iterator[tuple[Matrix, ...]]:
    """Draw moderate [K_i, H_ij …], with which each agent mostly follows one neighbor.

    In continuous time H_ij = −h I + noise for one j, which pulls x_i towards x_j; in discrete time
    a part of the difference is taken over.  Fewer draws for larger systems.
    """
    import numpy as np

    n, discrete = system.n, is_discrete(system.time)
    rng = np.random.default_rng(generator(error, "lists").getrandbits(64))
    spread = float(np.max(np.abs(np.linalg.eigvals(matrix_to_float(system.A))), initial=1.0))
    strengths = (0.5, 1.0, 0.0) if discrete else (2 * spread, spread, 4 * spread)
    count = 12 if error.n <= 60 else 6 if error.n <= 150 else 2
    for draw in range(count):
        h, noise = strengths[draw % len(strengths)], 0.25 if draw % 2 else 0.5
        gains = []
        for i in range(system.m):
            others = [j for j in graph.neighborhood(i) if j != i]
            parts = [noise * rng.standard_normal((n, system.q(i)))]
            leader = others[int(rng.integers(len(others)))] if others else None
            for j in others:
                H = noise * rng.standard_normal((n, n))
                parts.append(H - h * np.eye(n) if j == leader else H)
            on_grid = np.round(np.hstack(parts) * _GRID).astype(int)
            gains.append(Matrix.from_integers(on_grid.tolist(), _GRID, ncols=on_grid.shape[1]))
        yield tuple(gains)


def _solved(
    error: MultiChannelSystem,
    agent: int,
    observer_gains: tuple[Matrix, ...],
    target: StabilityRegion,
    reduced: bool,
) -> list[_Candidate]:
    """Observers of the errors under these gains, of full order and, if asked, of reduced order."""
    import numpy as np

    E, B, C = closed_by(error, observer_gains), error.B(agent), error.C(agent)
    G = _gain(E, B, target)
    if G is None:
        return []
    observers = []
    L = _gain(E.T, C.T, target)
    if L is not None:
        observers.append(full_order_observer(E, B, C, -G, -L.T))
    if reduced:

        def gain(E22: Matrix, E12: Matrix) -> Matrix | None:
            F = _gain(E22.T, E12.T, target)
            return None if F is None else -F.T

        less = reduced_order_observer(E, B, C, -G, gain)
        observers += [] if less is None else [less]
    size = float(np.linalg.norm(matrix_to_float(G)))
    return [
        _Candidate(observer_gains, -G, each, size * float(np.linalg.norm(matrix_to_float(each.L))))
        for each in observers
    ]


def _gain(A: Matrix, B: Matrix, target: StabilityRegion, price: float = 1.0) -> Matrix | None:
    """Compute a dyadic F for A + B F from a Riccati equation; None if there is no solution."""
    floats, inputs = matrix_to_float(A), matrix_to_float(B)
    F = _first_feedback(floats, inputs, target, price)
    return None if F is None else _rounded(floats, inputs, F, target)


def _first_feedback(A: Floats, B: Floats, target: StabilityRegion, price: float) -> Floats | None:
    """Compute a gain with the least effort for which the computed loop is fast enough."""
    for effort in _FLOAT_EFFORTS:
        F = riccati_feedback(A, B, target, effort=price * effort)
        if F is not None and is_within(A + B @ F, target):
            return F
    return None


def _rounded(A: Floats, B: Floats, F: Floats, target: StabilityRegion) -> Matrix:
    """Round a gain to few bits if these suffice, otherwise to the bits of a double."""
    few, many = _BITS
    short = dyadic_matrix(F, few)
    reached = is_within(A + B @ matrix_to_float(short), target)
    return short if reached else dyadic_matrix(F, many)


def refuse_if_impossible(
    system: MultiChannelSystem,
    graph: NeighborGraph,
    region: StabilityRegion,
    gains: Sequence[Matrix] | None = None,
) -> None:
    """Raise an error that proves that no observer exists, if that can be proved.

    Raises
    ------
    Impossible
    """
    refuse_joint_modes(system, region)
    if gains is None:
        return
    decision = fixed_spectrum(error_system(system, gains, graph))
    if decision.outside(region):
        raise refusal("fixed", decision, template=say.ERRORS_FIXED, region=region)
