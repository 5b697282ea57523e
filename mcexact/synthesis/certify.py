"""`certify_controller` decides whether a given controller makes a loop stable or fast enough."""

from __future__ import annotations

from fractions import Fraction
from typing import get_args

from mcexact.analysis.boxes.failing_plants import FAILING, FailingPlant
from mcexact.analysis.stability.closed_loop_spectrum import eigenvalue_outside
from mcexact.analysis.stability.stability import (
    POLYNOMIAL_LIMIT,
    Method,
    Separation,
    certify_stability,
    fastest_region,
)
from mcexact.answer.account import Account
from mcexact.answer.box_stable import BoxStability
from mcexact.answer.evidence import RootDisc
from mcexact.answer.protocol import Answer
from mcexact.answer.rules import VERDICT
from mcexact.answer.sentence import Given
from mcexact.answer.stability import StabilityVerdict
from mcexact.arguments import one_of, telling
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.floats import matrix_to_float, to_float
from mcexact.exact.location import StabilityRegion
from mcexact.exact.rational import Entry
from mcexact.floating.margins import spectral_bound
from mcexact.model.box import Box
from mcexact.model.controller import Controller
from mcexact.model.loop import closed_loop
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.observer.coordinates import observer_coordinates
from mcexact.synthesis.optimum.loop_figures import rounded_controller
from mcexact.synthesis.request import Progress

_PARTS_TRIED = 32
_MOST_ROUNDED = 1000
_POLYNOMIAL_UNASKED = 90


def certify_controller(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Entry | None = None,
    radius: Entry | None = None,
    damping: Entry | None = None,
    largest_modulus: Entry | None = None,
    method: Method | None = None,
    largest: bool = False,
    round_gains: int | None = None,
    progress: Progress | None = None,
) -> StabilityVerdict:
    """Decide whether every eigenvalue of a closed loop lies in a region.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant.
    controller : Controller
        A controller for the plant, designed by any method.
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    rate, radius : rational, optional
        A rate in continuous time, a radius in discrete time; by default only stability is decided.
    damping, largest_modulus : rational, optional
        In continuous time: whether also −Re λ > damping·|λ|, and |λ| < largest_modulus.
    method : {"polynomial", "lyapunov"}, optional
        See `certify_stability`.
    largest : bool
        Whether to search for the largest rate (least radius) and certify it.
    round_gains : int, optional
        Certify the controller whose entries are rounded to this many significant decimal digits,
        as `rounded_controller` does.
    progress : callable, optional
        A function that is called with a short description of each step.

    Returns
    -------
    StabilityVerdict
        The verdict on the closed loop; with ``largest``, for the region that was found, or for
        stability if none was.

    Raises
    ------
    InputError
        If the system or the controller is something else.
    UsageError
        If the rate or radius is out of range or for the other time domain, or the method is
        inconclusive.
    LimitReached
        If the loop is too large for its characteristic polynomial, and the Lyapunov method is
        inconclusive.

    Notes
    -----
    Both answers are exact.  The loop of a distributed observer is recognized and decided block by
    block (`observer_coordinates`).

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> certify_controller(plant, local_controllers(plant, [[[-3]]]), rate=1).stable
    True
    >>> certify_controller(plant, local_controllers(plant, [[[-3]]]), rate=2).stable
    False
    >>> stuck = local_controllers(plant, [[["-1.04"]]])
    >>> certify_controller(plant, stuck).stable, certify_controller(
    ...     plant, stuck, round_gains=1).stable
    (True, False)
    """
    InputError.require(system, MultiChannelSystem, "system")
    InputError.require(controller, Controller, "controller")
    one_of(method, (None, *get_args(Method)), "method")
    tell = telling(progress)
    region = StabilityRegion.of(system.time, rate, radius).limited(damping, largest_modulus)
    if largest and region.bound is not None:
        raise UsageError("give either a rate (radius) or `largest`, not both")
    if round_gains is not None:
        if type(round_gains) is not int or not 1 <= round_gains <= _MOST_ROUNDED:
            raise UsageError(
                f"expected a number of digits from 1 to {_MOST_ROUNDED}, found {round_gains!r}",
                where="round_gains",
            )
        controller = rounded_controller(controller, round_gains)
    tell("the closed loop")
    loop = closed_loop(system, controller, graph).system
    separation = None
    if method != "polynomial" and (method is not None or loop.n > POLYNOMIAL_LIMIT):
        coordinates = observer_coordinates(system.n, controller)
        separation = next(filter(None, (each.separation(loop.A) for each in coordinates)), None)
    if largest:
        tell("the largest rate")
        region = (_largest(loop, separation) or region).limited(**region.limits)
    tell("the decision")
    return _decided(loop, region, method, separation)


def _decided(
    loop: MultiChannelSystem,
    region: StabilityRegion,
    method: Method | None,
    separation: Separation | None,
) -> StabilityVerdict:
    """Decide by Lyapunov matrices if the loop is large, else by its characteristic polynomial."""
    if method is not None or loop.n <= POLYNOMIAL_LIMIT:
        return certify_stability(loop, region, method=method, separation=separation)
    try:
        return certify_stability(loop, region, method="lyapunov", separation=separation)
    except UsageError:
        if loop.n > _POLYNOMIAL_UNASKED:
            raise LimitReached(
                f"the Lyapunov method was inconclusive for this loop of {loop.n} states, and its "
                "characteristic polynomial takes long: choose the method polynomial, or "
                "another rate or radius"
            ) from None
    return certify_stability(loop, region, method="polynomial")


def _largest(loop: MultiChannelSystem, separation: Separation | None) -> StabilityRegion | None:
    """Search by bisection with the polynomial, or for large loops with parts of the margin."""
    import numpy as np

    floats, whole = matrix_to_float(loop.A), StabilityRegion(loop.time)
    if loop.n <= POLYNOMIAL_LIMIT or not np.all(np.isfinite(floats)):
        return fastest_region(loop)
    spare = Fraction(to_float(whole.limit) - spectral_bound(floats, loop.time))
    spare = spare.limit_denominator(10**6)
    if spare <= 0:
        return None
    best, holds, fails = None, 0, _PARTS_TRIED
    while fails - holds > 1:
        middle = (holds + fails) // 2
        # The region that uses some of the `_PARTS_TRIED` parts of the margin of the eigenvalues.
        region = whole.tightened(spare * middle / _PARTS_TRIED, offset=1)
        try:
            found = certify_stability(loop, region, method="lyapunov", separation=separation)
            proved = found.stable
        except UsageError:
            proved = False
        if proved:
            best, holds = region, middle
        else:
            fails = middle
    return best


def enclosed_outside(found: StabilityVerdict) -> RootDisc | None:
    """Enclose an eigenvalue of a loop that is certified not to lie in its region.

    Parameters
    ----------
    found : StabilityVerdict

    Returns
    -------
    RootDisc or None
        None if all lie in the region, or the loop has more than 40 states.

    Examples
    --------
    >>> from mcexact.model.local_controllers import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> found = certify_controller(plant, local_controllers(plant, [[[-3]]]), largest_modulus=1)
    >>> enclosed_outside(found)
    RootDisc(re='-2', im='0', radius='0')
    """
    if found.stable or found.about.n > POLYNOMIAL_LIMIT:
        return None
    return eigenvalue_outside(found.about.A, found.region)


def account_of_verdict(
    found: StabilityVerdict,
    *,
    largest: bool = False,
    every_loop: BoxStability | None = None,
    gains: Fraction | None = None,
    failing: FailingPlant | None = None,
) -> Account:
    """Make the account of a verdict on a closed loop.

    Parameters
    ----------
    found : StabilityVerdict
    largest : bool
        Whether its rate (radius) is the largest (least) that was found.
    every_loop : BoxStability, optional
        About all loops of a box around the plant.
    gains : Fraction, optional
        The part of their moduli that the radii of the gains are there.
    failing : FailingPlant, optional
        A plant nearby whose loop is not stable.
    """
    asked = {"region": found.region, "states": found.about.n, "largest": largest}
    answers: dict[str, Answer] = {found.kind: found}
    if every_loop is not None:
        answers["box_stability"] = every_loop
        asked |= {"part_of_plant": Box(every_loop.about.plant).part, "part_of_gains": gains}
    if failing is not None and failing.refutation is not None:
        answers[FAILING] = failing.refutation
        asked |= failing.facts(found.about.plant)
    given = Given(found.about.plant, asked)
    sentences = VERDICT.sentences(answers, given)
    return Account(answers, given, sentences, found.about.subject[:-1], nearby=(FAILING,))
