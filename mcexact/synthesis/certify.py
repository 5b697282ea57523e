"""Certification of any controller, and how its entries may be rounded.

`certify_controller` decides whether the loop of a controller, designed by any method, has all its
eigenvalues in a region.  Small loops are decided by their characteristic polynomial, which always
answers.  Large loops are decided by Lyapunov matrices, which take less time but can be
inconclusive; then the polynomial is tried up to a limit, beyond which the work ends with
`LimitReached`.  The large loop of a distributed observer is decided block by block.

A controller that is stored with few digits is another controller.  `unsafe_rounding` searches a
rounding with which the loop fails, along the slopes of the slowest eigenvalues; what it returns is
decided exactly, and finding none proves nothing.  `safe_digits` looks for the fewest digits with
which every rounding keeps the loop in the region, proved for the box of all roundings.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, get_args

import numpy as np
from scipy.linalg import eig

from mcexact.analysis.boxes.failure import FAILING, FailingPlant
from mcexact.analysis.boxes.loops import box_stability, digit_radii, rounded_ends, with_gains
from mcexact.analysis.boxes.pencils import Floats, one_thread
from mcexact.analysis.stability import (
    POLYNOMIAL_LIMIT,
    Method,
    Separation,
    certify_stability,
    eigenvalue_outside,
    fastest_region,
)
from mcexact.answer.account import Account
from mcexact.answer.boxes import BoxStability
from mcexact.answer.check import followed_in
from mcexact.answer.evidence import RootDisc
from mcexact.answer.listing import VERDICT
from mcexact.answer.loops import StabilityVerdict
from mcexact.answer.protocol import Answer
from mcexact.answer.sentence import Context
from mcexact.errors import InputError, LimitReached, UsageError, one_of, telling
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float
from mcexact.exact.rational import Entry
from mcexact.exact.roots import StabilityRegion
from mcexact.floating.margins import is_within, spectral_bound
from mcexact.model.box import Box
from mcexact.model.controller import Controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import ClosedLoop, LoopPencil, closed_loop
from mcexact.model.system import MultiChannelSystem, any_system
from mcexact.synthesis.gate import Progress
from mcexact.synthesis.observer import observer_coordinates
from mcexact.synthesis.optimum.diagnosis import rounded_controller
from mcexact.synthesis.performance import Performance
from mcexact.synthesis.robustness import margin_answers, margins_part

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
        If the system is no `MultiChannelSystem` or the controller no `Controller`.
    UsageError
        If the rate or radius is out of range or for the other time domain, the method is
        inconclusive, or the loop of a plant with feedthrough is not well posed.
    LimitReached
        If the loop is too large for its characteristic polynomial, and the Lyapunov method is
        inconclusive.

    Notes
    -----
    Both answers are exact.  The loop of a distributed observer is recognized and decided block by
    block (`observer_coordinates`).

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> certify_controller(plant, local_controllers(plant, [[[-3]]]), rate=1).stable
    True
    >>> certify_controller(plant, local_controllers(plant, [[[-3]]]), rate=2).stable
    False
    >>> controller = local_controllers(plant, [[["-1.04"]]])
    >>> certify_controller(plant, controller).stable, certify_controller(
    ...     plant, controller, round_gains=1).stable
    (True, False)
    """
    any_system(system)
    InputError.require(controller, Controller, "controller")
    one_of(method, (None, *get_args(Method)), "method")
    tell = telling(progress)
    region = StabilityRegion.of(system.time, rate, radius).limited(
        damping=damping, largest_modulus=largest_modulus
    )
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
            verdict = certify_stability(loop, region, method="lyapunov", separation=separation)
            proved = verdict.stable
        except UsageError:
            proved = False
        if proved:
            best, holds = region, middle
        else:
            fails = middle
    return best


def enclosed_outside(verdict: StabilityVerdict) -> RootDisc | None:
    """Enclose an eigenvalue of a loop that is certified not to lie in its region.

    Parameters
    ----------
    verdict : StabilityVerdict

    Returns
    -------
    RootDisc or None
        None if all lie in the region, or the loop has more than 40 states.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> verdict = certify_controller(plant, local_controllers(plant, [[[-3]]]), largest_modulus=1)
    >>> enclosed_outside(verdict)
    RootDisc(re='-2', im='0', radius='0')
    """
    if verdict.stable or verdict.about.n > POLYNOMIAL_LIMIT:
        return None
    return eigenvalue_outside(verdict.about.A, verdict.region)


def account_of_verdict(
    verdict: StabilityVerdict,
    *,
    largest: bool = False,
    every_loop: BoxStability | None = None,
    gains: Fraction | None = None,
    failing: FailingPlant | None = None,
    performance: Performance | None = None,
    margins: Mapping[str, BoxStability] | None = None,
) -> Account:
    """Make the account of a verdict on a closed loop.

    Parameters
    ----------
    verdict : StabilityVerdict
    largest : bool
        Whether its rate (radius) is the largest (least) that was found.
    every_loop : BoxStability, optional
        About all loops of a box around the plant.
    gains : Fraction, optional
        The radii of the gains in this box, as a part of their moduli.
    failing : FailingPlant, optional
        A plant nearby whose loop is not stable.
    performance : Performance, optional
        The cost and the margins of the loop.
    margins : mapping, optional
        Proofs of disk margins in a box of plants (`EveryLoop.margins`).
    """
    asked = {"region": verdict.region, "states": verdict.about.n, "largest": largest}
    answers: dict[str, Answer] = {verdict.kind: verdict}
    if verdict.stable:
        asked |= followed_in(verdict)
    if every_loop is not None:
        answers["box_stability"] = every_loop
        asked |= {"part_of_plant": Box(every_loop.about.plant).part, "part_of_gains": gains}
    if margins:
        answers |= margin_answers(margins)
        asked["part_of_margins"] = margins_part(margins)
    if failing is not None and failing.refutation is not None:
        answers[FAILING] = failing.refutation
        asked |= failing.facts(verdict.about.plant)
    if performance is not None:
        answers |= performance.answers
    context = Context(verdict.about.at_samples, asked)
    sentences = VERDICT.sentences(answers, context)
    return Account(answers, context, sentences, verdict.about.subject[:-1], nearby=(FAILING,))


# Roundings of a controller's entries with which the loop fails, decided exactly.

_MODES, _ROUNDS = 8, 4


def unsafe_rounding(
    loop: ClosedLoop, digits: int, region: StabilityRegion
) -> tuple[Controller, StabilityVerdict] | None:
    """Search a rounding of all entries to significant digits that leaves the region.

    Each entry is rounded up or down to the next number with so many digits.

    Parameters
    ----------
    loop : ClosedLoop
    digits : int
    region : StabilityRegion

    Returns
    -------
    tuple of Controller and StabilityVerdict, or None
        The rounded controller and the exact verdict on its loop; None if none was found, which
        proves nothing.

    Notes
    -----
    For each of the eigenvalues nearest to the border, every entry is moved to the side on which
    this eigenvalue comes nearer, to first order; and again from there.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.loop import closed_loop
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[["-1.06"]]]))
    >>> rounded, verdict = unsafe_rounding(loop, 2, StabilityRegion("continuous", "1/20"))
    >>> rounded.agents[0].input.outputs[0][0, 0], verdict.stable
    (Fraction(-1, 1), False)
    """
    ends = _ends(loop.controller, digits)
    with one_thread():
        for rounded in _roundings(loop, ends, region.discrete):
            if is_within(matrix_to_float(replace(loop, controller=rounded).matrix), region):
                continue
            bound: dict[str, Any] = {region.word: region.bound}
            verdict = certify_controller(loop.plant, rounded, loop.graph, **bound)
            if not verdict.stable:
                return rounded, verdict
    return None


def _ends(controller: Controller, digits: int) -> list[tuple[Fraction, Fraction]]:
    """The numbers with so many digits next to each entry, in the order of the entries."""
    ends: list[tuple[Fraction, Fraction]] = []

    def kept(M: Matrix) -> Matrix:
        for _, _, x in M.nonzero():
            ends.append(rounded_ends(Fraction(x, M.denominator), digits))
        return M

    with_gains(controller, kept)
    return ends


def _with_entries(controller: Controller, entries: Iterable[int | Fraction]) -> Controller:
    """Replace the nonzero entries of the controller, in their order."""
    values = iter(entries)

    def of(M: Matrix) -> Matrix:
        return Matrix.from_entries(M.shape, [(i, j, next(values)) for i, j, _ in M.nonzero()])

    return with_gains(controller, of)


def _roundings(
    loop: ClosedLoop, ends: list[tuple[Fraction, Fraction]], discrete: bool
) -> Iterator[Controller]:
    """Controllers whose entries are rounded to the side on which an eigenvalue gets slower."""
    seen = set[bytes]()
    for k in range(_MODES):
        controller = loop.controller
        for _ in range(_ROUNDS):
            slopes = _slopes(replace(loop, controller=controller), len(ends), k, discrete)
            if slopes is None:
                break
            up = slopes > 0
            pairs = zip(ends, up, strict=True)
            controller = _with_entries(loop.controller, (pair[int(side)] for pair, side in pairs))
            if up.tobytes() in seen:
                break
            seen.add(up.tobytes())
            yield controller


def _slopes(loop: ClosedLoop, count: int, k: int, discrete: bool) -> Floats | None:
    """How fast the k-th slowest eigenvalue gets slower where each entry grows."""
    signals = LoopPencil(loop.plant, loop.controller, loop.graph)
    Z, N = matrix_to_float(signals.matrix), signals.states
    static = np.linalg.solve(Z[N:, N:], np.hstack([Z[N:, :N], np.eye(len(Z) - N)]))
    M = Z[:N, :N] - Z[:N, N:] @ static[:, :N]
    if not np.all(np.isfinite(M)):
        return None
    solved: Any = eig(M, left=True)
    values, left, right = solved
    slow = np.abs(values) if discrete else values.real
    order = [i for i in np.argsort(-slow) if values[i].imag >= 0]
    if k >= len(order):
        return None
    i = order[k]
    v, w, value = right[:, i], left[:, i].conj(), values[i]
    r = np.concatenate([v, -static[:, :N] @ v])
    row = np.concatenate([w, -(w @ Z[:N, N:]) @ static[:, N:]])
    turn = np.conj(value) if discrete else 1.0
    places = _places(signals, count)
    return np.asarray((turn * row[places[0]] * r[places[1]] / (w @ v)).real)


def _places(signals: LoopPencil, count: int) -> tuple[list[int], list[int]]:
    """The row and the column in the pencil of each entry of the controller."""
    plant = signals.plant
    nothing = MultiChannelSystem(
        plant.A * 0, [M * 0 for M in plant.B], [M * 0 for M in plant.C], time=plant.time
    )
    numbered = _with_entries(signals.controller, range(1, count + 1))
    numbered_entries = sorted(
        (x, i, j) for i, j, x in signals.with_entries(nothing, numbered, 0).nonzero()
    )
    return [i for _, i, _ in numbered_entries], [j for _, _, j in numbered_entries]


# The number of digits that is enough, whichever way the entries are rounded.


@dataclass(frozen=True)
class SafeDigits:
    """Two numbers of digits: one that is enough, and one that is too small.

    Attributes
    ----------
    safe : int or None
        A number of significant digits for which every rounding of the entries is certified; None if
        no number up to the one asked for has a proof.
    proof : BoxStability or None
    unsafe : int or None
        The largest number of digits of a rounding that is proved to fail; None if none is known.
    rounded : Controller or None
        The controller with this rounding.
    refutation : StabilityVerdict or None
        The exact verdict on its loop.
    """

    safe: int | None
    proof: BoxStability | None
    unsafe: int | None
    rounded: Controller | None
    refutation: StabilityVerdict | None


def safe_digits(
    system: MultiChannelSystem,
    controller: Controller,
    graph: NeighborGraph | None = None,
    *,
    rate: Any = None,
    radius: Any = None,
    most: int = 6,
) -> SafeDigits:
    """Find the fewest digits of a controller's entries that keep every loop in a region.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant; with radii, all plants within them are meant.
    controller : Controller
    graph : NeighborGraph, optional
        Overrides ``system.neighbors``.
    rate, radius : rational, optional
        A rate in continuous time, a radius in discrete time; by default stability is meant.
    most : int
        The largest number of digits that is tried.

    Notes
    -----
    All numbers to which an entry is rounded, up or down, are in a box, about which `box_stability`
    has a proof.  `unsafe_rounding` searches a rounding with which the loop fails, which is decided
    exactly; between the two numbers of digits nothing is known.

    Examples
    --------
    >>> from mcexact.model.statespace import local_controllers
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> digits = safe_digits(plant, local_controllers(plant, [[["-1.04"]]]))
    >>> digits.safe, digits.unsafe
    (3, 2)
    """
    bound: dict[str, Any] = {"rate": rate, "radius": radius}
    loop = closed_loop(system, controller, graph)
    region = StabilityRegion.of(system.time, rate, radius)
    unsafe, failing = 0, None
    for digits in range(most, 0, -1):
        failing = unsafe_rounding(loop, digits, region)
        if failing is not None:
            unsafe = digits
            break
    for digits in range(unsafe + 1, most + 1):
        try:
            gains = digit_radii(controller, digits)
            proof = box_stability(system, controller, graph, gains=gains, **bound)
        except LimitReached:
            continue
        return SafeDigits(digits, proof, unsafe or None, *(failing or (None, None)))
    return SafeDigits(None, None, unsafe or None, *(failing or (None, None)))
