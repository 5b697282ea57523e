"""Matrices of rational functions of named parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from mcexact.exact.matrix import Matrix
from mcexact.exact.matrix_forms import MatrixDisplay
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.rational_function import RationalFunction
from mcexact.shown import LINE


@dataclass(frozen=True, repr=False)
class FunctionMatrix(MatrixDisplay):
    """A matrix of rational functions of the same parameters.

    Attributes
    ----------
    rows : tuple of tuples of RationalFunction
    ncols : int
        The number of columns, which no row tells where there is none.
    """

    rows: tuple[tuple[RationalFunction, ...], ...]
    ncols: int

    @property
    def nrows(self) -> int:
        """Number of rows."""
        return len(self.rows)

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return len(self.rows), self.ncols

    def __getitem__(self, position: tuple[int, int]) -> RationalFunction:
        return self.rows[position[0]][position[1]]

    def is_zero(self) -> bool:
        """Whether every entry is the zero function."""
        return not any(map(any, self.rows))

    def take(self, rows: Sequence[int], cols: Sequence[int]) -> FunctionMatrix:
        """The submatrix of some rows and columns."""
        return FunctionMatrix(tuple(tuple(self.rows[i][j] for j in cols) for i in rows), len(cols))

    def tolist(self) -> list[list[RationalFunction]]:
        """The rows as lists of functions."""
        return [list(row) for row in self.rows]

    def to_sympy(self) -> Any:
        """The matrix as one of sympy, whose entries are equal expressions.

        Examples
        --------
        >>> t = RationalFunction.parameter("t", ("t",))
        >>> FunctionMatrix(((t, 1 / t),), 2).to_sympy()
        Matrix([[t, 1/t]])
        """
        import sympy

        return sympy.Matrix(*self.shape, [e.to_sympy() for row in self.rows for e in row])

    _sympy_ = to_sympy

    def __repr__(self) -> str:
        entries = ", ".join(f"[{', '.join(map(str, row))}]" for row in self.rows)
        text = f"FunctionMatrix([{entries}])"
        if len(text) <= LINE:
            return text
        return f"<{self.nrows} × {self.ncols} matrix of functions>"

    def mapped(self, function: Callable[[RationalFunction], RationalFunction]) -> FunctionMatrix:
        """The matrix of the values of a function at the entries."""
        return FunctionMatrix(tuple(tuple(map(function, row)) for row in self.rows), self.ncols)

    def constants(self) -> Matrix:
        """The matrix of numbers that this one is, if all its entries are constant."""
        return Matrix.from_rows([[e.value for e in row] for row in self.rows], ncols=self.ncols)

    @cached_property
    def reduced(self) -> tuple[PolynomialMatrix, Polynomial]:
        """M' and δ with M = M'/δ, δ the least common monic denominator, for one parameter.

        Examples
        --------
        >>> t = RationalFunction.parameter("t", ("t",))
        >>> M, delta = FunctionMatrix(((1 / (t - 1), t / (t * t - 1)),), 2).reduced
        >>> str(M.entry(0, 0)), str(M.entry(0, 1)), str(delta)
        ('x + 1', 'x', 'x^2 - 1')
        """
        entries = [[e.polynomials() for e in row] for row in self.rows]
        common = Polynomial.of(1)
        for row in entries:
            for _, bottom in row:
                common = common * (bottom // common.gcd(bottom))
        common = common * (Fraction(1) / common.leading)
        rows = [[top * (common // bottom) for top, bottom in row] for row in entries]
        return PolynomialMatrix.from_polynomials(rows, ncols=self.ncols), common
