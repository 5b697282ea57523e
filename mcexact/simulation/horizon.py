"""The times of a simulation, chosen from the slowest and the fastest mode of the loop."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import matrix_to_float, to_float
from mcexact.exact.roots import is_discrete
from mcexact.model.loop import ClosedLoop

CONSTANTS = 6
"""How many time constants of the slowest mode are shown; e⁻⁶ is 0.0025."""
FEWEST, MOST = 200, 1000
"""The least and the largest number of intervals in continuous time."""
STEPS = 300
"""The largest number of steps that is chosen in discrete time."""
_PER_RADIAN = 5
_NICE = (10, 12, 15, 20, 25, 30, 40, 50, 60, 80, 100)
_SLOW = 1e-9


@dataclass(frozen=True)
class Grid:
    """The times of a run.

    Attributes
    ----------
    times : tuple of Fraction
    fastest : float
        The largest modulus of an eigenvalue of the loop, in floating point; 0 if it is unknown.
    note : str or None
        What these times do not show.
    """

    times: tuple[Fraction, ...]
    fastest: float = 0.0
    note: str | None = None


def chosen_grid(
    loop: ClosedLoop, last: Fraction, horizon: Fraction | None = None, points: int | None = None
) -> Grid:
    """Choose the times of a run.

    Parameters
    ----------
    loop : ClosedLoop
    last : Fraction
        The time of the last change of a signal, after which the loop should be seen to settle.
    horizon : Fraction, optional
        The last time, or the number of steps in discrete time.  By default `CONSTANTS` time
        constants of the slowest mode after the last change, rounded up to a short number.
    points : int, optional
        The number of equal intervals in continuous time, by default several for each radian of the
        fastest mode, within limits.

    Notes
    -----
    Eigenvalues in floating point; only in discrete time the characteristic polynomial as well,
    which says exactly how many eigenvalues are 0, where floating point cannot.
    """
    if is_discrete(loop.given.time):
        chosen = last + _steps(loop, _eigenvalues(loop)) if horizon is None else horizon
        return Grid(tuple(Fraction(k) for k in range(math.ceil(chosen) + 1)))
    modes = _eigenvalues(loop)
    fastest = max(map(abs, modes), default=0.0)
    end = _nice(last + _duration(modes)) if horizon is None else horizon
    needed = math.ceil(min(to_float(end) * fastest * _PER_RADIAN, 1e9)) if fastest else FEWEST
    count = min(max(needed, FEWEST), MOST) if points is None else points
    note = None
    if points is None and needed > _PER_RADIAN * MOST:
        note = (
            f"the fastest mode has |λ| = {fastest:.3g}, too fast for times that are "
            f"{to_float(end / count):.3g} apart; a shorter horizon shows it"
        )
    return Grid(tuple(end * k / count for k in range(count + 1)), fastest, note)


def _eigenvalues(loop: ClosedLoop) -> list[complex]:
    """The eigenvalues in floating point; none if entries exceed floats."""
    import numpy as np

    M = matrix_to_float(loop.matrix)
    if not M.size or not np.all(np.isfinite(M)):
        return []
    return [complex(each) for each in np.linalg.eigvals(M)]


def _duration(modes: list[complex]) -> Fraction:
    """Some time constants of the slowest mode, or the time in which unstable modes grow as much."""
    if not modes:
        return Fraction(10)
    scale = max(map(abs, modes))
    rate = -max(each.real for each in modes)
    if rate < -_SLOW * scale:
        # An unstable loop is shown until it has grown e³ times.
        return Fraction(CONSTANTS / -rate / 2)
    if rate <= _SLOW * scale:
        moving = [abs(each) for each in modes if abs(each) > _SLOW * scale]
        return Fraction(CONSTANTS * math.pi / min(moving)) if moving else Fraction(10)
    return Fraction(CONSTANTS / rate)


def _steps(loop: ClosedLoop, modes: list[complex]) -> int:
    """The same in discrete time, as a number of steps."""
    states = loop.dimension
    if states <= STEPS // 5:
        # A mode 0 is gone after as many steps as it has states.
        zeros = characteristic_polynomial(loop.matrix).numerators
        at_rest = next((k for k, c in enumerate(zeros) if c), 0)
        modes = sorted(modes, key=abs)[at_rest:]
    radius = max(map(abs, modes), default=0.0)
    if radius <= _SLOW:
        return min(states + 3, STEPS)
    constant = abs(math.log(radius))
    if constant < CONSTANTS / STEPS:
        return STEPS
    return min(max(states + 3, math.ceil(_nice(Fraction(CONSTANTS / constant)))), STEPS)


def _nice(value: Fraction) -> Fraction:
    """Round up to a number of two digits that is easily read.

    Examples
    --------
    >>> [str(_nice(Fraction(x))) for x in ("0.0163", "491", "8", "1/3")]
    ['1/50', '500', '8', '2/5']
    """
    exponent = math.floor(math.log10(value)) - 1
    unit = Fraction(10) ** exponent
    digits = next((each for each in _NICE if each * unit >= value), 100)
    return digits * unit
