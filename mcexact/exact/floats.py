"""Arrays of floats to rational matrices and back: the two crossings, entry by entry."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import Rounding, from_float, to_float

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


def matrix_from_float(
    M: Any, rounding: Rounding = "decimal", *, where: str | None = None
) -> Matrix:
    """The rational matrix that a matrix of floats is taken for.

    Parameters
    ----------
    M : array_like, r × c
        A real two-dimensional array, or a list of rows of numbers.  Integers stay what they are.
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

    if hasattr(M, "toarray"):
        M = M.toarray()
    rows, ncols = _from_array(M, where) if hasattr(M, "__array__") else _from_lists(M, where)
    exact = [
        [_exact(entry, rounding, f"{where or ''}[{i}][{j}]") for j, entry in enumerate(row)]
        for i, row in enumerate(rows)
    ]
    return Matrix.from_rows(exact, ncols=ncols)


def _exact(entry: Any, rounding: Rounding, where: str) -> Fraction | int:
    """One entry; an integer stays what it is, however long."""
    kind = getattr(getattr(entry, "dtype", None), "kind", "")
    if isinstance(entry, float) or kind == "f":
        return from_float(entry, rounding, where=where)
    if hasattr(entry, "__index__") and not isinstance(entry, bool) and kind != "b":
        return int(entry.__index__())
    raise InputError(f"expected a real number, found {type(entry).__name__}", where=where)


def dyadic_matrix(M: Any, bits: int = 52) -> Matrix:
    """M rounded to multiples of 2^−bits of its largest entry, up to a factor of 2.

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
    whole = matrix_from_float(np.round(np.ldexp(M, exponent)), "dyadic")
    return whole * (Fraction(2) ** -exponent)


def _from_array(M: Any, where: str | None) -> tuple[list[list[Any]], int]:
    """The rows of an array and their length."""
    import numpy as np

    array = np.asarray(M)
    if array.ndim != 2:
        raise InputError(
            f"expected a two-dimensional array, found {array.ndim} dimensions", where=where
        )
    if array.dtype.kind not in "fiuO" and array.size:
        raise InputError(
            f"expected an array of real numbers, found dtype {array.dtype}", where=where
        )
    rows: list[list[Any]] = array.tolist()
    return rows, array.shape[1]


def _from_lists(rows: Any, where: str | None) -> tuple[list[list[Any]], int]:
    """A list of rows and their length; numpy would round long integers beside a float."""
    if isinstance(rows, (str, bytes, dict)) or not isinstance(rows, Iterable):
        raise InputError(
            f"expected a two-dimensional array, found {type(rows).__name__}", where=where
        )
    try:
        table = [list(row) for row in rows]
    except TypeError:
        raise InputError("expected rows of numbers, all of one length", where=where) from None
    if len(set(map(len, table))) > 1:
        raise InputError("expected rows of numbers, all of one length", where=where)
    return table, len(table[0]) if table else 0


def matrix_to_float(M: Matrix) -> npt.NDArray[np.float64]:
    """The array of the floats nearest to the entries of a rational matrix.

    Entries beyond the range of floats become infinities.

    Examples
    --------
    >>> matrix_to_float(Matrix.from_rows([[1, "1/4"]]))
    array([[1.  , 0.25]])
    """
    import numpy as np

    array = np.empty(M.shape, dtype=np.float64)
    for i, row in enumerate(M.rows()):
        for j, entry in enumerate(row):
            array[i, j] = to_float(entry)
    return array
