"""Proposals of the ladder to the gate, with as few digits as it certifies."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
from threadpoolctl import threadpool_limits

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.errors import Impossible, LimitReached, UsageError
from mcexact.model.controller import Controller
from mcexact.synthesis.design import Design, Method, designed
from mcexact.synthesis.gate import Proposal, certify
from mcexact.synthesis.network.network_design import require_fast
from mcexact.synthesis.optimum.diagnosis import diagnosed
from mcexact.synthesis.optimum.effort import Effort
from mcexact.synthesis.optimum.figures import Figures, central_optimum, figures_of
from mcexact.synthesis.optimum.ladder import Candidate, Ladder, best_of, climbed
from mcexact.synthesis.optimum.polish import Target, bound_of
from mcexact.synthesis.optimum.problem import FeedbackProblem
from mcexact.synthesis.optimum.programs import controller_of, rounded
from mcexact.synthesis.optimum.structures import Family
from mcexact.synthesis.optimum.weights import Floats, Weights
from mcexact.synthesis.request import Request

MOST_DIGITS = 12
_LEAST_STORED = 3
_ENOUGH = 1.5
_GAINS = 10.0
_LEAST_GAIN = 1.0
_LARGEST_UNKNOWN = 1e3
_EFFORT, _EFFORT_GROWS, _FRAGILE = 60_000.0, 130, 0.25


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


def target_of(request: Request, central: Figures | None, margin: float = 0.3) -> Target:
    """Return the target of a request: gains up to ten times those of the central optimum."""
    largest = _LARGEST_UNKNOWN
    if central is not None and np.isfinite(central.cost):
        largest = _GAINS * max(central.largest_gain, _LEAST_GAIN)
    return Target(request.region, largest, margin)


def optimum(
    family: Family,
    request: Request,
    *,
    weights: Weights | None = None,
    effort: float | None = None,
) -> Optimum:
    """Search the ladder for a controller, and round it to few digits.

    Parameters
    ----------
    family : Family
    request : Request
        With a bound.
    weights : Weights, optional
        By default `Weights.unit`.
    effort : float, optional
        See `Effort`; by default it grows with the cube of the number of states.

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
    given = family.network.given
    weights = weights or Weights.unit(given)
    request.tell("the central optimum")
    central = central_optimum(given, weights, request.region)
    figures = None if central is None else central.figures
    target = target_of(request, figures)
    if effort is None:
        effort = _EFFORT * (1 + (given.n / _EFFORT_GROWS) ** 3)
        # What is fragile even in one hand does not become robust by a longer search.
        effort *= 1.0 if figures is not None and figures.margin >= target.margin else _FRAGILE
    ladder = Ladder(
        family.of_order,
        lambda: family.theorem(request),
        weights,
        target,
        np.inf if figures is None else _ENOUGH * figures.cost,
        Effort(effort),
        None if central is None else central.sizes,
        tell=request.tell,
    )
    with threadpool_limits(1, "blas"), np.errstate(all="ignore"), warnings.catch_warnings():
        # For matrices of this size threads cost more than they bring.  What overflows or is nearly
        # singular belongs to controllers that are dropped.
        warnings.simplefilter("ignore")
        found = climbed(ladder)
    if not found:
        told = diagnosed(given, request.region, weights, family.network.system)
        raise LimitReached(f"no controller was found for {request.region}: {told}")
    return with_few_digits(best_of(ladder, found), target, figures)


def with_few_digits(found: Candidate, target: Target, central: Figures | None) -> Optimum:
    """Round a controller to the least number of digits that the gate certifies, and one more.

    Parameters
    ----------
    found : Candidate
    target : Target
    central : Figures or None
        Of the central optimum.

    Raises
    ------
    LimitReached
        If the gate does not certify the controller, however many digits it keeps.

    Notes
    -----
    At least three digits are kept, unless these are not certified and fewer are.
    """
    problem, K, least = found.problem, found.K, None
    for digits in range(1, MOST_DIGITS + 1):
        if _certified(problem, rounded(K, digits), target):
            least = digits
            break
    if least is None and not _certified(problem, K, target):
        raise LimitReached(f"no controller that was found could be certified for {target.region}")
    if least is not None:
        stored = rounded(K, max(least + 1, _LEAST_STORED))
        holds = target.reached(bound_of(problem, problem.entries(stored)))
        K = stored if holds else rounded(K, least)
    return Optimum(found.step, problem, K, least, figures_of(problem, K), central)


def _certified(problem: FeedbackProblem, K: Floats, target: Target) -> bool:
    """Whether the gate certifies a controller; it is asked only where floating point sees it."""
    if not target.reached(bound_of(problem, problem.entries(K))):
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
    parts = {
        "network": network.kind,
        "dimensions": dict(zip(network.given.names, network.dimensions, strict=True)),
        "optimum": found,
    }
    return Proposal(found.controller, parts=parts)


def optimized_design(
    method: Method,
    family: Family,
    request: Request,
    *,
    weights: Weights | None = None,
    effort: float | None = None,
) -> Design:
    """Design a controller of a family by the ladder, and certify it.

    Parameters
    ----------
    method : {"decentralized", "extended"}
    family, request, weights, effort
        As in `optimum`.

    Returns
    -------
    Design
        Its parts are ``network``, ``dimensions``, and the `Optimum` as ``optimum``.

    Raises
    ------
    Impossible
        If a fixed mode is not fast enough, which is decided before any search.
    LimitReached
        If no controller was found, or none that is certified.
    """
    network = family.network
    request.tell("fixed modes")
    fixed = fixed_spectrum(network.system)
    require_fast(network, fixed, request.region)
    found = optimum(family, request, weights=weights, effort=effort)
    made = designed(method, request, network.given, network.graph, [proposal_of(found)])
    return replace(made, certificates={**made.certificates, "fixed_spectrum": fixed})
