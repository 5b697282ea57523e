"""From a gain matrix near a region to a local optimum of the objective inside it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion
from mcexact.floating.margins import is_within, spectral_bound
from mcexact.synthesis.optimum.cost import INFINITE, Valued, quadratic_costs
from mcexact.synthesis.optimum.descent import Function, minimize
from mcexact.synthesis.optimum.effort import Effort
from mcexact.synthesis.optimum.eigenvalues import Eigenvalues
from mcexact.synthesis.optimum.figures import shift_of
from mcexact.synthesis.optimum.objective import Objective
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.sensitivity import (
    GRID,
    Sensitivity,
    frequencies,
)
from mcexact.synthesis.optimum.shape import NO_LIMITS, Shape
from mcexact.synthesis.optimum.weights import Floats

SLACK = 1.02
"""The region is tightened by this factor, so that rounding the controller does not leave it."""
_RATCHETS, _STALLS, _SHARE = 40, 4, 0.15
_PARTS = (0.5, 0.25, 0.12, 0.06)
_MARGIN_ROUNDS = 10
_SETTLED = 60
_DRAFT, _POLISH = 60, 500
_CHECKED = 200
_GAIN_AIMED_AT = 0.95


@dataclass(frozen=True)
class Target:
    """What a search aims at.

    Attributes
    ----------
    region : StabilityRegion
    largest_gain : float
    margin : float
        The margin that is enough; the search aims a tenth higher.
    shape : Shape
        Limits on the eigenvalues, which the search aims at.
    """

    region: StabilityRegion
    largest_gain: float = np.inf
    margin: float = 0.3
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
    return spectral_bound(M, problem.network.given.time)


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
        height = abs(mode) if problem.discrete else mode.real
        return height + size * float(x @ x), problem.gradient(G) + 2 * size * x

    found, _ = minimize(
        value,
        x,
        steps=steps,
        tolerance=1e-4,
        enough=lambda height: target.reached(height, _well_inside(target.region)),
        stop=lambda: effort.over,
    )
    return found


def _well_inside(region: StabilityRegion) -> float:
    """A factor by which a region is tightened for a start."""
    return 1.5 if region.discrete and to_float(region.edge) == 1.0 else 1.1


def calmed(problem: FeedbackProblem, x: Floats, effort: Effort) -> tuple[Floats, float]:
    """Reduce what the agents do to the plant, where this makes a loop faster.

    Controllers that agents find for themselves can disturb each other: then parts of their inputs
    may leave a loop stable, from which a search can start.

    Returns
    -------
    x : ndarray
        The fastest of some.
    bound : float
        Its largest real part or modulus.
    """
    K, found = problem.gain(x), [(bound_of(problem, x), x)]
    stable = found[0][0] < (1.0 if problem.discrete else 0.0)
    for part in () if stable else _PARTS:
        effort.take(len(problem.A), 0.5)
        K[: problem.p] = part * problem.gain(x)[: problem.p]
        entries = problem.entries(K)
        found.append((bound_of(problem, entries), entries))
    bound, best = min(found, key=lambda each: each[0])
    return best, bound


def ratcheted(problem: FeedbackProblem, x: Floats, target: Target, effort: Effort) -> Floats | None:
    """Move a loop into the region by minimizing the cost for a part of the rate, then for more.

    Returns
    -------
    ndarray or None
        None if the loop stopped to become faster.
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

        moved, _ = minimize(shifted, x, steps=25, stop=lambda: effort.over)
        faster = bound_of(problem, moved)
        slow = bound - faster < 0.01 * gap
        # Nearer to the edge the cost counts little but how fast the loop is.
        stalls, share = (stalls + 1, 0.3 * share) if slow else (0, _SHARE)
        if faster < bound:
            x, bound = moved, faster
        if stalls >= _STALLS:
            break
    return x if target.reached(bound) else None


def settled(
    problem: FeedbackProblem, x: Floats, target: Target, effort: Effort, *, rounds: int = 8
) -> Floats:
    """Lower the cost of a stable loop outside the region, until it lies inside or for some rounds.

    Notes
    -----
    The cost of a long network is least inside most regions, and from a loop that disturbs itself
    less the way is short.  Half the rate of a loop is the barrier.  One that is not stable stays as
    it is.
    """
    edge = 1.0 if problem.discrete else 0.0
    for _ in range(rounds):
        bound = bound_of(problem, x)
        if not bound < edge or target.reached(bound, SLACK) or effort.over:
            break
        shift = (bound + edge) / 2 if problem.discrete else -bound / 2
        objective = _counted(Objective(problem, shift, target.largest_gain), effort)
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
    return Objective(problem, shift, _GAIN_AIMED_AT * target.largest_gain, shape=target.shape)


def polished(
    problem: FeedbackProblem, x: Floats, target: Target, effort: Effort
) -> Iterator[Floats]:
    """Minimize the objective from a loop inside the region, round by round.

    Parameters
    ----------
    problem : FeedbackProblem
    x : ndarray
        Free entries of K.
    target : Target
    effort : Effort

    Yields
    ------
    ndarray
        Free entries of K inside the region: first of least cost, without regard to the margin; then
        with larger and larger margins, of larger and larger cost, until the margin is enough.

    Notes
    -----
    A round penalizes the frequencies at which the loop is too sensitive.  The weight of the penalty
    makes it as large as the cost at first, and grows fourfold from round to round.
    """
    objective, first = _objective(problem, x, target), effort.part(0.5)
    counted = _counted(objective, first)
    x, value = minimize(counted, x, steps=_POLISH, stop=lambda: first.over)
    if not np.isfinite(value):
        return
    limit, unshifted, weight = 1 / (1.1 * target.margin), 1.0 if problem.discrete else 0.0, 0.0
    for _ in range(_MARGIN_ROUNDS):
        yield x
        seen = Sensitivity(problem, problem.gain(x))
        checked = frequencies(seen.eigenvalues, discrete=problem.discrete, count=_CHECKED)
        effort.take(len(problem.A), 4.0)
        if effort.over or seen.peak(checked) <= 1.02 * limit:
            return
        points = frequencies(seen.eigenvalues, discrete=problem.discrete, count=GRID)
        if not weight:
            [(cost, _)] = quadratic_costs(problem, problem.gain(x), (unshifted,))
            weight = cost / max(seen.excess(points, limit)[0], 1.0)
        penalized = replace(objective, weight=weight, limit=limit, points=points)
        x, _ = minimize(_counted(penalized, effort), x, steps=80, stop=lambda: effort.over)
        weight *= 4
    yield x


def _counted(objective: Objective, effort: Effort) -> Function:
    """The objective, which counts its work."""

    def value(x: Floats) -> Valued:
        effort.take(len(objective.problem.A), 2.0 if objective.points is None else 5.0)
        return objective(x)

    return value


def inside(problem: FeedbackProblem, x: Floats, target: Target, effort: Effort) -> Floats | None:
    """Move a start into the region: by the cost, else by its spectrum; None if both fail."""
    x, bound = calmed(problem, x, effort)
    if target.reached(bound, SLACK):
        return x
    moved = ratcheted(problem, x, target, effort.part(0.75))
    if moved is not None:
        return moved
    found = spectral_descent(problem, x, target, effort.part(0.5))
    if target.reached(bound_of(problem, found), SLACK):
        return found
    moved = ratcheted(problem, found, target, effort.part(0.7))
    if moved is not None:
        return moved
    again = spectral_descent(problem, found, target, effort)
    return again if target.reached(bound_of(problem, again)) else None
