"""Designs for which no rate was given become slower where the loop would be fragile."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from mcexact.errors import LimitReached
from mcexact.synthesis.asking import slower
from mcexact.synthesis.design import Design
from mcexact.synthesis.optimum.aims import MARGIN
from mcexact.synthesis.request import Progress, Request, Warned

_HALVINGS, _MORE_HALVINGS = 2, 4


def at_a_robust_rate(request: Request, design: Callable[[Request], Design]) -> Design:
    """Design for a request, and for half and a quarter of its rate and so on if this was chosen.

    Parameters
    ----------
    request : Request
    design : callable
        The design for a request.

    Returns
    -------
    Design
        The first with a margin of 0.3, or the one with the largest margin; a controller that was
        not searched is not made again.  A rate that was given stays.

    Raises
    ------
    LimitReached
        That of the first rate, if no controller was found for any.

    Notes
    -----
    The sensible rate is that of one controller for all agents; agents that know less than it can be
    too slow for half of it.  Where already this controller is fragile, a search that aims at a
    margin can find a robust one for a slower rate all the same.  Where it is robust, and no loop
    that was found is, an eighth and a sixteenth of the rate are tried, too.
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
            made = design(asked)
        except LimitReached as limit:
            failed = failed or limit
        else:
            best = made if best is None or _margin(made) > _margin(best) else best
        if not request.notes or (best is not None and _is_final(best)):
            break
    if best is None:
        raise failed or LimitReached("no controller was found")
    return best


def _halved(request: Request, times: int) -> Request:
    region = request.region
    for _ in range(times):
        region = slower(region)
    told = f", and {region.edge} was taken, since no faster loop that was found is robust"
    notes = (*request.notes[:-1], request.notes[-1] + told)
    return replace(request, region=region, notes=notes, tell=partial(_once_warned, request.tell))


def _once_warned(tell: Progress, step: str) -> None:
    """Tell a step, without the warnings that the first rate led to."""
    if not isinstance(step, Warned):
        tell(step)


def _margin(made: Design) -> float:
    """The margin of a controller that was searched, 0 for others."""
    found = made.parts.get("optimum")
    return 0.0 if found is None else float(found.figures.margin)


def _is_robust_for_all(made: Design) -> bool:
    """Whether one controller for all agents has the margin that designs aim at."""
    found = made.parts.get("optimum")
    central = None if found is None else found.central
    return central is not None and bool(central.margin >= MARGIN)


def _is_final(made: Design) -> bool:
    """Whether a slower rate is not tried: the loop is robust, or it was not searched."""
    return _margin(made) >= MARGIN or "diagnosis" not in made.parts
