"""Forms of a rational matrix: lists, arrays of numpy, matrices of sympy, text, HTML and LaTeX."""

from __future__ import annotations

import sys
from fractions import Fraction
from html import escape
from typing import TYPE_CHECKING, Any

from mcexact import shown
from mcexact.exact.rational import rational_latex, rational_text
from mcexact.exact.shortened import number

if TYPE_CHECKING:
    import numpy.typing as npt

    from mcexact.exact.matrix import Matrix

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


class MatrixForms(MatrixDisplay):
    """The conversions of `Matrix`, which alone inherits them."""

    def tolist(self: Any) -> list[list[Fraction]]:
        """The rows as lists of Fractions."""
        return lists_of(self)

    def __array__(
        self: Any, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[Any]:
        if copy is False:
            raise ValueError("numpy cannot use the memory of a matrix: leave out copy=False")
        return array_for_caller(self, dtype)

    def to_numpy(self: Any, dtype: npt.DTypeLike | None = None) -> npt.NDArray[Any]:
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
        >>> from mcexact.exact.matrix import Matrix
        >>> M = Matrix.from_rows([[1, "1/3"]])
        >>> M.to_numpy()
        array([[1.        , 0.33333333]])
        >>> M.to_numpy(object)
        array([[Fraction(1, 1), Fraction(1, 3)]], dtype=object)
        """
        return array_of(self, dtype)

    def to_sympy(self: Any) -> Any:
        """The matrix as one of sympy, with equal entries; ``sympy.Matrix(M)`` gives the same.

        Examples
        --------
        >>> from mcexact.exact.matrix import Matrix
        >>> Matrix.from_rows([[1, "1/3"]]).to_sympy()
        Matrix([[1, 1/3]])
        """
        return symbolic(self)

    _sympy_ = to_sympy


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

    from mcexact.exact.floats import matrix_to_float

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
    floats would lose what both sides can represent.  numpy's calls have no frame of numpy.
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
    found: list[list[Any]] = []
    for i in down:
        row: Any = iter(()) if i is None else iter(next(entries))
        found.append([_GAPS[i is None, j is None] if None in (i, j) else next(row) for j in across])
    return found


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
