"""What a search proposes to the gate: the best controller, rounded to few digits.

`optimum` runs the search of `search` for the structures of a `Family`.  Without a rate it then asks
for damping and for a box of plants, where these cost little; for a rate at which no loop keeps the
margins it looks for the fastest one that does (`continuation`).  It finds the least number of
digits with which the gate certifies the best controller, and keeps at least one digit more where
more digits are allowed.

`searched_proposals` is the entry: it decides first whether a fixed mode forbids the region and
whether the region is out of reach for all agents together, and it falls back to the controller of
the theorem if the search finds none.  The search is floating point and deterministic; only what the
gate certifies is proved, and finding no controller proves nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.derived.constructions import Share
from mcexact.errors import Impossible, LimitReached, OutOfReach, UsageError
from mcexact.exact.matrix import to_float
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import Controller
from mcexact.model.units import Units, controller_in, system_in
from mcexact.synthesis.gate import Proposal, Request, Warned, certify
from mcexact.synthesis.network_design import network_proposals, require_fast
from mcexact.synthesis.networks import DerivedNetwork, decentralized_network, shared_network
from mcexact.synthesis.optimum.continuation import (
    DAMPING,
    eased,
    fastest,
    more_damped,
    sounder,
    with_larger_box,
    with_margins,
)
from mcexact.synthesis.optimum.descent import Target
from mcexact.synthesis.optimum.diagnosis import (
    Diagnosis,
    chosen_regions,
    diagnosed,
    pace_of,
    with_diagnosis,
)
from mcexact.synthesis.optimum.figures import (
    FEW_DIGITS,
    LEAST_DAMPING,
    Aims,
    CentralOptimum,
    Figures,
    Limits,
    Margins,
    Peaks,
    central_optimum,
    figures_of,
    least_cost,
    least_damping,
)
from mcexact.synthesis.optimum.problem import (
    PER_SECOND,
    Effort,
    FeedbackProblem,
    Floats,
    NetworkController,
    Structure,
    Weights,
    controller_of,
    quiet_floats,
    rounded,
)
from mcexact.synthesis.optimum.search import (
    MOST_STATES,
    Candidate,
    Ladder,
    climbed,
    drawn_further,
    ranked,
)

# The structures of decentralized and of extended control, by the order of the agents' states.


@dataclass(frozen=True)
class Family:
    """The structures that a search tries, by the order of the agents' states.

    Attributes
    ----------
    network : DerivedNetwork
        That of least dimensions.
    share : {"outputs+states", "states"} or None
        What agents send, if they have a sub-state to share; else their states are private.
    """

    network: DerivedNetwork
    share: Share | None = None

    def of_order(self, order: int | Sequence[int]) -> Structure:
        """Return the structure in which every agent has a state of at least some order."""
        network, none = self.network, (0,) * self.network.plant.m
        orders = (order,) * network.plant.m if isinstance(order, int) else tuple(order)
        if network.graph is None or self.share is None:
            return network, orders
        if not any(orders):
            return network, none
        sizes = [max(pair) for pair in zip(orders, network.dimensions, strict=True)]
        wider = shared_network(network.plant, network.graph, sizes, self.share, network.kind)
        return wider, none

    @property
    def units(self) -> Units | None:
        """Units near the sizes of the plant, if they are not those of the file."""
        return Units.of(self.network.plant)

    def measured(self) -> Family:
        """The same structures for the plant in units near its sizes."""
        network, units = self.network, self.units
        if units is None:
            return self
        plant = system_in(units, network.plant)
        if network.graph is None or self.share is None:
            return replace(self, network=decentralized_network(plant))
        shared = network.graph, network.dimensions, self.share, network.kind
        return replace(self, network=shared_network(plant, *shared))

    def theorem(self, request: Request) -> NetworkController | None:
        """Return the controller of the theorem, in floating point; None if there is none."""
        try:
            inexact = replace(request, arithmetic="float")
            proposal = next(network_proposals(self.network, inexact), None)
        except (Impossible, LimitReached):
            return None
        return None if proposal is None else (self.network, proposal.controller)


# The result of a search, rounded to few digits, as a proposal to the gate.

_MOST_TRIED, _STARTS_OF_FASTEST = 12, 2
_LEAST_STORED, _MORE, _CERTIFIED = 3, 3, 20
_HARDLY_DEARER = 1.1
_ENOUGH = 1.5
_GAINS = 10.0
_LATE = (
    "the time for the search was over: this is the best controller so far, for which no larger "
    "margins, damping or box were sought"
)
_LEAST_GAIN = 1.0
_LARGEST_UNKNOWN = 1e3
_LEAST_EFFORT, _LEAST_ENOUGH = 40_000.0, 1.05
_FOR_MARGINS, _FURTHER, _AFTERWARDS = 1.5, 1.0, 0.5
"""How much more effort there is for margins that were missed, for more starts where the cost stays
high, and for what else is asked then, unless a user gave the whole of it."""
_LADDER = 0.5
"""The part of an effort that a user gave that the ladder may use, and the part of the rest for
larger margins and for more starts; what is left at last is for a damping ratio and a box."""
_EFFORT, _GROWS, _MOST_TIMES, _GROWS_WITH_CUBE, _FRAGILE_SHARE = 60_000.0, 40, 5.0, 130, 0.25


@dataclass(frozen=True, eq=False)
class Optimum:
    """The controller that a search found, with what is known of it and of the central one.

    Attributes
    ----------
    step : str
        The step of the ladder that found it.
    problem : FeedbackProblem
    K : ndarray
        Its rounded gain matrix.
    digits : int or None
        The least number of significant decimal digits with which the gate certified it; None if it
        was none of those tried.
    figures : Figures
        Of the rounded controller.
    central : Figures or None
        Of the optimal controller of all agents together, for the same region.
    peaks : Peaks
        The margins of the rounded controller.
    region : StabilityRegion or None
        Where its eigenvalues are, if it is not the region that was asked for.
    asked : StabilityRegion or None
        The region that was asked for, if the search took a slower one for the margins.
    notes : tuple of str
        What is to be told of aims that were missed.
    """

    step: str
    problem: FeedbackProblem
    K: Floats
    digits: int | None
    figures: Figures
    central: Figures | None
    peaks: Peaks
    region: StabilityRegion | None = None
    asked: StabilityRegion | None = None
    notes: tuple[str, ...] = ()

    @property
    def relative_cost(self) -> float:
        """The cost divided by that of the central optimum; NaN if this is not known."""
        return np.nan if self.central is None else self.figures.cost / self.central.cost

    @property
    def controller(self) -> Controller:
        """The agents' programs."""
        return controller_of(self.problem, self.K)


def target_of(
    request: Request, central: Figures | None, aims: Aims, least: float | None = None
) -> Target:
    """Return the target of a request: gains up to ten times those of the central optimum.

    Costs are divided by the least one for every controller, where it is known and no rate was asked
    for, or else by that of the central optimum.
    """
    largest = _LARGEST_UNKNOWN
    if aims.largest_gain is not None:
        largest = aims.largest_gain
    elif central is not None and np.isfinite(central.cost):
        largest = _GAINS * max(central.largest_gain, _LEAST_GAIN)
    unit = 1.0
    if request.brisk is not None and least is not None:
        unit = least
    elif central is not None and np.isfinite(central.cost):
        unit = central.cost
    limits = Limits(aims.disk, aims.margin)
    return Target(request.region, largest, limits, unit, aims.shape)


def _effort(
    seconds: float | None, states: int, central: Figures | None, target: Target, *, least: bool
) -> Effort:
    """The effort of a ladder: a part of some seconds; by default it grows with the states."""
    if seconds is not None:
        return Effort(seconds * PER_SECOND).part(_LADDER)
    grown = max(min((states / _GROWS) ** 2, _MOST_TIMES), (states / _GROWS_WITH_CUBE) ** 3)
    units = (_LEAST_EFFORT if least else _EFFORT) * (1 + grown)
    if least:
        return Effort(units)
    # What is fragile even in one hand does not become robust by a longer search.
    fragile = central is None or central.margin < target.limits.margin
    return Effort(units * (_FRAGILE_SHARE if fragile else 1.0))


def optimum(
    family: Family,
    request: Request,
    aims: Aims | None = None,
    *,
    weights: Weights | None = None,
    diagnosis: Diagnosis | None = None,
) -> Optimum:
    """Search the ladder for a controller, and round it to few digits.

    Parameters
    ----------
    family : Family
    request : Request
        With a bound.
    aims : Aims, optional
    weights : Weights, optional
        Those of the aims, which are read if this is left out.
    diagnosis : Diagnosis, optional
        Of the plant, for the region and the weights.

    Raises
    ------
    LimitReached
        If no controller was found; it names the mode that is nearest to being fixed, and the
        sensible rate.

    Notes
    -----
    In floating point, and deterministic.  Only `Optimum.digits` is proved, by the gate.

    Examples
    --------
    >>> from mcexact.model.system import MultiChannelSystem
    >>> from mcexact.synthesis.networks import decentralized_network
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 0], [0, 1]]])
    >>> request = Request.of(plant, rate=1, arithmetic="float")
    >>> result = optimum(Family(decentralized_network(plant)), request, Aims(effort=1))
    >>> result.peaks.margin > 0.3, result.figures.bound < -1
    (True, True)
    """
    plant, aims = family.network.plant, aims or Aims()
    weights = weights or Weights.of(plant, aims.weights)
    known = diagnosis or diagnosed(plant, request.region, weights, family.network.system)
    figures = None if known.central is None else known.central.figures
    with quiet_floats():
        ladder = _ladder(family, request, aims, weights, known.central)
        candidates = ranked(ladder, climbed(ladder))
        result = _Result(tuple(candidates), ladder.target)
        if ladder.effort.late:
            result = replace(result, notes=(_LATE,))
        else:
            result = _completed(family, request, aims, weights, ladder, result)
    if not result.candidates:
        raise LimitReached(f"no controller was found for {request.region}: {known}")
    found = _rounded(result, figures, aims.digits, f": {known}")
    slower = request.brisk is None and result.target.region != request.region
    asked = request.region if slower else None
    return replace(found, region=result.target.region, notes=result.notes, asked=asked)


def _rounded(result: _Result, central: Figures | None, most: int | None, known: str) -> Optimum:
    """The best candidate that the gate certifies, with few digits.

    A controller that needs many digits is replaced by one that needs few, has the margins and the
    damping of the best one, and costs hardly more.

    Raises
    ------
    LimitReached
        If none is certified; the message ends with what is known of the plant.
    """
    limit, first = LimitReached("no controller was found"), None
    best = result.candidates[0]
    for each in result.candidates[:_CERTIFIED]:
        if first is not None and not _is_as_good(result.target, best, each):
            continue
        try:
            found = with_few_digits(each, result.target, central, most)
        except LimitReached as reached:
            limit = reached
            continue
        if _suffices(found, result.target, FEW_DIGITS):
            return found
        first = found if first is None else first
    if first is None:
        raise LimitReached(f"{limit}{known}")
    return first


def _suffices(found: Optimum, target: Target, digits: int) -> bool:
    """Whether a controller stays in the region with its margins when it is rounded to digits."""
    problem, K = found.problem, rounded(found.K, digits)
    if not target.keeps(problem, problem.entries(K)):
        return False
    limits = target.limits
    return not found.peaks.keep(limits) or Margins(problem, K).peaks(limits).keep(limits)


def _is_as_good(target: Target, best: Candidate, other: Candidate) -> bool:
    """Whether a controller is hardly dearer than the best one, with its margins and damping."""
    cheap = other.figures.cost <= _HARDLY_DEARER * best.figures.cost
    keeps = other.peaks.keep(target.limits) or not best.peaks.keep(target.limits)
    damped = min(best.figures.damping, DAMPING)
    return cheap and keeps and other.figures.damping >= damped


@dataclass(frozen=True, eq=False)
class _Result:
    """Candidates, the best first, with the target that they have, and what is to be told."""

    candidates: tuple[Candidate, ...]
    target: Target
    notes: tuple[str, ...] = ()

    @property
    def keeps_margins(self) -> bool:
        """Whether the best one has the margins."""
        return bool(self.candidates) and self.candidates[0].peaks.keep(self.target.limits)


def _ladder(
    family: Family,
    request: Request,
    aims: Aims,
    weights: Weights,
    central: CentralOptimum | None,
) -> Ladder:
    """What a search for a request tries."""
    plant, asked = family.network.plant, request.brisk is None
    figures = None if central is None else central.figures
    target = target_of(request, figures, aims, None if asked else least_cost(plant, weights))
    enough = _LEAST_ENOUGH * target.least
    if asked:
        enough = np.inf if figures is None else _ENOUGH * figures.cost
    effort = _effort(aims.effort, plant.n, figures, target, least=not asked)
    effort.deadline = request.deadline
    if effort.whole is not None:
        effort.whole.deadline = request.deadline
    return Ladder(
        family.of_order,
        lambda: family.theorem(request),
        weights,
        target,
        enough,
        effort,
        None if central is None else central.sizes,
        seeds=aims.seeds,
        most_digits=aims.digits,
        most_order=aims.largest_order,
        tell=request.tell,
        brisk=request.brisk,
    )


def _completed(
    family: Family,
    request: Request,
    aims: Aims,
    weights: Weights,
    ladder: Ladder,
    result: _Result,
) -> _Result:
    """Look for the margins where they are missed, and for damping and a box."""
    if result.candidates and not result.keeps_margins:
        ladder.tell("larger margins")
        found = with_margins(_more(ladder, _FOR_MARGINS, _LADDER), result.candidates)
        candidates = tuple(ranked(ladder, [*found, *result.candidates]))
        result = replace(result, candidates=candidates)
    if request.brisk is not None and result.candidates:
        more = drawn_further(_more(ladder, _FURTHER, _LADDER), result.candidates)
        result = replace(result, candidates=tuple(ranked(ladder, [*more, *result.candidates])))
        if not result.keeps_margins:
            ladder, result = _eased(ladder, result)
    if request.brisk is None and not result.keeps_margins:
        return _slower(family, request, aims, weights, result) or result
    if result.candidates and (request.brisk is not None or aims.box is not None):
        return _improved(ladder, request, aims, result)
    return result


def _eased(ladder: Ladder, result: _Result) -> tuple[Ladder, _Result]:
    """Take a part of a rate that nobody asked for, where this gives the margins."""
    ladder = _more(ladder, _FURTHER, _LADDER)
    found = eased(ladder, result.candidates)
    if found is None:
        return ladder, result
    region, candidates = found
    target = replace(ladder.target, region=region)
    notes = (*result.notes, _too_slow(ladder.target.region, region, target.limits))
    slow = replace(ladder, target=target)
    return slow, replace(result, candidates=tuple(candidates), target=target, notes=notes)


def _too_slow(chosen: StabilityRegion, region: StabilityRegion, limits: Limits) -> str:
    """What is told where margins are kept in place of a rate that nobody asked for."""
    return (
        f"no loop with {chosen} was found that has a disk margin of {limits.disk:g} in every "
        f"single loop and a margin of {limits.margin:g} at all inputs together: {region} was taken "
        "(a search, not a proof)"
    )


def _more(ladder: Ladder, times: float = _AFTERWARDS, part: float = 1.0) -> Ladder:
    """The ladder with effort for what follows a search.

    Of an effort that a user gave it is a part of what is left; by default ``times`` the ladder's.
    """
    before = ladder.effort
    if before.whole is not None:
        return replace(ladder, effort=before.whole.part(part))
    return replace(ladder, effort=Effort(times * before.limit, deadline=before.deadline))


def _improved(ladder: Ladder, request: Request, aims: Aims, result: _Result) -> _Result:
    """Ask for damping and for a box, which are kept where they cost little.

    What a user asked for is kept whatever it costs.
    """
    best, notes = result.candidates[0], result.notes
    ladder.tell("margins together")
    step, further = sounder(_more(ladder), best)
    best, notes = step.candidate, (*notes, *step.notes)
    if request.brisk is not None:
        ladder.tell("damping")
        step = more_damped(further, best)
        best, notes = step.candidate, (*notes, *step.notes)
    ladder.tell("a box of plants")
    if aims.box is None and best.problem.network.plant.plant.uncertainty is None:
        step = with_larger_box(further, best)
    else:
        part = None if aims.box is None else Fraction(aims.box)
        step = with_larger_box(further, best, part, np.inf)
    best, notes = step.candidate, (*notes, *step.notes)
    target = replace(result.target, limits=further.target.limits)
    return _Result((best, *result.candidates), target, notes)


def _slower(
    family: Family, request: Request, aims: Aims, weights: Weights, result: _Result
) -> _Result | None:
    """Search the fastest rate with the margins, from loops of least cost; None if none has them.

    The cheapest loop is followed, and the cheapest of another order.
    """
    plant, asked = family.network.plant, request.region
    chosen = chosen_regions(plant, weights)
    if chosen is None or not pace_of(chosen.slowest) < pace_of(asked):
        return None
    request.tell("a slower rate, for the margins")
    slow = replace(asked, bound=chosen.slowest.bound)
    central = central_optimum(plant, weights, slow)
    ladder = _ladder(family, replace(request, region=slow, brisk=asked), aims, weights, central)
    target = replace(
        ladder.target, largest_gain=max(ladder.target.largest_gain, result.target.largest_gain)
    )
    ladder = replace(ladder, target=target)
    starts: dict[int, Candidate] = {}
    for each in ranked(ladder, climbed(ladder)):
        if each.peaks.keep(target.limits):
            starts.setdefault(each.figures.order, each)
    further = _more(ladder)
    tried = (fastest(further, each, asked) for each in [*starts.values()][:_STARTS_OF_FASTEST])
    found = [each for each in tried if each is not None]
    if not found:
        return None
    candidate, region = max(found, key=lambda each: pace_of(each[1]))
    notes = () if region == asked else (_too_fast(asked, region, target.limits),)
    return _Result((candidate,), replace(target, region=region), notes)


def _too_fast(asked: StabilityRegion, region: StabilityRegion, limits: Limits) -> str:
    """What is told where no loop of the asked rate has the margins."""
    return (
        f"no loop with {asked} was found that has a disk margin of {limits.disk:g} in every single "
        f"loop and a margin of {limits.margin:g} at all inputs together: the {region.word} with "
        f"these margins is about {to_float(region.edge):.3g} (a search, not a proof)"
    )


def with_few_digits(
    candidate: Candidate, target: Target, central: Figures | None, most: int | None = None
) -> Optimum:
    """Round a controller to the least number of digits that the gate certifies, and one more.

    Parameters
    ----------
    candidate : Candidate
    target : Target
    central : Figures or None
        Of the central optimum.
    most : int, optional
        The largest number of digits.

    Raises
    ------
    LimitReached
        If the gate does not certify the controller, however many digits it keeps.

    Notes
    -----
    At least three digits are kept, unless these are too many or are not certified and fewer are,
    and up to two more where the margin or the damping needs them.
    """
    problem, K, least = candidate.problem, candidate.K, None
    for digits in range(1, min(_MOST_TRIED, most or _MOST_TRIED) + 1):
        if _certified(problem, rounded(K, digits), target):
            least = digits
            break
    if least is None and (most is not None or not _certified(problem, K, target)):
        digits_told = "" if most is None else f" with {most} digits"
        raise LimitReached(
            f"no controller that was found could be certified{digits_told} for {target.region}"
        )
    if least is not None:
        kept = max(least + 1, _LEAST_STORED)
        tried = [min(kept + k, most or _MOST_TRIED) for k in range(_MORE)]
        K = _stored(candidate, target, least, tried)
    peaks = Margins(problem, K).peaks(target.limits)
    return Optimum(candidate.step, problem, K, least, figures_of(problem, K), central, peaks)


def _stored(candidate: Candidate, target: Target, least: int, tried: Iterable[int]) -> Floats:
    """Round to the first number of digits with the margin and damping aimed at, if it had them.

    Otherwise to the first number with which the loop stays in the region, or else to the least.
    """
    problem, first = candidate.problem, None
    kept = candidate.peaks.keep(target.limits)
    damping = next((d for d in (DAMPING, LEAST_DAMPING) if d <= candidate.figures.damping), 0.0)
    for digits in tried:
        stored = rounded(candidate.K, digits)
        if not target.keeps(problem, problem.entries(stored)):
            continue
        robust = not kept or Margins(problem, stored).peaks(target.limits).keep(target.limits)
        if robust and _damping(problem, stored) >= damping:
            return stored
        first = stored if first is None else first
    return rounded(candidate.K, least) if first is None else first


def _damping(problem: FeedbackProblem, K: Floats) -> float:
    values = np.linalg.eigvals(problem.closed(K)).astype(np.complex128)
    return least_damping(values, discrete=problem.discrete)


def _certified(problem: FeedbackProblem, K: Floats, target: Target) -> bool:
    """Whether the gate certifies a controller; not tried if floating point already refutes it."""
    if not target.keeps(problem, problem.entries(K)):
        return False
    network = problem.network
    proposal = Proposal(controller_of(problem, K))
    try:
        certify(network.plant, proposal, target.region, network.graph)
    except (Impossible, UsageError):
        return False
    return True


def proposal_of(result: Optimum) -> Proposal:
    """Return the proposal of a search, with its parts."""
    network = result.problem.network
    plant = network.plant
    parts = {
        "network": network.kind,
        "dimensions": dict(zip(plant.names, network.dimensions, strict=True)),
        "observer_order": plant.n * plant.m + plant.m - 1,
        "optimum": result,
    }
    return Proposal(result.controller, parts=parts, region=result.region, notes=result.notes)


def searched_proposals(
    family: Family, request: Request, aims: Aims | None = None, weights: Weights | None = None
) -> Iterator[Proposal]:
    """Propose the controller of a search, or that of the theorem where the search finds none.

    Parameters
    ----------
    family : Family
    request : Request
        With a prescribed spectrum, or an agent for the channel controller, there is no search.
    aims : Aims, optional
        Without effort there is no search.
    weights : Weights, optional
        Those of the aims, for the plant in units near its sizes; they are read if this is left out.

    Yields
    ------
    Proposal
        One.  After a search its parts include the `Optimum` as ``optimum`` and the `Diagnosis` as
        ``diagnosis``; else they are those of `network_proposals`.

    Raises
    ------
    Impossible
        If a fixed mode is not fast enough, which is decided before any search.
    OutOfReach
        If even the optimal controller of all agents together is one that nobody would install, and
        the aims name no effort.
    LimitReached
        If no controller was found, by a search or without one.  This message and that of
        `OutOfReach` contain the diagnosis.

    Notes
    -----
    A region that is hard even for all agents together is reported before the search, by a step
    `Warned`.  The search calculates in units near the sizes of the plant.
    """
    network, aims, units, searched = family.network, aims or Aims(), family.units, family.measured()
    weights = weights or Weights.of(network.plant, aims.weights, units)
    measured = searched.network
    about = measured.plant, request.region, weights, measured.system
    if not aims.searched_for(request):
        try:
            yield from network_proposals(network, request)
        except LimitReached as limit:
            raise with_diagnosis(limit, *about) from None
        return
    request.tell("fixed modes")
    fixed = fixed_spectrum(network.system)
    require_fast(network, fixed, request.region)
    request.tell("diagnosis")
    known = diagnosed(*about, request.chosen)
    if known.is_out_of_reach and aims.effort is None:
        raise OutOfReach(
            f"{request.region} is out of reach, even for all agents together: {known}; ask for "
            "less, or give an effort for which to search all the same"
        )
    if not known.is_sensible:
        request.tell(Warned(f"{request.region} is hard for all agents together: {known}"))
    more: dict[str, Any] = {"fixed_spectrum": fixed, "diagnosis": known}
    try:
        result = optimum(searched, request, aims, weights=weights, diagnosis=known)
    except LimitReached as limit:
        if aims.largest_order is not None or aims.digits is not None or request.region.limits:
            raise
        yield _of_the_theorem(family, request, limit, known)
        return
    if result.region is not None and result.region != request.region:
        about = measured.plant, result.region, weights, measured.system
        more["diagnosis"] = diagnosed(*about)
    proposal = proposal_of(result)
    if units is not None:
        digest = network.plant.digest_of_values()
        own = controller_in(units.inverse(), proposal.controller, digest)
        proposal = replace(proposal, controller=own)
    yield replace(proposal, parts={**proposal.parts, "kept": fixed.polynomial, **more})


def _of_the_theorem(
    family: Family, request: Request, limit: LimitReached, known: Diagnosis
) -> Proposal:
    """Return the controller of the theorem; the limit of the search if there is none either."""
    if family.network.plant.n > MOST_STATES:
        raise limit
    request.tell("the controller of the theorem")
    try:
        proposal = next(network_proposals(family.network, request))
    except LimitReached:
        raise limit from None
    return Proposal(
        proposal.controller, proposal.polynomials, parts={**proposal.parts, "diagnosis": known}
    )
