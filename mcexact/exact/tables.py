"""Tables of integers, the numerators of matrices: all entries in flint, or those that are not 0.

`DenseTable` and `SparseTable` have the same methods.  `table_of_rows`, `table_of_cells` and
`suited` choose between them: a table is sparse if it has at least 2**11 cells of which at most an
eighth are not 0.  Operations of flint give dense tables, and a sparse one takes flint's form only
when an algorithm asks for it, up to 2**25 cells.
"""

from __future__ import annotations

from array import array
from bisect import bisect_left
from collections.abc import Collection, Iterable, Iterator, Sequence
from fractions import Fraction
from functools import cached_property
from itertools import chain
from math import gcd, lcm

import flint

from mcexact.errors import LimitReached

Rows = tuple[tuple[int, ...], ...]
Cells = Sequence[int]
"""Positions i·ncols + j, increasing."""

LEAST_SPARSE = 2**11
"""The cells from which on a table is sparse if most of its entries are 0."""
_SHARE = 8
# From so many bits on, integers are not moved between Python and flint; of more numbers than this
# the least common multiple is longer than each by far.
_LONG, _MANY = 2048, 256

# No text of 64 MiB, the limit of files, lists more entries.
LARGEST_WRITTEN_OUT = 2**25
"""The cells of the largest sparse table that is written out with its zeros."""

# The cost of a product of two entries in a sparse table, in products of entries in flint.
_DEARER = 64


def is_mostly_zero(cells: int, nonzero: int) -> bool:
    """Whether a table is large enough, and few enough entries are not 0, for a sparse form."""
    return cells >= LEAST_SPARSE and _SHARE * nonzero <= cells


def _are_mostly_zero(entries: Sequence[int]) -> bool:
    """As `is_mostly_zero`, for the entries of a table; of a dense one, an eighth is read."""
    nonzero = 0
    for start in range(0, len(entries), LEAST_SPARSE):
        if not is_mostly_zero(len(entries), nonzero):
            return False
        part = entries[start : start + LEAST_SPARSE]
        nonzero += len(part) - part.count(0)
    return is_mostly_zero(len(entries), nonzero)


class DenseTable:
    """A table of integers in flint's form.

    Attributes
    ----------
    integer : fmpz_mat
        Tables and functions of this stage share this object, so nothing may change it.
    nrows, ncols : int
    """

    def __init__(self, table: flint.fmpz_mat) -> None:
        self.integer = table
        self.nrows, self.ncols = table.nrows(), table.ncols()

    @cached_property
    def rows(self) -> Rows:
        """The rows."""
        words, width = self.__dict__.get("words"), self.ncols
        entries = tuple(words or map(int, self.integer.entries()))
        return tuple(entries[i * width : (i + 1) * width] for i in range(self.nrows))

    @cached_property
    def words(self) -> array[int] | None:
        """The entries row by row as machine words of 64 bits; None if one is longer."""
        return _words(list(chain.from_iterable(self.rows)))

    @property
    def T(self) -> DenseTable:
        """The transpose."""
        return DenseTable(self.integer.transpose())

    def entry(self, i: int, j: int) -> int:
        """One entry."""
        return int(self.integer[i, j])

    def nonzero(self) -> Iterator[tuple[int, int]]:
        """The cells whose entry is not 0, in increasing order, and their entries."""
        return ((k, x) for k, x in enumerate(chain.from_iterable(self.rows)) if x)

    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        return not self.integer

    def scaled(self, factor: int) -> DenseTable:
        """All entries times a factor."""
        return self if factor == 1 else DenseTable(self.integer * factor)

    def take(self, rows: Sequence[int] | None, cols: Sequence[int] | None) -> Table:
        """The rows and columns chosen, in this order; None takes all."""
        table = self.rows if rows is None else [self.rows[i] for i in rows]
        if cols is not None:
            table = [tuple(row[j] for j in cols) for row in table]
        return table_of_rows(table, self.ncols if cols is None else len(cols))

    def reduced(self, denominator: int) -> tuple[DenseTable, int]:
        """The table and a denominator, not 0, both divided by their greatest common divisor."""
        if denominator == 1:
            return self, 1
        numerators, least = (flint.fmpq_mat(self.integer) / denominator).numer_denom()
        return DenseTable(numerators), int(least)


class SparseTable:
    """A table of integers that lists those that are not 0.

    Parameters
    ----------
    nrows, ncols : int
    cells : increasing integers
        i·ncols + j for each entry that is not 0.
    values : integers
        These entries.
    """

    def __init__(self, nrows: int, ncols: int, cells: Cells, values: Iterable[int]) -> None:
        self.nrows, self.ncols = nrows, ncols
        self.cells, self.values = array("q", cells), tuple(values)

    @cached_property
    def integer(self) -> flint.fmpz_mat:
        """The table with its zeros.

        Raises
        ------
        LimitReached
            If it is too large.
        """
        self._require_room()
        return self._written_out()

    def _written_out(self) -> flint.fmpz_mat:
        table = flint.fmpz_mat(self.nrows, self.ncols)
        for cell, value in self.nonzero():
            table[divmod(cell, self.ncols)] = value
        return table

    @cached_property
    def rows(self) -> Rows:
        """The rows; those of zeros are one object.

        Raises
        ------
        LimitReached
            If the table is too large.
        """
        self._require_room()
        touched: dict[int, list[int]] = {}
        for cell, value in self.nonzero():
            i, j = divmod(cell, self.ncols)
            touched.setdefault(i, [0] * self.ncols)[j] = value
        zeros = (0,) * self.ncols
        return tuple(tuple(touched[i]) if i in touched else zeros for i in range(self.nrows))

    @cached_property
    def words(self) -> array[int] | None:
        """The entries row by row as machine words of 64 bits; None if one is longer.

        Raises
        ------
        LimitReached
            If the table is too large.
        """
        self._require_room()
        dense, values = array("q", bytes(8 * self.nrows * self.ncols)), _words(self.values)
        for cell, value in zip(self.cells, values or (), strict=False):
            dense[cell] = value
        return None if values is None else dense

    @property
    def T(self) -> SparseTable:
        """The transpose."""
        cells = [(cell % self.ncols) * self.nrows + cell // self.ncols for cell in self.cells]
        return SparseTable(self.ncols, self.nrows, *_sorted(zip(cells, self.values, strict=True)))

    def entry(self, i: int, j: int) -> int:
        """One entry."""
        cell = i * self.ncols + j
        k = bisect_left(self.cells, cell)
        return self.values[k] if k < len(self.cells) and self.cells[k] == cell else 0

    def nonzero(self) -> Iterator[tuple[int, int]]:
        """The cells whose entry is not 0, in increasing order, and their entries."""
        return zip(self.cells, self.values, strict=True)

    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        return not self.values

    def scaled(self, factor: int) -> SparseTable:
        """All entries times a factor."""
        if factor == 1:
            return self
        cells = self.cells if factor else ()
        values = (factor * value for value in self.values) if factor else ()
        return SparseTable(self.nrows, self.ncols, cells, values)

    def take(self, rows: Sequence[int] | None, cols: Sequence[int] | None) -> Table:
        """The rows and columns chosen, in this order; None takes all."""
        down, across = _places(rows), _places(cols)
        width, entries = self.ncols if cols is None else len(cols), []
        for cell, value in self.nonzero() if rows is None else self._in_rows(set(rows)):
            i, j = divmod(cell, self.ncols)
            for a in (i,) if down is None else down.get(i, ()):
                for b in (j,) if across is None else across.get(j, ()):
                    entries.append((a * width + b, value))
        return table_of_cells(self.nrows if rows is None else len(rows), width, *_sorted(entries))

    def _in_rows(self, rows: Collection[int]) -> Iterator[tuple[int, int]]:
        """The cells in some rows, with their values; all of them if these rows are many."""
        if 16 * len(rows) > len(self.cells):
            yield from self.nonzero()
            return
        for i in sorted(rows):
            start, end = (bisect_left(self.cells, k * self.ncols) for k in (i, i + 1))
            yield from zip(self.cells[start:end], self.values[start:end], strict=True)

    def reduced(self, denominator: int) -> tuple[SparseTable, int]:
        """The table and a denominator, not 0, both divided by their greatest common divisor."""
        common = gcd(denominator, *self.values) * (-1 if denominator < 0 else 1)
        if common == 1:
            return self, denominator
        values = (value // common for value in self.values)
        return SparseTable(self.nrows, self.ncols, self.cells, values), denominator // common

    def lines(self) -> dict[int, list[tuple[int, int]]]:
        """The columns and values of the entries of each row that has any."""
        by_row: dict[int, list[tuple[int, int]]] = {}
        for cell, value in self.nonzero():
            i, j = divmod(cell, self.ncols)
            by_row.setdefault(i, []).append((j, value))
        return by_row

    def _require_room(self) -> None:
        if self.nrows * self.ncols > LARGEST_WRITTEN_OUT:
            raise LimitReached(
                f"a sparse {self.nrows} × {self.ncols} matrix has more than {LARGEST_WRITTEN_OUT} "
                "entries when its zeros are written out"
            )


Table = DenseTable | SparseTable


def table_of_rows(rows: Sequence[Sequence[int]], ncols: int) -> Table:
    """The table with these rows, in the form that suits it."""
    entries = list(chain.from_iterable(rows))
    if _are_mostly_zero(entries):
        cells = [k for k, x in enumerate(entries) if x]
        return SparseTable(len(rows), ncols, cells, (entries[k] for k in cells))
    table = DenseTable(flint.fmpz_mat(len(rows), ncols, entries))
    table.__dict__["words"] = _words(entries)
    return table


def over_one_denominator(rows: Sequence[Sequence[Fraction]], ncols: int) -> tuple[Table, int]:
    """The table of the numerators over the least common denominator, and that.

    A long denominator, as of very many quotients, stays in flint's numbers all along.
    """
    denominator = _least_common({x.denominator for row in rows for x in row})
    nonzero = sum(map(bool, chain.from_iterable(rows)))
    if denominator.bit_length() <= _LONG or is_mostly_zero(len(rows) * ncols, nonzero):
        numerators = [[x.numerator * (denominator // x.denominator) for x in row] for row in rows]
        return table_of_rows(numerators, ncols), denominator
    common = flint.fmpz(denominator)
    entries = [common // x.denominator * x.numerator for row in rows for x in row]
    return DenseTable(flint.fmpz_mat(len(rows), ncols, entries)), denominator


def _least_common(numbers: Collection[int]) -> int:
    """The least common multiple; of very many numbers by a tree of pairs."""
    if len(numbers) <= _MANY:
        return lcm(*numbers)
    multiples = [*map(flint.fmpz, numbers)]
    while len(multiples) > 1:
        pairs = zip(multiples[::2], multiples[1::2], strict=False)
        odd = multiples[-1:] if len(multiples) % 2 else []
        multiples = [x.lcm(y) for x, y in pairs] + odd
    return int(multiples[0])


def table_of_cells(nrows: int, ncols: int, cells: Cells, values: Iterable[int]) -> Table:
    """The table with these entries, none of them 0, in the form that suits it."""
    table = SparseTable(nrows, ncols, cells, values)
    if is_mostly_zero(nrows * ncols, len(table.values)):
        return table
    return DenseTable(table._written_out())


def suited(table: Table) -> Table:
    """The table in the form, dense or sparse, that suits its size and its entries."""
    if isinstance(table, DenseTable) and table.nrows * table.ncols >= LEAST_SPARSE:
        words = table.words
        if _are_mostly_zero(list(chain.from_iterable(table.rows)) if words is None else words):
            return listed(table)
    return table


def equal(left: Table, right: Table) -> bool:
    """Whether two tables have the same shape and the same entries."""
    if isinstance(left, DenseTable) and isinstance(right, DenseTable):
        return bool(left.integer == right.integer)
    if (left.nrows, left.ncols) != (right.nrows, right.ncols):
        return False
    a, b = listed(left), listed(right)
    return a.values == b.values and a.cells == b.cells


def total(left: Table, right: Table, sign: int) -> Table:
    """left + sign · right, of the same shape."""
    if isinstance(left, DenseTable) or isinstance(right, DenseTable):
        a, b = left.integer, right.integer
        return DenseTable(a + b if sign > 0 else a - b)
    sums = dict(left.nonzero())
    for cell, value in right.nonzero():
        sums[cell] = sums.get(cell, 0) + sign * value
    return table_of_cells(left.nrows, left.ncols, *_sorted(x for x in sums.items() if x[1]))


def product(left: Table, right: Table) -> Table:
    """left · right; entries that are 0 are skipped where that is less work."""
    if isinstance(left, DenseTable) and isinstance(right, DenseTable):
        return DenseTable(left.integer * right.integer)
    a, lines = listed(left), listed(right).lines()
    terms = sum(len(lines.get(cell % a.ncols, ())) for cell in a.cells)
    if _DEARER * terms > left.nrows * left.ncols * right.ncols:
        largest = max(left.nrows * left.ncols, right.nrows * right.ncols)
        if largest <= LARGEST_WRITTEN_OUT:
            return DenseTable(left.integer * right.integer)
    sums: dict[int, int] = {}
    for cell, value in a.nonzero():
        i, k = divmod(cell, a.ncols)
        start = i * right.ncols
        for j, factor in lines.get(k, ()):
            sums[start + j] = sums.get(start + j, 0) + value * factor
    return table_of_cells(left.nrows, right.ncols, *_sorted(x for x in sums.items() if x[1]))


def listed(table: Table) -> SparseTable:
    """The entries of any table that are not 0."""
    if isinstance(table, SparseTable):
        return table
    pairs = tuple(table.nonzero())
    return SparseTable(table.nrows, table.ncols, [k for k, _ in pairs], (x for _, x in pairs))


def _sorted(pairs: Iterable[tuple[int, int]]) -> tuple[list[int], list[int]]:
    """Cells in increasing order, and their values."""
    ordered = sorted(pairs)
    return [cell for cell, _ in ordered], [value for _, value in ordered]


def _places(chosen: Sequence[int] | None) -> dict[int, list[int]] | None:
    """The new positions of each old one; None if all stay."""
    if chosen is None:
        return None
    positions: dict[int, list[int]] = {}
    for new, old in enumerate(chosen):
        positions.setdefault(old, []).append(new)
    return positions


def _words(entries: Sequence[int]) -> array[int] | None:
    """Integers as machine words; None if one is longer."""
    try:
        return array("q", entries)
    except OverflowError:
        return None
