"""Ball arithmetic: exponentials, trajectories and responses, with errors proved.

A ball is a number with a radius that bounds its error; flint's operations on balls enlarge the
radius so that the exact result stays inside.

`exponential_above` and `power_above` round up to floats, so that bounds on decay remain bounds.
`states_at_doubling_steps` and `even_powers`, with more and more bits, and `response`, with a fixed
number, give floats that are accurate to 1e-9 for the curves of a loop, and None if their bits do
not suffice.
"""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import flint
import numpy as np
import numpy.typing as npt

from mcexact.exact.matrix import Matrix, float_above
from mcexact.exact.roots import PRECISION

# Powers and exponentials rounded up to floats.

_SCALAR_BITS = 80
_LEAST = -1074
"""The exponent of the least float above 0."""


def exponential_above(x: Fraction) -> float:
    """Return a float that is at least exp(x) and close to it, for x ≤ 0.

    Examples
    --------
    >>> exponential_above(Fraction(0)), exponential_above(Fraction(-(10**30)))
    (1.0, 5e-324)
    >>> exponential_above(Fraction(-1))
    0.36787944117144233
    """
    with PRECISION, flint.ctx.workprec(_SCALAR_BITS):
        return _above(flint.arb(flint.fmpq(x.numerator, x.denominator)).exp())


def power_above(base: Fraction, exponent: int) -> float:
    """Return a float that is at least base^exponent and close to it, for 0 ≤ base ≤ 1.

    Examples
    --------
    >>> power_above(Fraction(1, 2), 2), power_above(Fraction(1, 10), 1)
    (0.25, 0.10000000000000002)
    >>> power_above(Fraction(1, 2), 10**9)
    5e-324
    """
    with PRECISION, flint.ctx.workprec(_SCALAR_BITS):
        return _above(flint.arb(flint.fmpq(base.numerator, base.denominator)) ** exponent)


def _above(ball: flint.arb) -> float:
    """The least float that no number in a ball exceeds; the numbers are at most 1."""
    upper = ball.upper()
    if upper <= 0:
        return 0.0
    # The exponent of a tiny number may be too long to be written as a fraction.
    return float_above(Fraction(2) ** _LEAST if upper < flint.arb(2) ** _LEAST else _exact(upper))


def _exact(x: flint.arb) -> Fraction:
    """The value of a ball of radius 0."""
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


# Trajectories and responses of linear systems in ball arithmetic, as accurate floats.

Floats = npt.NDArray[np.float64]
_STATE_BITS, _MOST_STATE_BITS, _RESPONSE_BITS = 192, 4096, 1024
_ACCURACY = 1e-9
"""The largest error of an entry, as a part of the largest entry or of 1."""


def states_at_doubling_steps(
    M: Matrix, start: Matrix, rows: int, *, first: float, whole: int, end: float
) -> list[Floats] | None:
    """Return the first rows of X^k times a matrix, at times whose steps double after every eighth.

    Parameters
    ----------
    M : Matrix, N × N
    start : Matrix, N × k
    rows : int
    first : float
        X = exp(M·first), or X = M if this is 0.
    whole : int
        The number of single powers at the beginning; then the step is an eighth of this, at least
        1.
    end : float
        The power at which the doubling ends.

    Returns
    -------
    list of ndarray, rows × k, or None
        Each accurate to 1e-9 of its largest entry or of 1; None if 4,096 bits do not suffice.

    Examples
    --------
    >>> start = Matrix.identity(1)
    >>> states = states_at_doubling_steps(start * 2, start, 1, first=0, whole=0, end=2)
    >>> [int(each[0, 0]) for each in states]
    [2, 4, 8, 16, 32, 64, 128, 256]
    """

    def states(seen: Callable[[flint.arb_mat], bool]) -> bool:
        state, step = _balls(start), _step(M, first)
        current = state
        for _ in range(whole):
            current = step * current
            if not seen(current):
                return False
        elapsed = max(whole // 8, 1)
        step = step**elapsed
        while elapsed < end:
            current = state
            for _ in range(8):
                current = step * current
                if not seen(current):
                    return False
            step, elapsed = step * step, 2 * elapsed
        return True

    return _accurate(states, rows)


def even_powers(M: Matrix, columns: int, interval: float, count: int) -> list[Floats] | None:
    """Return the first columns of I, X, X², … with X = exp(M·interval), or M for an interval of 0.

    Parameters
    ----------
    M : Matrix, N × N
    columns, count : int
    interval : float

    Returns
    -------
    list of ndarray, N × columns, or None
        Each accurate to 1e-9 of its largest entry or of 1; None if 4,096 bits do not suffice.

    Examples
    --------
    >>> powers = even_powers(Matrix.from_rows([[-1, 1], [0, -1]]), 2, 1.0, 3)
    >>> [float(each[0, 1].round(6)) for each in powers]
    [0.0, 0.367879, 0.270671]
    """

    def states(seen: Callable[[flint.arb_mat], bool]) -> bool:
        step = _step(M, interval)
        current = _balls(Matrix.identity(M.nrows).take(cols=range(columns)))
        for _ in range(count):
            if not seen(current):
                return False
            current = step * current
        return True

    return _accurate(states, M.nrows)


def response(A: Matrix, B: Matrix, C: Matrix, z: complex) -> npt.NDArray[np.complex128] | None:
    """Return C (zI − A)⁻¹ B at a point; None if 1,024 bits do not give it to 1e-9, or at a pole.

    Examples
    --------
    >>> one = Matrix.identity(1)
    >>> response(one, one, one, 3 + 0j), response(one, one, one, 1 + 0j)
    (array([[0.5+0.j]]), None)
    """
    with PRECISION, flint.ctx.workprec(_RESPONSE_BITS):
        at = flint.acb_mat(_balls(Matrix.identity(A.nrows))) * flint.acb(z.real, z.imag)
        try:
            solved = (at - flint.acb_mat(_balls(A))).solve(flint.acb_mat(_balls(B)))
        except ZeroDivisionError:
            return None
        T = flint.acb_mat(_balls(C)) * solved
        re, im = (_floats(_part(T, name), T.nrows()) for name in ("real", "imag"))
    return None if re is None or im is None else re + 1j * im


def _accurate(
    states: Callable[[Callable[[flint.arb_mat], bool]], bool], rows: int
) -> list[Floats] | None:
    """The floats of all matrices that `states` passes on, with as many bits as they need."""
    bits = _STATE_BITS
    while bits <= _MOST_STATE_BITS:
        floats = list[Floats]()

        def seen(state: flint.arb_mat, floats: list[Floats] = floats) -> bool:
            shown = _floats(state, rows)
            if shown is not None:
                floats.append(shown)
            return shown is not None

        with PRECISION, flint.ctx.workprec(bits):
            if states(seen):
                return floats
        bits *= 2
    return None


def _step(M: Matrix, interval: float) -> flint.arb_mat:
    return (_balls(M) * flint.arb(interval)).exp() if interval else _balls(M)


def _balls(M: Matrix) -> flint.arb_mat:
    """Balls around the entries of a matrix, in the precision that is set."""
    entries = [flint.arb(flint.fmpq(x.numerator, x.denominator)) for row in M.rows() for x in row]
    return flint.arb_mat(M.nrows, M.ncols, entries)


def _floats(state: flint.arb_mat, rows: int) -> Floats | None:
    """The first rows as floats; None if they are not accurate."""
    balls = [[state[i, j] for j in range(state.ncols())] for i in range(rows)]
    middle = np.array([[float(x.mid()) for x in row] for row in balls]).reshape(rows, -1)
    error = np.array([[float(x.rad()) for x in row] for row in balls]).reshape(rows, -1)
    size = max(1.0, float(np.max(np.abs(middle), initial=0.0)))
    known = np.all(np.isfinite(middle)) and np.max(error, initial=0.0) <= _ACCURACY * size
    return middle if known else None


def _part(T: flint.acb_mat, name: str) -> flint.arb_mat:
    entries = [getattr(T[i, j], name) for i in range(T.nrows()) for j in range(T.ncols())]
    return flint.arb_mat(T.nrows(), T.ncols(), entries)
