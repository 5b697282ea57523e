"""The arithmetics of a simulation: rational numbers, multiple precision, or double precision.

Vectors are columns that can be added, scaled and multiplied by matrices from the left.  The code of
the agents and of the plant uses these operations alone, so it is the same for all arithmetics.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float

Native = Any
"""A matrix or column of an arithmetic: `Matrix`, ``mpmath.matrix`` or ``numpy.ndarray``."""


class Arithmetic(Protocol):
    """The numbers of a simulation, into which exact matrices are converted."""

    @property
    def name(self) -> str:
        """The name that `simulate` takes for it."""
        ...

    def convert(self, M: Matrix) -> Native:
        """A matrix or column in native numbers."""
        ...

    def scalar(self, value: Fraction) -> Any:
        """A number by which native matrices can be multiplied."""
        ...

    def entries(self, column: Native) -> list[Any]:
        """The entries of a column as native numbers."""
        ...

    def largest(self, column: Native) -> float:
        """The largest absolute value, as a float for control and display."""
        ...


@dataclass(frozen=True)
class ExactArithmetic:
    """Rational numbers."""

    name: str = "exact"

    def convert(self, M: Matrix) -> Native:
        """The matrix itself."""
        return M

    def scalar(self, value: Fraction) -> Fraction:
        """The number itself."""
        return value

    def entries(self, column: Matrix) -> list[Any]:
        """Fractions."""
        return [Fraction(row[0], column.denominator) for row in column.numerators]

    def largest(self, column: Matrix) -> float:
        """The largest absolute value; infinity where it exceeds every float."""
        return to_float(max(map(abs, self.entries(column)), default=0))


class MultiprecisionArithmetic:
    """Floating point with a given number of decimal digits (mpmath).

    Parameters
    ----------
    digits : int
        The number of digits that the results should have; half as many more are computed.
    """

    name = "multiprecision"

    def __init__(self, digits: int) -> None:
        from mpmath import MPContext

        self.context = MPContext()
        # The terms of a Taylor series may exceed their sum by some digits, which these make up for.
        self.context.dps = digits + digits // 2 + 10

    def convert(self, M: Matrix) -> Native:
        """An ``mpmath.matrix``, every entry rounded once."""
        converted = self.context.matrix(M.nrows, M.ncols)
        for i, row in enumerate(M.numerators):
            for j, entry in enumerate(row):
                if entry:
                    converted[i, j] = self.context.mpf(entry) / M.denominator
        return converted

    def scalar(self, value: Fraction) -> Any:
        """A multiple-precision number."""
        return self.context.mpf(value.numerator) / value.denominator

    def entries(self, column: Native) -> list[Any]:
        """Multiple-precision numbers."""
        return [column[i, 0] for i in range(column.rows)]

    def largest(self, column: Native) -> float:
        """The largest absolute value."""
        return max((abs(float(entry)) for entry in self.entries(column)), default=0.0)


@dataclass(frozen=True)
class DoubleArithmetic:
    """Double precision (numpy)."""

    name: str = "float"

    def convert(self, M: Matrix) -> Native:
        """An array of floats, every entry rounded once.

        Raises
        ------
        LimitReached
            If an entry exceeds the range of floats.
        """
        return representable(matrix_to_float(M))

    def scalar(self, value: Fraction) -> float:
        """A float."""
        return to_float(value)

    def entries(self, column: Native) -> list[Any]:
        """Floats."""
        return [float(entry) for entry in column[:, 0]]

    def largest(self, column: Native) -> float:
        """The largest absolute value."""
        return float(abs(column).max()) if column.size else 0.0


def representable(numbers: Any) -> Any:
    """Return an array of floats, which has no infinity and no NaN.

    Raises
    ------
    LimitReached
        If it has one.
    """
    import numpy as np

    if not np.all(np.isfinite(numbers)):
        raise LimitReached(
            "the trajectory has numbers beyond the range of double precision; "
            "use multiprecision arithmetic or a shorter horizon"
        )
    return numbers


def arithmetic_named(name: str, digits: int = 60) -> Arithmetic:
    """Return the arithmetic with a name: "exact", "multiprecision" or "float".

    Raises
    ------
    UsageError
        If the name is none of these.
    """
    if name == "exact":
        return ExactArithmetic()
    if name == "multiprecision":
        return MultiprecisionArithmetic(digits)
    if name == "float":
        return DoubleArithmetic()
    raise UsageError(
        f"expected the arithmetic exact, multiprecision or float, found {name!r}",
        where="arithmetic",
    )
