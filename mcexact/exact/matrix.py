"""Rational matrices: entries, sizes, blocks, conversion from and to rows, floats, numpy.

A `Matrix` is N/d, integer numerators N over one common denominator d, in lowest terms: products
and sums then compute with integers alone.  N is a table of `exact.tables`, dense in flint or
sparse.

Around it stand, in this order: its display and its conversions to lists, numpy, sympy, text, HTML
and LaTeX; the sizes that flint and the memory allow; `rows_of` and `entries_of`, which copy a
matrix-like value of a caller as rows or as stored entries; the class; the size of its entries;
the conversions between floats and rational numbers, for the whole package; and matrices assembled
from blocks.

`Matrix.from_rows` and `Matrix.from_entries` refuse floats.  `from_float`, `matrix_from_float` and
`dyadic_matrix` convert them explicitly, by a rounding that is named; `as_requested` takes a float
as the decimal that it prints, since a rate that a user asks for is no measurement.
"""

from __future__ import annotations

import math
import sys
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from decimal import Context, Decimal
from fractions import Fraction
from html import escape
from itertools import accumulate
from typing import TYPE_CHECKING, Any, Literal, get_args, overload

import flint

from mcexact import shown
from mcexact.errors import FloatRefused, InputError, LimitReached, one_of
from mcexact.exact import tables
from mcexact.exact.rational import (
    TWO_WAYS_IN,
    Entry,
    as_fraction,
    number,
    rational_latex,
    rational_text,
    require_power,
)
from mcexact.exact.tables import DenseTable, SparseTable, Table
from mcexact.exact.tables import Rows as Rows

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt


# Display, and conversions to lists, numpy, sympy, text, HTML and LaTeX.

_LONGEST = 60
MOST_SHOWN = 12
"""The rows, and the columns, of the largest matrix that is shown completely."""
_DOTS = {"⋱": r"\ddots", "⋮": r"\vdots", "…": r"\cdots"}
_GAPS = {(True, True): "⋱", (True, False): "⋮", (False, True): "…"}


class MatrixDisplay:
    """The display of matrices of numbers and of functions."""

    def __str__(self: Any) -> str:
        return aligned(self)

    def _repr_pretty_(self, printer: Any, cycle: bool) -> None:
        printer.text(repr(self))

    def _html(self: Any) -> str:
        """The matrix as a piece of HTML."""
        return html(self)

    def _latex(self: Any) -> str:
        """The matrix as a piece of LaTeX."""
        return latex(self)

    def _repr_html_(self) -> str:
        return shown.framed(self._html())

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self._latex()}$"


def row_of(M: Matrix, i: Any) -> tuple[Fraction, ...]:
    """Return a row as a tuple.

    Raises
    ------
    IndexError
        If there is no such row.
    TypeError
        If it is not a position, such as a slice.
    """
    if not hasattr(i, "__index__"):
        raise TypeError(
            "expected the position of a row, or of a row and a column; "
            "M.take(rows=[…], cols=[…]) gives a submatrix"
        )
    return M.take(rows=[i.__index__()]).rows()[0]


def lists_of(M: Matrix) -> list[list[Fraction]]:
    """Return the rows of a matrix as lists of Fractions."""
    return [list(row) for row in M.rows()]


def array_of(M: Matrix, dtype: npt.DTypeLike | None = None) -> npt.NDArray[Any]:
    """Return a matrix as an array of numpy.

    Parameters
    ----------
    M : Matrix
    dtype : dtype, optional
        By default float64: each entry becomes the float nearest to it.  The dtype ``object`` keeps
        the entries as Fractions, and one of integers keeps integers.

    Raises
    ------
    ValueError
        If integers are asked for, and an entry is not one, or does not fit.
    """
    import numpy as np

    kind = np.dtype(np.float64 if dtype is None else dtype)
    if kind.kind not in "Oiu":
        return matrix_to_float(M).astype(kind)
    if kind.kind == "O":
        exact = np.full(M.shape, Fraction(0), dtype=object)
        for i, j, entry in M.nonzero():
            exact[i, j] = Fraction(entry, M.denominator)
        return exact
    if M.denominator != 1:
        raise ValueError("the matrix has entries that are not integers: leave out the dtype")
    whole, limits = np.zeros(M.shape, dtype=kind), np.iinfo(kind)
    for i, j, entry in M.nonzero():
        if not limits.min <= entry <= limits.max:
            raise ValueError(f"the matrix has entries that {kind} cannot hold")
        whole[i, j] = entry
    return whole


def array_for_caller(M: Matrix, dtype: npt.DTypeLike | None, depth: int = 2) -> npt.NDArray[Any]:
    """Return what ``__array__`` gives: floats to numpy, and the exact entries to sympy.

    ``sympy.Matrix(M)`` calls ``M.__array__()`` itself and takes the entries one by one, so that
    floats would lose what both sides can represent.  ``numpy.asarray(M)`` makes the same call, with
    the same arguments and without a frame of numpy: only the module of the caller tells the two
    apart, so it is looked up in the frame ``depth`` levels up.
    """
    caller = sys._getframe(depth).f_globals.get("__name__", "")
    if dtype is None and str(caller).partition(".")[0] == "sympy":
        return array_of(M, object)
    return array_of(M, dtype)


def symbolic(M: Matrix) -> Any:
    """Return a matrix as one of sympy, whose entries are equal."""
    import sympy

    entries = [sympy.Rational(x.numerator, x.denominator) for row in M.rows() for x in row]
    return sympy.Matrix(*M.shape, entries)


def pasted(M: Matrix) -> str:
    """Return an expression that makes the matrix again, or a summary in one line if it is long."""
    r, c = M.shape
    if not (r and c):
        return f"Matrix.zeros({r}, {c})"
    if r * c <= shown.LINE:
        rows = ", ".join("[" + ", ".join(map(_literal, row)) + "]" for row in M.rows())
        if len(rows) + len("Matrix.from_rows([])") <= shown.LINE:
            return f"Matrix.from_rows([{rows}])"
    first = [number(x) for x in M.take(rows=[0], cols=range(min(c, 4))).rows()[0]]
    left = ", … " + f"{c - len(first)} more" if c > len(first) else ""
    below = f", … {r - 1} more" if r > 1 else ""
    return f"<{r} × {c} matrix [[{', '.join(first)}{left}]{below}]>"


def _literal(x: Fraction) -> str:
    text = rational_text(x)
    return repr(text) if "/" in text else text


def shortened(M: Any) -> list[list[Any]]:
    """Return the entries to show, with dots in the place of middle rows and columns."""
    down, across = shown.kept(M.nrows, MOST_SHOWN), shown.kept(M.ncols, MOST_SHOWN)
    rows, cols = [i for i in down if i is not None], [j for j in across if j is not None]
    entries = iter(M.take(rows=rows, cols=cols).tolist())
    lines: list[list[Any]] = []
    for i in down:
        row: Any = iter(()) if i is None else iter(next(entries))
        lines.append([_GAPS[i is None, j is None] if None in (i, j) else next(row) for j in across])
    return lines


def aligned(M: Any) -> str:
    """Return the matrix as lines of text with columns that are aligned on the right."""
    if not (M.nrows and M.ncols):
        return f"[] ({M.nrows} × {M.ncols})"
    table = [[_text(x) for x in row] for row in shortened(M)]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    lines = [
        "[" + "  ".join(x.rjust(width) for x, width in zip(row, widths, strict=True)) + "]"
        for row in table
    ]
    elided = max(M.shape) > MOST_SHOWN
    return "\n".join([*lines, f"({M.nrows} × {M.ncols})"] if elided else lines)


def html(M: Any) -> str:
    """Return the matrix as a piece of HTML, in brackets."""
    if not (M.nrows and M.ncols):
        return f"{M.nrows} × {M.ncols}, no entries"
    rows = "".join(
        "<tr>" + "".join(f"<td>{escape(_text(x))}</td>" for x in row) + "</tr>"
        for row in shortened(M)
    )
    size = f"<div>{M.nrows} × {M.ncols}</div>" if max(M.shape) > MOST_SHOWN else ""
    return f'<table class="matrix"><tbody>{rows}</tbody></table>{size}'


def latex(M: Any, *, whole: bool = False) -> str:
    r"""Return the matrix as LaTeX.

    Parameters
    ----------
    M : Matrix or FunctionMatrix
    whole : bool
        Whether every entry is written, exactly; else a large matrix has dots in the place of middle
        rows and columns, and long numbers are rounded.

    Examples
    --------
    >>> from mcexact.exact.matrix import Matrix
    >>> print(latex(Matrix.from_rows([["1/2", 0]])))
    \begin{bmatrix} \tfrac{1}{2} & 0 \end{bmatrix}
    """
    rows = r" \\ ".join(
        " & ".join(_DOTS[x] if isinstance(x, str) else _latex_of(x, whole) for x in row)
        for row in (M.tolist() if whole else shortened(M))
    )
    return rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}"


def _text(x: Any) -> str:
    """An entry, or the dots in its place."""
    if isinstance(x, str):
        return x
    return number(x) if isinstance(x, Fraction) else shown.fitting(str(x), _LONGEST)


def _latex_of(x: Any, whole: bool) -> str:
    if not isinstance(x, Fraction):
        return str(x.latex())
    if whole or len(rational_text(x)) <= 24:
        return rational_latex(x, "tfrac")
    return rf"\text{{{number(x)}}}"


# Checks of sizes and positions.

# 2 GiB of machine words
_MOST_ENTRIES = 2**28


def require_sides(nrows: int, ncols: int) -> None:
    """Raise an error for numbers of rows and columns that no matrix has."""
    for size, name in ((nrows, "rows"), (ncols, "columns")):
        if type(size) is not int or size < 0:
            raise InputError(f"expected a number of {name} that is at least 0, found {size!r}")
    if max(nrows, ncols) > _MOST_ENTRIES:
        raise _too_large(nrows, ncols)


def require_sizes(nrows: int, ncols: int) -> None:
    """Raise an error for sizes for which flint would abort, or that exceed the memory."""
    require_sides(nrows, ncols)
    if nrows * ncols > _MOST_ENTRIES:
        raise _too_large(nrows, ncols)


def _too_large(nrows: int, ncols: int) -> LimitReached:
    return LimitReached(
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


# Conversion of matrix-like values to rows: nested lists, arrays, sparse and symbolic matrices.

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
        kind = "a string" if isinstance(value, (str, bytes)) else type(value).__name__
        raise InputError(
            f"expected a matrix as a list of rows, found {kind}; write [[1, 2], [3, 4]]",
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
    """Whether an array holds floats of another length than Python's, such as single precision."""
    dtype: Any = getattr(array, "dtype", None)
    return getattr(dtype, "kind", "") == "f" and dtype.itemsize != 8


def _scalars(array: Any) -> list[Any]:
    """The numbers of an array of one dimension; ``tolist`` would widen floats to Python's."""
    scalars: list[Any] = list(array) if _is_of_other_length(array) else array.tolist()
    return scalars


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
    value_at: dict[tuple[int, int], Any] = {}
    stored = value.tocoo()
    for i, j, entry in zip(
        stored.row.tolist(), stored.col.tolist(), _scalars(stored.data), strict=True
    ):
        value_at[i, j] = value_at[i, j] + entry if (i, j) in value_at else entry
    return [(i, j, entry) for (i, j), entry in value_at.items()]


def _is_sequence(value: Any) -> bool:
    return hasattr(value, "__iter__") and not isinstance(value, (str, bytes, dict))


def common_width(rows: Sequence[Sequence[Any]], where: str | None = None) -> int | None:
    """Return the number of entries of each row; None if there are no rows.

    Raises
    ------
    InputError
        If the rows have different numbers of entries.
    """
    for k, row in enumerate(rows):
        if len(row) != len(rows[0]):
            raise InputError(
                f"expected {len(rows[0])} entries as in row 0, found {len(row)}",
                where=f"{where or ''}[{k}]",
            )
    return len(rows[0]) if rows else None


# Rational matrices: integer numerators over one common denominator.


@dataclass(frozen=True, eq=False, repr=False)
class Matrix(MatrixDisplay):
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
        # In lowest terms: what divides the denominator does not divide all numerators.
        return cls(*tables.over_one_denominator(fractions, width))

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
        value_at: dict[int, Entry] = {}
        for i, j, value in entries:
            if not (0 <= i < r and 0 <= j < c):
                raise InputError(
                    f"expected a position inside {r} × {c}, found ({i}, {j})", where=where
                )
            if i * c + j in value_at:
                raise InputError(f"the position ({i}, {j}) is given twice", where=where)
            value_at[i * c + j] = value
        cells = sorted(value_at)
        if not {type(value) for value in value_at.values()} <= {int}:
            for k, value in value_at.items():
                value_at[k] = as_fraction(value, where=f"{where or ''}[{k // c}][{k % c}]")
        denominator = math.lcm(*{value.denominator for value in value_at.values()})
        values = (value_at[k].numerator * (denominator // value_at[k].denominator) for k in cells)
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
        """The matrix in the form, sparse or dense, that suits its size and its entries."""
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
        table = tables.product(self._table, other._table)
        return _lowest(table, self.denominator * other.denominator)

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

    def tolist(self) -> list[list[Fraction]]:
        """The rows as lists of Fractions."""
        return lists_of(self)

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[Any]:
        if copy is False:
            raise ValueError("numpy cannot use the memory of a matrix: leave out copy=False")
        return array_for_caller(self, dtype)

    def to_numpy(self, dtype: npt.DTypeLike | None = None) -> npt.NDArray[Any]:
        """The matrix as an array of numpy, in floats unless another dtype is given.

        Parameters
        ----------
        dtype : dtype, optional
            By default float64: each entry is rounded to the float nearest to it.  ``object`` keeps
            the entries as Fractions, and integers stay integers.

        Raises
        ------
        ValueError
            Integers are asked for, and an entry is not one, or does not fit.

        Examples
        --------
        >>> M = Matrix.from_rows([[1, "1/3"]])
        >>> M.to_numpy()
        array([[1.        , 0.33333333]])
        >>> M.to_numpy(object)
        array([[Fraction(1, 1), Fraction(1, 3)]], dtype=object)
        """
        return array_of(self, dtype)

    def to_sympy(self) -> Any:
        """The matrix as one of sympy, with equal entries; ``sympy.Matrix(M)`` gives the same.

        Examples
        --------
        >>> Matrix.from_rows([[1, "1/3"]]).to_sympy()
        Matrix([[1, 1/3]])
        """
        return symbolic(self)

    _sympy_ = to_sympy

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
    table = tables.table_of_cells(*shape, [cell for cell, _ in pairs], [x for _, x in pairs])
    return _lowest(table, denominator)


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


# The bit length and the size of the entries of matrices.


def bit_length(matrices: Iterable[Matrix]) -> int:
    """Return the bits of the longest reduced numerator or denominator of the entries, or 0.

    Examples
    --------
    >>> bit_length([Matrix.from_rows([["1/8", 3]]), Matrix.zeros(0, 2)])
    4
    """
    longest = 0
    for M in matrices:
        d = M.denominator
        for entry in {x for _, _, x in M.nonzero()}:
            # For most entries the bound without cancellation is already small enough.
            if max(entry.bit_length(), d.bit_length()) > longest:
                p, q = Fraction(entry, d).as_integer_ratio()
                longest = max(longest, p.bit_length(), q.bit_length())
    return longest


def largest_entry(matrices: Iterable[Matrix]) -> Fraction:
    """Return the largest absolute value of the entries; 0 without entries.

    Examples
    --------
    >>> largest_entry([Matrix.from_rows([["-3/2", 1]]), Matrix.identity(2)])
    Fraction(3, 2)
    """
    return max(
        (
            Fraction(max((abs(x) for _, _, x in M.nonzero()), default=0), M.denominator)
            for M in matrices
        ),
        default=Fraction(0),
    )


# Conversions between floats and rational numbers and matrices, for the whole package.

Rounding = Literal["decimal", "dyadic", "simplest"]
_ROUNDINGS = get_args(Rounding)
BINARY: Rounding = "simplest"
"""The rounding of plants in floats where the caller names none."""
_READ_AS: dict[Rounding, str] = {
    "decimal": "the shortest decimal that prints it",
    "dyadic": "the binary fraction that is stored",
    "simplest": "a short fraction or decimal within 4 units in the last place, or else as the "
    "shortest decimal that prints it",
}

LARGEST_WHOLE = 2**53
"""Floats hold every integer up to here."""


def finite(number: float) -> float | None:
    """The number; None for what JSON does not have, an infinity or NaN."""
    return number if math.isfinite(number) else None


def reading_in_words(rounding: Rounding) -> str:
    """Say how floats were read.

    Examples
    --------
    >>> reading_in_words("dyadic")
    'rounding dyadic: each float was read as the binary fraction that is stored'
    """
    return f"rounding {rounding}: each float was read as {_READ_AS[rounding]}"


def from_float(x: float, rounding: Rounding, *, where: str | None = None) -> Fraction:
    """Convert a float to a rational number.

    Parameters
    ----------
    x : float
        A finite float or numpy floating-point scalar.
    rounding : {"decimal", "dyadic", "simplest"}
        "decimal" reads the shortest decimal that prints the float in its own precision (0.1 is
        1/10, also in single precision), "dyadic" the binary fraction that is stored, and "simplest"
        a short fraction or decimal within 4 units in the last place, if there is one.

    Raises
    ------
    InputError
        The number is not real or not finite, or the rounding is unknown.

    Notes
    -----
    In double precision "simplest" is the first of these that exists:

    1. the integer, if the float is one and at most 2**53;
    2. a fraction p/q ≠ 0 within 4 units in the last place, whose p and q have at most 44 bits
       together, if p and q, or its decimal, have no more digits than the shortest decimals of the
       float and of the float nearest to p/q;
    3. the shortest decimal, if it has at most 15 digits;
    4. a decimal of at most 11 digits within 4 units, if the float nearest to it is read as it;
    5. the shortest decimal.

    Reading the result again changes nothing: two fractions of 44 bits differ by 2**-44 of their
    size or more, and two decimals of 11 digits by 1e-11, far more than 4 units, so that the float
    nearest to the result leads to the same one.  In a precision of P bits, which always keeps D
    decimal digits, the bounds are P − 9 bits, D digits and D − 4 digits.

    Examples
    --------
    >>> from_float(0.1, "decimal")
    Fraction(1, 10)
    >>> from_float(0.1, "dyadic")
    Fraction(3602879701896397, 36028797018963968)
    >>> from_float(1.7 / 12, "simplest"), from_float(0.1 + 0.2, "simplest")
    (Fraction(17, 120), Fraction(3, 10))
    >>> from_float(2**0.5, "simplest") == from_float(2**0.5, "decimal")
    True
    >>> import numpy
    >>> from_float(numpy.float32(0.1), "decimal"), from_float(numpy.float32(0.1), "dyadic")
    (Fraction(1, 10), Fraction(13421773, 134217728))
    """
    one_of(rounding, _ROUNDINGS, "rounding", InputError)
    shape = getattr(x, "shape", ())
    if shape:
        raise InputError(f"expected a number, found an array of shape {shape}", where=where)
    if isinstance(x, complex) or getattr(getattr(x, "dtype", None), "kind", "") == "c":
        raise InputError(f"expected a real number, found {type(x).__name__}", where=where)
    # A numpy scalar stays as it is: Python's floats are longer than some and shorter than others.
    value = x if hasattr(x, "as_integer_ratio") else float(x)
    try:
        if rounding == "simplest":
            return _simplest(value)
        # Python's and numpy's floats are printed with the fewest digits that tell them apart.
        return Fraction(*value.as_integer_ratio()) if rounding == "dyadic" else Fraction(str(value))
    except (OverflowError, ValueError):
        raise InputError(f"expected a finite number, found {float(x)!r}", where=where) from None


# A result of the rounding "simplest" is at most so many units in the last place from the float.
_UNITS = 4


@dataclass(frozen=True)
class _Precision:
    """What is short for floats of P bits that always keep some number of decimal digits."""

    bits: int
    digits: int

    @property
    def most_bits(self) -> int:
        """A fraction is short if numerator and denominator have at most so many bits together."""
        return self.bits - 9

    @property
    def few_digits(self) -> int:
        """A decimal is short if it has at most so many digits."""
        return self.digits - 4

    def is_near(self, p: int, q: int, n: int, d: int) -> bool:
        """Whether p/q is within `_UNITS` of n/d > 0, where d is a power of 2 and q > 0.

        A unit is 2**(e − P), where n/d is from 2**(e−1) to 2**e, so that d * 2**e has the bits of n
        as its exponent.  Floats below the normal ones have larger units.
        """
        return abs(n * q - p * d) << self.bits <= _UNITS * q << n.bit_length()

    def fraction_near(self, n: int, d: int) -> tuple[int, int] | None:
        """Return the short fraction near n/d > 0, in lowest terms; None if there is none.

        Such a fraction p/q differs from n/d by less than 1/(2q²), so it is a convergent of the
        continued fraction, by Legendre's theorem.
        """
        a, b = n, d
        p, q, before = 1, 0, (0, 1)
        while b:
            k, rest = divmod(a, b)
            p, q, before = k * p + before[0], k * q + before[1], (p, q)
            if p.bit_length() + q.bit_length() > self.most_bits:
                return None
            if self.is_near(p, q, n, d):
                return p, q
            a, b = b, rest
        return None


_DOUBLE = _Precision(sys.float_info.mant_dig, sys.float_info.dig)


def _precision(kind: Any) -> _Precision:
    """The precision of numpy's floats of some dtype."""
    import numpy as np

    info = np.finfo(kind)
    return _Precision(int(info.nmant) + 1, int(info.precision))


def _simplest(value: Any) -> Fraction:
    """Convert by the rounding "simplest"; what is exact already does not change."""
    n, d = value.as_integer_ratio()
    if isinstance(value, float):
        value, precision = float(value), _DOUBLE
    elif hasattr(value, "dtype"):
        precision = _precision(value.dtype)
    else:
        return Fraction(n, d)
    if d == 1 and abs(n) <= 1 << precision.bits:
        return Fraction(n)
    if n < 0:
        return -_simplest_positive(-value, -n, d, precision)
    return _simplest_positive(value, n, d, precision)


def _simplest_positive(value: Any, n: int, d: int, precision: _Precision) -> Fraction:
    """Convert a float n/d > 0 by the rules of `from_float`."""
    kind, text = type(value), str(value)
    near = precision.fraction_near(n, d)
    if near is not None:
        # Both integers are floats, so their quotient is the float nearest to the fraction.
        p, q = near
        fraction, again = Fraction(p, q), str(kind(p) / kind(q))
        length = len(str(p)) + len(str(q))
        if Fraction(again) == fraction:
            length = min(length, _digits(again))
        if length <= min(_digits(text), _digits(again)):
            return fraction
    if _digits(text) > precision.digits and precision.few_digits > 0:
        context = Context(prec=precision.few_digits)
        short = context.divide(Decimal(n), Decimal(d))
        if precision.is_near(*short.as_integer_ratio(), n, d):
            decimal = Fraction(short)
            # The float nearest to it prints few digits, so this goes no deeper.
            if _simplest(kind(str(short))) == decimal:
                return decimal
    return Fraction(text)


def _digits(text: str) -> int:
    """Count the significant digits of a printed decimal.

    Examples
    --------
    >>> _digits("-0.0120"), _digits("1e-20"), _digits("300.0")
    (2, 1, 1)
    """
    return len(text.partition("e")[0].replace(".", "").strip("-0"))


def as_requested(number: Any, *, where: str | None = None) -> Fraction:
    """Convert a number that a caller requests, such as a rate.

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
    if _is_float(number):
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
    above = to_float(q)
    if above == -math.inf:
        above = math.nextafter(above, 0.0)
    while math.isfinite(above) and min(Fraction(above), Fraction(repr(above))) < q:
        above = math.nextafter(above, math.inf)
    return above


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
    rounding : {"decimal", "dyadic", "simplest"}
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


def has_rounded(M: Any) -> bool:
    """Whether a matrix-like value has a float that may be a rounded number.

    Integers up to 2**53 are floats, which every rounding reads as these integers.

    Examples
    --------
    >>> has_rounded([[1, 2.0]]), has_rounded([[1, 0.5]]), has_rounded([[1e300]])
    (False, True, True)
    """
    if isinstance(M, Matrix):
        return False
    if is_sparse_array(M):
        M = M.tocoo().data
    kind = getattr(getattr(M, "dtype", None), "kind", "O")
    if kind == "O":
        return any(_may_be_rounded(x) for row in rows_of(M, floats=True) for x in row)
    if kind != "f":
        return False
    import numpy as np

    # In half precision the limit would be an infinity.
    return bool(np.any((np.abs(M) > np.float64(LARGEST_WHOLE)) | (M != np.round(M))))


def _may_be_rounded(entry: Any) -> bool:
    return _is_float(entry) and not (entry == entry // 1 and abs(entry) <= LARGEST_WHOLE)


def _is_float(entry: Any) -> bool:
    """Whether it is a float of Python or numpy."""
    return isinstance(entry, float) or getattr(getattr(entry, "dtype", None), "kind", "") == "f"


def _exact(entry: Any, rounding: Rounding, where: str) -> Fraction | int:
    """Convert one entry; an integer of any length does not change."""
    if _is_float(entry):
        return from_float(entry, rounding, where=where)
    kind = getattr(getattr(entry, "dtype", None), "kind", "")
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
    if table is not None and max(M.denominator, int(np.abs(table).max(initial=0))) <= LARGEST_WHOLE:
        return table / np.float64(M.denominator)
    entries = [[_quotient(entry, M.denominator) for entry in row] for row in M.numerators]
    return np.array(entries, dtype=np.float64).reshape(M.shape)


# Assembly of rational matrices from blocks.


def hstack(matrices: Sequence[Matrix], nrows: int | None = None) -> Matrix:
    """Return the matrix [M1 M2 …].

    Parameters
    ----------
    matrices : sequence of Matrix
        All with the same number of rows.
    nrows : int, optional
        This number, which is required if there may be no matrices.

    Examples
    --------
    >>> hstack([Matrix.identity(2), Matrix.column([5, 6])]).numerators
    ((1, 0, 5), (0, 1, 6))
    >>> hstack([], nrows=2).shape
    (2, 0)
    """
    height = _common(matrices, [M.nrows for M in matrices], nrows, "rows", "hstack")
    width = sum(M.ncols for M in matrices)
    if any(M.is_sparse for M in matrices):
        left = offsets(M.ncols for M in matrices)
        return _placed((height, width), [(M, 0, j) for M, j in zip(matrices, left, strict=False)])
    tables, denominator = _over_one_denominator(matrices)
    rows = [[entry for table in tables for entry in table[i]] for i in range(height)]
    return from_numerators(rows, denominator, width)


def vstack(matrices: Sequence[Matrix], ncols: int | None = None) -> Matrix:
    """Return the matrix [M1; M2; …].

    Parameters
    ----------
    matrices : sequence of Matrix
        All with the same number of columns.
    ncols : int, optional
        This number, which is required if there may be no matrices.

    Raises
    ------
    InputError
        If the numbers of columns differ, or there are no matrices and no number.

    Examples
    --------
    >>> vstack([Matrix.identity(2), Matrix.from_rows([[5, "1/2"]])]).rows()[2]
    (Fraction(5, 1), Fraction(1, 2))
    """
    width = _common(matrices, [M.ncols for M in matrices], ncols, "columns", "vstack")
    if any(M.is_sparse for M in matrices):
        top = offsets(M.nrows for M in matrices)
        shape = sum(M.nrows for M in matrices), width
        return _placed(shape, [(M, i, 0) for M, i in zip(matrices, top, strict=False)])
    tables, denominator = _over_one_denominator(matrices)
    return from_numerators([row for table in tables for row in table], denominator, width)


def block(rows: Sequence[Sequence[Matrix]]) -> Matrix:
    """Return the matrix assembled from rows of blocks.

    At least one row of blocks, each with at least one block.

    Examples
    --------
    >>> I = Matrix.identity(1)
    >>> block([[I, 2 * I], [3 * I, 4 * I]]).numerators
    ((1, 2), (3, 4))
    """
    if not rows:
        raise InputError("block: expected at least one row of blocks")
    return vstack([hstack(row) for row in rows])


def block_diagonal(matrices: Sequence[Matrix]) -> Matrix:
    """Return the matrix diag(M1, M2, …); blocks may have no rows or no columns.

    Examples
    --------
    >>> block_diagonal([Matrix.identity(1), Matrix.zeros(0, 2), Matrix.identity(1)]).numerators
    ((1, 0, 0, 0), (0, 0, 0, 1))
    """
    top, left = offsets(M.nrows for M in matrices), offsets(M.ncols for M in matrices)
    shape = sum(M.nrows for M in matrices), sum(M.ncols for M in matrices)
    return _placed(shape, list(zip(matrices, top, left, strict=False)))


def kronecker(A: Matrix, B: Matrix) -> Matrix:
    """Return the Kronecker product, the block matrix of all a_ij B.

    Examples
    --------
    >>> kronecker(Matrix.from_rows([[1, 2]]), Matrix.identity(2)).numerators
    ((1, 0, 2, 0), (0, 1, 0, 2))
    """
    shape = A.nrows * B.nrows, A.ncols * B.ncols
    small = list(B.nonzero())
    value_at = {
        (i * B.nrows + k) * shape[1] + j * B.ncols + l: a * b
        for i, j, a in A.nonzero()
        for k, l, b in small
    }
    cells = sorted(value_at)
    return from_cells(shape, cells, map(value_at.__getitem__, cells), A.denominator * B.denominator)


def _placed(shape: tuple[int, int], parts: Sequence[tuple[Matrix, int, int]]) -> Matrix:
    """The matrix that is 0 except for parts, each with the position of its first row and column."""
    require_sides(*shape)
    denominator = math.lcm(*(M.denominator for M, _, _ in parts))
    value_at = {
        (top + i) * shape[1] + left + j: x * (denominator // M.denominator)
        for M, top, left in parts
        for i, j, x in M.nonzero()
    }
    cells = sorted(value_at)
    return from_cells(shape, cells, map(value_at.__getitem__, cells), denominator)


def offsets(sizes: Iterable[int]) -> list[int]:
    """The positions where consecutive parts of these sizes begin, and where the last one ends.

    Examples
    --------
    >>> offsets([2, 0, 3])
    [0, 2, 2, 5]
    """
    return [0, *accumulate(sizes)]


def _common(
    matrices: Sequence[Matrix], sizes: list[int], number: int | None, name: str, caller: str
) -> int:
    numbers = set(sizes) | (set() if number is None else {number})
    if not numbers:
        raise InputError(f"{caller}: expected at least one matrix, or the number of {name}")
    if len(numbers) > 1:
        raise InputError(f"{caller}: expected equal numbers of {name}, found {sorted(numbers)}")
    return numbers.pop()


def _over_one_denominator(matrices: Sequence[Matrix]) -> tuple[list[Rows], int]:
    denominator = math.lcm(*(M.denominator for M in matrices))
    return [(M * denominator).numerators for M in matrices], denominator
