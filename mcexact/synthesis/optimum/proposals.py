"""Proposals of the ladder to the gate, with as few digits as it certifies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.errors import Impossible, LimitReached, OutOfReach, UsageError
from mcexact.model.controller import Controller
from mcexact.synthesis.gate import Proposal, certify
from mcexact.synthesis.network.network_design import network_proposals, require_fast
from mcexact.synthesis.optimum.aims import Aims
from mcexact.synthesis.optimum.climb import climbed
from mcexact.synthesis.optimum.diagnosis import Diagnosis, diagnosed, with_diagnosis
from mcexact.synthesis.optimum.effort import PER_SECOND, Effort
from mcexact.synthesis.optimum.figures import Figures, figures_of
from mcexact.synthesis.optimum.kernel import quiet_floats
from mcexact.synthesis.optimum.ladder import MOST_STATES, Candidate, Ladder, ranked
from mcexact.synthesis.optimum.polish import Target
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.programs import controller_of, rounded
from mcexact.synthesis.optimum.structures import Family
from mcexact.synthesis.optimum.weights import Floats, Weights
from mcexact.synthesis.request import Request, Warned

_MOST_TRIED = 12
_LEAST_STORED, _MORE, _CERTIFIED = 3, 3, 20
_ENOUGH = 1.5
_GAINS = 10.0
_LEAST_GAIN = 1.0
_LARGEST_UNKNOWN = 1e3
_EFFORT, _GROWS, _MOST_TIMES, _GROWS_WITH_CUBE, _FRAGILE = 60_000.0, 40, 5.0, 130, 0.25


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
    """

    step: str
    problem: FeedbackProblem
    K: Floats
    digits: int | None
    figures: Figures
    central: Figures | None

    @property
    def relative_cost(self) -> float:
        """The cost divided by that of the central optimum; NaN if this is not known."""
        return np.nan if self.central is None else self.figures.cost / self.central.cost

    @property
    def controller(self) -> Controller:
        """The agents' programs."""
        return controller_of(self.problem, self.K)


def target_of(request: Request, central: Figures | None, aims: Aims) -> Target:
    """Return the target of a request: gains up to ten times those of the central optimum."""
    largest = _LARGEST_UNKNOWN
    if aims.largest_gain is not None:
        largest = aims.largest_gain
    elif central is not None and np.isfinite(central.cost):
        largest = _GAINS * max(central.largest_gain, _LEAST_GAIN)
    return Target(request.region, largest, aims.margin, aims.shape)


def _effort(given: float | None, states: int, central: Figures | None, target: Target) -> Effort:
    """The effort that is given in seconds; by default it grows with the states."""
    if given is not None:
        return Effort(given * PER_SECOND)
    grown = max(min((states / _GROWS) ** 2, _MOST_TIMES), (states / _GROWS_WITH_CUBE) ** 3)
    units = _EFFORT * (1 + grown)
    # What is fragile even in one hand does not become robust by a longer search.
    fragile = central is None or central.margin < target.margin
    return Effort(units * (_FRAGILE if fragile else 1.0))


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
    >>> from mcexact.synthesis.network.networks import decentralized_network
    >>> plant = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 0], [0, 1]]])
    >>> request = Request.of(plant, rate=1, arithmetic="float")
    >>> found = optimum(Family(decentralized_network(plant)), request)
    >>> found.step, found.figures.order, found.figures.bound < -1
    ('static gains', 0, True)
    """
    given, aims = family.network.given, aims or Aims()
    weights = weights or Weights.of(given, aims.weights)
    known = diagnosis or diagnosed(given, request.region, weights, family.network.system)
    central = known.central
    figures = None if central is None else central.figures
    target = target_of(request, figures, aims)
    ladder = Ladder(
        family.of_order,
        lambda: family.theorem(request),
        weights,
        target,
        np.inf if figures is None else _ENOUGH * figures.cost,
        _effort(aims.effort, given.n, figures, target),
        None if central is None else central.sizes,
        seeds=aims.seeds,
        most_digits=aims.digits,
        most_order=aims.largest_order,
        tell=request.tell,
    )
    with quiet_floats():
        found = climbed(ladder)
    if not found:
        raise LimitReached(f"no controller was found for {request.region}: {known}")
    limit = LimitReached("")
    for each in ranked(ladder, found)[:_CERTIFIED]:
        try:
            return with_few_digits(each, target, figures, aims.digits)
        except LimitReached as reached:
            limit = reached
    raise LimitReached(f"{limit}: {known}")


def with_few_digits(
    found: Candidate, target: Target, central: Figures | None, most: int | None = None
) -> Optimum:
    """Round a controller to the least number of digits that the gate certifies, and one more.

    Parameters
    ----------
    found : Candidate
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
    and up to two more where the margin needs them.
    """
    problem, K, least = found.problem, found.K, None
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
        K = _stored(found, target, least, tried)
    return Optimum(found.step, problem, K, least, figures_of(problem, K), central)


def _stored(found: Candidate, target: Target, least: int, tried: Iterable[int]) -> Floats:
    """Round to the first number of digits with which the margin is as aimed at, if it was before.

    Otherwise it is the first of them with which the region is kept, or the least of all.
    """
    problem, first = found.problem, None
    robust = found.figures.margin >= target.margin
    for digits in tried:
        stored = rounded(found.K, digits)
        if not target.keeps(problem, problem.entries(stored)):
            continue
        if not robust or figures_of(problem, stored, peak=False).margin >= target.margin:
            return stored
        first = stored if first is None else first
    return rounded(found.K, least) if first is None else first


def _certified(problem: FeedbackProblem, K: Floats, target: Target) -> bool:
    """Whether the gate certifies a controller; it is asked only where floating point sees it."""
    if not target.keeps(problem, problem.entries(K)):
        return False
    network = problem.network
    proposal = Proposal(controller_of(problem, K))
    try:
        certify(network.given, proposal, target.region, network.graph)
    except (Impossible, UsageError):
        return False
    return True


def proposal_of(found: Optimum) -> Proposal:
    """Return the proposal of a search, with its parts."""
    network = found.problem.network
    given = network.given
    parts = {
        "network": network.kind,
        "dimensions": dict(zip(given.names, network.dimensions, strict=True)),
        "observer_order": given.n * given.m + given.m - 1,
        "optimum": found,
    }
    return Proposal(found.controller, parts=parts)


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
        Those of the aims, which are read if this is left out.

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
        If no controller was found, by a search or without one.  Both tell the diagnosis.

    Notes
    -----
    What is hard for all agents together is told as soon as it is known, by a step `Warned`.
    """
    network, aims = family.network, aims or Aims()
    weights = weights or Weights.of(network.given, aims.weights)
    about = network.given, request.region, weights, network.system
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
    known = diagnosed(*about)
    if known.is_out_of_reach and aims.effort is None:
        raise OutOfReach(
            f"{request.region} is out of reach, even for all agents together: {known}; ask for "
            "less, or give an effort for which to search all the same"
        )
    if not known.is_sensible:
        request.tell(Warned(f"{request.region} is hard for all agents together: {known}"))
    more: dict[str, Any] = {"fixed_spectrum": fixed, "diagnosis": known}
    try:
        found = optimum(family, request, aims, weights=weights, diagnosis=known)
    except LimitReached as limit:
        if aims.largest_order is not None or aims.digits is not None or request.region.limits:
            raise
        yield _of_the_theorem(family, request, limit, known)
        return
    made = proposal_of(found)
    yield Proposal(made.controller, parts={**made.parts, "kept": fixed.polynomial, **more})


def _of_the_theorem(
    family: Family, request: Request, limit: LimitReached, known: Diagnosis
) -> Proposal:
    """Return the controller of the theorem; the limit of the search if there is none either."""
    if family.network.given.n > MOST_STATES:
        raise limit
    request.tell("the controller of the theorem")
    try:
        made = next(network_proposals(family.network, request))
    except LimitReached:
        raise limit from None
    return Proposal(made.controller, made.polynomials, parts={**made.parts, "diagnosis": known})
