"""Conversion of matrices from Python callers: nested lists, numpy integers, sympy, strings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, Protocol, TypeVar

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rows import common_width, entries_of, is_sparse_array, rows_of


class Shaped(Protocol):
    """An object with numbers of rows and columns."""

    @property
    def shape(self) -> tuple[int, int]: ...


S = TypeVar("S", bound=Shaped)
M_co = TypeVar("M_co", covariant=True)


@dataclass(frozen=True)
class Table(Generic[M_co]):
    """A matrix from a caller whose shape is known and whose entries are not converted yet.

    Attributes
    ----------
    shape : (int, int)
    matrix : function
        Reads the entries.
    """

    shape: tuple[int, int]
    matrix: Callable[[], M_co]


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


def as_table(value: Any, where: str, ncols: int | None = None) -> Table[Matrix]:
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
    if is_sparse_array(value):
        entries, shape = entries_of(value, where), (int(value.shape[0]), int(value.shape[1]))
        return Table(shape, partial(Matrix.from_entries, shape, entries, where=where))
    rows, width = rows_and_width(value, where, ncols)
    return Table((len(rows), width), partial(Matrix.from_rows, rows, width, where=where))


def rows_and_width(
    value: Any, where: str, ncols: int | None = None
) -> tuple[list[tuple[Any, ...]], int]:
    """The rows of a matrix-like value, and their length, which is given where there is no row.

    Raises
    ------
    FloatRefused
        If it is an array of floats.
    InputError
        If the value is not a matrix, or its rows have different lengths.
    """
    rows = rows_of(value, where)
    width = common_width(rows, where)
    return rows, int(getattr(value, "shape", (0, ncols or 0))[1]) if width is None else width


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
