"""The ladder of starts, from static gains to the controller of the theorem, and the best result."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from mcexact.synthesis.optimum.aims import SEEDS
from mcexact.synthesis.optimum.alone import found_alone
from mcexact.synthesis.optimum.cost import quadratic_costs
from mcexact.synthesis.optimum.cuts import cut_gains, cut_observers, held_states, whole_model
from mcexact.synthesis.optimum.effort import Effort
from mcexact.synthesis.optimum.figures import Figures, figures_of, shift_of
from mcexact.synthesis.optimum.polish import SLACK, Target, bound_of, drafted, inside, polished
from mcexact.synthesis.optimum.problem import FeedbackProblem, Sizes, Structure
from mcexact.synthesis.optimum.programs import NetworkController, balanced, problem_of, rounded
from mcexact.synthesis.optimum.starts import (
    Locality,
    drawn_dynamics,
    local_observers,
    local_regulators,
    localities,
    with_private_parts,
)
from mcexact.synthesis.optimum.weights import Floats, Weights
from mcexact.synthesis.request import Progress

Rank = tuple[bool, float]

_SHIFTS = (1.0, 1.3, 1.7, 2.5, 4.0)
_REACHES = ((1.0, 1.0), (10.0, 1.0), (100.0, 1.0), (10.0, 100.0))
_KEPT, _LARGEST_ORDER = 2, 3
_PRICE_OF_ORDER = 1.02
_MOST_ENTRIES = 1500
_BETTER, _GOOD = 0.97, 2.0
_DEAR, _HOPELESS, _CONTENT = 0.05, 1000.0, 1.5
_SMALL, _FRAGILE = 20, 1.25
_STATIC = "static gains"
MOST_STATES = 100
"""Of plants for which the controller of the theorem is constructed where a search found none."""


@dataclass(frozen=True)
class Ladder:
    """What a search tries, and when it ends.

    Attributes
    ----------
    structure : callable
        The structure in which every agent has a state of some order, one for all or for each.
    theorem : callable
        The controller of the theorem, with its network; None if there is none.
    weights : Weights
    target : Target
    enough : float
        The cost at which the search ends, if margin and gains are as aimed at.
    effort : Effort
    sizes : Sizes or None
        Of the signals of the plant.
    seeds : int
        The number of drawn starts of each order.
    most_digits : int or None
        The largest number of digits of an entry.
    most_order : int or None
        The largest number of states of each agent; None without a limit, where starts are drawn
        for orders up to 3.
    tell : callable
    """

    structure: Callable[[int | Sequence[int]], Structure]
    theorem: Callable[[], NetworkController | None]
    weights: Weights
    target: Target
    enough: float
    effort: Effort
    sizes: Sizes | None = None
    seeds: int = SEEDS
    most_digits: int | None = None
    most_order: int | None = None
    tell: Progress = field(default=lambda _: None)

    @property
    def large(self) -> bool:
        """Whether the plant is so large that a search is content with a little more."""
        return len(self.weights.Q) > MOST_STATES

    @property
    def orders(self) -> range:
        """The orders for which starts are drawn."""
        return range(1, (_LARGEST_ORDER if self.most_order is None else self.most_order) + 1)

    def allows(self, problem: FeedbackProblem) -> bool:
        """Whether no agent has more states than it may have."""
        sizes = zip(problem.orders, problem.network.dimensions, strict=True)
        return self.most_order is None or all(z + x <= self.most_order for z, x in sizes)

    def fine(self, found: Figures) -> bool:
        """Whether a controller is good enough to end the search."""
        return (
            found.cost <= self.enough
            and found.margin >= self.target.margin
            and self.target.shape.met(found.damping, found.fastest)
            and found.largest_gain <= 1.001 * self.target.largest_gain
        )

    def keeps(self, problem: FeedbackProblem, K: Floats) -> bool:
        """Whether a gain matrix stays in the region with the digits that it may have."""
        if self.most_digits is None:
            return True
        x = problem.entries(rounded(K, self.most_digits))
        return self.target.reached(bound_of(problem, x))


@dataclass(frozen=True, eq=False)
class Candidate:
    """A controller inside the region, as a gain matrix.

    Attributes
    ----------
    step : str
        The step of the ladder that found it.
    problem : FeedbackProblem
    K : ndarray
        Balanced.
    figures : Figures
        Without the peak.
    """

    step: str
    problem: FeedbackProblem
    K: Floats
    figures: Figures


@dataclass(frozen=True, eq=False)
class Start:
    """A gain matrix from which a search starts, and the step of the ladder that it belongs to."""

    step: str
    problem: FeedbackProblem
    K: Floats


def climbed(ladder: Ladder) -> list[Candidate]:
    """Return the candidates of the ladder, up to the first that is good enough.

    Notes
    -----
    In floating point; nothing is proved.  All starts of a step are followed for a while, and the
    best two of them to the end.  For a large plant 1.5 times the price that is enough ends the
    search after a step.  Where drafts are dear there is only one, and if its cost is far too high
    it waits until all steps were tried; a hopeless one waits in any case.
    """
    found: list[Candidate] = []
    later: list[tuple[float, Start]] = []
    for step in _steps(ladder, found, later):
        drafts, dear = list[tuple[float, Start]](), False
        for start in filter(lambda each: ladder.allows(each.problem), step):
            if ladder.effort.over:
                break
            ladder.tell(start.step)
            before = ladder.effort.left
            value, draft = _draft(ladder, start)
            if value <= ladder.enough and _finish(ladder, draft, found):
                return found
            if np.isfinite(value) and value > ladder.enough:
                drafts.append((value, draft))
                dear = ladder.effort.left < (1 - _DEAR) * before
                if dear:
                    break
        drafts.sort(key=lambda each: each[0])
        for value, draft in drafts[:_KEPT]:
            if value > (_GOOD if dear else _HOPELESS) * ladder.enough:
                later.append((value, draft))
            elif _finish(ladder, draft, found):
                return found
        if ladder.large and best_price(ladder, found) <= _CONTENT * ladder.enough:
            return found
    for _, draft in sorted(later, key=lambda each: each[0])[: 2 * _KEPT]:
        if _finish(ladder, draft, found):
            break
    return found


def _draft(ladder: Ladder, start: Start) -> tuple[float, Start]:
    """Follow a start into the region and for a few steps; return its cost, too.

    It is infinite where the region is not reached.  The barrier does not count: at the border of
    the region it is high, and polishing leaves it.
    """
    problem, part = start.problem, ladder.effort.part(0.3)
    x = inside(problem, problem.entries(start.K), ladder.target, part)
    if x is None:
        return np.inf, start
    x, value = drafted(problem, x, ladder.target, part)
    K = problem.gain(x)
    [(cost, _)] = quadratic_costs(problem, K, (1.0 if problem.discrete else 0.0,))
    return min(cost, value), replace(start, K=K)


def _finish(ladder: Ladder, draft: Start, found: list[Candidate]) -> bool:
    """Follow a draft to the end and append what it leads to; whether that is good enough."""
    problem = draft.problem
    if ladder.effort.over and found:
        return False
    part = ladder.effort.part(0.4)
    for x in polished(problem, problem.entries(draft.K), ladder.target, part):
        made = _candidate(ladder, draft.step, problem, problem.gain(x))
        if made is not None:
            found.append(made)
            if ladder.fine(made.figures) and ladder.keeps(problem, made.K):
                return True
    return False


def ranked(ladder: Ladder, found: list[Candidate]) -> list[Candidate]:
    """Return the candidates by their prices, the lowest first."""
    return sorted(found, key=lambda each: _price(ladder, each))


def _price(ladder: Ladder, candidate: Candidate) -> float:
    """The cost; small margins, large gains and high orders make it higher."""
    figures, target = candidate.figures, ladder.target
    lacking = _FRAGILE * target.margin / max(figures.margin, 1e-9)
    lacking = 1.0 if figures.margin >= target.margin else lacking
    large = max(figures.largest_gain / target.largest_gain, 1.0)
    lacking *= 1.0 if target.shape.met(figures.damping, figures.fastest) else _FRAGILE
    return figures.cost * lacking * large * _PRICE_OF_ORDER**figures.order


def best_price(ladder: Ladder, found: list[Candidate]) -> float:
    """The lowest price; infinite without candidates."""
    return min((_price(ladder, each) for each in found), default=np.inf)


def _candidate(ladder: Ladder, step: str, problem: FeedbackProblem, K: Floats) -> Candidate | None:
    """Compute the figures of a gain matrix; None if its loop lies outside the region."""
    K = balanced(problem, K)
    figures = figures_of(problem, K, peak=False)
    if not ladder.target.reached(figures.bound) or not np.isfinite(figures.cost):
        return None
    return Candidate(step, problem, K, figures)


def _steps(
    ladder: Ladder, found: list[Candidate], later: list[tuple[float, Start]]
) -> Iterator[Iterable[Start]]:
    """Yield the starts of each step, from the lowest order to the highest.

    An order is the last one if the best price is moderate, and it did not make it lower by a part.
    """
    static = FeedbackProblem.of(*ladder.structure(0), ladder.weights, ladder.sizes)
    parts = [localities(static, ladder.weights, driven=each) for each in (False, True)]
    yield [Start(_STATIC, static, _best_static(ladder, static, parts))]
    observers = [*_cut(ladder, static, parts[1]), *_local_observers(ladder, static, parts)]
    for order in ladder.orders:
        problem = FeedbackProblem.of(*ladder.structure(order), ladder.weights, ladder.sizes)
        yield [each for each in observers if each.problem.order <= problem.order]
        observers = [each for each in observers if each.problem.order > problem.order]
        if problem.order > 2 * problem.n or problem.size > _MOST_ENTRIES:
            break
        before = best_price(ladder, found)
        yield _alone(ladder, static, parts[1], order)
        yield _drawn(ladder, problem, order, [*found, *(draft for _, draft in later)])
        if _BETTER * before < best_price(ladder, found) < _GOOD * ladder.enough:
            return
    yield observers
    # It takes long to construct, and is hardly ever a better start than what was found.
    small = static.n <= (_SMALL if found else MOST_STATES)
    proposed = ladder.theorem() if small else None
    if proposed is not None:
        problem, K = problem_of(*proposed, ladder.weights, ladder.sizes)
        if problem.size <= _MOST_ENTRIES:
            yield [Start("from the theorem's controller", problem, balanced(problem, K))]


def _drawn(
    ladder: Ladder, problem: FeedbackProblem, order: int, known: Sequence[Candidate | Start]
) -> Iterator[Start]:
    """Yield drawn starts of one order, with and without the static gains that were found."""
    static = next((each for each in known if each.step == _STATIC), None)
    given = None if static is None else (static.problem, static.K)
    for seed in range(ladder.seeds):
        K = drawn_dynamics(problem, seed, None if seed % 2 else given)
        yield Start(f"order {order} per agent, seed {seed}", problem, K)


def _alone(
    ladder: Ladder, static: FeedbackProblem, parts: list[Locality], order: int
) -> Iterator[Start]:
    """Yield the controllers that agents find for their own parts, if any of them finds one."""
    network = static.network
    orders = (order,) * network.given.m
    problem = FeedbackProblem.of(network, orders, ladder.weights, ladder.sizes)
    made = found_alone(parts, order, ladder.target, ladder.effort.part(0.05))
    if any(part is not None for part in made):
        K, drawn = with_private_parts(problem, made), drawn_dynamics(problem, 0)
        for agent, part in zip(problem.agents, made, strict=True):
            K[agent.updates] = drawn[agent.updates]
            if part is None:
                K[agent.private_rows] = drawn[agent.private_rows]
        yield Start(f"order {order} per agent, each for itself", problem, balanced(problem, K))


def _best_static(ladder: Ladder, problem: FeedbackProblem, parts: list[list[Locality]]) -> Floats:
    """The best of the local regulators of several rates, and of no feedback at all."""
    shifts = [shift_of(ladder.target.region, factor) for factor in _SHIFTS]
    starts = [local_regulators(problem, each, shift) for each in parts for shift in shifts]
    model = whole_model(problem, ladder.weights)
    cut = (cut_gains(problem, model, shift) for shift in shifts)
    starts += [each for each in cut if each is not None]
    if sum(problem.network.dimensions) + sum(problem.orders):
        dynamics = drawn_dynamics(problem, 0)
        starts = [each + dynamics for each in starts]
        starts.append(dynamics)
    else:
        starts.append(np.zeros(problem.mask.shape))

    return min(starts, key=lambda K: _rank(ladder, problem, K))


def _rank(ladder: Ladder, problem: FeedbackProblem, K: Floats) -> Rank:
    """Whether a start is outside the region; its cost, or else its largest real part or modulus."""
    ladder.effort.take(len(problem.A), 2.0)
    bound = bound_of(problem, problem.entries(K))
    if not ladder.target.reached(bound, SLACK):
        return True, bound
    [(cost, _)] = quadratic_costs(problem, K, (1.0 if problem.discrete else 0.0,))
    return False, cost


def _cut(ladder: Ladder, static: FeedbackProblem, parts: Sequence[Locality]) -> list[Start]:
    """Optimal controllers of all agents together, cut to what each agent knows: the best of some.

    The noisier outputs are taken to be, and the dearer inputs, the shorter is the reach of gains.
    """
    held = held_states(parts)
    problem = FeedbackProblem.of(
        *ladder.structure([len(each) for each in held]), ladder.weights, ladder.sizes
    )
    if problem.size > _MOST_ENTRIES or problem.order > max(2 * problem.n, 8):
        return []
    model, ranked = whole_model(static, ladder.weights), list[tuple[Rank, Floats]]()
    for noise, price in _REACHES:
        weighed = replace(model, V=noise * model.V, R=price * model.R)
        for factor in _SHIFTS:
            K = cut_observers(problem, held, weighed, shift_of(ladder.target.region, factor))
            if K is not None:
                ranked.append((_rank(ladder, problem, K), K))
    if not ranked:
        return []
    K = min(ranked, key=lambda each: each[0])[1]
    return [Start("cut from the controller for all agents", problem, balanced(problem, K))]


def _local_observers(
    ladder: Ladder, static: FeedbackProblem, parts: list[list[Locality]]
) -> list[Start]:
    """The optimal controllers of the agents' own parts, where they are not too large."""
    found = []
    for each in parts:
        made = local_observers(each, shift_of(ladder.target.region))
        orders = [0 if part is None else len(part[0]) for part in made]
        problem = FeedbackProblem.of(static.network, orders, ladder.weights, ladder.sizes)
        if not 0 < sum(orders) <= max(2 * problem.n, 8) or problem.size > _MOST_ENTRIES:
            continue
        K = with_private_parts(problem, made)
        updates = np.concatenate([agent.updates for agent in problem.agents])
        K[updates] = drawn_dynamics(problem, 0)[updates]
        found.append(Start("local observers", problem, balanced(problem, K)))
    return found
