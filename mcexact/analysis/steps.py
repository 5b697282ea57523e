"""Peaks of inputs and outputs after a step, proposed in floating point, verified by the checker.

A constant 1 is added to an input or an output of a loop at rest, or a set-point changes from 0 to
1.  The proof is a response in integers that begins at rest, and a matrix P in whose norm every
error falls; `mcexact.checker.steps` has the rule.  What is proposed here is how it is computed:

- P solves a Lyapunov equation of a loop that is slower, so that its norm falls at nearly the rate
  of the slowest mode;
- in continuous time the steps of time are a few radians of the fastest mode, for Taylor
  polynomials of some 20 to 50 terms, which describe the response between the steps as well;
- it ends where the derivative is so small that nothing larger can follow;
- integers have so many bits that rounding is negligible.

Peaks are computed in the same steps and rounded up.  The checker itself verifies the proof, as the
response in integers is all that there is to verify; this takes as long as any other check of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from itertools import product
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from mcexact.analysis.lyapunov import is_positive
from mcexact.analysis.performance import (
    BITS,
    diagonal_matrix,
    lyapunov_difference,
    rounded_form,
    solved,
)
from mcexact.answer.check import checked
from mcexact.answer.performance import StepPeaks, StepResponse, Symmetric
from mcexact.answer.protocol import encode
from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float, vstack
from mcexact.exact.roots import is_discrete
from mcexact.model.loop import ClosedLoop

Floats = npt.NDArray[np.float64]
Steps = Literal["inputs", "outputs", "setpoints"]
"""Where a step enters."""
_ANGLE = 8.0
"""The radians of the fastest mode in one step of time."""
_SLOWER = (0.7, 0.4, 0.15, 0.05)
"""Parts of the rate of the slowest mode at which the norm of P falls, best first."""
_TERMS = 60
"""The terms of Taylor polynomials in floating point."""
_POINTS = 256
"""The points within a step of time where signals are computed."""
_SLACK = 5e-4
"""What may follow after the last step is above the peak by at most this part of it."""
_ROUNDING = 1e-6
"""The part of a peak that rounding to integers may add."""
_SETTLED, _DRAWN, _FEWEST, _MOVES = 8.0, 300, 12, 0.02
"""The times of the slowest mode, and the points, that are drawn at most, and the fewest instants;
less than this part of the largest value counts as rest."""
SECONDS = 1.5e-8
"""Of a unit of work of the checker, on a processor of 2025, in long products as here."""
_REST = 256
"""The first term that is left out of a Taylor polynomial is below so many units (the checker)."""
_NOTHING = 1e-8
"""A signal is nothing if it is below this part of what a state of the same norm could have."""


@dataclass(frozen=True)
class Peaks:
    """Peaks of signals in floating point; they prove nothing.

    Attributes
    ----------
    inputs, outputs : array
        The largest absolute value of each signal, one row for each step.
    """

    inputs: Floats
    outputs: Floats


class StepLoop:
    """The responses of a loop to steps: z' = M z + b, signals s = S z + d, or z(t+1).

    Parameters
    ----------
    loop : ClosedLoop
    at : {"inputs", "outputs", "setpoints"}
    """

    def __init__(self, loop: ClosedLoop, at: Steps) -> None:
        disturbed = loop.disturbed
        p = disturbed.U.nrows
        b, through = {
            "inputs": lambda: (disturbed.E, Matrix.zeros(p, p)),
            "outputs": lambda: (disturbed.G, disturbed.K),
            "setpoints": lambda: (loop.reference, loop.reference_at_once),
        }[at]()
        N, k = disturbed.M.nrows, b.ncols
        S = vstack([disturbed.U, disturbed.Y], ncols=N)
        d = vstack([through, Matrix.zeros(S.nrows - p, k)], ncols=k)
        self.exact = disturbed.M, b, S, d
        self.at, self.loop, self.discrete, self.p = at, loop, is_discrete(loop.plant.time), p
        self.m, self.b, self.s, self.d = map(matrix_to_float, self.exact)
        self.poles = np.linalg.eigvals(self.m)

    @property
    def decay(self) -> float:
        """The rate of the slowest mode: −Re λ, in discrete time 1 − |λ|; at most 0 if unstable."""
        if self.discrete:
            return float(np.min(1 - np.abs(self.poles), initial=1.0))
        return float(np.min(-self.poles.real, initial=1.0))

    @property
    def fastest(self) -> float:
        """The largest modulus of an eigenvalue."""
        return float(np.max(np.abs(self.poles), initial=0.0)) or 1.0


def computed_steps(loop: ClosedLoop, at: Steps) -> Peaks | None:
    """Compute the peaks after each step in floating point; None for a loop that is not stable.

    Parameters
    ----------
    loop : ClosedLoop
    at : {"inputs", "outputs", "setpoints"}

    Notes
    -----
    The response at 128 times in each octave of time, from a tenth of a radian of the fastest mode
    on; in discrete time at all of the first 256 instants, then at every second, every fourth, ….
    """
    from scipy.linalg import expm

    steps = StepLoop(loop, at)
    if not 0 < steps.decay:
        return None
    N, k = steps.b.shape
    whole = np.block([[steps.m, steps.b], [np.zeros((k, N)), np.eye(k) * steps.discrete]])
    span = 1.0 if steps.discrete else 0.1 / steps.fastest
    E = whole if steps.discrete else expm(span * whole)
    seen = np.hstack([steps.s, steps.d])
    state = np.vstack([np.zeros((N, k)), np.eye(k)])
    peaks, time, last = np.abs(seen @ state), 0.0, 16 / steps.decay
    while time < last:
        for _ in range(256 if not time else 128):
            state = E @ state
            peaks = np.maximum(peaks, np.abs(seen @ state))
            time += span
        span, E = 2 * span, E @ E
    return Peaks(peaks[: steps.p].T, peaks[steps.p :].T)


@dataclass(frozen=True)
class _Run:
    """A response in floating point in steps of time, in coordinates scaled by P.

    ``peaks`` and ``last`` are the signals' peaks and last values, ``after`` is what may follow, and
    peaks up to ``least`` need not be accurate; ``largest`` is the largest number of all states,
    ``terms`` the number of all terms.
    """

    peaks: Floats
    last: Floats
    after: Floats
    least: Floats
    largest: float
    times: int
    terms: int


@dataclass(frozen=True)
class _Norm:
    """P with the rate at which its norm falls, and the sizes of signals."""

    P: Symmetric
    rate: Fraction
    sizes: tuple[Fraction, ...]

    def scales(self) -> Floats:
        """The powers 2^f of the checker, 4^f ≥ P_ii."""
        diagonal = np.diag(matrix_to_float(self.P.matrix()))
        return np.exp2(np.ceil(np.log2(diagonal) / 2))


@dataclass(frozen=True)
class StepCurve:
    """The response to a step of the input, or of the output, where the step is.

    Attributes
    ----------
    port : int
        The number of the input or output, in the order of the channels.
    times : tuple of float
        From 0 until little moves; in discrete time instants.
    values : tuple of float
    """

    port: int
    times: tuple[float, ...]
    values: tuple[float, ...]


def step_curves(loop: ClosedLoop, at: Steps, most: int) -> list[StepCurve]:
    """Compute the responses with the largest peaks, to be drawn; none of an unstable loop.

    Parameters
    ----------
    loop : ClosedLoop
    at : {"inputs", "outputs", "setpoints"}
    most : int
        The number of responses.

    Examples
    --------
    >>> from mcexact.model.loop import closed_loop
    >>> from mcexact.model.statespace import local_controllers
    >>> from mcexact.model.system import MultiChannelSystem
    >>> plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    >>> loop = closed_loop(plant, local_controllers(plant, [[[-3]]]))
    >>> [curve] = step_curves(loop, "inputs", 4)
    >>> curve.values[0], round(curve.values[-1], 2)
    (0.0, -1.5)
    """
    from scipy.linalg import expm

    steps = StepLoop(loop, at)
    N, k = steps.b.shape
    if not 0 < steps.decay or not k:
        return []
    whole = np.block([[steps.m, steps.b], [np.zeros((k, N)), np.eye(k) * steps.discrete]])
    first = 0 if at == "inputs" else steps.p
    seen = np.hstack([steps.s, steps.d])[first : first + k]

    def along(span: float, count: int) -> Floats:
        """The responses at multiples of a time, one column for each step."""
        E = np.linalg.matrix_power(whole, int(span)) if steps.discrete else expm(span * whole)
        state, values = np.vstack([np.zeros((N, k)), np.eye(k)]), list[Floats]()
        for _ in range(count + 1):
            values.append(np.einsum("ij,ji->i", seen, state))
            state = E @ state
        return np.array(values)

    last = _SETTLED / steps.decay
    while True:
        count = min(_DRAWN, max(math.ceil(last), _FEWEST)) if steps.discrete else _DRAWN
        span = float(math.ceil(last / count)) if steps.discrete else last / count
        values = along(span, count)
        peaks = np.max(np.abs(values), axis=0)
        away = (np.abs(values - values[-1]) > _MOVES * peaks).any(axis=1)
        # A slow mode that hardly shows would hide how the response begins.
        moving = int(np.max(np.flatnonzero(away), initial=0)) > count / 3
        if moving or count == _FEWEST or last * steps.fastest < 1:
            break
        last /= 2
    times = tuple(span * t for t in range(count + 1))
    order = np.argsort(-peaks, kind="stable")[:most]
    return [StepCurve(int(k), times, tuple(values[:, k].tolist())) for k in sorted(order)]


def steps_of(
    loop: ClosedLoop, at: Steps, *, most: int = 20_000, work: float = math.inf
) -> StepPeaks | None:
    """Prove how large inputs and outputs become after a step.

    Parameters
    ----------
    loop : ClosedLoop
    at : {"inputs", "outputs", "setpoints"}
    most : int
        The largest number of steps of time.
    work : float
        The units of work that the checker may take at most.

    Returns
    -------
    StepPeaks or None
        Bounds that exceed the peaks by some 0.05 % at most; None where none were found, as for
        loops that are not stable, or so stiff that more steps are needed.

    Raises
    ------
    LimitReached
        If the checker would take more work.

    Notes
    -----
    The checker's time is about that of N² products of long integers for each of some 20 to 50 terms
    of each step of time, and the number of steps grows with the ratio of the fastest mode to the
    slowest one.
    """
    steps = StepLoop(loop, at)
    if not 0 < steps.decay or not steps.b.shape[1]:
        return None
    # what is far too long is not begun
    _allow(_work_before(steps) / 4, work)
    norm = _norm_of(steps)
    if norm is None:
        return None
    h = None if steps.discrete else _dyadic(_ANGLE / steps.fastest)
    run = _run(steps, norm, h, most)
    if run is None:
        return None
    found = _proposal(steps, norm, h, run)
    _allow(_units(steps, found.response.bits, run.terms), work)
    verdict = checked(encode(found).encode())
    _allow(verdict.spent, work)
    return found if verdict.verdict == "VALID" else None


def _allow(units: float, work: float) -> None:
    if units > work:
        took = f"{units * SECONDS:.0f} s" if units * SECONDS > 1 else "long"
        raise LimitReached(f"a proof takes {took} to check (--prove-all)")


def _work_before(steps: StepLoop) -> float:
    """The units of work that a response may take, before anything is computed."""
    if steps.discrete:
        return _units(steps, 60, 12 / steps.decay)
    return _units(steps, 60, 25 * (1 + 2 * steps.fastest / steps.decay))


def _units(steps: StepLoop, bits: int, terms: float) -> float:
    """The units of the checker for products of the matrices with so many terms."""
    M, b, S, _ = steps.exact
    entries = sum(1 for _ in M.nonzero()) + sum(1 for _ in S.nonzero())
    limbs = b.ncols * (2 * bits + 12) / 30 + 1
    short = bits / 30 + 2
    each = 2 + short * limbs / 20 * 8 / max(8.0, math.sqrt(min(short, limbs)))
    # each sum is rounded, and each signal is taken apart
    return terms * (entries * each + (M.nrows + S.nrows) * limbs / 2 + S.nrows * b.ncols * 20)


def _dyadic(x: float, bits: int = 6) -> Fraction:
    """A number x > 0, rounded down to a few bits."""
    mantissa, exponent = math.frexp(x)
    return Fraction(math.floor(math.ldexp(mantissa, bits))) * Fraction(2) ** (exponent - bits)


def _norm_of(steps: StepLoop) -> _Norm | None:
    """P of a Lyapunov equation, with fewest bits."""
    M, _, S, _ = steps.exact
    N, count = M.nrows, S.nrows
    for P, rate in _forms(steps):
        inverse = np.linalg.inv(P)
        square = np.einsum("ik,kj,ij->i", steps.s, inverse, steps.s) * max(count, 1) * 1.05
        sizes = tuple(_above(math.sqrt(max(x, 1e-60))) for x in square)
        squares = S.T @ (diagonal_matrix([1 / size**2 for size in sizes]) @ S)
        for bits in BITS:
            form = rounded_form(P, bits)
            if form is None:
                break
            exact = form.matrix()
            falls = lyapunov_difference(exact, M, steps.discrete) - exact * (2 * rate)
            if is_positive(exact - squares) and is_positive(falls):
                return _Norm(form, rate, sizes)
    return _Norm(Symmetric((), ()), Fraction(1, 4), (Fraction(1),) * count) if not N else None


def _forms(steps: StepLoop) -> Any:
    """Matrices whose norm falls, with a rate."""
    from scipy.linalg import matrix_balance, solve_continuous_lyapunov, solve_discrete_lyapunov

    N = len(steps.m)
    if not N:
        return
    _, (scales, _) = matrix_balance(steps.m, permute=False, separate=True)
    m, seen = steps.m / scales[:, None] * scales, steps.s * scales
    sizes = np.sqrt(np.sum(seen**2, axis=1))
    seen = seen / np.where(sizes > 0, sizes, 1)[:, None]
    for part, more in product(_SLOWER, (0.1, 1.0)):
        Q = seen.T @ seen + more * np.eye(N)
        if steps.discrete:
            radius = 1 - part * steps.decay
            rate, slower = (1 - radius**2) / 2, (m / radius).T
            P = solved(partial(solve_discrete_lyapunov, slower, Q))
        else:
            rate = part * steps.decay
            P = solved(partial(solve_continuous_lyapunov, (m + rate * np.eye(N)).T, -Q))
        if P is not None and np.all(np.linalg.eigvalsh(P) > 0):
            yield P / scales[:, None] / scales, _dyadic(rate * 0.99, 10)


def _above(x: float) -> Fraction:
    """A number with few bits from x on."""
    return _dyadic(x) + Fraction(2) ** (math.frexp(x)[1] - 6)


def _run(steps: StepLoop, norm: _Norm, h: Fraction | None, most: int) -> _Run | None:
    """Compute a response until nothing larger follows, None after too many steps of time."""
    f = norm.scales()
    sizes = np.array([to_float(size) for size in norm.sizes])
    span = 1.0 if h is None else to_float(h)
    m, b = steps.m * f[:, None] / f * span, steps.b * f[:, None] * span
    s, falling = steps.s / f, to_float(norm.rate) * span
    z, peaks, largest = np.zeros_like(b), np.abs(steps.d), float(np.max(np.abs(b), initial=0.0))
    points, norms = np.linspace(0, 1, _POINTS + 1), np.sum(np.abs(b), axis=0)
    count, moves = 0, np.any(steps.s != 0, axis=1)
    for times in range(most + 1):
        terms = [m @ z + b - (z if h is None else 0)]
        after = np.sum(np.abs(terms[0]), axis=0) / falling * sizes[:, None]
        last = s @ z + steps.d
        peaks = np.maximum(peaks, np.abs(last))
        norms = np.maximum(norms, np.sum(np.abs(z), axis=0))
        least = _NOTHING * sizes[:, None] * norms
        ends = np.abs(last) + after <= peaks * (1 + _SLACK) + least
        if np.all(ends[moves]):
            return _Run(peaks, last, after, least, largest, times, count)
        if h is not None:
            size = float(np.max(np.abs(z), initial=0.0)) + float(np.max(np.abs(terms[0])))
            while len(terms) < _TERMS and np.max(np.abs(terms[-1])) > 1e-16 * size:
                terms.append(m @ terms[-1] / (len(terms) + 1))
            between = np.stack([last, *(s @ term for term in terms)])
            peaks = np.maximum(peaks, _largest(between, peaks, points))
        count += len(terms)
        largest = max(largest, *(float(np.max(np.abs(term))) for term in [z, *terms]))
        z = z + sum(terms)
        largest = max(largest, float(np.max(np.abs(z))))
    return None


def _largest(c: Floats, peaks: Floats, points: Floats) -> Floats:
    """Bounds of polynomials from 0 to 1, from their values and second derivatives at points."""
    size = np.maximum(np.abs(c[0]), np.abs(c[0] + c[1])) + np.sum(np.abs(c[2:]), axis=0)
    result = peaks.copy()
    i, k = np.nonzero(size > peaks)
    if len(i):
        chosen = c[:, i, k]
        orders = np.arange(len(c))
        values = np.abs(chosen.T @ points ** orders[:, None])
        bends = np.zeros_like(values)
        if len(c) > 2:
            factors = (orders * (orders - 1))[2:, None]
            bends = np.abs((chosen[2:] * factors).T @ points ** (orders[2:, None] - 2))
        result[i, k] = np.max(values + bends / (8 * (len(points) - 1) ** 2), axis=1)
    return result


def _proposal(steps: StepLoop, norm: _Norm, h: Fraction | None, run: _Run) -> StepPeaks:
    """The bounds with the bits that make rounding negligible."""
    N = len(steps.m)
    sizes = np.array([to_float(size) for size in norm.sizes])[:, None]
    wanted = np.min((run.peaks / sizes)[run.peaks > run.least], initial=np.inf)
    rounding = _unit_errors(N, run.times, h, norm.rate)
    # the largest number keeps two bits below the limit
    top = math.frexp(run.largest or 1.0)[1] + 2
    unit = top - 40
    if np.isfinite(wanted):
        unit = min(unit, math.frexp(float(wanted) * _ROUNDING / rounding)[1] - 1)
    bits = min(max(top - unit, 24), 900)
    slack = sizes * math.ldexp(rounding, unit)
    bound = np.maximum(run.peaks * (1 + 1e-5), np.abs(run.last) + run.after * (1 + 1e-6)) + slack
    claimed = [tuple(_decimal_above(float(x)) for x in column) for column in bound.T]
    response = StepResponse(norm.P, norm.rate, norm.sizes, bits, unit, run.times)
    if h is not None:
        response = replace(response, step=h)
    inputs, outputs = (
        tuple(row[a:b] for row in claimed) for a, b in ((0, steps.p), (steps.p, None))
    )
    return StepPeaks(steps.loop.system, steps.at, inputs, outputs, response)


def _unit_errors(N: int, times: int, h: Fraction | None, rate: Fraction) -> float:
    """The units by which rounding changes signals at most, as the checker adds them up."""
    each = N * (N + 2) if h is None else N * ((_TERMS + 1) * (N + 1) + 1 + _REST)
    # rounding down shifts the limit, where the terms of a step of time add up to nothing
    after = N * (N + 2 + 2 * _TERMS) / to_float(rate * (h or 1))
    return (times + 1) * each + (_TERMS + 2) * (N + 2) + after


def _decimal_above(x: float, digits: int = 5) -> Fraction:
    """A decimal of so many significant digits above x ≥ 0."""
    if not x:
        return Fraction(0)
    power = digits - 1 - math.floor(math.log10(x))
    return Fraction(math.floor(Fraction(x) * Fraction(10) ** power) + 1) / Fraction(10) ** power
