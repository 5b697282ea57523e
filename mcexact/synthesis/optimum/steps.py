"""The steps of the ladder: starts of static gains, of low orders and of all agents together."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from mcexact.synthesis.optimum.alone import found_alone
from mcexact.synthesis.optimum.cost import quadratic_costs
from mcexact.synthesis.optimum.cuts import cut_gains, cut_observers, held_states, whole_model
from mcexact.synthesis.optimum.figures import shift_of
from mcexact.synthesis.optimum.ladder import MOST_STATES, Candidate, Ladder, Start, best_price
from mcexact.synthesis.optimum.polish import SLACK, bound_of, settled
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.programs import balanced, problem_of
from mcexact.synthesis.optimum.starts import (
    Locality,
    drawn_dynamics,
    local_observers,
    local_regulators,
    localities,
    with_private_parts,
)
from mcexact.synthesis.optimum.weights import Floats

Rank = tuple[bool, float]

_SHIFTS = (1.0, 1.3, 1.7, 2.5, 4.0)
_REACHES = ((1.0, 1.0), (10.0, 1.0), (100.0, 1.0), (10.0, 100.0))
_FURTHER_REACHES = ((10.0, 10.0), (100.0, 10.0))
_MOST_ENTRIES, _SETTLED = 1500, 3
_BETTER, _GOOD = 0.97, 2.0
_SMALL = 20
_STATIC = "static gains"


def steps_of(
    ladder: Ladder, found: list[Candidate], later: list[tuple[float, Start]]
) -> Iterator[Iterable[Start]]:
    """Yield the starts of each step, from the lowest order to the highest.

    An order is the last one if the best price is moderate, and it did not make it lower by a part.
    """
    static = ladder.problem(ladder.structure(0))
    parts = [localities(static, ladder.weights, driven=each) for each in (False, True)]
    narrow = localities(static, ladder.weights, much=True)
    if all(_states(narrow) != _states(each) for each in parts):
        parts.append(narrow)
    yield [Start(_STATIC, static, _best_static(ladder, static, parts))]
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


def _states(parts: list[Locality]) -> list[tuple[int, ...]]:
    return [each.states for each in parts]


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
    problem = ladder.problem((network, orders))
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


def _cut(ladder: Ladder, static: FeedbackProblem, parts: Sequence[Locality]) -> list[Start]:
    """Optimal controllers of all agents together, cut to what each agent knows: the best of some.

    The noisier outputs are taken to be, and the dearer inputs, the shorter is the reach of gains.
    """
    held = held_states(parts)
    problem = ladder.problem(ladder.structure([len(each) for each in held]))
    if problem.size > _MOST_ENTRIES or problem.order > max(2 * problem.n, 8):
        return []
    model, ranked = whole_model(static, ladder.weights), list[tuple[Rank, Floats]]()
    for noise, price in _REACHES if problem.ties is None else (*_REACHES, *_FURTHER_REACHES):
        weighed, tried = replace(model, V=noise * model.V, R=price * model.R), len(ranked)
        for factor in _SHIFTS:
            K = cut_observers(problem, held, weighed, shift_of(ladder.target.region, factor))
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
    """Follow a start for a short while: the cheapest one need not become the cheapest."""
    x = settled(problem, problem.entries(K), ladder.target, ladder.effort.part(0.1), rounds=1)
    K = problem.gain(x)
    return _rank(ladder, problem, K), K


def _local_observers(
    ladder: Ladder, static: FeedbackProblem, parts: list[list[Locality]]
) -> list[Start]:
    """The optimal controllers of the agents' own parts, where they are not too large."""
    found = []
    for each in parts:
        made = local_observers(each, shift_of(ladder.target.region))
        orders = [0 if part is None else len(part[0]) for part in made]
        problem = ladder.problem((static.network, tuple(orders)))
        if not 0 < sum(orders) <= max(2 * problem.n, 8) or problem.size > _MOST_ENTRIES:
            continue
        K = with_private_parts(problem, made)
        updates = np.concatenate([agent.updates for agent in problem.agents])
        K[updates] = drawn_dynamics(problem, 0)[updates]
        found.append(Start("local observers", problem, balanced(problem, K)))
    return found


def _rank(ladder: Ladder, problem: FeedbackProblem, K: Floats) -> Rank:
    """Whether a start is outside the region; its cost, or else its largest real part or modulus.

    If agents are tied it is enough that the loop is stable: of long networks the fast starts are
    far more costly than the way of others into the region.
    """
    ladder.effort.take(len(problem.A), 2.0)
    x, edge = problem.entries(K), 1.0 if problem.discrete else 0.0
    bound = bound_of(problem, x)
    usable = ladder.target.reached(bound, SLACK) if problem.ties is None else bound < edge
    if not usable:
        return True, bound
    [(cost, _)] = quadratic_costs(problem, problem.gain(x), (edge,))
    return False, cost
