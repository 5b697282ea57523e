"""From a controller that was found to one with another aim, by continuation.

The structure stays, and each step starts from the end of the one before it, which is far cheaper
than another search:

- `with_margins` insists on margins that a search did not reach;
- `eased` does so at a part of a rate that nobody asked for;
- `sounder` asks for a margin of all inputs and of all outputs together, and for a loop that is not
  slower than the plant alone;
- `more_damped` asks for a damping ratio, and `with_larger_box` for a box of plants around the given
  one within which every loop seems stable, by faster and faster loops, or by costs at the corners
  of the box where a loop fails first (`Corners`);
- `fastest` looks for the fastest rate at which a loop still keeps its margins: by factors of 1.5,
  then by bisection.

What these cost is compared with what was there before, and told where it is too much.  All
of this is floating point, and finding nothing proves nothing: there may be faster loops.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import isfinite, log, sqrt

from mcexact.analysis.boxes.loops import StabilitySearch
from mcexact.derived.sampling import is_sampled, resampled
from mcexact.errors import McexactError
from mcexact.exact.matrix import to_float
from mcexact.exact.rational import percent
from mcexact.exact.roots import StabilityRegion, is_discrete
from mcexact.floating.margins import spectral_bound
from mcexact.model.box import Box
from mcexact.model.loop import closed_loop
from mcexact.synthesis.optimum.corners import Corner, Corners
from mcexact.synthesis.optimum.descent import Target, hardened, inside, polished
from mcexact.synthesis.optimum.diagnosis import pace_of, region_of_pace, rounded_region
from mcexact.synthesis.optimum.figures import LEAST_DAMPING, TOGETHER, Figures, Shape
from mcexact.synthesis.optimum.problem import Effort, FeedbackProblem, controller_of
from mcexact.synthesis.optimum.search import Candidate, Ladder, candidate_of, ranked

DAMPING, BOX = 0.07, Fraction(1, 100)
"""The damping ratio and the part of all entries that designs without a rate aim at."""
AFFORDABLE = 1.15
"""They are kept where they make a loop at most this factor dearer."""
_CERTIFIED_PART = 0.9
"""Of what seems to be the largest box, the part that is likely proved."""
_FASTER, _NARROW, _WALK = 1.5, 1.05, 6
_NEARLY_WIDEST = 0.9
"""The part of the largest box that is enough, where none is as large as was asked."""
_MOST_SIGNALS = 120
_SMALL = Fraction(1, 1000)
"""A part of the entries of a plant for which the radii of its samples are about in proportion."""
_SHARE = 0.3
_INSISTING, _HEAVY = 3, 10.0
_EASED = (4, 8, 16)
"""By how much a rate is divided whose loops lack the margins."""
_NEARLY = 0.99
"""The part of the pace of the plant alone at which a loop does not count as slower."""
_FURTHER = (1.0, 1.1, 1.2, 1.35, 1.6, 2.2)
_ROUNDS, _FIRST_SHARE, _NEAR, _BEYOND, _INSIDE = 7, 0.01, 1.5, 1.2, 0.9


@dataclass(frozen=True, eq=False)
class Improved:
    """A controller, and what is to be told of the aims that it misses.

    Attributes
    ----------
    candidate : Candidate
    notes : tuple of str
    """

    candidate: Candidate
    notes: tuple[str, ...] = ()


def followed(
    ladder: Ladder, candidate: Candidate, target: Target, effort: Effort
) -> Candidate | None:
    """Go on from a controller to a local optimum for another target; None if that is not reached.

    Parameters
    ----------
    ladder : Ladder
        Whose prices rank what is found.
    candidate : Candidate
    target : Target
    effort : Effort
    """
    problem, aimed = candidate.problem, replace(ladder, target=target)
    x = inside(problem, problem.entries(candidate.K), target, effort.part(0.5))
    if x is None:
        return None
    made = [
        candidate_of(aimed, candidate.step, problem, problem.gain(each))
        for each in polished(problem, x, target, effort)
    ]
    return next(iter(ranked(aimed, [each for each in made if each is not None])), None)


def with_margins(ladder: Ladder, candidates: Sequence[Candidate]) -> list[Candidate]:
    """Insist on the margins, from some controllers without them: with heavier penalties.

    Parameters
    ----------
    ladder : Ladder
    candidates : sequence of Candidate
        The best first; some that started apart are followed until one has the margins.

    Returns
    -------
    list of Candidate
        What was found on the way, not ranked.
    """
    found: list[Candidate] = []
    apart: dict[str, Candidate] = {}
    for each in candidates:
        apart.setdefault(each.step, each)
    for start in [*apart.values()][:_INSISTING]:
        problem, part = start.problem, ladder.effort.part(1 / _INSISTING)
        x = problem.entries(start.K)
        for entries in polished(problem, x, ladder.target, part, _HEAVY):
            other = candidate_of(ladder, start.step, problem, problem.gain(entries))
            if other is not None:
                found.append(other)
        if any(each.peaks.keep(ladder.target.limits) for each in found):
            break
    return found


def eased(
    ladder: Ladder, candidates: Sequence[Candidate]
) -> tuple[StabilityRegion, list[Candidate]] | None:
    """Look for the margins at a part of the rate, from loops that lack them.

    Parameters
    ----------
    ladder : Ladder
        With a rate that nobody asked for.
    candidates : sequence of Candidate
        The best first.

    Returns
    -------
    StabilityRegion, list of Candidate, or None
        The region of the first part of the rate, and loops in it, of which the first has the
        margins.  None if no such loop was found.

    Notes
    -----
    Where inputs hardly move a mode, such as those of a light structure with few actuators, what
    damps it costs margins.
    """
    asked, found = ladder.target.region, [*candidates]
    for times in _EASED:
        if ladder.effort.over:
            break
        region = _like(asked, region_of_pace(asked.time, pace_of(asked) / times))
        target, part = replace(ladder.target, region=region), ladder.effort.part(0.5)
        slow = replace(ladder, target=target, effort=part)
        ladder.tell(f"larger margins with {region}")
        found = ranked(slow, [*with_margins(slow, found), *found])
        if found[0].peaks.keep(target.limits):
            return region, found
    return None


@dataclass(frozen=True)
class _Wish:
    """What is asked of a loop besides its target, in words."""

    told: str
    target: Target


def sounder(ladder: Ladder, best: Candidate) -> tuple[Improved, Ladder]:
    """Ask for a margin of all ports together, and for a loop that is not slower than the plant.

    Parameters
    ----------
    ladder : Ladder
    best : Candidate

    Returns
    -------
    Improved
        The cheapest loop that was found with both, or with one of them; ``best`` if it has both, or
        if none is affordable.
    Ladder
        With this as its target, for what follows.

    Notes
    -----
    The verdict on a design looks at both (`assessment`).  A plant that is not stable has no pace.
    """
    limits = replace(ladder.target.limits, together=TOGETHER)
    joint = replace(ladder, target=replace(ladder.target, limits=limits))
    seen = candidate_of(joint, best.step, best.problem, best.K)
    if seen is None:
        return Improved(best), ladder
    ladder = joint if seen.peaks.together >= TOGETHER else ladder
    wishes, notes = _wishes(ladder.target, seen), list[str]()
    for wish in wishes:
        aimed = replace(ladder, target=wish.target)
        if best.figures.damping >= DAMPING and wish.target.shape.free:
            aimed = replace(ladder, target=replace(wish.target, shape=Shape(DAMPING)))
        found = _insisted(aimed, best)
        if found is not None and found.figures.cost <= AFFORDABLE * best.figures.cost:
            return Improved(found, tuple(notes)), replace(ladder, target=wish.target)
        told = f"{wish.told} was not found (computed)"
        if found is not None:
            told = f"{wish.told} would cost {_dearer(found.figures, best.figures)} more (computed)"
        notes.append(told)
    return Improved(seen if ladder is joint else best, tuple(notes[-2:])), ladder


def _wishes(target: Target, seen: Candidate) -> list[_Wish]:
    """What a loop lacks: all of it at first, then each alone."""
    wishes, limits = list[_Wish](), replace(target.limits, together=TOGETHER)
    if seen.peaks.together < TOGETHER:
        told = f"a disk margin of {TOGETHER:g} of all inputs, and of all outputs, together"
        wishes.append(_Wish(told, replace(target, limits=limits)))
    time, own = target.region.time, _pace_alone(seen.problem)
    if _pace(seen, time) < _NEARLY * own:
        told = "a loop that is not slower than the plant without a controller"
        region = replace(target.region, bound=region_of_pace(time, own).bound)
        wishes.append(_Wish(told, replace(target, region=region)))
    if len(wishes) == 2:
        both = replace(wishes[1].target, limits=limits)
        wishes.insert(0, _Wish(" and ".join(each.told for each in wishes), both))
    return wishes


def _insisted(ladder: Ladder, start: Candidate) -> Candidate | None:
    """The cheapest loop with a target that is found from another loop; None if none is found."""
    problem, target, effort = start.problem, ladder.target, ladder.effort.part(_SHARE)
    x = inside(problem, problem.entries(start.K), target, effort.part(0.5))
    if x is None:
        return None
    made = (
        candidate_of(ladder, start.step, problem, problem.gain(each))
        for each in polished(problem, x, target, effort, 1.0)
    )
    able = [
        each
        for each in made
        if each is not None
        and each.peaks.keep(target.limits)
        and target.shape.met(each.figures.damping, each.figures.fastest)
    ]
    return min(able, key=lambda each: each.figures.cost, default=None)


def _pace_alone(problem: FeedbackProblem) -> float:
    """The rate of the plant without a controller, or −log of its radius; 0 if it is not stable."""
    n, plant = problem.n, problem.network.plant
    bound = spectral_bound(problem.A[:n, :n], plant.time)
    if not n:
        return 0.0
    return max(-log(max(bound, 1e-300)) if problem.discrete else -bound, 0.0)


def more_damped(ladder: Ladder, best: Candidate, damping: float = DAMPING) -> Improved:
    """Ask for a damping ratio, and keep it where it costs little.

    If it is not found, `LEAST_DAMPING` is enough, which the verdict on a design asks for.
    """
    shape = ladder.target.shape
    if best.figures.damping >= damping or shape.damping is not None:
        return Improved(best)
    other, tried = best, list[Candidate]()
    for factor in _FURTHER:
        # The penalty is a soft one.
        target = replace(ladder.target, shape=Shape(factor * damping, shape.largest))
        following = followed(ladder, other, target, ladder.effort.part(_SHARE))
        if following is None:
            break
        other = following
        if not _loses_margins(ladder, best, other):
            tried.append(other)
        if other.figures.damping >= damping:
            break
    aimed, notes = f"a damping ratio of at least {damping:g}", tuple[str, ...]()
    able = [each for each in tried if each.figures.damping >= damping]
    if not able:
        notes = (f"no loop with {aimed} was found (computed)",)
        able = [each for each in tried if each.figures.damping >= min(LEAST_DAMPING, damping)]
    if not able or (notes and best.figures.damping >= LEAST_DAMPING):
        return Improved(best, notes)
    cheapest = min(able, key=lambda each: each.figures.cost)
    if cheapest.figures.cost <= AFFORDABLE * best.figures.cost:
        return Improved(cheapest, notes)
    dearer = _dearer(cheapest.figures, best.figures)
    return Improved(best, notes or (f"{aimed} would cost {dearer} more (computed)",))


def with_larger_box(
    ladder: Ladder, best: Candidate, part: Fraction | None = None, most: float = AFFORDABLE
) -> Improved:
    """Ask for a box of plants within which every loop seems stable.

    Faster and faster loops are tried first, then loops that are cheap at corners of the box, too.

    Parameters
    ----------
    ladder : Ladder
    best : Candidate
    part : Fraction, optional
        The part of each entry by which plants of the box may differ; by default 1 %.  Where the
        plant has radii, these are the box.
    most : float
        The factor by which the cost may grow.

    Returns
    -------
    Improved
        The first loop that seems to have the box, or ``best`` where none has, or only dearer ones.
        Where the cost may grow without limit, and no loop seems to have the box, it is the cheapest
        of those that nearly have the largest one that was found.
    """
    own = best.problem.network.plant.plant.uncertainty is not None
    aimed, whole = (Fraction(1), "the radii") if own else (part or BOX, "each entry")
    cost = best.figures.cost
    seen = box_part(best)
    if seen is None and part is not None:
        return Improved(best, ("no box was sought: the loop is large, or its plant a derived one",))
    if seen is None or seen >= aimed:
        return Improved(best)
    cheapest: Candidate | None = None
    known = [(seen, best)]
    for loops in (_faster_loops, _loops_of_members):
        for other in loops(ladder, best, aimed):
            if _loses_margins(ladder, best, other) or other.figures.cost > 4 * most * cost:
                break
            known.append((box_part(other) or 0.0, other))
            if known[-1][0] >= aimed:
                if other.figures.cost <= most * cost:
                    return Improved(other)
                if cheapest is None or other.figures.cost < cheapest.figures.cost:
                    cheapest = other
                break
    taken = best
    if cheapest is None:
        end = f"no loop for {percent(aimed)} was found (computed)"
        if not isfinite(most):
            seen, taken = _widest(known)
    else:
        end = (
            f"{percent(aimed)} would cost {_dearer(cheapest.figures, best.figures)} more (computed)"
        )
    told = f"the loop stays stable for plants within about {percent(_short(seen))} of {whole}"
    return Improved(taken, (f"{told}: {end}",))


def _widest(known: Sequence[tuple[float, Candidate]]) -> tuple[float, Candidate]:
    """The cheapest of the loops with nearly the largest box."""
    enough = _NEARLY_WIDEST * max(part for part, _ in known)
    return min((each for each in known if each[0] >= enough), key=lambda each: each[1].figures.cost)


def _faster_loops(ladder: Ladder, best: Candidate, aimed: Fraction) -> Iterator[Candidate]:
    """Faster and faster loops, each from the one before, whatever is aimed at."""
    pace, found = _pace(best, ladder.target.region.time), best
    for _ in range(_WALK):
        pace *= _FASTER
        target = replace(ladder.target, region=region_of_pace(ladder.target.region.time, pace))
        other = followed(ladder, found, target, ladder.effort.part(_SHARE))
        if other is None:
            return
        found = other
        yield other


def _loops_of_members(ladder: Ladder, best: Candidate, aimed: Fraction) -> Iterator[Candidate]:
    """Loops that are cheap for plants at corners of the box, too, where loops fail first.

    A round adds corners at which the loop of the round before fails, and the costs at all corners,
    at nine tenths of the nearest failure, count more and more.
    """
    problem, box = best.problem, Corners.of(best.problem)
    x, share, corners = problem.entries(best.K), _FIRST_SHARE, list[Corner]()
    for _ in range(_ROUNDS):
        K, part = problem.gain(x), ladder.effort.part(_SHARE)
        for distance, corner in box.failing(K, part):
            if distance < _NEAR * aimed and not any(map(corner.same, corners)):
                corners.append(corner)
        if not corners or part.over:
            return
        size = min(_BEYOND * float(aimed), *(_INSIDE * box.distance(K, each) for each in corners))
        members = [box.member(each, size) for each in corners]
        x, share = hardened(problem, x, ladder.target, part, members, share), 3 * share
        other = candidate_of(ladder, best.step, problem, problem.gain(x))
        if other is None:
            return
        yield other


def box_part(candidate: Candidate) -> float | None:
    """The part of each entry by which a plant may differ while a proof of its loop is likely.

    Where the plant has radii it is a part of these.  None where it is not searched: for derived
    plants, and for loops of many signals.
    """
    problem = candidate.problem
    plant, graph = problem.network.plant, problem.network.graph
    rows, columns = problem.mask.shape
    sampled = is_sampled(plant)
    if (plant.subject and not sampled) or (graph is not None and graph.delays):
        return None
    if len(problem.A) + rows + columns > _MOST_SIGNALS:
        return None
    loop = closed_loop(plant, controller_of(problem, candidate.K), graph)
    size = Fraction(1) if plant.plant.uncertainty is not None or not sampled else _SMALL
    try:
        if plant.plant.uncertainty is None:
            near = Box.relative(plant.plant, size).system
            loop = replace(loop, plant=resampled(plant, near) if sampled else near)
        margins = StabilitySearch(loop, StabilityRegion(plant.time)).margins()
        least = min((each for each, _ in margins), default=0.0)
    except McexactError:
        return None
    return _CERTIFIED_PART * to_float(size) * float(least)


def fastest(
    ladder: Ladder, start: Candidate, asked: StabilityRegion
) -> tuple[Candidate, StabilityRegion] | None:
    """Search the fastest rate at which a loop keeps its margins, from a slow loop that does.

    Parameters
    ----------
    ladder : Ladder
    start : Candidate
    asked : StabilityRegion
        The region that was asked for, beyond which nothing is tried.

    Returns
    -------
    Candidate, StabilityRegion, or None
        The controller, and its region: the one that was asked for, or a slower one of two digits.
        None if the slow loop lacks the margins, too.

    Notes
    -----
    By factors of 1.5 from the rate of the slow loop, then by bisection in the logarithm until the
    bracket is narrower than 5 %, each time from the fastest loop so far.  A search, not a proof.
    """
    time, limits = asked.time, ladder.target.limits
    if not start.peaks.keep(limits):
        return None
    most, holds, fails, best = pace_of(asked), 0.98 * _pace(start, time), float("inf"), start
    if not 0 < holds < float("inf"):
        return None
    while holds < most and fails / holds > _NARROW and not ladder.effort.over:
        trial = min(_FASTER * holds, most) if not isfinite(fails) else sqrt(holds * fails)
        region = asked if trial == most else _like(asked, region_of_pace(time, trial))
        target = replace(ladder.target, region=region)
        other = followed(ladder, best, target, ladder.effort.part(_SHARE))
        gains = 1.01 * ladder.target.largest_gain
        if other is None or not other.peaks.keep(limits) or other.figures.largest_gain > gains:
            fails = trial
        else:
            best, holds = other, trial
            ladder.tell(f"the fastest rate with these margins: {region}")
    return best, asked if holds >= most else _like(asked, rounded_region(time, holds))


def _like(region: StabilityRegion, other: StabilityRegion) -> StabilityRegion:
    """A region with the bound of another one."""
    return replace(region, bound=other.bound)


def _pace(candidate: Candidate, time: str) -> float:
    """The rate of a loop, or −log of its radius."""
    bound = candidate.figures.bound
    return -log(max(bound, 1e-300)) if is_discrete(time) else -bound


def _loses_margins(ladder: Ladder, before: Candidate, after: Candidate) -> bool:
    """Whether a controller lacks the margins that another one has."""
    limits = ladder.target.limits
    return before.peaks.keep(limits) and not after.peaks.keep(limits)


def _dearer(after: Figures, before: Figures) -> str:
    """By how much a cost is larger, in percent."""
    return f"{100 * (after.cost / before.cost - 1):.0f} %"


def _short(part: float) -> Fraction:
    """A part with two digits."""
    return Fraction(f"{part:.1e}")
