"""All steps of the ladder in their order: every start is followed, and the best to the end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from mcexact.synthesis.optimum.cost import quadratic_costs
from mcexact.synthesis.optimum.figures import figures_of
from mcexact.synthesis.optimum.ladder import Candidate, Ladder, Start, contents, ranked
from mcexact.synthesis.optimum.polish import bound_of, drafted, inside, polished, settled
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.programs import balanced
from mcexact.synthesis.optimum.steps import steps_of
from mcexact.synthesis.optimum.weights import Floats

_KEPT, _MOST_FREED = 2, 3000
_GOOD, _DEAR, _HOPELESS = 2.0, 0.05, 1000.0


def climbed(ladder: Ladder) -> list[Candidate]:
    """Return the candidates of the ladder, up to the first that is good enough.

    Notes
    -----
    In floating point; nothing is proved.  All starts of a step are followed for a while, and the
    best two of them to the end; a start that lies inside the region counts as it is, too.  For a
    large plant 1.5 times the price that is enough ends the search after a step.  Where drafts are
    dear there is only one, and if its cost is far too high it waits until all steps were tried,
    unless its agents are tied; a hopeless one waits in any case.
    """
    found: list[Candidate] = []
    later: list[tuple[float, Start]] = []
    for step in steps_of(ladder, found, later):
        drafts, dear = list[tuple[float, Start]](), False
        for start in filter(lambda each: ladder.allows(each.problem), step):
            if ladder.effort.over:
                break
            ladder.tell(start.step)
            found += _as_it_is(ladder, start)
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
            waits = dear and draft.problem.ties is None
            if value > (_GOOD if waits else _HOPELESS) * ladder.enough:
                later.append((value, draft))
            elif _finish(ladder, draft, found):
                return found
        if contents(ladder, found):
            return found
    for _, draft in sorted(later, key=lambda each: each[0])[: 2 * _KEPT]:
        if _finish(ladder, draft, found):
            break
    return found


def _as_it_is(ladder: Ladder, start: Start) -> list[Candidate]:
    """A start inside the region, which is a candidate: descent may end with a higher price."""
    if not ladder.target.reached(bound_of(start.problem, start.problem.entries(start.K))):
        return []
    made = _candidate(ladder, start.step, start.problem.untied, start.K)
    return [] if made is None else [made]


def _draft(ladder: Ladder, start: Start) -> tuple[float, Start]:
    """Follow a start into the region and for a few steps; return its cost, too.

    It is infinite where the region is not reached.  The barrier does not count: at the border of
    the region it is high, and polishing leaves it.
    """
    problem, x = start.problem, start.problem.entries(start.K)
    if problem.ties is not None:
        x = settled(problem, x, ladder.target, ladder.effort.part(0.4))
    part = ladder.effort.part(0.3 if problem.ties is None else 0.5)
    entered = inside(problem, x, ladder.target, part)
    if entered is None:
        return np.inf, start
    x, value = drafted(problem, entered, ladder.target, part)
    K = problem.gain(x)
    [(cost, _)] = quadratic_costs(problem, K, (1.0 if problem.discrete else 0.0,))
    return min(cost, value), replace(start, K=K)


def _finish(ladder: Ladder, draft: Start, found: list[Candidate]) -> bool:
    """Follow a draft to the end and append what it leads to; whether that is good enough.

    Where agents that look alike are tied and this does not content, a search without ties goes on.
    """
    before = len(found)
    if _followed(ladder, draft, found):
        return True
    problem = draft.problem.untied
    made = ranked(ladder, found[before:])
    if not made or problem.ties is draft.problem.ties or problem.size > _MOST_FREED:
        return False
    if contents(ladder, made):
        return False
    return _followed(ladder, Start(draft.step, problem, made[0].K), found)


def _followed(ladder: Ladder, draft: Start, found: list[Candidate]) -> bool:
    """Follow a draft in its problem, as `_finish` does."""
    problem = draft.problem
    if ladder.effort.over and found:
        return False
    part = ladder.effort.part(0.4 if problem.ties is None else 0.8)
    for x in polished(problem, problem.entries(draft.K), ladder.target, part):
        made = _candidate(ladder, draft.step, problem.untied, problem.gain(x))
        if made is not None:
            found.append(made)
            if ladder.fine(made.figures) and ladder.keeps(made.problem, made.K):
                return True
    return False


def _candidate(ladder: Ladder, step: str, problem: FeedbackProblem, K: Floats) -> Candidate | None:
    """Compute the figures of a gain matrix; None if its loop lies outside the region."""
    K = balanced(problem, K)
    figures = figures_of(problem, K, peak=False)
    if not ladder.target.reached(figures.bound) or not np.isfinite(figures.cost):
        return None
    return Candidate(step, problem, K, figures)
