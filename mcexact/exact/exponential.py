"""The matrix exponential with a proved error, and powers and exponentials rounded up to floats."""

from __future__ import annotations

from fractions import Fraction

import flint

from mcexact.errors import LimitReached
from mcexact.exact.enclosures import PRECISION
from mcexact.exact.floats import float_above
from mcexact.exact.matrix import Matrix

_BITS, _MOST_BITS = 128, 1 << 16
_SPARE = 100
_SCALAR_BITS = 80
_LEAST = -1074
"""The exponent of the least float above 0."""


def exponential(M: Matrix, decimals: int) -> Matrix:
    """Compute exp(M) with every entry rounded to a number of decimals.

    Parameters
    ----------
    M : Matrix, n × n
    decimals : int
        After the decimal point.

    Returns
    -------
    Matrix
        Every entry differs from that of exp(M) by at most 0.51·10^−decimals.

    Raises
    ------
    LimitReached
        If 65,536 bits do not suffice.

    Notes
    -----
    Ball arithmetic encloses exp(M) with more and more bits, until every radius is below 1/100 of
    the last decimal.

    Examples
    --------
    >>> exponential(Matrix.from_rows([[0, "1/10"], [0, 0]]), 6).rows()[0]
    (Fraction(1, 1), Fraction(1, 10))
    >>> exponential(Matrix.from_rows([[1]]), 6)[0, 0]
    Fraction(1359141, 500000)
    """
    unit = Fraction(1, 10**decimals)
    if not M.nrows:
        return M
    entries = [[flint.fmpq(x.numerator, x.denominator) for x in row] for row in M.rows()]
    bits = _BITS
    while bits <= _MOST_BITS:
        balls = [x for row in _enclosed(entries, bits) for x in row]
        if all(x.is_finite() and _exact(x.rad()) * _SPARE <= unit for x in balls):
            numbers = [round(_exact(x.mid()) / unit) * unit for x in balls]
            n = M.ncols
            return Matrix.from_rows([numbers[n * i : n * (i + 1)] for i in range(n)])
        bits *= 2
    raise LimitReached(f"{_MOST_BITS} bits do not suffice for {decimals} decimals of exp(M)")


def exponential_above(x: Fraction) -> float:
    """Return a float that is at least exp(x), and hardly more; for x ≤ 0, as decays have it.

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
    """Return a float that is at least base^exponent, and hardly more, for 0 ≤ base ≤ 1.

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
    """The least float that is at least everything in a ball of numbers at most 1."""
    upper = ball.upper()
    if upper <= 0:
        return 0.0
    # The exponent of a tiny number may be too long to be written as a fraction.
    return float_above(Fraction(2) ** _LEAST if upper < flint.arb(2) ** _LEAST else _exact(upper))


def _enclosed(entries: list[list[flint.fmpq]], bits: int) -> list[list[flint.arb]]:
    """Balls that contain the entries of the exponential, computed with some bits."""
    with PRECISION:
        before = flint.ctx.prec
        flint.ctx.prec = bits
        try:
            found = flint.arb_mat([[flint.arb(x) for x in row] for row in entries]).exp()
            return [[found[i, j] for j in range(len(entries))] for i in range(len(entries))]
        finally:
            flint.ctx.prec = before


def _exact(x: flint.arb) -> Fraction:
    """The value of a ball of radius 0."""
    mantissa, exponent = x.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)
