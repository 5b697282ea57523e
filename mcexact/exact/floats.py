"""Conversions between floats and rational numbers and matrices, for the whole package."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Literal, get_args

from mcexact.arguments import one_of
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import as_fraction
from mcexact.exact.rows import entries_of, is_sparse_array, rows_of

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

Rounding = Literal["decimal", "dyadic"]
_ROUNDINGS = get_args(Rounding)

# Floats hold every integer up to here.
_EXACT = 2**53


def finite(number: float) -> float | None:
    """The number; None for what JSON does not have, an infinity or NaN."""
    return number if math.isfinite(number) else None


def from_float(x: float, rounding: Rounding, *, where: str | None = None) -> Fraction:
    """Convert a float to a rational number.

    Parameters
    ----------
    x : float
        A finite float or numpy floating-point scalar.
    rounding : {"decimal", "dyadic"}
        "decimal" reads the shortest decimal that prints the float in its own precision (0.1 is
        1/10, also in single precision), "dyadic" the binary fraction that is stored.

    Raises
    ------
    InputError
        The number is not finite, or the rounding is unknown.

    Examples
    --------
    >>> from_float(0.1, "decimal")
    Fraction(1, 10)
    >>> from_float(0.1, "dyadic")
    Fraction(3602879701896397, 36028797018963968)
    >>> import numpy
    >>> from_float(numpy.float32(0.1), "decimal"), from_float(numpy.float32(0.1), "dyadic")
    (Fraction(1, 10), Fraction(13421773, 134217728))
    """
    one_of(rounding, _ROUNDINGS, "rounding", InputError)
    shape = getattr(x, "shape", ())
    if shape:
        raise InputError(f"expected a number, found an array of shape {shape}", where=where)
    # A numpy scalar stays as it is: Python's floats are longer than some and shorter than others.
    value = x if hasattr(x, "as_integer_ratio") else float(x)
    try:
        # Python's and numpy's floats are printed with the fewest digits that tell them apart.
        return Fraction(*value.as_integer_ratio()) if rounding == "dyadic" else Fraction(str(value))
    except (OverflowError, ValueError):
        raise InputError(f"expected a finite number, found {float(x)!r}", where=where) from None


def as_requested(number: Any, *, where: str | None = None) -> Fraction:
    """Convert a number by which a caller asks for something, such as a rate.

    Parameters
    ----------
    number : int, Fraction, Decimal, str, float or scalar of numpy or sympy
        A float stands for the shortest decimal that prints it, 0.1 for 1/10: it is a wish and not a
        measurement, and what is certified in the end states the exact number.
    where : str, optional
        The place to name in an error.

    Raises
    ------
    InputError
        If it is not a finite rational number.

    Examples
    --------
    >>> as_requested(0.1), as_requested("1/3"), as_requested(2)
    (Fraction(1, 10), Fraction(1, 3), Fraction(2, 1))
    """
    if isinstance(number, float) or getattr(getattr(number, "dtype", None), "kind", "") == "f":
        return from_float(number, "decimal", where=where)
    return as_fraction(number, where=where)


def to_float(q: Fraction | int | str) -> float:
    """Convert a rational number, or the text of a decimal, to the nearest float.

    A number beyond the range of floats becomes an infinity of its sign.

    Examples
    --------
    >>> to_float(Fraction(1, 3))
    0.3333333333333333
    """
    return float(q) if isinstance(q, str) else _quotient(q.numerator, q.denominator)


def float_above(q: Fraction) -> float:
    """Return the least float that is at least a rational number, and so is its printed decimal.

    Beyond the range of floats this is infinity.

    Examples
    --------
    >>> float_above(Fraction(1, 3)), float_above(Fraction(1, 10**400)), float_above(Fraction(1, 4))
    (0.33333333333333337, 5e-324, 0.25)
    >>> float_above(Fraction(0.1)), 0.1 < Fraction(0.1)
    (0.10000000000000002, False)
    """
    found = to_float(q)
    if found == -math.inf:
        found = math.nextafter(found, 0.0)
    while math.isfinite(found) and min(Fraction(found), Fraction(repr(found))) < q:
        found = math.nextafter(found, math.inf)
    return found


def float_below(q: Fraction) -> float:
    """Return the largest float that is at most a rational number, as is its printed decimal.

    Examples
    --------
    >>> float_below(Fraction(1, 3)), float_below(Fraction(-1, 10**400))
    (0.3333333333333333, -5e-324)
    """
    return -float_above(-q)


def _quotient(p: int, q: int) -> float:
    try:
        return p / q
    except OverflowError:
        return math.inf if p > 0 else -math.inf


def matrix_from_float(
    M: Any, rounding: Rounding = "decimal", *, where: str | None = None
) -> Matrix:
    """Convert a matrix of floats to a rational matrix.

    Parameters
    ----------
    M : array_like, r × c
        A real two-dimensional array, a sparse array of scipy, or a list of rows of numbers.
        Integers, Fractions and matrices of this package do not change.
    rounding : {"decimal", "dyadic"}
        See `from_float`.
    where : str, optional
        The place to name in an error.

    Raises
    ------
    InputError
        The array is not a real two-dimensional one, or holds an infinity or NaN.

    Examples
    --------
    >>> matrix_from_float([[0.1, 2.0]]).rows()
    ((Fraction(1, 10), Fraction(2, 1)),)
    """
    if isinstance(M, Matrix):
        return M
    if is_sparse_array(M):
        entries = entries_of(M, where, floats=True)
        return Matrix.from_entries(
            M.shape,
            ((i, j, _exact(x, rounding, f"{where or ''}[{i}][{j}]")) for i, j, x in entries),
        )
    exact = [
        [_exact(entry, rounding, f"{where or ''}[{i}][{j}]") for j, entry in enumerate(row)]
        for i, row in enumerate(rows_of(M, where, floats=True))
    ]
    ncols = None if exact else int(getattr(M, "shape", (0, 0))[1])
    return Matrix.from_rows(exact, ncols=ncols, where=where)


def _exact(entry: Any, rounding: Rounding, where: str) -> Fraction | int:
    """Convert one entry; an integer of any length does not change."""
    kind = getattr(getattr(entry, "dtype", None), "kind", "")
    if isinstance(entry, float) or kind == "f":
        return from_float(entry, rounding, where=where)
    if hasattr(entry, "__index__") and not isinstance(entry, bool) and kind != "b":
        return int(entry.__index__())
    if isinstance(entry, Fraction):
        return as_fraction(entry, where=where)
    raise InputError(f"expected a real number, found {type(entry).__name__}", where=where)


def dyadic_matrix(M: Any, bits: int = 52) -> Matrix:
    """Round a matrix to multiples of 2^−bits times its largest entry, up to a factor of 2.

    Parameters
    ----------
    M : ndarray of float, r × c
    bits : int

    Returns
    -------
    Matrix
        Its denominator is a power of 2; symmetric if M is.

    Examples
    --------
    >>> import numpy as np
    >>> dyadic_matrix(np.array([[0.3, 1.0]]), bits=4).rows()
    ((Fraction(1, 4), Fraction(1, 1)),)
    """
    import numpy as np

    largest = float(np.max(np.abs(M), initial=0.0))
    if largest == 0.0:
        return Matrix.zeros(*M.shape)
    exponent = bits - int(np.frexp(largest)[1])
    whole = [list(map(int, row)) for row in np.round(np.ldexp(M, exponent)).tolist()]
    return Matrix.from_integers(whole, ncols=M.shape[1]) * (Fraction(2) ** -exponent)


def matrix_to_float(M: Matrix) -> npt.NDArray[np.float64]:
    """Convert a rational matrix to the array of the floats nearest to its entries.

    Entries beyond the range of floats become infinities.

    Examples
    --------
    >>> matrix_to_float(Matrix.from_rows([[1, "1/4"]]))
    array([[1.  , 0.25]])
    """
    import numpy as np

    try:
        table = np.array(M.numerators, dtype=np.int64).reshape(M.shape)
    except OverflowError:
        table = None
    if table is not None and max(M.denominator, int(np.abs(table).max(initial=0))) <= _EXACT:
        return table / np.float64(M.denominator)
    entries = [[_quotient(entry, M.denominator) for entry in row] for row in M.numerators]
    return np.array(entries, dtype=np.float64).reshape(M.shape)
