"""Requests without a rate, which take half the sensible one."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.answer.fixed_spectrum import FixedSpectrum
from mcexact.arguments import telling
from mcexact.errors import InputError, UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.aims import Aims
from mcexact.synthesis.optimum.diagnosis import chosen_region
from mcexact.synthesis.optimum.weights import Weights
from mcexact.synthesis.request import Arithmetic, Progress, Request

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
        The system with integrators whose sensible rate counts, if it is not the given one.
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
        given = Request.of(system, agent, spectrum, rate, radius, arithmetic, progress)
        return _limited(given, aims)
    telling(progress)("the sensible rate")
    about = controlled or system
    weights = Weights.of(system, aims.weights)
    if controlled is not None:
        weights = weights.with_integrators(system)
    found = chosen_region(about, weights)
    region, told = found or _SMALL[StabilityRegion(system.time).discrete]
    if controlled is None and avoids_fixed_modes:
        region, told = _beyond(fixed_spectrum(system), region, told)
    note = f"no {region.word} was given: {region.edge} is {told}"
    asked: dict[str, Any] = {region.word: region.edge}
    made = Request.of(system, agent, arithmetic=arithmetic, progress=progress, **asked)
    return _limited(replace(made, notes=(note,)), aims)


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
    fixed: FixedSpectrum, region: StabilityRegion, told: str
) -> tuple[StabilityRegion, str]:
    """Halve a rate (or the distance of a radius to 1) until the stable fixed modes are faster."""
    if not fixed.stabilizable:
        return region, told
    while fixed.outside(region):
        region = slower(region)
        told = "slow enough for the fixed modes"
    return region, told
