"""Matrices in files: read strictly from dense rows or sparse entries, written in lowest terms."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any, TypeVar

from mcexact.errors import InputError
from mcexact.exact.function_matrix import FunctionMatrix
from mcexact.exact.matrix import Matrix, from_cells
from mcexact.exact.rational import (
    DEFAULT_LIMITS,
    PRINTABLE_BITS,
    Limits,
    digits_of,
    parse_rational,
    rational_text,
)
from mcexact.exact.rows import common_width
from mcexact.model.json_text import (
    REMEMBERED,
    expect_integer,
    expect_list,
    expect_object,
    kind_of,
    shown_integer,
)
from mcexact.model.matrix_entry import Table, require_shape

M = TypeVar("M")

LONGEST_SIDE = 2**20
"""The most rows and columns of a sparse matrix; a few bytes must not fill the memory."""


_LETTERS = re.compile(r"[A-Za-z0-9_+*/^(). -]*[A-DF-Za-df-z][A-Za-z0-9_+*/^(). -]*")
"""A text with a letter other than that of an exponent."""


def read_number(value: Any, where: str, limits: Limits = DEFAULT_LIMITS) -> Fraction:
    """Read one exact number: an integer, a decimal as typed, or a string "p/q".

    Raises
    ------
    InputError
        If the value is not such a number, or is too long.
    """
    if type(value) is int:
        return Fraction(value)
    if not isinstance(value, str):
        raise InputError(f"expected a number, found {kind_of(value)}", where=where)
    try:
        number = parse_rational(str(value), limits, where=where)
    except InputError as error:
        if _LETTERS.fullmatch(value) and value.lower() not in ("nan", "inf", "infinity"):
            error.message += "; the key `parameters` of a system file makes letters parameters"
        raise
    # A decimal with an exponent can have more digits when it is written out.
    longest = max(abs(number.numerator), number.denominator)
    # Of the two conditions the first one is quick, and false for nearly all numbers.
    if longest.bit_length() > 3 * limits.digits and longest >= 10**limits.digits:
        raise InputError(
            f"expected at most {limits.digits} digits when written out (Limits.digits), "
            f"found {len(value)} characters that stand for more",
            where=where,
        )
    return number


def read_matrix(
    value: Any,
    where: str,
    nrows: int | None = None,
    ncols: int | None = None,
    limits: Limits = DEFAULT_LIMITS,
) -> Matrix:
    """Read a matrix of a known or unknown shape.

    Parameters
    ----------
    value : list of rows, or object
        A dense matrix is a list of rows.  A sparse matrix is ``{"shape": [r, c], "entries": [[i, j,
        value], …]}`` with positions from 0; other entries are 0.
    where : str
        Its place, for messages.
    nrows, ncols : int, optional
        The expected shape, if it is known.
    limits : Limits

    Raises
    ------
    InputError
        If the matrix is malformed or has another shape.

    Examples
    --------
    >>> read_matrix({"shape": [2, 3], "entries": [[1, 2, "1/2"]]}, "A")[1, 2]
    Fraction(1, 2)
    >>> read_matrix([[1], [2], [3]], "channels[2].B", nrows=4)
    Traceback (most recent call last):
        ...
    mcexact.errors.InputError: channels[2].B: expected 4 rows, found 3
    """
    return unread_matrix(value, where, nrows, ncols, partial(numbers, limits=limits)).matrix()


@dataclass(frozen=True)
class Entries:
    """The entries of a matrix in a file, which are not read yet.

    Attributes
    ----------
    where : str
        The place of the matrix, for messages.
    shape : (int, int)
    rows : list of lists, or None
        The entries row by row.
    given : list
        Without rows, the triples [row, column, value] of the entries that are not 0.
    """

    where: str
    shape: tuple[int, int]
    rows: list[list[Any]] | None
    given: list[Any]

    def listed(self) -> Iterator[tuple[int, int, int, Any]]:
        """Yield number, row, column and value of each triple.

        Raises
        ------
        InputError
            If it is no triple, or its position is outside or was there before.
        """
        r, c = self.shape
        seen: set[int] = set()
        for k, entry in enumerate(self.given):
            if type(entry) is not list or len(entry) != 3:
                length = len(expect_list(entry, self.place(k)))
                raise InputError(
                    f"expected [row, column, value], found {length} items", where=self.place(k)
                )
            i, j, value = entry
            if type(i) is not int or type(j) is not int or i < 0 or j < 0:
                i, j = (expect_integer(entry[axis], f"{self.place(k)}[{axis}]") for axis in (0, 1))
            if i >= r or j >= c:
                found = f"[{shown_integer(i)}, {shown_integer(j)}]"
                raise InputError(
                    f"expected a position inside {r} × {c}, found {found}", where=self.place(k)
                )
            if i * c + j in seen:
                raise InputError(f"the position [{i}, {j}] is listed twice", where=self.place(k))
            seen.add(i * c + j)
            yield k, i, j, value

    def place(self, k: int) -> str:
        """The place of a triple."""
        return f"{self.where}.entries[{k}]"


def unread_matrix(
    value: Any,
    where: str,
    nrows: int | None,
    ncols: int | None,
    read: Callable[[Entries], M],
) -> Table[M]:
    """Determine the shape of a matrix in a file, and leave its entries to be read later.

    Parameters
    ----------
    value : list of rows, or object
        As `read_matrix` takes it.
    where : str
    nrows, ncols : int or None
        The expected shape, if it is known.
    read : callable
        Makes the matrix of its entries.

    Raises
    ------
    InputError
        If the value is not a matrix, its rows have different lengths, or it is too large.

    Examples
    --------
    >>> unread_matrix([[1, "no number"]], "A", None, None, numbers).shape
    (1, 2)
    """
    if isinstance(value, dict):
        expect_object(value, where, ("shape", "entries"))
        shape = _sparse_shape(value["shape"], where)
        rows = expect_list(value["entries"], f"{where}.entries")
        entries = Entries(where, shape, None, rows)
    else:
        rows = expect_list(value, where)
        for k, row in enumerate(rows):
            if not isinstance(row, list):
                raise InputError(
                    f"expected a row as a list, found {kind_of(row)}; "
                    "write a column as [[1], [2]] and a row as [[1, 2]]",
                    where=f"{where}[{k}]",
                )
        width = common_width(rows, where)
        width = ncols or 0 if width is None else width
        entries = Entries(where, (len(rows), width), rows, [])
    return require_shape(Table(entries.shape, partial(read, entries)), where, nrows, ncols)


def numbers(entries: Entries, limits: Limits = DEFAULT_LIMITS) -> Matrix:
    """Read the numbers of a matrix.

    Raises
    ------
    InputError
        If an entry is no number, or is too long.
    """
    if entries.rows is None:
        return _sparse(entries, limits)
    return _dense(entries.rows, entries.shape[1], entries.where, limits)


def _dense(rows: list[list[Any]], width: int, where: str, limits: Limits) -> Matrix:
    """Read the numbers of all rows; what occurs again, as 0.0 does, is read once."""
    known: dict[str, Fraction] = {}

    def number(entry: Any, i: int, j: int) -> Fraction | int:
        if type(entry) is int:
            return entry
        if isinstance(entry, str) and entry in known:
            return known[entry]
        found = read_number(entry, f"{where}[{i}][{j}]", limits)
        if isinstance(entry, str) and len(known) < REMEMBERED:
            known[entry] = found
        return found

    if not all(set(map(type, row)) <= {int} for row in rows):
        rows = [[number(entry, i, j) for j, entry in enumerate(row)] for i, row in enumerate(rows)]
    return Matrix.from_rows(rows, ncols=width)


def _sparse_shape(value: Any, where: str) -> tuple[int, int]:
    """Read the shape of a sparse matrix."""
    sizes = expect_list(value, f"{where}.shape")
    if len(sizes) != 2:
        raise InputError(
            f"expected [rows, columns], found {len(sizes)} numbers", where=f"{where}.shape"
        )
    r, c = (expect_integer(size, f"{where}.shape[{k}]") for k, size in enumerate(sizes))
    if max(r, c) > LONGEST_SIDE:
        raise InputError(
            f"expected at most {LONGEST_SIDE} rows and columns in a sparse matrix, "
            f"found {shown_integer(r)} × {shown_integer(c)}",
            where=where,
        )
    return r, c


def _sparse(entries: Entries, limits: Limits) -> Matrix:
    """Read the entries of a sparse matrix."""
    c = entries.shape[1]
    values: dict[int, Fraction | int] = {}
    for k, i, j, value in entries.listed():
        if type(value) is not int:
            value = read_number(value, f"{entries.place(k)}[2]", limits)
        values[i * c + j] = value
    denominator = math.lcm(*{number.denominator for number in values.values()})
    cells = sorted(values)
    numerators = (values[k].numerator * (denominator // values[k].denominator) for k in cells)
    return from_cells(entries.shape, cells, numerators, denominator)


def number_json(value: Fraction) -> int | str:
    """Write a rational as a JSON integer, or as a string "p/q" in lowest terms.

    An integer of thousands of digits, which exceeds the default limit of readers, becomes a string
    too.
    """
    if value.denominator == 1 and value.numerator.bit_length() < PRINTABLE_BITS:
        return value.numerator
    return rational_text(value)


def matrix_json(M: Matrix | FunctionMatrix) -> Any:
    """Write a matrix as a list of rows; one with columns but no rows says its shape.

    Raises
    ------
    LimitReached
        The matrix is sparse, and too large for that.
    """
    r, c = M.shape
    if not r and c:
        return {"shape": [0, c], "entries": []}
    if isinstance(M, FunctionMatrix):
        return [[number_json(e.value) if e.is_constant else str(e) for e in row] for row in M.rows]
    d = M.denominator
    if d == 1 and M.words is not None:
        return [list(row) for row in M.numerators]
    return [[number_json(Fraction(entry, d)) for entry in row] for row in M.numerators]


def canonical_matrix_text(M: Matrix) -> str:
    """The canonical JSON text of a matrix in a certificate's system, in lowest terms.

    A matrix of at least 2**11 cells of which at most an eighth are not 0 is an object that has its
    shape and lists these entries row by row; any other one is a list of rows.

    Notes
    -----
    Integers of at most 64 bits are formatted row by row from machine words, in 40 ns each, which is
    half of what ``json`` takes without the rows as lists.

    Examples
    --------
    >>> print(canonical_matrix_text(Matrix.from_rows([["1/2", 3]])))
    [["1/2",3]]
    """
    r, c = M.shape
    M = M.suited()
    if M.is_sparse or (c and not r):
        return sparse_matrix_text(M)
    if not r:
        return "[]"
    words = M.words if M.denominator == 1 else None
    if words is None:
        rows = [",".join([_entry_text(x, M.denominator) for x in row]) for row in M.numerators]
    elif c == 1:
        return "[[" + _template(r, "],[") % tuple(words) + "]]"
    else:
        template = _template(c, ",")
        rows = [template % tuple(words[k * c : (k + 1) * c]) for k in range(r)]
    return "[[" + "],[".join(rows) + "]]"


def sparse_matrix_text(M: Matrix, between: str = ",") -> str:
    """The JSON text of a matrix by its shape and its entries that are not 0."""
    d = M.denominator
    if d == 1:
        found = between.join([f"[{i},{j},{digits_of(x)}]" for i, j, x in M.nonzero()])
    else:
        found = between.join([f"[{i},{j},{_entry_text(x, d)}]" for i, j, x in M.nonzero()])
    return f'{{"entries":[{found}],"shape":[{M.nrows},{M.ncols}]}}'


@lru_cache(maxsize=16)
def _template(size: int, between: str) -> str:
    """The text into which so many integers are formatted."""
    return between.join(["%d"] * size)


def _entry_text(numerator: int, denominator: int) -> str:
    """A quotient as JSON: an integer, or "p/q" in lowest terms."""
    common = math.gcd(numerator, denominator)
    text = digits_of(numerator // common)
    return text if common == denominator else f'"{text}/{digits_of(denominator // common)}"'


def json_text_of_number(value: int | str) -> str:
    """The JSON text of a number as `number_json` gives it."""
    return f'"{value}"' if isinstance(value, str) else str(value)
