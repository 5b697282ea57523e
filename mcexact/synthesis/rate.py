"""Requests without a rate: the sensible one, and slower designs.

A request without a rate gets half the sensible one as a rule; this is the fastest that one
controller for all agents can afford (`optimum.diagnosis`).  `request_for` chooses it.  Agents that
know less can be too slow for it, so `at_a_robust_rate` designs for smaller and smaller parts of a
chosen rate until the loop has a margin of 0.3, and otherwise keeps the loop with the largest
margin.  A prescribed rate is never changed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.modes import FixedSpectrum
from mcexact.errors import InputError, LimitReached, UsageError, telling
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.design import Design
from mcexact.synthesis.gate import Arithmetic, Progress, Request, Warned
from mcexact.synthesis.optimum.diagnosis import chosen_region
from mcexact.synthesis.optimum.figures import MARGIN, Aims
from mcexact.synthesis.optimum.problem import Weights

_NO_OPTIMUM = "a small one, since all agents together have no optimal controller"
_SMALL = (
    (StabilityRegion("continuous", Fraction(1, 1000)), _NO_OPTIMUM),
    (StabilityRegion("discrete", Fraction(999, 1000)), _NO_OPTIMUM.replace("small", "large")),
)


def request_for(
    system: MultiChannelSystem,
    agent: str | None = None,
    spectrum: Any = None,
    rate: Any = None,
    radius: Any = None,
    arithmetic: Arithmetic = "exact",
    progress: Progress | None = None,
    *,
    aims: Aims | None = None,
    controlled: MultiChannelSystem | None = None,
    avoids_fixed_modes: bool = False,
) -> Request:
    """Check the arguments of a ``design_…`` function, and choose a rate if none is given.

    Parameters
    ----------
    system, agent, spectrum, rate, radius, arithmetic, progress
        As in `Request.of`.
    aims : Aims, optional
    controlled : MultiChannelSystem, optional
        The plant with integrators, if its sensible rate counts and not that of the system.
    avoids_fixed_modes : bool
        Whether a chosen rate is slow enough for the stable fixed modes of the system.

    Raises
    ------
    UsageError
        As in `Request.of`, or if the largest modulus of the aims leaves no number of this rate.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> request_for(plant, spectrum=[-1]).notes
    ()
    >>> print(*request_for(plant).notes)
    no rate was given: 21/5 is half the sensible rate
    >>> print(*request_for(MultiChannelSystem([[1]], [[[0]]], [[[1]]])).notes)
    no rate was given: 1/1000 is a small one, since all agents together have no optimal controller
    """
    aims = Aims() if aims is None else aims
    InputError.require(aims, Aims, "aims")
    if spectrum is not None or rate is not None or radius is not None:
        request = Request.of(system, agent, spectrum, rate, radius, arithmetic, progress)
        return _limited(request, aims)
    telling(progress)("the sensible rate")
    about = controlled or system
    weights = Weights.of(system, aims.weights)
    if controlled is not None:
        weights = weights.with_integrators(system)
    sensible = chosen_region(about, weights)
    region, reason = sensible or _SMALL[StabilityRegion(system.time).discrete]
    if controlled is None and avoids_fixed_modes:
        region, reason = _beyond(fixed_spectrum(system), region, reason)
    note = f"no {region.word} was given: {region.edge} is {reason}"
    asked: dict[str, Any] = {region.word: region.edge}
    chosen = Request.of(system, agent, arithmetic=arithmetic, progress=progress, **asked)
    return _limited(replace(chosen, notes=(note,)), aims)


def _limited(request: Request, aims: Aims | None) -> Request:
    """Add the damping ratio and the largest modulus of the aims, which continuous time proves."""
    if aims is None or request.region.discrete:
        return request
    region = request.region.limited(aims.damping, aims.largest_modulus)
    if region.largest_modulus is not None and region.largest_modulus <= region.edge:
        raise UsageError(f"no eigenvalue satisfies {region}: allow a larger modulus")
    return replace(request, region=region)


def slower(region: StabilityRegion) -> StabilityRegion:
    """Halve a rate, or the distance of a radius to 1."""
    edge = (region.edge + 1) / 2 if region.discrete else region.edge / 2
    return replace(region, bound=edge)


def _beyond(
    fixed: FixedSpectrum, region: StabilityRegion, reason: str
) -> tuple[StabilityRegion, str]:
    """Halve a rate (or the distance of a radius to 1) until the stable fixed modes are faster."""
    if not fixed.stabilizable:
        return region, reason
    while fixed.outside(region):
        region = slower(region)
        reason = "slow enough for the fixed modes"
    return region, reason


_HALVINGS, _MORE_HALVINGS = 2, 4


def at_a_robust_rate(request: Request, design: Callable[[Request], Design]) -> Design:
    """Design for a request; if its rate was chosen, also for half of it, a quarter and so on.

    Parameters
    ----------
    request : Request
    design : callable
        The design for a request.

    Returns
    -------
    Design
        The first with a margin of 0.3, or else the one with the largest margin.  A design without a
        search is not repeated, and a prescribed rate stays.

    Raises
    ------
    LimitReached
        That of the first rate, if no controller was found for any.

    Notes
    -----
    The sensible rate is that of one controller for all agents; agents that know less than it can be
    too slow for half of it.  Where already this controller is fragile, a search that aims at a
    margin can find a robust one for a slower rate all the same.  If it is robust but no loop of the
    search is, an eighth and a sixteenth of the rate are tried, too.
    """
    best, failed = None, None
    for trial in range(_MORE_HALVINGS + 1):
        if trial > _HALVINGS and (best is None or not _is_robust_for_all(best)):
            break
        asked = request
        if trial:
            request.tell("a slower rate")
            asked = _halved(request, trial)
        try:
            result = design(asked)
        except LimitReached as limit:
            failed = failed or limit
        else:
            best = result if best is None or _margin(result) > _margin(best) else best
        if not request.notes or (best is not None and _is_final(best)):
            break
    if best is None:
        raise failed or LimitReached("no controller was found")
    return best


def _halved(request: Request, times: int) -> Request:
    region = request.region
    for _ in range(times):
        region = slower(region)
    remark = f", and {region.edge} was taken, since no faster loop that was found is robust"
    notes = (*request.notes[:-1], request.notes[-1] + remark)
    return replace(request, region=region, notes=notes, tell=partial(_once_warned, request.tell))


def _once_warned(tell: Progress, step: str) -> None:
    """Report a step, but no warning that was already reported for the first rate."""
    if not isinstance(step, Warned):
        tell(step)


def _margin(design: Design) -> float:
    """The margin of a controller that was searched, 0 for others."""
    optimum = design.parts.get("optimum")
    return 0.0 if optimum is None else float(optimum.figures.margin)


def _is_robust_for_all(design: Design) -> bool:
    """Whether one controller for all agents has the margin that designs aim at."""
    optimum = design.parts.get("optimum")
    central = None if optimum is None else optimum.central
    return central is not None and bool(central.margin >= MARGIN)


def _is_final(design: Design) -> bool:
    """Whether a slower rate is not tried: the loop is robust, or it was not searched."""
    return _margin(design) >= MARGIN or "diagnosis" not in design.parts
