"""Rational matrices: integer numerators over one common denominator."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import chain
from typing import Any

import flint

from mcexact.errors import InputError, LimitReached
from mcexact.exact.rational import Entry, as_fraction, rational_text, require_power
from mcexact.exact.rows import common_width, rows_of

Rows = tuple[tuple[int, ...], ...]

# 2 GiB of machine words
_MOST_ENTRIES = 2**28


@dataclass(frozen=True, eq=False, repr=False)
class Matrix:
    """A rational matrix, M = N / d with integer N and d ≥ 1 in lowest terms.

    Attributes
    ----------
    denominator : int
        d: at least 1 and coprime to the numerators taken together; 1 without entries.

    Notes
    -----
    Exact, immutable, hashable; equal matrices are equal objects in the sense of ``==``.  Build one
    with `from_rows` (any exact entries) or `from_integers`.  The numerators stay in flint's form
    from one operation to the next; `numerators` converts them to integers when it is first read.

    Examples
    --------
    >>> M = Matrix.from_rows([[1, "1/2"], [0, "0.25"]])
    >>> M.numerators, M.denominator
    (((4, 2), (0, 1)), 4)
    >>> (M @ M)[0, 1]
    Fraction(5, 8)
    >>> Matrix.zeros(0, 3).T.shape
    (3, 0)
    """

    # Other matrices and functions of this stage share this object, so nothing may change it.
    _integer: flint.fmpz_mat
    denominator: int

    @classmethod
    def from_rows(
        cls, rows: Iterable[Iterable[Entry]], ncols: int | None = None, *, where: str | None = None
    ) -> Matrix:
        """Make the matrix with the given rows of exact entries.

        Parameters
        ----------
        rows : iterable of iterables of int, Fraction, Decimal, str or sympy Rational
        ncols : int, optional
            The number of columns of a matrix without rows, by default 0.
        where : str, optional
            The place to name in an error, such as ``channels[0].B``.

        Raises
        ------
        InputError
            The rows differ in length, or an entry is not a rational number.
        FloatRefused
            An entry is a float.
        """
        table = rows_of(rows, where)
        width = common_width(table, where)
        if width is None:
            width = ncols or 0
        elif ncols is not None and width != ncols:
            raise InputError(f"expected {ncols} columns, found {width}", where=where)
        require_sizes(len(table), width)
        if all(set(map(type, entries)) <= {int} for entries in table):
            return from_numerators(table, 1, width)
        fractions = [
            [as_fraction(entry, where=f"{where or ''}[{i}][{j}]") for j, entry in enumerate(row)]
            for i, row in enumerate(table)
        ]
        denominator = math.lcm(*{entry.denominator for row in fractions for entry in row})
        numerators = [
            [entry.numerator * (denominator // entry.denominator) for entry in row]
            for row in fractions
        ]
        return from_numerators(numerators, denominator, width)

    @classmethod
    def from_integers(
        cls, rows: Iterable[Iterable[int]], denominator: int = 1, ncols: int | None = None
    ) -> Matrix:
        """Make the matrix of integer rows over a common denominator, in lowest terms.

        Raises
        ------
        InputError
            An entry is not an int, the denominator is 0, or the rows differ in length.
        """
        table = list(map(tuple, rows))
        width = (len(table[0]) if table else 0) if ncols is None else ncols
        if type(denominator) is not int or denominator == 0:
            raise InputError(f"expected a nonzero integer denominator, found {denominator!r}")
        require_sizes(len(table), width)
        for row in table:
            if len(row) != width:
                raise InputError(f"expected rows of {width} numerators each")
            if not set(map(type, row)) <= {int}:
                raise InputError("expected numerators of type int; use Matrix.from_rows")
        return from_numerators(table, denominator, width)

    @classmethod
    def zeros(cls, nrows: int, ncols: int) -> Matrix:
        """The nrows × ncols zero matrix."""
        require_sizes(nrows, ncols)
        return cls(flint.fmpz_mat(nrows, ncols), 1)

    @classmethod
    def identity(cls, n: int) -> Matrix:
        """The n × n identity matrix."""
        made = cls.zeros(n, n)
        for i in range(n):
            made._integer[i, i] = 1
        return made

    @classmethod
    def column(cls, entries: Iterable[Entry]) -> Matrix:
        """The matrix with one column."""
        return cls.from_rows([[entry] for entry in entries], ncols=1)

    @property
    def nrows(self) -> int:
        """Number of rows."""
        return self._integer.nrows()

    @property
    def ncols(self) -> int:
        """Number of columns."""
        return self._integer.ncols()

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self.nrows, self.ncols

    @cached_property
    def numerators(self) -> Rows:
        """The rows of N."""
        words, width = self.__dict__.get("words"), self.ncols
        entries = tuple(words or map(int, self._integer.entries()))
        return tuple(entries[i * width : (i + 1) * width] for i in range(self.nrows))

    @cached_property
    def words(self) -> array[int] | None:
        """The entries of N row by row as machine words of 64 bits; None if one is longer.

        A matrix that was made of integers has them from the start: others convert each entry.
        """
        return _words(list(chain.from_iterable(self.numerators)))

    @property
    def T(self) -> Matrix:
        """The transpose."""
        return Matrix(self._integer.transpose(), self.denominator)

    def __getitem__(self, position: tuple[int, int]) -> Fraction:
        """The entry in a row and a column, counted from 0; negative positions are refused."""
        i, j = position
        if not (0 <= i < self.nrows and 0 <= j < self.ncols):
            raise IndexError(f"no entry ({i}, {j}) in a {self.nrows} × {self.ncols} matrix")
        return Fraction(int(self._integer[i, j]), self.denominator)

    def rows(self) -> tuple[tuple[Fraction, ...], ...]:
        """The entries as Fractions; slower than `numerators` for large matrices."""
        return tuple(
            tuple(Fraction(entry, self.denominator) for entry in row) for row in self.numerators
        )

    def take(self, rows: Sequence[int] | None = None, cols: Sequence[int] | None = None) -> Matrix:
        """The submatrix with these rows and columns, in the order given; None takes all.

        Examples
        --------
        >>> Matrix.identity(3).take(rows=[2, 0]).numerators
        ((0, 0, 1), (1, 0, 0))
        """
        require_positions(self.shape, rows, cols)
        table = self.numerators if rows is None else [self.numerators[i] for i in rows]
        if cols is not None:
            table = [tuple(row[j] for j in cols) for row in table]
        return from_numerators(table, self.denominator, self.ncols if cols is None else len(cols))

    def is_zero(self) -> bool:
        """Whether every entry is 0; true without entries."""
        return not self._integer

    def is_square(self) -> bool:
        """Whether there are as many rows as columns."""
        return self.nrows == self.ncols

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Matrix):
            return NotImplemented
        return self.denominator == other.denominator and bool(self._integer == other._integer)

    def __hash__(self) -> int:
        return hash((self.shape, self.numerators, self.denominator))

    def __add__(self, other: Matrix) -> Matrix:
        return self._combined(other, 1)

    def __sub__(self, other: Matrix) -> Matrix:
        return self._combined(other, -1)

    def _combined(self, other: Matrix, sign: int) -> Matrix:
        if not isinstance(other, Matrix):
            return NotImplemented
        if self.shape != other.shape:
            raise _shapes_do_not_match("+" if sign > 0 else "-", self, other)
        denominator = math.lcm(self.denominator, other.denominator)
        left = self._over(denominator)
        right = other._over(denominator)
        return from_flint(left + right if sign > 0 else left - right, denominator)

    def _over(self, denominator: int) -> flint.fmpz_mat:
        """The numerators over a multiple of the denominator."""
        factor = denominator // self.denominator
        return self._integer if factor == 1 else self._integer * factor

    def __neg__(self) -> Matrix:
        return Matrix(-self._integer, self.denominator)

    def __matmul__(self, other: Matrix) -> Matrix:
        if not isinstance(other, Matrix):
            return NotImplemented
        if self.ncols != other.nrows:
            raise _shapes_do_not_match("@", self, other)
        return from_flint(self._integer * other._integer, self.denominator * other.denominator)

    def __mul__(self, factor: int | Fraction) -> Matrix:
        if isinstance(factor, bool) or not isinstance(factor, (int, Fraction)):
            return NotImplemented
        p, q = factor.numerator, factor.denominator
        return from_flint(self._integer * p, q * self.denominator)

    __rmul__ = __mul__

    def power(self, k: int) -> Matrix:
        """The k-th power of a square matrix, k ≥ 0."""
        if not self.is_square():
            raise InputError(f"expected a square matrix, found {self.nrows} × {self.ncols}")
        lengths = (int(x.bit_length()) for x in self._integer.entries())
        k = require_power(k, max(self.denominator.bit_length(), *lengths, 1))
        return from_flint(self._integer**k, self.denominator**k)

    def __reduce__(self) -> tuple[Any, ...]:
        return Matrix.from_integers, (self.numerators, self.denominator, self.ncols)

    def __repr__(self) -> str:
        rows = ", ".join("[" + ", ".join(map(rational_text, row)) + "]" for row in self.rows())
        shape = "" if self.nrows and self.ncols else f", shape={self.shape}"
        return f"Matrix([{rows}]{shape})"


def require_sizes(nrows: int, ncols: int) -> None:
    """Raise an error for sizes for which flint would abort, or that exceed the memory."""
    for size, name in ((nrows, "rows"), (ncols, "columns")):
        if type(size) is not int or size < 0:
            raise InputError(f"expected a number of {name} that is at least 0, found {size!r}")
    if max(nrows, 1) * max(ncols, 1) > _MOST_ENTRIES:
        raise LimitReached(
            f"a {nrows} × {ncols} matrix has more than {_MOST_ENTRIES} entries: too many for memory"
        )


def require_positions(
    shape: tuple[int, int], rows: Sequence[int] | None, cols: Sequence[int] | None
) -> None:
    """Refuse rows and columns that a matrix of this shape does not have."""
    for chosen, size, name in zip((rows, cols), shape, ("row", "column"), strict=True):
        for k in chosen or ():
            if not 0 <= k < size:
                raise IndexError(f"no {name} {k} in a {shape[0]} × {shape[1]} matrix")


def from_numerators(rows: Sequence[Sequence[int]], denominator: int, ncols: int) -> Matrix:
    """The matrix rows / denominator; the rows are valid, denominator ≠ 0."""
    entries = list(chain.from_iterable(rows))
    made = from_flint(flint.fmpz_mat(len(rows), ncols, entries), denominator)
    if denominator == 1:
        made.__dict__["words"] = _words(entries)
    return made


def _words(entries: list[int]) -> array[int] | None:
    """Integers as machine words; None if one is longer."""
    try:
        return array("q", entries)
    except OverflowError:
        return None


def from_flint(table: flint.fmpz_mat, denominator: int = 1) -> Matrix:
    """The matrix table / denominator in lowest terms, denominator ≠ 0."""
    if denominator == 1:
        return Matrix(table, 1)
    numerators, least = (flint.fmpq_mat(table) / denominator).numer_denom()
    return Matrix(numerators, int(least))


def _shapes_do_not_match(operation: str, a: Matrix, b: Matrix) -> InputError:
    return InputError(
        f"shapes do not match: {a.nrows} × {a.ncols} {operation} {b.nrows} × {b.ncols}"
    )
