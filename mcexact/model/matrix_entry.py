"""Conversion of matrices from Python callers: nested lists, numpy integers, sympy, strings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol, TypeVar

from mcexact.errors import FloatRefused, InputError
from mcexact.exact.matrix import Matrix

_TWO_WAYS_IN = (
    "write the numbers as integers, fractions or strings, or use "
    'MultiChannelSystem.from_float(..., rounding="decimal" or "dyadic")'
)


class Shaped(Protocol):
    """An object with numbers of rows and columns."""

    @property
    def shape(self) -> tuple[int, int]: ...


S = TypeVar("S", bound=Shaped)


@dataclass(frozen=True)
class Table:
    """A matrix from a caller whose shape is known and whose entries are not converted yet.

    Attributes
    ----------
    shape : (int, int)
    matrix : function
        Reads the entries.
    """

    shape: tuple[int, int]
    matrix: Callable[[], Matrix]


def as_matrix(value: Any, where: str, ncols: int | None = None) -> Matrix:
    """Convert a matrix-like value to an exact matrix.

    Parameters
    ----------
    value : Matrix, sequence of rows, numpy or scipy array of integers or objects, sympy matrix
        Entries as `as_fraction` takes them.
    where : str
        The place of the matrix, for messages.
    ncols : int, optional
        The number of columns when there are no rows to tell it.

    Raises
    ------
    FloatRefused
        If an entry is a float.
    InputError
        If the value is not a matrix, its rows have different lengths, or an entry is not rational.

    Examples
    --------
    >>> as_matrix([["1/3", 2]], "A").shape
    (1, 2)
    >>> as_matrix([[0.5]], "A")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
        ...
    mcexact.errors.FloatRefused: A[0][0]: ...
    """
    return as_table(value, where, ncols).matrix()


def as_table(value: Any, where: str, ncols: int | None = None) -> Table:
    """Determine the shape of a matrix-like value, and leave its entries to be converted later.

    Raises
    ------
    FloatRefused
        If it is an array of floats.
    InputError
        If the value is not a matrix, or its rows have different lengths.
    """
    if isinstance(value, Matrix):
        return Table(value.shape, lambda: value)
    rows = _rows(value, where)
    width = common_width(rows, where)
    if width is None:
        width = int(getattr(value, "shape", (0, ncols or 0))[1])
    return Table((len(rows), width), partial(Matrix.from_rows, rows, width, where=where))


def common_width(rows: Sequence[Sequence[Any]], where: str) -> int | None:
    """The number of entries of each row; None if there are no rows.

    Raises
    ------
    InputError
        If they differ.
    """
    for k, row in enumerate(rows):
        if len(row) != len(rows[0]):
            raise InputError(
                f"expected {len(rows[0])} entries as in row 0, found {len(row)}",
                where=f"{where}[{k}]",
            )
    return len(rows[0]) if rows else None


def _rows(value: Any, where: str) -> list[tuple[Any, ...]]:
    """Copy a matrix-like value as tuples, so that the caller cannot change it."""
    if isinstance(value, (str, bytes)):
        raise InputError(
            "expected a matrix as a list of rows, found a string; write [[1, 2], [3, 4]]",
            where=where,
        )
    if hasattr(value, "toarray"):
        value = value.toarray()
    dtype = getattr(value, "dtype", None)
    if dtype is not None and hasattr(dtype, "kind"):
        if dtype.kind == "f":
            raise FloatRefused(f"found an array of {dtype}; {_TWO_WAYS_IN}", where=where)
        if dtype.kind not in "iuO":
            raise InputError(
                f"expected an array of integers or of exact objects, found {dtype}", where=where
            )
        if value.ndim != 2:
            raise InputError(
                f"expected a two-dimensional array, found {value.ndim} dimensions", where=where
            )
    if hasattr(value, "tolist"):
        value = value.tolist()
    try:
        # An iterator is used, since list() would reserve the length that a subclass claims to have.
        rows = tuple(iter(value))
    except TypeError:
        raise InputError(
            f"expected a matrix as a list of rows, found {type(value).__name__}", where=where
        ) from None
    copied = []
    for k, row in enumerate(rows):
        if isinstance(row, (str, bytes)) or not hasattr(row, "__iter__"):
            raise InputError(
                f"expected a row as a list, found {type(row).__name__}; "
                "write a column as [[1], [2]] and a row as [[1, 2]]",
                where=f"{where}[{k}]",
            )
        copied.append(tuple(row))
    return copied


def require_shape(M: S, where: str, nrows: int | None, ncols: int | None) -> S:
    """Return the matrix if it has the expected numbers of rows and columns.

    Raises
    ------
    InputError
        If it does not, such as ``channels[2].B: expected 4 rows, found 3``.
    """
    for expected, found, what in (
        (nrows, M.shape[0], "row"),
        (ncols, M.shape[1], "column"),
    ):
        if expected is not None and found != expected:
            plural = "" if expected == 1 else "s"
            raise InputError(f"expected {expected} {what}{plural}, found {found}", where=where)
    return M


def require_square(M: S, where: str) -> S:
    """Return the matrix if it is square.

    Raises
    ------
    InputError
        If it is not.
    """
    if M.shape[0] != M.shape[1]:
        raise InputError(
            f"expected a square matrix, found {M.shape[0]} × {M.shape[1]}", where=where
        )
    return M
