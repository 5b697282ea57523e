"""Requests without a rate: the least cost under margins, with a slow rate that is kept.

A request without a rate asks for the least cost, and its loop has to be hardly faster than the
plant needs: `request_for` chooses the smaller of half the rate of the optimal state feedback and a
tenth of the sensible rate, which is the fastest that one controller for all agents can afford
(`optimum.diagnosis`).  Agents that know less can be too slow even for this, so
`at_a_reachable_rate` designs for smaller and smaller parts of a chosen rate until a controller is
found.  A prescribed rate is never changed here.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import Any

from mcexact.answer.modes import FixedSpectrum
from mcexact.errors import InputError, LimitReached, UsageError, telling
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.model.units import Units, in_own_units
from mcexact.synthesis.design import Design
from mcexact.synthesis.gate import Arithmetic, Progress, Request, Warned
from mcexact.synthesis.optimum.diagnosis import chosen_regions
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.optimum.problem import Weights, integrated_problem

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
    selection: Sequence[Matrix] | None = None,
    signals: Polynomial | None = None,
    stays: Callable[[], FixedSpectrum | None] | None = None,
    least_cost: bool = True,
) -> Request:
    """Check the arguments of a ``design_…`` function, and choose a rate if none is given.

    Parameters
    ----------
    system, agent, spectrum, rate, radius, arithmetic, progress
        As in `Request.of`.
    aims : Aims, optional
    selection : sequence of m Matrix, optional
        S_i, for a controller with integrators of S_i y_i: the sensible rate is that of the plant
        with these integrators.
    signals : Polynomial, optional
        Of models that stand in place of the integrators.
    stays : callable, optional
        It returns a fixed spectrum, or None: a chosen rate is slow enough for its stable modes.
    least_cost : bool
        Whether a search follows that looks for the least cost; otherwise, and without effort or for
        a named agent, half the sensible rate is chosen.

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
    no rate was given: a search minimized the cost, at a rate of at least 7/10, half that of the \
optimal state feedback
    >>> print(*request_for(MultiChannelSystem([[1]], [[[0]]], [[[1]]])).notes)
    no rate was given: a search minimized the cost, at a rate of at least 1/1000, a small one, \
since all agents together have no optimal controller
    """
    aims = Aims() if aims is None else aims
    InputError.require(aims, Aims, "aims")
    # The choice of a rate counts, too.
    deadline = None if aims.seconds is None else time.monotonic() + aims.seconds
    if spectrum is not None or rate is not None or radius is not None:
        request = Request.of(system, agent, spectrum, rate, radius, arithmetic, progress)
        return _limited(replace(request, deadline=deadline), aims)
    telling(progress)("the sensible rate")
    about, weights = in_own_units(system), Weights.of(system, aims.weights, Units.of(system))
    if selection is not None:
        about, weights, _ = integrated_problem(system, selection, aims.weights, signals)
    chosen = chosen_regions(about, weights)
    searches = least_cost and agent is None and aims.effort != 0
    brisk = None
    if chosen is None:
        region, reason = _SMALL[StabilityRegion(system.time).discrete]
        brisk = region if searches else None
    elif searches:
        region, reason, brisk = chosen.slowest, chosen.reason, chosen.brisk
    else:
        region, reason = chosen.brisk, chosen.brisk_reason
    if stays is not None and (fixed := stays()) is not None:
        region, reason = _beyond(fixed, region, reason)
    note = f"no {region.word} was given: {region.edge} is {reason}"
    if searches:
        limit = "a radius of at most" if region.discrete else "a rate of at least"
        sought = f"a search minimized the cost, at {limit} {region.edge}"
        note = f"no {region.word} was given: {sought}, {reason}"
    asked: dict[str, Any] = {region.word: region.edge}
    request = Request.of(system, agent, arithmetic=arithmetic, progress=progress, **asked)
    request = replace(request, notes=(note,), brisk=brisk, deadline=deadline, chosen=chosen)
    return _limited(request, aims)


def _limited(request: Request, aims: Aims) -> Request:
    """Add the limits of the aims that are proved in continuous time."""
    if request.region.discrete:
        return request
    region = request.region.limited(damping=aims.damping, largest_modulus=aims.largest_modulus)
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


_HALVINGS = 2


def at_a_reachable_rate(request: Request, design: Callable[[Request], Design]) -> Design:
    """Design for a request; if its rate was chosen, and not reached, for a half or a quarter of it.

    Parameters
    ----------
    request : Request
    design : callable
        The design for a request.

    Returns
    -------
    Design
        The first that is found.

    Raises
    ------
    LimitReached
        That of the first rate, if no controller was found for any.
    """
    failed = None
    for trial in range(_HALVINGS + 1 if request.notes else 1):
        asked = request
        if trial:
            request.tell("a slower rate")
            asked = _halved(request, trial)
        try:
            return design(asked)
        except LimitReached as limit:
            failed = failed or limit
    raise failed or LimitReached("no controller was found")


def _halved(request: Request, times: int) -> Request:
    region = request.region
    for _ in range(times):
        region = slower(region)
    remark = f"; {region.edge} was taken, since no faster loop was found"
    notes = (*request.notes[:-1], request.notes[-1] + remark)
    return replace(request, region=region, notes=notes, tell=partial(_once_warned, request.tell))


def _once_warned(tell: Progress, step: str) -> None:
    """Report a step, but no warning that was already reported for the first rate."""
    if not isinstance(step, Warned):
        tell(step)
