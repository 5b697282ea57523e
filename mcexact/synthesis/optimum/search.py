"""The ladder of structures and starts: what is tried in which order.

A local search ends in the local optimum next to its start, so many starts are tried, in steps from
the lowest order to the highest (`steps_of`):

1. static gains, from the regulators of the agents' own parts and of the whole plant;
2. for each order, the optimal controller of all agents together, cut to what each agent knows;
   optimal controllers of the agents' own parts; controllers of this order that agents find for
   their own parts; and drawn dynamics;
3. for plants that are not large, the controller of the theorem.

For large plants the cut controllers come before all orders.  `climbed` follows every start of a
step for a while and the best two to the end, and stops at the first controller that is good enough
in cost, margins, gains and digits.  Candidates are ranked by their price, the cost with surcharges
for small margins, large gains and high orders.  All of it is floating point and proves nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np

from mcexact.exact.roots import StabilityRegion
from mcexact.synthesis.gate import Progress
from mcexact.synthesis.optimum.descent import (
    SLACK,
    Target,
    bound_of,
    controllers_of_parts,
    drafted,
    inside,
    polished,
    settled,
)
from mcexact.synthesis.optimum.figures import (
    SEEDS,
    Figures,
    Margins,
    Peaks,
    figures_of,
    quadratic_costs,
    shift_of,
)
from mcexact.synthesis.optimum.problem import (
    Effort,
    FeedbackProblem,
    Floats,
    NetworkController,
    Sizes,
    Structure,
    Weights,
    balanced,
    problem_of,
    rounded,
)
from mcexact.synthesis.optimum.starts import (
    Locality,
    cut_gains,
    cut_observers,
    drawn_dynamics,
    held_states,
    local_observers,
    local_regulators,
    localities,
    tied,
    whole_model,
    with_private_parts,
)

# The ladder, its starts and candidates, and the price by which these are ranked.

_LARGEST_ORDER = 3
_PRICE_OF_ORDER, _PRICED_ORDERS = 1.02, 20
_CONTENT, _FRAGILE, _NOT_CERTIFIED = 1.5, 1.25, 1e6
MOST_STATES = 100
"""The most states of a plant for which the controller of the theorem follows a failed search."""


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
    brisk : StabilityRegion or None
        A faster region in which starts are sought, too, where no rate was asked for.
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
    brisk: StabilityRegion | None = None

    @property
    def regions(self) -> Iterator[tuple[StabilityRegion, float]]:
        """The regions for which Riccati equations give starts, with factors of their rates."""
        if self.brisk is None:
            yield from ((self.target.region, factor) for factor in _SHIFTS)
        else:
            yield self.target.region, 1.0
            yield from ((self.brisk, factor) for factor in _SHIFTS)

    @property
    def shifts(self) -> list[float]:
        """The shifts of these regions."""
        return [shift_of(region, factor) for region, factor in self.regions]

    @property
    def large(self) -> bool:
        """Whether the plant is so large that a search is content with a little more."""
        return len(self.weights.Q) > MOST_STATES

    def problem(self, structure: Structure) -> FeedbackProblem:
        """Return the problem of a structure.

        Of large plants whose agents send signals, those that look alike are tied.
        """
        untied = FeedbackProblem.of(*structure, self.weights, self.sizes)
        sending = structure[0].graph is not None
        return tied(untied, self.weights) if self.large and sending else untied

    @property
    def orders(self) -> range:
        """The orders for which starts are drawn."""
        return range(1, (_LARGEST_ORDER if self.most_order is None else self.most_order) + 1)

    def allows(self, problem: FeedbackProblem) -> bool:
        """Whether no agent has more states than it may have."""
        sizes = zip(problem.orders, problem.network.dimensions, strict=True)
        return self.most_order is None or all(z + x <= self.most_order for z, x in sizes)

    def fine(self, candidate: Candidate) -> bool:
        """Whether a controller is good enough to end the search."""
        figures = candidate.figures
        return (
            figures.cost <= self.enough
            and candidate.peaks.keep(self.target.limits)
            and self.target.shape.met(figures.damping, figures.fastest)
            and figures.largest_gain <= 1.001 * self.target.largest_gain
        )

    def keeps(self, problem: FeedbackProblem, K: Floats) -> bool:
        """Whether a gain matrix stays in the region with the digits that it may have."""
        if self.most_digits is None:
            return True
        return self.target.keeps(problem, problem.entries(rounded(K, self.most_digits)))


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
    peaks : Peaks
        The margins, on a grid of frequencies.
    """

    step: str
    problem: FeedbackProblem
    K: Floats
    figures: Figures
    peaks: Peaks


@dataclass(frozen=True, eq=False)
class Start:
    """A gain matrix from which a search starts, and the step of the ladder that it belongs to."""

    step: str
    problem: FeedbackProblem
    K: Floats


def ranked(ladder: Ladder, candidates: list[Candidate]) -> list[Candidate]:
    """Return the candidates by their prices, the lowest first."""
    return sorted(candidates, key=lambda each: _price(ladder, each))


def _price(ladder: Ladder, candidate: Candidate) -> float:
    """The cost; small margins, large gains and high orders make it higher.

    Of large plants, whose many agents have an order of one or two each, orders beyond a limit do
    not make it higher.
    """
    figures, target = candidate.figures, ladder.target
    lacking = 1.0
    for size, limit in (
        (candidate.peaks.disk, target.limits.disk),
        (candidate.peaks.margin, target.limits.margin),
        (candidate.peaks.together, target.limits.together),
    ):
        if size < limit:
            lacking = max(lacking, _FRAGILE * limit / max(size, 1e-9))
    large = max(figures.largest_gain / target.largest_gain, 1.0)
    if not target.shape.met(figures.damping, figures.fastest):
        lacking *= _NOT_CERTIFIED if target.region.limits else _FRAGILE
    priced = min(figures.order, _PRICED_ORDERS) if ladder.large else figures.order
    return figures.cost * lacking * large * _PRICE_OF_ORDER**priced


def suffices(ladder: Ladder, candidates: list[Candidate]) -> bool:
    """Whether the search of a large plant may end: the best price is nearly low enough."""
    return ladder.large and best_price(ladder, candidates) <= _CONTENT * ladder.enough


def best_price(ladder: Ladder, candidates: list[Candidate]) -> float:
    """The lowest price; infinite without candidates."""
    return min((_price(ladder, each) for each in candidates), default=np.inf)


# The steps of the ladder: starts of static gains, of low orders and of all agents together.

Rank = tuple[bool, float]

_SHIFTS = (1.0, 1.3, 1.7, 2.5, 4.0)
_REACHES = ((1.0, 1.0), (10.0, 1.0), (100.0, 1.0), (10.0, 100.0))
_FURTHER_REACHES = ((10.0, 10.0), (100.0, 10.0))
_MOST_ENTRIES, _SETTLED = 1500, 3
_BETTER, _CLOSE, _GOOD = 0.97, 1.15, 2.0
_SMALL = 20
_STATIC = "static gains"


def steps_of(
    ladder: Ladder, candidates: list[Candidate], later: list[tuple[float, Start]]
) -> Iterator[Iterable[Start]]:
    """Yield the starts of each step, from the lowest order to the highest.

    The orders end with one that hardly lowered the best price, if this price is moderate; larger
    controllers of all agents together and of the agents' own parts follow unless it is low.
    """
    static = ladder.problem(ladder.structure(0))
    parts = [localities(static, ladder.weights, driven=each) for each in (False, True)]
    narrow = localities(static, ladder.weights, much=True)
    if all(_states(narrow) != _states(each) for each in parts):
        parts.append(narrow)
    yield [Start(_STATIC, static, K) for K in _best_static(ladder, static, parts)]
    cut = _cut(ladder, static, parts[1])
    if ladder.large and any(sum(each.problem.network.dimensions) for each in cut):
        # Controllers that agents find alone disturb each other more, the more agents there are.
        yield cut
        cut = []
    observers = [*cut, *_local_observers(ladder, static, parts)]
    for order in ladder.orders:
        problem = ladder.problem(ladder.structure(order))
        yield [each for each in observers if each.problem.order <= problem.order]
        observers = [each for each in observers if each.problem.order > problem.order]
        if problem.order > 2 * problem.n or problem.size > _MOST_ENTRIES:
            break
        before = best_price(ladder, candidates)
        yield _alone(ladder, static, parts[1], order)
        yield _drawn(ladder, problem, order, [*candidates, *(draft for _, draft in later)])
        if _BETTER * before < best_price(ladder, candidates) < _GOOD * ladder.enough:
            break
    if best_price(ladder, candidates) < _CLOSE * ladder.enough:
        return
    yield observers
    if best_price(ladder, candidates) < _GOOD * ladder.enough:
        return
    # It takes long to construct, and is hardly ever a better start than what was found.
    small = static.n <= (_SMALL if candidates else MOST_STATES)
    proposed = ladder.theorem() if small and not ladder.effort.late else None
    if proposed is not None:
        problem, K = problem_of(*proposed, ladder.weights, ladder.sizes)
        if problem.size <= _MOST_ENTRIES:
            yield [Start("from the theorem's controller", problem, balanced(problem, K))]


def _states(parts: list[Locality]) -> list[tuple[int, ...]]:
    return [each.states for each in parts]


def _drawn(
    ladder: Ladder, problem: FeedbackProblem, order: int, known: Sequence[Candidate | Start]
) -> Iterator[Start]:
    """Yield drawn starts of one order, with and without the best static gains."""
    static = next((each for each in known if each.step == _STATIC), None)
    gains = None if static is None else (static.problem, static.K)
    for seed in range(ladder.seeds):
        K = drawn_dynamics(problem, seed, None if seed % 2 else gains)
        yield Start(f"order {order} per agent, seed {seed}", problem, K)


def _alone(
    ladder: Ladder, static: FeedbackProblem, parts: list[Locality], order: int
) -> Iterator[Start]:
    """Yield the controllers that agents find for their own parts, if any of them finds one."""
    network = static.network
    orders = (order,) * network.plant.m
    problem = ladder.problem((network, orders))
    alone = controllers_of_parts(parts, order, ladder.target, ladder.effort.part(0.05))
    if any(part is not None for part in alone):
        K, drawn = with_private_parts(problem, alone), drawn_dynamics(problem, 0)
        for agent, part in zip(problem.agents, alone, strict=True):
            K[agent.updates] = drawn[agent.updates]
            if part is None:
                K[agent.private_rows] = drawn[agent.private_rows]
        yield Start(f"order {order} per agent, each for itself", problem, balanced(problem, K))


def _best_static(
    ladder: Ladder, problem: FeedbackProblem, parts: list[list[Locality]]
) -> list[Floats]:
    """The best of the regulators of several rates: the agents' own, and that of all, cut.

    With no feedback at all they are at most three, the best first; where a rate was asked for there
    is one.
    """
    model = whole_model(problem, ladder.weights)
    kinds = [
        [local_regulators(problem, each, shift) for each in parts for shift in ladder.shifts],
        [K for shift in ladder.shifts if (K := cut_gains(problem, model, shift)) is not None],
        [np.zeros(problem.mask.shape)],
    ]
    if sum(problem.network.dimensions) + sum(problem.orders):
        dynamics = drawn_dynamics(problem, 0)
        kinds = [[each + dynamics for each in kind] for kind in kinds]
    best = [
        min(((_rank(ladder, problem, K), k, K) for k, K in enumerate(kind)), key=_first_two)
        for kind in kinds
        if kind
    ]
    best.sort(key=_first_two)
    return [K for *_, K in best][: 1 if ladder.brisk is None else len(best)]


def _first_two(ranked: tuple[Rank, int, Floats]) -> tuple[Rank, int]:
    return ranked[:2]


def _cut(ladder: Ladder, static: FeedbackProblem, parts: Sequence[Locality]) -> list[Start]:
    """Optimal controllers of all agents together, cut to what each agent knows: the best of some.

    Larger weights of the noise of outputs and of the inputs give gains that reach less far.
    """
    held = held_states(parts)
    problem = ladder.problem(ladder.structure([len(each) for each in held]))
    if problem.size > _MOST_ENTRIES or problem.order > max(2 * problem.n, 8):
        return []
    model, ranked = whole_model(static, ladder.weights), list[tuple[Rank, Floats]]()
    for noise, price in _REACHES if problem.ties is None else (*_REACHES, *_FURTHER_REACHES):
        weighed, tried = replace(model, V=noise * model.V, R=price * model.R), len(ranked)
        for shift in ladder.shifts:
            K = cut_observers(problem, held, weighed, shift)
            if K is not None:
                ranked.append((_rank(ladder, problem, K), K))
        ranked[tried:] = sorted(ranked[tried:], key=_first)[:1]
    ranked.sort(key=_first)
    if problem.ties is not None:
        ranked = sorted((_settled(ladder, problem, K) for _, K in ranked[:_SETTLED]), key=_first)
    if not ranked:
        return []
    K = ranked[0][1]
    return [Start("cut from the controller for all agents", problem, balanced(problem, K))]


def _first(ranked: tuple[Rank, Floats]) -> Rank:
    return ranked[0]


def _settled(ladder: Ladder, problem: FeedbackProblem, K: Floats) -> tuple[Rank, Floats]:
    """Follow a start for a short while: the cheapest start need not lead to the cheapest loop."""
    x = settled(problem, problem.entries(K), ladder.target, ladder.effort.part(0.1), rounds=1)
    K = problem.gain(x)
    return _rank(ladder, problem, K), K


def _local_observers(
    ladder: Ladder, static: FeedbackProblem, parts: list[list[Locality]]
) -> list[Start]:
    """The optimal controllers of the agents' own parts, where they are not too large."""
    starts = []
    shifts = [shift_of(each) for each in (ladder.target.region, ladder.brisk) if each is not None]
    for each, shift in product(parts, shifts):
        observers = local_observers(each, shift)
        orders = [0 if part is None else len(part[0]) for part in observers]
        problem = ladder.problem((static.network, tuple(orders)))
        if not 0 < sum(orders) <= max(2 * problem.n, 8) or problem.size > _MOST_ENTRIES:
            continue
        K = with_private_parts(problem, observers)
        updates = np.concatenate([agent.updates for agent in problem.agents])
        K[updates] = drawn_dynamics(problem, 0)[updates]
        starts.append(Start("local observers", problem, balanced(problem, K)))
    return starts


def _rank(ladder: Ladder, problem: FeedbackProblem, K: Floats) -> Rank:
    """Rank a start: whether it is outside the region; then its cost, or outside its spectral bound.

    If agents are tied it is enough that the loop is stable: in long networks the starts that lie in
    the region are far more costly than others that are moved into it.
    """
    ladder.effort.take(len(problem.A), 2.0)
    x, edge = problem.entries(K), 1.0 if problem.discrete else 0.0
    bound = bound_of(problem, x)
    usable = ladder.target.reached(bound, SLACK) if problem.ties is None else bound < edge
    if not usable:
        return True, bound
    [(cost, _)] = quadratic_costs(problem, problem.gain(x), (edge,))
    return False, cost


# The climb: every start of a step is followed for a while, the best two to the end.

_KEPT, _MOST_FREED, _SAME = 2, 3000, 1e-3
_GOOD_ENOUGH, _DEAR, _HOPELESS = 2.0, 0.05, 1000.0
_ENTERING, _ENTERING_TIED, _BEHIND = 0.3, 0.5, 1.5
_FURTHER_SEEDS = 6


def climbed(ladder: Ladder) -> list[Candidate]:
    """Return the candidates of the ladder, up to the first that is good enough.

    Notes
    -----
    In floating point; nothing is proved.  All starts of a step are followed for a while, and the
    best two of them to the end; a start that lies inside the region counts as it is, too.  For a
    large plant 1.5 times the price that is enough ends the search after a step.  Where drafts take
    much of the effort a step has only one; if its cost is far too high it is followed after all
    other steps, unless its agents are tied.  A draft of hopeless cost always comes last, and one
    that has become far dearer than the best controller is given up.  Where the deadline has passed
    before anything was found, the starts that are left count as they are.
    """
    candidates: list[Candidate] = []
    later: list[tuple[float, Start]] = []
    for step in steps_of(ladder, candidates, later):
        drafts, dear, failures = list[tuple[float, Start]](), False, 0
        for start in filter(lambda each: ladder.allows(each.problem), step):
            if ladder.effort.over and (candidates or not ladder.effort.late):
                break
            ladder.tell(f"{start.step}{_so_far(ladder, candidates)}")
            candidates += _as_it_is(ladder, start)
            if ladder.effort.over:
                continue
            before = ladder.effort.left
            value, draft = _draft(ladder, start, 1 / 3**failures)
            failures += not np.isfinite(value)
            if value <= ladder.enough and _finish(ladder, draft, candidates):
                return candidates
            if np.isfinite(value) and value > ladder.enough:
                drafts.append((value, draft))
                dear = ladder.effort.left < (1 - _DEAR) * before
                if dear:
                    break
        for value, draft in _different(drafts)[:_KEPT]:
            waits = dear and draft.problem.ties is None
            if value > (_GOOD_ENOUGH if waits else _HOPELESS) * ladder.enough:
                later.append((value, draft))
            elif _finish(ladder, draft, candidates):
                return candidates
        if suffices(ladder, candidates):
            return candidates
    for _, draft in sorted(later, key=lambda each: each[0])[: 2 * _KEPT]:
        if _finish(ladder, draft, candidates):
            break
    return candidates


def drawn_further(ladder: Ladder, candidates: Sequence[Candidate]) -> list[Candidate]:
    """Follow more drawn starts, of the order of the best controller and of one more.

    Parameters
    ----------
    ladder : Ladder
    candidates : sequence of Candidate
        The best first.

    Returns
    -------
    list of Candidate
        What was found on the way, not ranked, until the effort is spent.  Empty where the best
        price is moderate.

    Notes
    -----
    Where margins are dear the objective has many local optima, and the cheapest drafts need not
    lead to the best of them.
    """
    found = list[Candidate]()
    network = candidates[0].problem.network
    sizes = zip(candidates[0].problem.orders, network.dimensions, strict=True)
    least = max((sum(each) for each in sizes), default=0)
    for seed, more in product(range(1, _FURTHER_SEEDS), (0, 1)):
        if best_price(ladder, [*candidates, *found]) <= _GOOD * ladder.enough or ladder.effort.over:
            break
        problem = ladder.problem(ladder.structure(least + more))
        if not problem.order or problem.size > _MOST_ENTRIES or not ladder.allows(problem):
            continue
        name = f"order {least + more} per agent, seed {seed}"
        ladder.tell(f"{name}{_so_far(ladder, [*candidates, *found])}")
        start = Start(name, problem, drawn_dynamics(problem, seed))
        value, draft = _draft(ladder, start)
        if np.isfinite(value):
            _followed(ladder, draft, found)
    return found


def _different(drafts: list[tuple[float, Start]]) -> list[tuple[float, Start]]:
    """The drafts, the cheapest first, without those that seem to lead to the same optimum."""
    kept: list[tuple[float, Start]] = []
    for value, draft in sorted(drafts, key=lambda each: each[0]):
        orders = draft.problem.network, draft.problem.orders
        if not any(
            value - other < _SAME * value
            and orders == (known.problem.network, known.problem.orders)
            for other, known in kept
        ):
            kept.append((value, draft))
    return kept


def _so_far(ladder: Ladder, candidates: list[Candidate]) -> str:
    """What the best controller so far costs, and its margins."""
    if not candidates:
        return ""
    best = min(candidates, key=lambda each: _price(ladder, each))
    bound = "the bound" if ladder.brisk is not None else "the cost of one controller for all"
    return (
        f"; so far {best.figures.cost / ladder.target.least:.3g} times {bound}, disk "
        f"margin {best.peaks.disk:.2g} and {best.peaks.margin:.2g} together"
    )


def _as_it_is(ladder: Ladder, start: Start) -> list[Candidate]:
    """A start inside the region, which is a candidate: descent may end with a higher price."""
    if not ladder.target.reached(bound_of(start.problem, start.problem.entries(start.K))):
        return []
    candidate = candidate_of(ladder, start.step, start.problem.untied, start.K)
    return [] if candidate is None else [candidate]


def _draft(ladder: Ladder, start: Start, part_of: float = 1.0) -> tuple[float, Start]:
    """Follow a start into the region and for a few steps, with a part of the usual effort.

    Its cost is returned, too, which is infinite if the region is not reached.  It leaves out the
    barrier, which is high at the border of the region, from where polishing moves away.
    """
    problem, x = start.problem, start.problem.entries(start.K)
    if problem.ties is not None:
        x = settled(problem, x, ladder.target, ladder.effort.part(0.4))
    usual = _ENTERING if problem.ties is None else _ENTERING_TIED
    part = ladder.effort.part(usual * part_of)
    entered = inside(problem, x, ladder.target, part)
    if entered is None:
        return np.inf, start
    x, value = drafted(problem, entered, ladder.target, part)
    K = problem.gain(x)
    [(cost, _)] = quadratic_costs(problem, K, (1.0 if problem.discrete else 0.0,))
    return min(cost, value * ladder.target.least), replace(start, K=K)


def _finish(ladder: Ladder, draft: Start, candidates: list[Candidate]) -> bool:
    """Follow a draft to the end, append the results, and return whether one is good enough.

    If agents that look alike are tied, and no result is good enough, the ties are removed and the
    search goes on.
    """
    before = len(candidates)
    if _followed(ladder, draft, candidates):
        return True
    problem = draft.problem.untied
    freed = ranked(ladder, candidates[before:])
    if not freed or problem.ties is draft.problem.ties or problem.size > _MOST_FREED:
        return False
    if suffices(ladder, freed):
        return False
    return _followed(ladder, Start(draft.step, problem, freed[0].K), candidates)


def _followed(ladder: Ladder, draft: Start, candidates: list[Candidate]) -> bool:
    """Follow a draft in its problem, as `_finish` does."""
    problem = draft.problem
    if ladder.effort.over and candidates:
        return False
    part = ladder.effort.part(0.4 if problem.ties is None else 0.8)
    best = best_price(ladder, candidates)
    peaks = Margins(problem, draft.K).peaks(ladder.target.limits)
    # The cheapest loop of all is often a fragile one, from which no way leads to large margins.
    weight = None if peaks.keep(ladder.target.limits) else 1.0
    for x in polished(problem, problem.entries(draft.K), ladder.target, part, weight):
        candidate = candidate_of(ladder, draft.step, problem.untied, problem.gain(x))
        if candidate is not None:
            candidates.append(candidate)
            if ladder.fine(candidate) and ladder.keeps(candidate.problem, candidate.K):
                return True
            if candidate.figures.cost > _BEHIND * best:
                break
    return False


def candidate_of(
    ladder: Ladder, step: str, problem: FeedbackProblem, K: Floats
) -> Candidate | None:
    """Compute the figures of a gain matrix; None if its loop lies outside the region."""
    K = balanced(problem, K)
    figures = figures_of(problem, K, peak=False, margin=np.nan)
    if not ladder.target.reached(figures.bound) or not np.isfinite(figures.cost):
        return None
    peaks = Margins(problem, K).peaks(ladder.target.limits)
    return Candidate(step, problem, K, replace(figures, margin=peaks.margin), peaks)
