"""Matrices of rational functions of named parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.rational_function import RationalFunction


@dataclass(frozen=True)
class FunctionMatrix:
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
