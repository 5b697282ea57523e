"""The matrix exponential, rounded to decimals with a proved error."""

from __future__ import annotations

from fractions import Fraction

import flint

from mcexact.errors import LimitReached
from mcexact.exact.enclosures import PRECISION
from mcexact.exact.matrix import Matrix

_BITS, _MOST_BITS = 128, 1 << 16
_SPARE = 100


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
