"""Requests without a rate, which take half the sensible one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from mcexact.errors import UsageError
from mcexact.exact.location import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.aims import Aims
from mcexact.synthesis.optimum.diagnosis import chosen_region
from mcexact.synthesis.optimum.weights import Weights
from mcexact.synthesis.request import Arithmetic, Progress, Request


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
) -> Request:
    """Check the arguments of a ``design_…`` function, and choose a rate if none is given.

    Parameters
    ----------
    system, agent, spectrum, rate, radius, arithmetic, progress
        As in `Request.of`.
    aims : Aims, optional
    controlled : MultiChannelSystem, optional
        The system whose sensible rate counts, if it is not the given one.

    Raises
    ------
    UsageError
        As in `Request.of`; or if no rate is given, and none can be chosen.

    Examples
    --------
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> request_for(plant, spectrum=[-1]).notes
    ()
    >>> print(*request_for(plant).notes)
    no rate was given: 21/5 is half the sensible rate
    >>> request_for(MultiChannelSystem([[1]], [[[0]]], [[[1]]]))
    Traceback (most recent call last):
        ...
    mcexact.errors.UsageError: give a rate or a spectrum: no optimal controller of all agents \
together was found, from which to choose a rate
    """
    if spectrum is not None or rate is not None or radius is not None:
        return Request.of(system, agent, spectrum, rate, radius, arithmetic, progress)
    (progress or (lambda _: None))("the sensible rate")
    about = controlled or system
    weights = Weights.of(system, (aims or Aims()).weights)
    found = chosen_region(about, weights.with_integrators(about.n - system.n))
    if found is None:
        word = StabilityRegion(system.time).word
        raise UsageError(
            f"give a {word} or a spectrum: no optimal controller of all agents together was found, "
            f"from which to choose a {word}"
        )
    region, told = found
    note = f"no {region.word} was given: {region.edge} is {told}"
    given: dict[str, Any] = {region.word: region.edge}
    made = Request.of(system, agent, arithmetic=arithmetic, progress=progress, **given)
    return replace(made, notes=(note,))
