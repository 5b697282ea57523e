"""Periodic decentralized control of plants in discrete time, and its certification.

Linear time-invariant decentralized control leaves fixed modes where they are; gains that vary in
time move all but the quotient fixed modes.  `design_periodic` looks for a controller of period 2,
then of period 3, and so on:

1. static gains of all channels, by descent on the spectral radius of the monodromy matrix;
2. the controller of the theorem, one strong component of the transfer graph after the other: with
   drawn periodic gains at all channels but one, this one controls and observes every mode of the
   component's own part of the plant over a period but the modes 0; there a periodic observer with
   a periodic feedback closes the loop, both from periodic Riccati equations.

Both are proposals in floating point, rounded to few digits.  `certify_periodic` decides exactly
where the eigenvalues of the monodromy matrix lie, whoever designed the controller.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from scipy.optimize import minimize

from mcexact.analysis.boxes.pencils import one_thread
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.modulo import modulo
from mcexact.analysis.stability import certify_stability
from mcexact.analysis.structure import transfer_graph
from mcexact.answer.account import Account, ShownByAccount
from mcexact.answer.loops import StabilityVerdict
from mcexact.answer.modes import FixedSpectrum
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import Context
from mcexact.answer.structure import TransferGraph
from mcexact.answer.time_varying import PERIODIC_RULES
from mcexact.derived.constructions import merged, restricted
from mcexact.errors import Impossible, InputError, LimitReached, UsageError, telling
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.exact.rational import Entry
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.periodic import PeriodicController, periodic_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Progress
from mcexact.synthesis.optimum.diagnosis import rounded_controller

LONGEST = 6
"""The longest period that is tried unless another one is asked for."""
_DRAWS = 12
"""The drawn gains of a component for each period and each channel that closes it."""
_STARTS = 6
"""The starts of the descent for static gains."""
_MOST_GAINS = 24
"""The most gains, over all phases, for which the descent is tried."""
MOST_STATES = 60
"""The most states of a plant for which controllers are searched."""
_DIGITS = (2, 3, 4, 6, 9, 12, 15)
_PERIODS = 400
"""The periods after which an iteration of a Riccati equation is given up."""
_INSIDE = 0.95
"""The descent for static gains ends below this part of the radius."""
_SPEED = 0.98
"""Riccati equations aim at this part of a radius."""

Floats = npt.NDArray[Any]


def certify_periodic(
    system: MultiChannelSystem, controller: PeriodicController, *, radius: Entry | None = None
) -> StabilityVerdict:
    """Decide whether the loop of a periodic controller is stable, or fast enough.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in discrete time.
    controller : PeriodicController
        Of the period N, designed by any method.
    radius : rational, optional
        r, of one step: whether every eigenvalue of the monodromy matrix has modulus below r^N.  By
        default r is 1, and stability is decided.

    Returns
    -------
    StabilityVerdict
        About `periodic_loop`, with the bound r^N.

    Raises
    ------
    InputError
        If an argument has another type, or the controller does not fit the plant.
    UsageError
        If the plant is in continuous time, or the radius is out of range.

    Notes
    -----
    Exact.  The state of the loop tends to 0 from every start in every step of the period iff every
    eigenvalue of the monodromy matrix has modulus below 1 (``periodic.any_step``).

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]], time="discrete")
    >>> phases = [local_controllers(plant, [[[gain]]]) for gain in ("-7/4", 0)]
    >>> controller = PeriodicController(tuple(phases))
    >>> certify_periodic(plant, controller).stable
    True
    >>> certify_periodic(plant, controller, radius="1/2").stable
    False
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, PeriodicController, "controller")
    _require_discrete(system)
    region = StabilityRegion.of(system.time, None, radius)
    return certify_stability(
        periodic_loop(system, controller), _over_a_period(region, controller.period)
    )


def _over_a_period(region: StabilityRegion, period: int) -> StabilityRegion:
    """The region of the monodromy matrix: the radius of one step becomes its power."""
    return region if region.bound is None else replace(region, bound=region.bound**period)


def _require_discrete(system: MultiChannelSystem) -> None:
    if not is_discrete(system.time):
        raise UsageError(
            "periodic controllers are for plants in discrete time: sample the plant "
            "(sampled_system, or --step)"
        )


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicDesign(ShownByAccount):
    """A certified periodic decentralized controller.

    Attributes
    ----------
    controller : PeriodicController
    region : StabilityRegion
        What was asked for, of one step.
    certificates : mapping
        ``periodic_loop``, about the loop over one period.
    notes : tuple of str
        How the controller was found.
    """

    controller: PeriodicController
    region: StabilityRegion
    certificates: Mapping[str, StabilityVerdict]
    notes: tuple[str, ...] = field(default=())

    @property
    def period(self) -> int:
        """N, the number of steps after which the gains repeat."""
        return self.controller.period

    @property
    def order(self) -> int:
        """The sum of the dimensions of all agents' states."""
        return self.controller.order

    @property
    def proof(self) -> StabilityVerdict:
        """The certificate about the eigenvalues of the monodromy matrix."""
        return self.certificates["periodic_loop"]

    @property
    def account(self) -> Account:
        """The certificate, with the sentences that follow from it."""
        return account_of_period(self.proof, self.controller, self.region)

    def to_dict(self) -> dict[str, Any]:
        """Return the design as plain data."""
        return {
            "period": self.period,
            "order": self.order,
            "region": str(self.region),
            "notes": list(self.notes),
            "periodic_controller": self.controller.to_dict(),
        }

    def __repr__(self) -> str:
        bound = f", {self.region}" if self.region.bound is not None else ""
        return f"PeriodicDesign(period {self.period}, order {self.order}{bound}, certified)"


def account_of_period(
    verdict: StabilityVerdict, controller: PeriodicController, region: StabilityRegion
) -> Account:
    """Make the account of a verdict on the loop of a periodic controller.

    Parameters
    ----------
    verdict : StabilityVerdict
    controller : PeriodicController
    region : StabilityRegion
        What was asked for, of one step.
    """
    facts = {
        "period": controller.period,
        "order": controller.order,
        "region": region,
        "states": verdict.about.n,
    }
    answers: dict[str, Answer] = {"periodic_loop": verdict}
    context = Context(verdict.about.at_samples, facts)
    sentences = PERIODIC_RULES.sentences(answers, context)
    return Account(answers, context, sentences, verdict.about.subject[:-1])


def design_periodic(
    system: MultiChannelSystem,
    *,
    radius: Entry | None = None,
    longest: int = LONGEST,
    progress: Progress | None = None,
) -> PeriodicDesign:
    """Design a periodic decentralized controller: u_i(t) depends on y_i alone, and on t modulo N.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant in discrete time without feedthrough, whose neighbor graph is not used.
    radius : rational, optional
        r: over a period of N steps every eigenvalue of the loop gets modulus below r^N.  By default
        the loop is stable, without more.
    longest : int
        The longest period that is tried, from 2 on.
    progress : callable, optional
        A function that is called with a short description of each step.

    Returns
    -------
    PeriodicDesign

    Raises
    ------
    Impossible
        If a quotient fixed mode is not fast enough: no causal decentralized controller moves it.
        The certificate is that of the quotient fixed modes.
    LimitReached
        If no controller was found up to the longest period, or the plant has more than 60 states.
    InputError
        If the plant has feedthrough.
    UsageError
        If the plant is in continuous time, or an argument is out of range.

    Notes
    -----
    Searched in floating point, certified exactly.  Fixed modes 0 stay, and are in every region.
    (Willems 1989; Khargonekar and Özgüler 1994.)

    Examples
    --------
    >>> from mcexact.model import gallery
    >>> plant = gallery.load("movable-by-periodic-gains")
    >>> design = design_periodic(plant)
    >>> design.period, design.proof.stable
    (2, True)
    >>> design_periodic(plant.__class__([[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete"))
    Traceback (most recent call last):
        ...
    mcexact.errors.Impossible: no causal decentralized control moves the quotient fixed modes, the \
roots of x - 2, also none that varies in time, and they are not fast enough
    """
    InputError.require(system, MultiChannelSystem, "system")
    _require_discrete(system)
    if isinstance(longest, bool) or not isinstance(longest, int) or longest < 2:
        raise UsageError(f"expected an integer from 2 on, found {longest!r}", where="longest")
    region, tell = StabilityRegion.of(system.time, None, radius), telling(progress)
    tell("the quotient fixed modes")
    graph = transfer_graph(system)
    quotient = fixed_spectrum(merged(system, graph.components))
    _require_movable(quotient, region)
    if system.n > MOST_STATES:
        raise LimitReached(f"periodic controllers are searched for up to {MOST_STATES} states")
    components = _components(system, graph)
    for period in range(2, longest + 1):
        tell(f"controllers of period {period}")
        for how, proposal in _proposals(system, components, period, region):
            for rounded in _roundings(system, proposal, region):
                verdict = certify_periodic(system, rounded, radius=region.bound)
                if verdict.stable:
                    return PeriodicDesign(rounded, region, {"periodic_loop": verdict}, (how,))
    raise LimitReached(
        f"no controller of a period up to {longest} was found; some causal decentralized "
        "controller exists: allow a longer period"
    )


def _require_movable(quotient: FixedSpectrum, region: StabilityRegion) -> None:
    """Stop if a quotient fixed mode is not in the region."""
    outside = quotient.outside(region)
    if outside:
        roots = ", ".join(str(each.polynomial) for each in outside)
        raise Impossible(
            "no causal decentralized control moves the quotient fixed modes, the roots of "
            f"{roots}, also none that varies in time, and they are not fast enough",
            quotient,
        )


# Proposals: agents' matrices for each phase, in floating point.


class Agent(NamedTuple):
    """F, G, H and K of one agent in each phase: z(t+1) = F z + G y, u = H z + K y."""

    F: list[Floats]
    G: list[Floats]
    H: list[Floats]
    K: list[Floats]


class Component(NamedTuple):
    """The part of a plant that the channels of one strong component control and observe.

    Attributes
    ----------
    channels : tuple of int
    A, B, C
        Its matrices; B and C have one for each of these channels.
    """

    channels: tuple[int, ...]
    A: Floats
    B: list[Floats]
    C: list[Floats]


def _components(system: MultiChannelSystem, graph: TransferGraph) -> list[Component]:
    """The strong components of the transfer graph that control and observe anything."""
    components = []
    for names in graph.components:
        part = modulo(restricted(system, names), "both")
        if part.n:
            B, C = ([matrix_to_float(port(i)) for i in range(part.m)] for port in (part.B, part.C))
            channels = tuple(map(system.index, names))
            components.append(Component(channels, matrix_to_float(part.A), B, C))
    return components


def _proposals(
    system: MultiChannelSystem,
    components: Sequence[Component],
    period: int,
    region: StabilityRegion,
) -> Iterator[tuple[str, list[Agent]]]:
    """Static gains of all channels, then the controllers of the components."""
    rng = random.Random(f"{system.digest()} {period}")
    radius = 1.0 if region.bound is None else float(region.bound)
    with one_thread():
        static = _static(system, components, period, radius, rng)
    if static is not None:
        yield f"static gains of period {period}, found by descent", static
    with one_thread():
        closed = _theorem(system, components, period, radius, rng)
    if closed is not None:
        channels, agents = closed
        closing = ", ".join(system.names[i] for i in channels)
        yield f"gains of period {period} at all channels, and an observer at {closing}", agents


def _idle(system: MultiChannelSystem, period: int) -> list[Agent]:
    """Agents that do nothing."""
    agents = []
    for i in range(system.m):
        p, q = system.p(i), system.q(i)
        shapes = (0, 0), (0, q), (p, 0), (p, q)
        agents.append(Agent(*([np.zeros(shape) for _ in range(period)] for shape in shapes)))
    return agents


def _power_radius(M: Floats) -> float:
    """The spectral radius; infinite where numbers exceed floats."""
    return float(abs(np.linalg.eigvals(M)).max(initial=0.0)) if np.isfinite(M).all() else np.inf


def _static(
    system: MultiChannelSystem,
    components: Sequence[Component],
    period: int,
    radius: float,
    rng: random.Random,
) -> list[Agent] | None:
    """Static periodic gains with a small spectral radius over a period, component by component."""
    agents = _idle(system, period)
    for part in components:
        shapes = [(B.shape[1], C.shape[0]) for B, C in zip(part.B, part.C, strict=True)]
        sizes = [p * q for p, q in shapes]
        if period * sum(sizes) > _MOST_GAINS:
            return None
        split = np.cumsum([size for _ in range(period) for size in sizes])[:-1]

        def gains(values: Floats, split: Any = split, shapes: Any = shapes) -> list[list[Floats]]:
            pieces = iter(np.split(values, split))
            return [[next(pieces).reshape(shape) for shape in shapes] for _ in range(period)]

        def size(values: Floats, part: Component = part, gains: Any = gains) -> float:
            M = np.eye(len(part.A))
            for F in gains(values):
                M = _closed(part, F) @ M
            return _power_radius(M)

        best = _descended(size, period * sum(sizes), radius**period * _INSIDE, rng)
        if best is None:
            return None
        for t, phase in enumerate(gains(best)):
            for i, F in zip(part.channels, phase, strict=True):
                agents[i].K[t] = F
    return agents


def _descended(
    size: Callable[[Floats], float], count: int, enough: float, rng: random.Random
) -> Floats | None:
    """Descend from drawn points until a function is small enough."""
    for _ in range(_STARTS):
        start = np.array([rng.choice((0, 0, 1, -1, 0.5, -0.5)) for _ in range(count)], float)
        options = {"maxfev": 250 * count, "xatol": 1e-3, "fatol": 1e-4}
        reached: Floats = minimize(size, start, method="Nelder-Mead", options=options).x  # type: ignore[call-overload]
        if size(reached) < enough:
            return reached
    return None


def _closed(part: Component, F: Sequence[Floats], but: int | None = None) -> Floats:
    """A + Σ B_i F_i C_i over the channels of a component, one of them left out."""
    A = part.A.copy()
    for i, (B, C) in enumerate(zip(part.B, part.C, strict=True)):
        if i != but:
            A += B @ F[i] @ C
    return A


def _theorem(
    system: MultiChannelSystem,
    components: Sequence[Component],
    period: int,
    radius: float,
    rng: random.Random,
) -> tuple[list[int], list[Agent]] | None:
    """Drawn gains at all channels of a component but one, and the cheapest observer at this one."""
    agents, closing = _idle(system, period), list[int]()
    for part in components:
        best: tuple[float, int, Agent, list[list[Floats]]] | None = None
        for _ in range(_DRAWS):
            F = [_drawn(part, rng) for _ in range(period)]
            for q in range(len(part.channels)):
                found = _observer(part, q, F, radius)
                if found is not None and (best is None or found[0] < best[0]):
                    best = (found[0], q, found[1], F)
        if best is None:
            return None
        _, q, agent, F = best
        for k, i in enumerate(part.channels):
            for t in range(period):
                agents[i].K[t] = F[t][k]
        agents[part.channels[q]] = agent
        closing.append(part.channels[q])
    return closing, agents


def _drawn(part: Component, rng: random.Random) -> list[Floats]:
    """Gains of one phase, about as large as what they act on; some channels do nothing."""
    gains, scale = [], float(np.linalg.norm(part.A, 2)) or 1.0
    for B, C in zip(part.B, part.C, strict=True):
        p, q = B.shape[1], C.shape[0]
        F = np.array([[rng.choice((-2, -1, 1, 2)) for _ in range(q)] for _ in range(p)], float)
        size = float(np.linalg.norm(B, 2) * np.linalg.norm(C, 2)) or 1.0
        on = rng.choice((0.0, 0.25, 0.5, 1.0))
        gains.append(F.reshape(p, q) * on * 2.0 ** round(np.log2(scale / size)))
    return gains


def _observer(
    part: Component, q: int, F: Sequence[Sequence[Floats]], radius: float
) -> tuple[float, Agent] | None:
    """The cost and the matrices of the periodic observer at channel q; None if there is none.

    With the gains of the other channels x(t+1) = A_t x + B u, y = C x.  The observer

        z(t+1) = A_t z + B u + L_t (y − C z),   u = K_t z

    leaves the eigenvalues of the products of all A_t + B K_t, and of all A_t − L_t C.
    """
    speed = radius * _SPEED if radius < 1 else 1.0
    A = [_closed(part, phase, but=q) / speed for phase in F]
    B, C = part.B[q] / speed, part.C[q]
    feedback = _riccati(A[::-1], B)
    errors = _riccati([M.T for M in A], C.T)
    if feedback is None or errors is None:
        return None
    (K, P), (L, S) = feedback, errors
    K, P = K[::-1], P[::-1]
    # the cost of the noise in the estimates, and of the noise in the plant
    cost = sum(
        float(np.trace(P_t) + np.trace(K_t @ S_t @ K_t.T))
        for P_t, K_t, S_t in zip(P, K, S, strict=True)
    )
    agent = Agent([], [], [], [])
    for A_t, K_t, L_t in zip(A, K, L, strict=True):
        gain = -L_t.T * speed  # A' + C' K~ is the transpose of A - L C with L = -K~'
        agent.F.append(A_t * speed + B @ K_t * speed - gain @ C)
        agent.G.append(gain)
        agent.H.append(K_t)
        agent.K.append(np.zeros((part.B[q].shape[1], C.shape[0])))
    return cost, agent


def _riccati(A: Sequence[Floats], B: Floats) -> tuple[list[Floats], list[Floats]] | None:
    """Iterate the periodic Riccati equation with unit weights, A in the order of the iteration.

    Returns
    -------
    tuple of two lists, or None
        For each matrix of A a gain K with which A + B K is what the next one starts from, and the
        matrix P before it; None if they do not converge.
    """
    n, p = B.shape
    P: Floats = np.eye(n)
    last: Floats | None = None
    for _ in range(_PERIODS):
        gains, costs = list[Floats](), list[Floats]()
        for M in A:
            costs.append(P)
            K = -np.linalg.solve(np.eye(p) + B.T @ P @ B, B.T @ P @ M)
            gains.append(K)
            P = np.eye(n) + M.T @ P @ (M + B @ K)
            P = (P + P.T) / 2
            if not np.isfinite(P).all() or np.linalg.norm(P) > 1e13:
                return None
        if last is not None and np.linalg.norm(P - last) <= 1e-9 * np.linalg.norm(P):
            return gains, costs
        last = P
    return None


# Controllers with few digits.


def _roundings(
    system: MultiChannelSystem, agents: Sequence[Agent], region: StabilityRegion
) -> Iterator[PeriodicController]:
    """The controller with few digits, then with more, as far as it is fast enough in floats."""
    digest = system.digest_of_values()
    wanted = 1.0 if region.bound is None else float(region.bound)
    period = len(agents[0].K)
    exact = tuple(_phase(system, agents, t, digest) for t in range(period))
    for digits in _DIGITS:
        rounded = PeriodicController(tuple(rounded_controller(each, digits) for each in exact))
        M = matrix_to_float(periodic_loop(system, rounded).A)
        if _power_radius(M) < wanted**period * (1 - 1e-9):
            yield rounded


def _phase(system: MultiChannelSystem, agents: Sequence[Agent], t: int, digest: str) -> Controller:
    """The programs of one phase."""
    programs = []
    for i, agent in enumerate(agents):
        update = _map(i, agent.G[t], agent.F[t])
        control = _map(i, agent.K[t], agent.H[t])
        z = agent.F[t].shape[0]
        programs.append(AgentProgram(system.names[i], 0, z, LinearMap(), update, control))
    return Controller("discrete", digest, tuple(programs))


def _map(i: int, of_output: Floats, of_state: Floats) -> LinearMap:
    """A map of an agent's own output and state."""
    return LinearMap({i: _exact(of_output)}, {}, _exact(of_state)).without_zeros()


def _exact(M: Floats) -> Matrix:
    """The numbers of a matrix as they are stored; those that are almost 0 are 0."""
    least = 1e-12 * float(abs(M).max(initial=0.0))
    rows = [[Fraction(float(x)) if abs(x) > least else Fraction(0) for x in row] for row in M]
    return Matrix.from_rows(rows, ncols=M.shape[1])
