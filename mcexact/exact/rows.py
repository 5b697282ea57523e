"""Conversion of matrix-like values to rows: nested lists, arrays, sparse and symbolic matrices."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.errors import FloatRefused, InputError
from mcexact.exact.rational import TWO_WAYS_IN

Row = tuple[Any, ...]


def rows_of(value: Any, where: str | None = None, *, floats: bool = False) -> list[Row]:
    """Copy a matrix-like value as tuples, so that the caller cannot change it.

    Parameters
    ----------
    value : sequence of rows, numpy or scipy array, sympy matrix
    where : str, optional
        The place of the matrix, for messages.
    floats : bool
        Whether an array of floats is allowed.

    Raises
    ------
    FloatRefused
        If it is an array of floats, which is not allowed.
    InputError
        If the value is not a matrix.

    Examples
    --------
    >>> rows_of([[1, "1/2"], [0, 3]])
    [(1, '1/2'), (0, 3)]
    """
    if is_sparse_array(value):
        value = value.toarray()
    elif hasattr(value, "__array__") and not hasattr(value, "tolist"):
        value = value.__array__()
    _require_numbers(value, where, floats)
    if hasattr(value, "tolist"):
        value = [_scalars(row) for row in value] if _is_of_other_length(value) else value.tolist()
    if not _is_sequence(value):
        found = "a string" if isinstance(value, (str, bytes)) else type(value).__name__
        raise InputError(
            f"expected a matrix as a list of rows, found {found}; write [[1, 2], [3, 4]]",
            where=where,
        )
    copied = []
    # An iterator is used, since list() would reserve the length that a subclass claims to have.
    for k, row in enumerate(iter(value)):
        if not _is_sequence(row):
            raise InputError(
                f"expected a row as a list, found {type(row).__name__}; "
                "write a column as [[1], [2]] and a row as [[1, 2]]",
                where=f"{where or ''}[{k}]",
            )
        copied.append(tuple(row))
    return copied


def _require_numbers(value: Any, where: str | None, floats: bool) -> None:
    """Refuse an array with entries of another kind, or with one dimension or three."""
    dtype = getattr(value, "dtype", None)
    if dtype is None or not hasattr(dtype, "kind"):
        return
    if dtype.kind == "f" and not floats:
        raise FloatRefused(f"found an array of {dtype}: {TWO_WAYS_IN}", where=where)
    if dtype.kind not in "fiuO":
        kinds = "real numbers" if floats else "integers or of exact objects"
        raise InputError(f"expected an array of {kinds}, found {dtype}", where=where)
    if value.ndim != 2:
        raise InputError(
            f"expected a two-dimensional array, found {value.ndim} dimensions", where=where
        )


def _is_of_other_length(array: Any) -> bool:
    """Whether it holds floats of another length than Python's, such as single precision."""
    dtype: Any = getattr(array, "dtype", None)
    return getattr(dtype, "kind", "") == "f" and dtype.itemsize != 8


def _scalars(array: Any) -> list[Any]:
    """The numbers of an array of one dimension; ``tolist`` would widen floats to Python's."""
    found: list[Any] = list(array) if _is_of_other_length(array) else array.tolist()
    return found


def is_sparse_array(value: Any) -> bool:
    """Whether a value is a sparse array or matrix of scipy."""
    return hasattr(value, "tocoo") and hasattr(value, "shape")


def entries_of(
    value: Any, where: str | None = None, *, floats: bool = False
) -> list[tuple[int, int, Any]]:
    """List the row, the column and the value of each stored entry of a sparse array of scipy.

    Values that are stored for the same position are added, as scipy does.

    Raises
    ------
    FloatRefused
        If it is an array of floats, which is not allowed.
    InputError
        If it is not a matrix of numbers.
    """
    _require_numbers(value, where, floats)
    found: dict[tuple[int, int], Any] = {}
    stored = value.tocoo()
    for i, j, entry in zip(
        stored.row.tolist(), stored.col.tolist(), _scalars(stored.data), strict=True
    ):
        found[i, j] = found[i, j] + entry if (i, j) in found else entry
    return [(i, j, entry) for (i, j), entry in found.items()]


def _is_sequence(value: Any) -> bool:
    return hasattr(value, "__iter__") and not isinstance(value, (str, bytes, dict))


def common_width(rows: Sequence[Sequence[Any]], where: str | None = None) -> int | None:
    """Return the number of entries of each row; None if there are no rows.

    Raises
    ------
    InputError
        If they differ.
    """
    for k, row in enumerate(rows):
        if len(row) != len(rows[0]):
            raise InputError(
                f"expected {len(rows[0])} entries as in row 0, found {len(row)}",
                where=f"{where or ''}[{k}]",
            )
    return len(rows[0]) if rows else None
