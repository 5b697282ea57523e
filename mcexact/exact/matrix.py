"""Rational matrices, integer numerators over one common denominator."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import flint

from mcexact.errors import InputError, LimitReached
from mcexact.exact.rational import Entry, as_fraction, rational_text, require_power

Rows = tuple[tuple[int, ...], ...]

# 2 GiB of machine words
_MOST_ENTRIES = 2**28


@dataclass(frozen=True)
class Matrix:
    """A rational matrix, M = N / d with integer N and d ≥ 1 in lowest terms.

    Parameters
    ----------
    nrows, ncols : int
        Either may be 0.
    numerators : tuple of nrows tuples of ncols int
    denominator : int
        At least 1 and coprime to the numerators taken together; 1 for a matrix without entries.

    Notes
    -----
    Exact, immutable, hashable; equal matrices are equal objects in the sense of ``==``.  Build one
    with `from_rows` (any exact entries) or `from_integers`.

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

    nrows: int
    ncols: int
    numerators: Rows
    denominator: int

    def __post_init__(self) -> None:
        require_sizes(self.nrows, self.ncols)
        if type(self.denominator) is not int or self.denominator < 1:
            raise InputError(f"expected a denominator of at least 1, found {self.denominator!r}")
        if type(self.numerators) is not tuple or len(self.numerators) != self.nrows:
            raise InputError(f"expected a tuple of {self.nrows} rows of numerators")
        for row in self.numerators:
            if type(row) is not tuple or len(row) != self.ncols:
                raise InputError(f"expected rows that are tuples of {self.ncols} numerators")
            if not set(map(type, row)) <= {int}:
                raise InputError("expected numerators of type int; use Matrix.from_rows")
        if self.denominator != 1 and _content(self.numerators, self.denominator) != 1:
            raise InputError("expected lowest terms; use Matrix.from_integers")

    @classmethod
    def from_rows(
        cls, rows: Iterable[Iterable[Entry]], ncols: int | None = None, *, where: str | None = None
    ) -> Matrix:
        """The matrix with the given rows of exact entries.

        Parameters
        ----------
        rows : iterable of iterables of int, Fraction, Decimal, str or sympy Rational
        ncols : int, optional
            Needed for a matrix without rows, which otherwise has no columns.
        where : str, optional
            The place to name in an error, such as ``channels[0].B``.

        Raises
        ------
        InputError
            The rows differ in length, or an entry is not a rational number.
        FloatRefused
            An entry is a float.
        """
        table: list[list[Any]] = []
        for i, row in enumerate(_items(rows, where)):
            place = f"{where or ''}[{i}]"
            table.append(list(_items(row, place)))
        width = (len(table[0]) if table else 0) if ncols is None else ncols
        for i, entries in enumerate(table):
            if len(entries) != width:
                raise InputError(
                    f"expected {width} entries in the row, found {len(entries)}",
                    where=f"{where or ''}[{i}]",
                )
        if all(set(map(type, entries)) <= {int} for entries in table):
            return cls(len(table), width, tuple(map(tuple, table)), 1)
        fractions = [
            [as_fraction(entry, where=f"{where or ''}[{i}][{j}]") for j, entry in enumerate(row)]
            for i, row in enumerate(table)
        ]
        denominator = math.lcm(*{entry.denominator for row in fractions for entry in row})
        numerators = tuple(
            tuple(entry.numerator * (denominator // entry.denominator) for entry in row)
            for row in fractions
        )
        return cls(len(table), width, numerators, denominator)

    @classmethod
    def from_integers(
        cls, rows: Iterable[Iterable[int]], denominator: int = 1, ncols: int | None = None
    ) -> Matrix:
        """The matrix of integer rows over a common denominator, brought to lowest terms.

        Raises
        ------
        InputError
            An entry is not an int, the denominator is 0, or the rows differ in length.
        """
        table = tuple(tuple(row) for row in rows)
        width = (len(table[0]) if table else 0) if ncols is None else ncols
        if type(denominator) is not int or denominator == 0:
            raise InputError(f"expected a nonzero integer denominator, found {denominator!r}")
        numerators = cls(len(table), width, table, 1).numerators
        return lowest_terms(len(table), width, numerators, denominator)

    @classmethod
    def zeros(cls, nrows: int, ncols: int) -> Matrix:
        """The nrows × ncols zero matrix."""
        require_sizes(nrows, ncols)
        return cls(nrows, ncols, ((0,) * ncols,) * nrows, 1)

    @classmethod
    def identity(cls, n: int) -> Matrix:
        """The n × n identity matrix."""
        require_sizes(n, n)
        return cls(n, n, tuple((0,) * i + (1,) + (0,) * (n - 1 - i) for i in range(n)), 1)

    @classmethod
    def column(cls, entries: Iterable[Entry]) -> Matrix:
        """The matrix with one column."""
        return cls.from_rows([[entry] for entry in entries], ncols=1)

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self.nrows, self.ncols

    @property
    def T(self) -> Matrix:
        """The transpose."""
        columns = tuple(zip(*self.numerators, strict=True)) if self.nrows else ((),) * self.ncols
        return unchecked(self.ncols, self.nrows, columns, self.denominator)

    def __getitem__(self, position: tuple[int, int]) -> Fraction:
        """The entry in a row and a column, counted from 0; negative positions are refused."""
        i, j = position
        if not (0 <= i < self.nrows and 0 <= j < self.ncols):
            raise IndexError(f"no entry ({i}, {j}) in a {self.nrows} × {self.ncols} matrix")
        return Fraction(self.numerators[i][j], self.denominator)

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
        for chosen, size, name in ((rows, self.nrows, "row"), (cols, self.ncols, "column")):
            for k in chosen or ():
                if not 0 <= k < size:
                    raise IndexError(f"no {name} {k} in a {self.nrows} × {self.ncols} matrix")
        table = self.numerators if rows is None else tuple(self.numerators[i] for i in rows)
        if cols is not None:
            table = tuple(tuple(row[j] for j in cols) for row in table)
        return lowest_terms(
            len(table), self.ncols if cols is None else len(cols), table, self.denominator
        )

    def is_zero(self) -> bool:
        """Whether every entry is 0; true without entries."""
        return not any(map(any, self.numerators))

    def is_square(self) -> bool:
        """Whether there are as many rows as columns."""
        return self.nrows == self.ncols

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
        a, b = denominator // self.denominator, sign * (denominator // other.denominator)
        table = tuple(
            tuple(a * x + b * y for x, y in zip(row, addend, strict=True))
            for row, addend in zip(self.numerators, other.numerators, strict=True)
        )
        return lowest_terms(self.nrows, self.ncols, table, denominator)

    def __neg__(self) -> Matrix:
        table = tuple(tuple(-entry for entry in row) for row in self.numerators)
        return unchecked(self.nrows, self.ncols, table, self.denominator)

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
        table = tuple(tuple(p * entry for entry in row) for row in self.numerators)
        return lowest_terms(self.nrows, self.ncols, table, q * self.denominator)

    __rmul__ = __mul__

    def power(self, k: int) -> Matrix:
        """The k-th power of a square matrix, k ≥ 0."""
        if not self.is_square():
            raise InputError(f"expected a square matrix, found {self.nrows} × {self.ncols}")
        heights = (x.bit_length() for row in self.numerators for x in row)
        k = require_power(k, max(self.denominator.bit_length(), *heights, 1))
        result = Matrix.identity(self.nrows)
        for bit in bin(k)[2:]:
            result = result @ result
            if bit == "1":
                result = result @ self
        return result

    def trace(self) -> Fraction:
        """The sum of the diagonal entries of a square matrix."""
        if not self.is_square():
            raise InputError(f"expected a square matrix, found {self.nrows} × {self.ncols}")
        return Fraction(sum(self.numerators[i][i] for i in range(self.nrows)), self.denominator)

    @cached_property
    def _integer(self) -> flint.fmpz_mat:
        """The numerators for flint; shared, so never to be changed by anyone."""
        return flint.fmpz_mat(self.nrows, self.ncols, [x for row in self.numerators for x in row])

    def __getstate__(self) -> dict[str, Any]:
        return {name: self.__dict__[name] for name in self.__dataclass_fields__}

    def __repr__(self) -> str:
        rows = ", ".join("[" + ", ".join(map(rational_text, row)) + "]" for row in self.rows())
        shape = "" if self.nrows and self.ncols else f", shape={self.shape}"
        return f"Matrix([{rows}]{shape})"


def require_sizes(nrows: int, ncols: int) -> None:
    """Refuse sizes that flint would abort on, and matrices that cannot fit into memory."""
    for size, name in ((nrows, "rows"), (ncols, "columns")):
        if type(size) is not int or size < 0:
            raise InputError(f"expected a number of {name} that is at least 0, found {size!r}")
    if max(nrows, 1) * max(ncols, 1) > _MOST_ENTRIES:
        raise LimitReached(
            f"a {nrows} × {ncols} matrix has more than {_MOST_ENTRIES} entries: too many for memory"
        )


def _items(rows: Any, where: str | None) -> Iterable[Any]:
    if isinstance(rows, (str, bytes, dict)) or not isinstance(rows, Iterable):
        raise InputError(
            f"expected a list of rows, each a list of numbers, found {type(rows).__name__}",
            where=where,
        )
    return rows


def _content(numerators: Rows, denominator: int) -> int:
    """The greatest common divisor of the denominator and all numerators."""
    content = denominator
    for row in numerators:
        content = math.gcd(content, *row)
        if content == 1:
            break
    return content


def unchecked(nrows: int, ncols: int, numerators: Rows, denominator: int) -> Matrix:
    """A matrix from parts known to be valid; `__post_init__` would look at every entry again."""
    made = object.__new__(Matrix)
    made.__dict__.update(nrows=nrows, ncols=ncols, numerators=numerators, denominator=denominator)
    return made


def lowest_terms(nrows: int, ncols: int, numerators: Rows, denominator: int) -> Matrix:
    """The matrix numerators / denominator in lowest terms; the parts are valid, denominator ≠ 0."""
    content = _content(numerators, abs(denominator))
    if denominator < 0:
        content = -content
    if content != 1:
        numerators = tuple(tuple(entry // content for entry in row) for row in numerators)
    return unchecked(nrows, ncols, numerators, denominator // content)


def from_flint(table: flint.fmpz_mat, denominator: int = 1) -> Matrix:
    """The matrix table / denominator, denominator ≠ 0."""
    nrows, ncols = table.nrows(), table.ncols()
    entries = tuple(map(int, table.entries()))
    rows = tuple(entries[i * ncols : (i + 1) * ncols] for i in range(nrows))
    return lowest_terms(nrows, ncols, rows, denominator)


def _shapes_do_not_match(operation: str, a: Matrix, b: Matrix) -> InputError:
    return InputError(
        f"shapes do not match: {a.nrows} × {a.ncols} {operation} {b.nrows} × {b.ncols}"
    )
