"""Rational matrices: integer numerators over one common denominator."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, overload

import flint

from mcexact.errors import InputError
from mcexact.exact import tables
from mcexact.exact.matrix_forms import MatrixForms, pasted, row_of
from mcexact.exact.matrix_sizes import require_positions, require_sides, require_sizes
from mcexact.exact.rational import Entry, as_fraction, require_power
from mcexact.exact.rows import common_width, rows_of
from mcexact.exact.tables import DenseTable, SparseTable, Table
from mcexact.exact.tables import Rows as Rows


@dataclass(frozen=True, eq=False, repr=False)
class Matrix(MatrixForms):
    """A rational matrix, M = N / d with integer N and d ≥ 1 in lowest terms.

    Attributes
    ----------
    denominator : int
        d: at least 1 and coprime to the numerators taken together; 1 without entries.

    Notes
    -----
    Exact, immutable, hashable; equal matrices are equal objects in the sense of ``==``.  Build one
    with `from_rows` (any exact entries), `from_entries` or `from_integers`.  In operations with
    arrays of numpy, and in its functions, a matrix is an array of floats: each entry is rounded to
    the nearest one.  sympy gets the exact entries.  The numerators stay in
    flint's form from one operation to the next; `numerators` converts them to integers when it is
    first read.  A matrix of at least 2**11 cells of which at most an eighth are not 0 keeps these
    alone, and so do its submatrices, transposes, sums, and products with others of this sort; only
    `numerators`, `words` and algorithms for dense matrices write it out with its zeros.

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

    _table: Table
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
    def from_entries(
        cls,
        shape: tuple[int, int],
        entries: Iterable[tuple[int, int, Entry]],
        *,
        where: str | None = None,
    ) -> Matrix:
        """Make the matrix of a shape with the given entries, and zeros elsewhere.

        Parameters
        ----------
        shape : (int, int)
        entries : iterable of (int, int, entry)
            Row, column and value, in any order; positions are counted from 0.
        where : str, optional
            The place to name in an error.

        Raises
        ------
        InputError
            A position is outside the shape or is given twice, or a value is not rational.
        FloatRefused
            A value is a float.

        Examples
        --------
        >>> Matrix.from_entries((2, 3), [(1, 2, "1/2"), (0, 0, 3)]).rows()[1]
        (Fraction(0, 1), Fraction(0, 1), Fraction(1, 2))
        >>> Matrix.from_entries((100_000, 100_000), [(7, 8, 9)])[7, 8]
        Fraction(9, 1)
        """
        r, c = shape
        require_sides(r, c)
        found: dict[int, Entry] = {}
        for i, j, value in entries:
            if not (0 <= i < r and 0 <= j < c):
                raise InputError(
                    f"expected a position inside {r} × {c}, found ({i}, {j})", where=where
                )
            if i * c + j in found:
                raise InputError(f"the position ({i}, {j}) is given twice", where=where)
            found[i * c + j] = value
        cells = sorted(found)
        if not {type(value) for value in found.values()} <= {int}:
            for k, value in found.items():
                found[k] = as_fraction(value, where=f"{where or ''}[{k // c}][{k % c}]")
        denominator = math.lcm(*{value.denominator for value in found.values()})
        values = (found[k].numerator * (denominator // found[k].denominator) for k in cells)
        return from_cells(shape, cells, values, denominator)

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
        return from_cells((nrows, ncols), (), ())

    @classmethod
    def identity(cls, n: int) -> Matrix:
        """The n × n identity matrix."""
        require_sides(n, n)
        return from_cells((n, n), range(0, n * n, n + 1), (1,) * n)

    @classmethod
    def column(cls, entries: Iterable[Entry]) -> Matrix:
        """The matrix with one column."""
        return cls.from_rows([[entry] for entry in entries], ncols=1)

    @property
    def nrows(self) -> int:
        """Number of rows."""
        return self._table.nrows

    @property
    def ncols(self) -> int:
        """Number of columns."""
        return self._table.ncols

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self._table.nrows, self._table.ncols

    @property
    def is_sparse(self) -> bool:
        """Whether only the entries that are not 0 are kept; equal matrices may differ in this."""
        return isinstance(self._table, SparseTable)

    def suited(self) -> Matrix:
        """The same matrix, sparse if its size and its entries suit that."""
        return Matrix(tables.suited(self._table), self.denominator)

    @property
    def _integer(self) -> flint.fmpz_mat:
        """N in flint's form, which nothing may change."""
        return self._table.integer

    @property
    def numerators(self) -> Rows:
        """The rows of N, with all zeros.

        Raises
        ------
        LimitReached
            The matrix is sparse, and too large to be written out.
        """
        return self._table.rows

    @property
    def words(self) -> array[int] | None:
        """The entries of N row by row as machine words of 64 bits; None if one is longer.

        A matrix that was made of integers has them from the start: others convert each entry.
        """
        return self._table.words

    def nonzero(self) -> Iterator[tuple[int, int, int]]:
        """The entries of N that are not 0, row by row: row, column, numerator.

        Examples
        --------
        >>> list(Matrix.from_rows([[0, "1/2"], [3, 0]]).nonzero())
        [(0, 1, 1), (1, 0, 6)]
        """
        for cell, value in self._table.nonzero():
            yield *divmod(cell, self.ncols), value

    @property
    def T(self) -> Matrix:
        """The transpose."""
        return Matrix(self._table.T, self.denominator)

    @overload
    def __getitem__(self, position: tuple[int, int]) -> Fraction: ...

    @overload
    def __getitem__(self, position: int) -> tuple[Fraction, ...]: ...

    def __getitem__(self, position: tuple[int, int] | int) -> Fraction | tuple[Fraction, ...]:
        """The entry in a row and a column, or a row; positions from 0, and none negative."""
        try:
            i, j = position  # type: ignore[misc]
            inside = 0 <= i < self.nrows and 0 <= j < self.ncols
        except TypeError:
            return row_of(self, position)
        if not inside:
            raise IndexError(f"no entry ({i}, {j}) in a {self.nrows} × {self.ncols} matrix")
        return Fraction(self._table.entry(i, j), self.denominator)

    def __iter__(self) -> Iterator[tuple[Fraction, ...]]:
        """The rows."""
        return iter(self.rows())

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
        return _lowest(self._table.take(rows, cols), self.denominator)

    def is_zero(self) -> bool:
        """Whether every entry is 0; true without entries."""
        return self._table.is_zero()

    def is_square(self) -> bool:
        """Whether there are as many rows as columns."""
        return self.nrows == self.ncols

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Matrix):
            return NotImplemented
        return self.denominator == other.denominator and tables.equal(self._table, other._table)

    def __hash__(self) -> int:
        return hash((self.shape, self.denominator, tuple(self._table.nonzero())))

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
        left = self._table.scaled(denominator // self.denominator)
        right = other._table.scaled(denominator // other.denominator)
        return _lowest(tables.total(left, right, sign), denominator)

    def __neg__(self) -> Matrix:
        return Matrix(self._table.scaled(-1), self.denominator)

    def __matmul__(self, other: Matrix) -> Matrix:
        if not isinstance(other, Matrix):
            return NotImplemented
        if self.ncols != other.nrows:
            raise _shapes_do_not_match("@", self, other)
        made = tables.product(self._table, other._table)
        return _lowest(made, self.denominator * other.denominator)

    def __mul__(self, factor: int | Fraction) -> Matrix:
        if isinstance(factor, bool) or not isinstance(factor, (int, Fraction)):
            return NotImplemented
        p, q = factor.numerator, factor.denominator
        return _lowest(self._table.scaled(p), q * self.denominator)

    __rmul__ = __mul__

    def __truediv__(self, divisor: int | Fraction) -> Matrix:
        if isinstance(divisor, bool) or not isinstance(divisor, (int, Fraction)):
            return NotImplemented
        return self * (1 / Fraction(divisor))

    def power(self, k: int) -> Matrix:
        """The k-th power of a square matrix, k ≥ 0."""
        if not self.is_square():
            raise InputError(f"expected a square matrix, found {self.nrows} × {self.ncols}")
        lengths = (int(x.bit_length()) for x in self._integer.entries())
        k = require_power(k, max(self.denominator.bit_length(), *lengths, 1))
        return from_flint(self._integer**k, self.denominator**k)

    def __reduce__(self) -> tuple[Any, ...]:
        if isinstance(self._table, SparseTable):
            table = self._table
            return from_cells, (self.shape, table.cells, table.values, self.denominator)
        return Matrix.from_integers, (self.numerators, self.denominator, self.ncols)

    def __repr__(self) -> str:
        return pasted(self)


def from_numerators(rows: Sequence[Sequence[int]], denominator: int, ncols: int) -> Matrix:
    """The matrix rows / denominator; the rows are valid, denominator ≠ 0."""
    return _lowest(tables.table_of_rows(rows, ncols), denominator)


def from_cells(
    shape: tuple[int, int], cells: Sequence[int], values: Iterable[int], denominator: int = 1
) -> Matrix:
    """The matrix with values / denominator at increasing cells i·ncols + j, and zeros elsewhere.

    No position is given twice, and denominator ≠ 0.
    """
    require_sides(*shape)
    pairs = [(cell, value) for cell, value in zip(cells, values, strict=True) if value]
    made = tables.table_of_cells(*shape, [cell for cell, _ in pairs], [x for _, x in pairs])
    return _lowest(made, denominator)


def from_flint(table: flint.fmpz_mat, denominator: int = 1) -> Matrix:
    """The matrix table / denominator in lowest terms, denominator ≠ 0."""
    return _lowest(DenseTable(table), denominator)


def _lowest(table: Table, denominator: int) -> Matrix:
    """The matrix table / denominator in lowest terms, denominator ≠ 0."""
    return Matrix(*table.reduced(denominator))


def _shapes_do_not_match(operation: str, a: Matrix, b: Matrix) -> InputError:
    return InputError(
        f"shapes do not match: {a.nrows} × {a.ncols} {operation} {b.nrows} × {b.ncols}"
    )
