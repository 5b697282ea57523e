"""Descent from a gain matrix to a local optimum.

The objective of a design is the linear-quadratic cost over a bound for every controller, plus
penalties: a barrier at the border of the region, peaks that leave single loops or all inputs
together too little margin, large gains, and eigenvalues that are badly damped or too fast.  It is
infinite outside the region, so every descent has two parts.

1.  `inside` moves a start into the region.  `ratcheted` minimizes the cost for a part of the rate,
   then for more of it.  If it fails, `spectral_descent` minimizes the largest real part or modulus,
   which is not smooth where eigenvalues meet, and `ratcheted` goes on from where it ends.
2.  `drafted` takes a few steps of least objective, to compare starts; `polished` goes on to the
   local optimum, and then penalizes the peaks that it meets, with larger and larger weights, until
   the margins are enough.

Two more moves serve starts that are far from the region: `calmed` reduces what the agents do to the
plant where this makes a loop faster, and `settled` lowers the cost of a stable loop outside the
region, which long networks need.  `controllers_of_parts` runs the search for each agent and its own
part of the plant.

All of them use one method, BFGS with a line search that accepts infinite values, and count their
work in an `Effort` instead of timing it, so that results do not depend on the load of the machine.
Everything here is floating point and proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from mcexact.exact.matrix import matrix_from_float, to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.floating.margins import is_within, spectral_bound
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.figures import (
    GRID_OF_PEAKS,
    INFINITE,
    MARGINS,
    NO_LIMITS,
    NO_MARGINS,
    Complexes,
    Eigenvalues,
    Limits,
    Margins,
    Scalings,
    Shape,
    Valued,
    quadratic_costs,
    shift_of,
)
from mcexact.synthesis.optimum.problem import (
    Effort,
    FeedbackProblem,
    Floats,
    Weights,
    single_channel,
)
from mcexact.synthesis.optimum.starts import Locality, Model, Realization, drawn_dynamics

# The objective: cost, barrier of the region, sensitivity, size of the gains, eigenvalues.

_SHAPE = 100.0
SHARE_OF_SHIFTED = 0.0005
"""The weight σ of the cost of the shifted loop, which makes the border of the region a barrier.

With larger weights loops become faster than is asked, and dearer.
"""
_NO_POINTS: Complexes = np.zeros(0, dtype=np.complex128)


@dataclass(frozen=True, eq=False)
class Objective:
    """(J_0 + σ J_a + τ Σ_k J_k)/J* + μ e_T + Σ max(0, |K_ij|/g − 1)² + 100 e.

    Here e_T is `Margins.excess`, e is `Shape.excess`, and J_k are the costs of plants nearby.

    Attributes
    ----------
    problem : FeedbackProblem
    shift : float
        The shift a (continuous time) or ρ (discrete time) of J_a.
    least : float
        J*, such as a bound for every controller.
    largest_gain : float
        g; infinite without a limit.
    weight : float
        μ, the weight of the peaks of T.
    limits : Limits
        On the peaks.
    points : ndarray of complex
        The frequencies at which they are penalized.
    shape : Shape
    scalings : pair of ndarray or None
        Those of the margins of all inputs and of all outputs together.
    members : tuple of FeedbackProblem
        The same problem for plants nearby, the cost of which counts, too.
    share : float
        τ.
    """

    problem: FeedbackProblem
    shift: float
    least: float = 1.0
    largest_gain: float = np.inf
    weight: float = 0.0
    limits: Limits = NO_MARGINS
    points: Complexes = field(default_factory=lambda: _NO_POINTS)
    shape: Shape = NO_LIMITS
    scalings: Scalings | None = None
    members: tuple[FeedbackProblem, ...] = ()
    share: float = 0.0

    def __call__(self, x: Floats) -> Valued:
        """Compute the objective and its gradient in the free entries of K.

        Returns
        -------
        float, ndarray
            Infinite unless every eigenvalue of the shifted loop is stable, and all loops of plants
            nearby are.
        """
        problem = self.problem
        K, unshifted = problem.gain(x), 1.0 if problem.discrete else 0.0
        (plain, G0), (shifted, Ga) = quadratic_costs(problem, K, (unshifted, self.shift))
        if not np.isfinite(plain) or not np.isfinite(shifted):
            return INFINITE
        value = (plain + SHARE_OF_SHIFTED * shifted) / self.least
        G = (G0 + SHARE_OF_SHIFTED * Ga) / self.least
        for member in self.members:
            [(cost, Gk)] = quadratic_costs(member, K, (unshifted,))
            if not np.isfinite(cost):
                return INFINITE
            value, G = value + self.share * cost / self.least, G + self.share * Gk / self.least
        if self.points.size and self.weight:
            excess, Gm = Margins(problem, K).excess(self.points, self.limits, self.scalings)
            if not np.isfinite(excess):
                return INFINITE
            value, G = value + self.weight * excess, G + self.weight * Gm
        if np.isfinite(self.largest_gain):
            over = np.maximum(np.abs(K) / self.largest_gain - 1, 0)
            size = float(np.sum(over**2))
            if size:
                value, G = value + size, G + 2 * over * np.sign(K) / self.largest_gain
        if not self.shape.free:
            excess, Ge = self.shape.excess(problem, K)
            value, G = value + _SHAPE * excess, G + _SHAPE * Ge
        if not np.isfinite(value):
            return INFINITE
        return value, problem.gradient(G)

    @property
    def work(self) -> float:
        """How many times the work of one Lyapunov equation an evaluation takes, about."""
        problem = self.problem
        if not self.points.size:
            return 2.0 + len(self.members)
        rows, columns = problem.mask.shape
        # Each point multiplies the L × N, N × P matrices; an equation has some 25 N³ operations.
        of_points = len(self.points) * rows * columns / (6 * max(len(problem.A), 1) ** 2)
        return float(4 + of_points + len(self.members))


# The BFGS method with a line search that accepts infinite values (Lewis and Overton 2013).

Function = Callable[[Floats], Valued]

_DECREASE, _CURVATURE = 1e-4, 0.9
_SEARCH = 40
_WINDOW = 15


@dataclass(frozen=True, eq=False)
class _Step:
    """An accepted step of the line search."""

    x: Floats
    value: float
    gradient: Floats


def minimize(
    function: Function,
    x: Floats,
    *,
    steps: int = 200,
    tolerance: float = 1e-6,
    enough: Callable[[float], bool] | None = None,
    stop: Callable[[], bool] | None = None,
) -> tuple[Floats, float]:
    """Find a local minimum from a point where a function is finite.

    Parameters
    ----------
    function : callable
        The value and the gradient; the value may be infinite, where the gradient is not used.
    x : ndarray
    steps : int
        The largest number of steps.
    tolerance : float
        Ends when 15 steps together decrease the value by less than this part of it.
    enough : callable, optional
        Ends when it holds for the value.
    stop : callable, optional
        Ends when it holds; it is asked before each step.

    Returns
    -------
    x : ndarray
    value : float
        Infinite if it is infinite at the start.

    Examples
    --------
    >>> def barrier(x):
    ...     inside = x[0] > 1
    ...     return (x[0] - np.log(x[0] - 1), 1 - 1 / (x - 1)) if inside else (np.inf, x)
    >>> minimize(barrier, np.array([5.0]))[0].round(3).tolist()
    [2.0]
    """
    value, gradient = function(x)
    if not np.isfinite(value) or not x.size:
        return x, value
    H, fresh, values = _first(x, gradient), True, [value]
    for _ in range(steps):
        if stop is not None and stop():
            break
        direction = -H @ gradient
        if not float(gradient @ direction) < 0:
            H, fresh = _first(x, gradient), True
            direction = -H @ gradient
        step = _line_search(function, x, value, gradient, direction)
        if step is None:
            break
        shift, change = step.x - x, step.gradient - gradient
        H, fresh = _updated(H, shift, change, fresh=fresh)
        x, value, gradient = step.x, step.value, step.gradient
        values.append(value)
        settled = len(values) > _WINDOW and values[-_WINDOW] - value < tolerance * abs(value)
        if settled or (enough is not None and enough(value)):
            break
    return x, value


def _first(x: Floats, gradient: Floats) -> Floats:
    """A multiple of the identity with which the first step is short."""
    length = max(0.05, 0.1 * float(np.linalg.norm(x)))
    return np.eye(len(x)) * (length / max(float(np.linalg.norm(gradient)), 1e-300))


def _updated(H: Floats, shift: Floats, change: Floats, *, fresh: bool) -> tuple[Floats, bool]:
    """Update the inverse of the Hessian matrix; a first one is scaled before."""
    curvature = float(shift @ change)
    if not curvature > 1e-14 * np.linalg.norm(shift) * np.linalg.norm(change):
        return H, fresh
    if fresh:
        H = np.eye(len(H)) * (curvature / float(change @ change))
    r, Hy = 1 / curvature, H @ change
    crossed = np.outer(Hy, shift)
    H = H + (1 + r * float(change @ Hy)) * r * np.outer(shift, shift) - r * (crossed + crossed.T)
    return H, False


def _line_search(
    function: Function, x: Floats, value: float, gradient: Floats, direction: Floats
) -> _Step | None:
    """Bisect for a step of sufficient decrease and curvature; None if no step decreases."""
    slope, low, high, t = float(gradient @ direction), 0.0, np.inf, 1.0
    best: _Step | None = None
    for k in range(_SEARCH):
        point = x + t * direction
        lower, G = function(point)
        if not lower <= value + _DECREASE * t * slope:
            high = t
        else:
            best = _Step(point, lower, G)
            if float(G @ direction) >= _CURVATURE * slope:
                break
            low = t
        t = (low + high) / 2 if np.isfinite(high) else 2 * low
        if best is not None and k > 12:
            break
    return best


# From a start into the region, and on to a local optimum of the objective.

SLACK = 1.02
"""The region is tightened by this factor, so that rounding the controller does not leave it."""
_RATCHETS, _STALLS, _SHARE = 40, 4, 0.15
_PARTS = (0.5, 0.25, 0.12, 0.06)
_MARGIN_ROUNDS, _MARGIN_STEPS = 6, 120
_AIMED_FURTHER, _NEARLY = 1.1, 1.02
"""The peaks are penalized for margins a tenth larger than asked; a fiftieth larger is enough."""
_AIMED_LAST, _LAST_WEIGHT, _HEAVY = 1.04, 300.0, 10.0
"""Of the rounds after that, in which heavy penalties allow smaller margins and a lower cost."""
_SETTLED = 60
_DRAFT, _POLISH = 60, 400
_TOLERANCE = 1e-4
_GAIN_AIMED_AT = 0.95


@dataclass(frozen=True)
class Target:
    """What a search aims at.

    Attributes
    ----------
    region : StabilityRegion
    largest_gain : float
    limits : Limits
        The margins that are enough; the search aims a tenth higher.
    least : float
        A cost by which all costs are divided, such as the bound for every controller.
    shape : Shape
        Limits on the eigenvalues, which the search aims at.
    """

    region: StabilityRegion
    largest_gain: float = np.inf
    limits: Limits = MARGINS
    least: float = 1.0
    shape: Shape = NO_LIMITS

    def reached(self, bound: float, factor: float = 1.0) -> bool:
        """Whether a largest real part or modulus lies in the region, tightened by a factor."""
        shift = shift_of(self.region, factor)
        return bound < shift if self.region.discrete else bound < -shift

    def keeps(self, problem: FeedbackProblem, x: Floats) -> bool:
        """Whether the computed eigenvalues of a loop lie in the region, with its limits."""
        if not self.reached(bound_of(problem, x)):
            return False
        return not self.region.limits or is_within(problem.loop(x), self.region)


def bound_of(problem: FeedbackProblem, x: Floats) -> float:
    """The largest real part or modulus of an eigenvalue of a loop; infinite if it overflows."""
    M = problem.loop(x)
    if not np.all(np.isfinite(M)):
        return np.inf
    return spectral_bound(M, problem.network.plant.time)


def spectral_descent(
    problem: FeedbackProblem, x: Floats, target: Target, effort: Effort, *, steps: int = 150
) -> Floats:
    """Minimize the largest real part, or the largest modulus, until it lies well inside.

    Notes
    -----
    The function is not smooth where eigenvalues meet; BFGS descends all the same (Lewis and Overton
    2013).
    """
    size = 1e-6 / max(1.0, float(x @ x))

    def value(x: Floats) -> Valued:
        effort.take(len(problem.A), 2.0)
        M = problem.loop(x)
        if not np.all(np.isfinite(M)):
            return INFINITE
        seen = Eigenvalues.of(problem, M)
        values = seen.values
        k = int(np.argmax(np.abs(values) if problem.discrete else values.real))
        mode = complex(values[k])
        G = seen.slope(k, mode.conjugate() / max(abs(mode), 1e-300) if problem.discrete else 1.0)
        bound = abs(mode) if problem.discrete else mode.real
        return bound + size * float(x @ x), problem.gradient(G) + 2 * size * x

    result, _ = minimize(
        value,
        x,
        steps=steps,
        tolerance=1e-4,
        enough=lambda bound: target.reached(bound, _well_inside(target.region)),
        stop=lambda: effort.over,
    )
    return result


def _well_inside(region: StabilityRegion) -> float:
    """A factor by which a region is tightened for a start."""
    return 1.5 if region.discrete and to_float(region.edge) == 1.0 else 1.1


def calmed(problem: FeedbackProblem, x: Floats, effort: Effort) -> tuple[Floats, float]:
    """Scale down the gains that act on the plant, where this makes a loop faster.

    Controllers that agents design for their own parts can disturb each other.  With smaller inputs
    the loop may be stable, and a search can start from it.

    Returns
    -------
    x : ndarray
        The free entries of the fastest of the loops that were tried.
    bound : float
        Its largest real part or modulus.
    """
    K, tries = problem.gain(x), [(bound_of(problem, x), x)]
    stable = tries[0][0] < (1.0 if problem.discrete else 0.0)
    for part in () if stable else _PARTS:
        effort.take(len(problem.A), 0.5)
        K[: problem.p] = part * problem.gain(x)[: problem.p]
        entries = problem.entries(K)
        tries.append((bound_of(problem, entries), entries))
    bound, best = min(tries, key=lambda each: each[0])
    return best, bound


def ratcheted(problem: FeedbackProblem, x: Floats, target: Target, effort: Effort) -> Floats | None:
    """Move a loop into the region by minimizing the cost for a part of the rate, then for more.

    Returns
    -------
    ndarray or None
        None if the loop stopped becoming faster.
    """
    goal = shift_of(target.region, SLACK)
    bound, stalls, share = bound_of(problem, x), 0, _SHARE
    for _ in range(_RATCHETS):
        if target.reached(bound, SLACK):
            return x
        if effort.over or not np.isfinite(bound):
            break
        gap = abs(bound - goal) if problem.discrete else bound + goal
        step = share * max(gap, 1e-6 * abs(goal))
        shift = bound + step if problem.discrete else -bound - step

        def shifted(x: Floats, shift: float = shift) -> Valued:
            effort.take(len(problem.A), 2.0)
            [(value, G)] = quadratic_costs(problem, problem.gain(x), (shift,))
            return (value, problem.gradient(G)) if np.isfinite(value) else INFINITE

        candidate, _ = minimize(shifted, x, steps=25, stop=lambda: effort.over)
        faster = bound_of(problem, candidate)
        slow = bound - faster < 0.01 * gap
        # Nearer to the edge the cost counts little but how fast the loop is.
        stalls, share = (stalls + 1, 0.3 * share) if slow else (0, _SHARE)
        if faster < bound:
            x, bound = candidate, faster
        if stalls >= _STALLS:
            break
    return x if target.reached(bound) else None


def settled(
    problem: FeedbackProblem, x: Floats, target: Target, effort: Effort, *, rounds: int = 8
) -> Floats:
    """Lower the cost of a stable loop outside the region, for some rounds or until it is inside.

    Notes
    -----
    The cost of a long network is least inside most regions, so that lowering it leads there.  The
    barrier of each round is half the rate that the loop has.  A loop that is not stable is returned
    unchanged.
    """
    edge = 1.0 if problem.discrete else 0.0
    for _ in range(rounds):
        bound = bound_of(problem, x)
        if not bound < edge or target.reached(bound, SLACK) or effort.over:
            break
        shift = (bound + edge) / 2 if problem.discrete else -bound / 2
        costs = Objective(problem, shift, target.least, target.largest_gain)
        objective = _counted(costs, effort)
        x, _ = minimize(objective, x, steps=_SETTLED, stop=lambda: effort.over)
    return x


def drafted(
    problem: FeedbackProblem, x: Floats, target: Target, effort: Effort
) -> tuple[Floats, float]:
    """Take a few steps towards the least objective, without regard to the margin.

    Returns
    -------
    x : ndarray
    value : float
        The objective.
    """
    objective = _objective(problem, x, target)
    return minimize(_counted(objective, effort), x, steps=_DRAFT, stop=lambda: effort.over)


def _objective(problem: FeedbackProblem, x: Floats, target: Target) -> Objective:
    """The objective whose barrier is the region with the slack, or as much as a start has of it."""
    bound, edge = bound_of(problem, x), shift_of(target.region)
    shift = shift_of(target.region, SLACK)
    if not target.reached(bound, SLACK):
        shift = (edge + (bound if problem.discrete else -bound)) / 2
    gain = _GAIN_AIMED_AT * target.largest_gain
    return Objective(problem, shift, target.least, gain, shape=target.shape)


def polished(
    problem: FeedbackProblem,
    x: Floats,
    target: Target,
    effort: Effort,
    weight: float | None = None,
) -> Iterator[Floats]:
    """Minimize the objective from a loop inside the region, round by round.

    Parameters
    ----------
    problem : FeedbackProblem
    x : ndarray
        Free entries of K.
    target : Target
    effort : Effort
    weight : float, optional
        That of the first penalty; by default 1, after a round without one.

    Yields
    ------
    ndarray
        Free entries of K inside the region: first of least cost, without regard to the margins;
        then with larger and larger margins, of larger and larger cost, until these are enough.

    Notes
    -----
    A round penalizes the highest peaks that this round and all before it have met, so that a peak
    that was lowered does not return; the weight of the penalty grows threefold.  Light penalties
    leave the margins more room than was asked; the last round, with a heavy one, takes it back.
    """
    objective, first = _objective(problem, x, target), effort.part(0.5)
    counted = _counted(objective, first)
    if weight is None:
        x, value = minimize(
            counted, x, steps=_POLISH, tolerance=_TOLERANCE, stop=lambda: first.over
        )
        weight = 1.0
    else:
        value, _ = counted(x)
    if not np.isfinite(value):
        return
    limits, aimed = target.limits, _AIMED_FURTHER
    points = _NO_POINTS
    for _ in range(_MARGIN_ROUNDS):
        yield x
        peaks = Margins(problem, problem.gain(x)).peaks(limits.tightened(aimed))
        effort.take(len(problem.A), replace(objective, points=_GRID).work)
        if effort.over:
            return
        if peaks.keep(target.limits.tightened(_NEARLY)):
            if not points.size or aimed == _AIMED_LAST:
                return
            aimed, weight = _AIMED_LAST, _LAST_WEIGHT
        points = np.unique(np.concatenate([points, peaks.points]))
        penalized = replace(
            objective,
            weight=weight,
            limits=limits.tightened(aimed),
            points=points,
            scalings=peaks.scalings,
        )
        x, _ = minimize(
            _counted(penalized, effort),
            x,
            steps=_MARGIN_STEPS,
            tolerance=_TOLERANCE,
            stop=lambda: effort.over,
        )
        weight *= 3
    yield x


def hardened(
    problem: FeedbackProblem,
    x: Floats,
    target: Target,
    effort: Effort,
    members: Sequence[FeedbackProblem],
    share: float,
) -> Floats:
    """Minimize the objective together with the costs of plants nearby, from a loop with margins.

    Parameters
    ----------
    problem : FeedbackProblem
    x : ndarray
        Free entries of K with which all these plants are stable, too.
    target : Target
    effort : Effort
    members : sequence of FeedbackProblem
        The same problem for these plants.
    share : float
        The weight of their costs.  It is a barrier: where a loop is hardly stable, its cost is
        high.
    """
    limits = target.limits.tightened(_AIMED_LAST)
    peaks = Margins(problem, problem.gain(x)).peaks(limits)
    objective = replace(
        _objective(problem, x, target),
        weight=_HEAVY,
        limits=limits,
        points=peaks.points,
        scalings=peaks.scalings,
        members=tuple(members),
        share=share,
    )
    x, _ = minimize(
        _counted(objective, effort),
        x,
        steps=_SETTLED,
        tolerance=_TOLERANCE,
        stop=lambda: effort.over,
    )
    return x


_GRID: Complexes = np.zeros(GRID_OF_PEAKS, dtype=np.complex128)


def _counted(objective: Objective, effort: Effort) -> Function:
    """The objective, which counts its work."""
    work = objective.work

    def value(x: Floats) -> Valued:
        effort.take(len(objective.problem.A), work)
        return objective(x)

    return value


def inside(problem: FeedbackProblem, x: Floats, target: Target, effort: Effort) -> Floats | None:
    """Move a start into the region: by the cost, else by its spectrum; None if both fail."""
    x, bound = calmed(problem, x, effort)
    if target.reached(bound, SLACK):
        return x
    result = ratcheted(problem, x, target, effort.part(0.75))
    if result is not None:
        return result
    slow = spectral_descent(problem, x, target, effort.part(0.5))
    if target.reached(bound_of(problem, slow), SLACK):
        return slow
    result = ratcheted(problem, slow, target, effort.part(0.7))
    if result is not None:
        return result
    again = spectral_descent(problem, slow, target, effort)
    return again if target.reached(bound_of(problem, again)) else None


_SEEDS = 4


def controllers_of_parts(
    parts: Sequence[Locality], order: int, target: Target, effort: Effort
) -> list[Realization | None]:
    """Search a controller of some order for each agent's own part of the plant.

    The result is None for an agent whose search fails.

    Notes
    -----
    Equal parts are searched once.
    """
    known: dict[bytes, Realization | None] = {}
    alone = []
    for part in parts:
        model = part.model
        key = b"|".join(each.tobytes() for each in (model.A, model.B, model.C))
        if key not in known:
            known[key] = _searched(model, order, target, effort)
        alone.append(known[key])
    return alone


def _searched(model: Model, order: int, target: Target, effort: Effort) -> Realization | None:
    """The best of a few drawn starts, followed for a while."""
    if not (model.B.any() and model.C.any()):
        return None
    A, B, C = (matrix_from_float(M, "dyadic") for M in (model.A, model.B, model.C))
    plant = MultiChannelSystem(A, [B], [C], time=target.region.time)
    weights = Weights(model.Q, model.R, model.W, model.V, model.bandwidth)
    problem = FeedbackProblem.of(single_channel(plant), (order,), weights)
    best, least = None, np.inf
    for seed in range(_SEEDS):
        start = problem.entries(drawn_dynamics(problem, seed))
        x = inside(problem, start, target, effort.part(0.1))
        if x is None:
            continue
        x, value = drafted(problem, x, target, effort.part(0.1))
        if value < least:
            best, least = problem.gain(x), value
    if best is None:
        return None
    p, q = len(model.B.T), len(model.C)
    return best[p:, q:], best[p:, :q], best[:p, q:], best[:p, :q]
