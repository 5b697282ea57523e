"""The numbers that a simulation runs in: rationals, multiple precision, or double precision.

Vectors are columns that can be added, scaled and multiplied by matrices from the left; the agents
and the plant are written once, over any of these.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Protocol

from mcexact.exact.floats import matrix_to_float, to_float
from mcexact.exact.matrix import Matrix

Native = Any
"""A matrix or column of an arithmetic: `Matrix`, ``mpmath.matrix`` or ``numpy.ndarray``."""


class Arithmetic(Protocol):
    """How an exact matrix becomes a native one, and how entries come back."""

    @property
    def name(self) -> str:
        """What `simulate` calls it."""
        ...

    def convert(self, M: Matrix) -> Native:
        """A matrix or column in native numbers."""
        ...

    def scalar(self, q: Fraction) -> Any:
        """A factor for native matrices."""
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

    def scalar(self, q: Fraction) -> Fraction:
        """The number itself."""
        return q

    def entries(self, column: Matrix) -> list[Any]:
        """Fractions."""
        return [Fraction(row[0], column.denominator) for row in column.numerators]

    def largest(self, column: Matrix) -> float:
        """The largest absolute value; inf beyond the floats."""
        return to_float(max(map(abs, self.entries(column)), default=0))


class MultiprecisionArithmetic:
    """Floating point with a given number of decimal digits (mpmath).

    Parameters
    ----------
    digits : int
        Of the results; half as many more are carried.
    """

    name = "multiprecision"

    def __init__(self, digits: int) -> None:
        from mpmath import MPContext  # type: ignore[import-untyped]

        self.context = MPContext()
        # Taylor terms may be larger than their sum by some digits; these are spare ones.
        self.context.dps = digits + digits // 2 + 10

    def convert(self, M: Matrix) -> Native:
        """An ``mpmath.matrix``, every entry rounded once."""
        converted = self.context.matrix(M.nrows, M.ncols)
        for i, row in enumerate(M.numerators):
            for j, entry in enumerate(row):
                if entry:
                    converted[i, j] = self.context.mpf(entry) / M.denominator
        return converted

    def scalar(self, q: Fraction) -> Any:
        """A multiple-precision number."""
        return self.context.mpf(q.numerator) / q.denominator

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
        """An array of floats, every entry rounded once."""
        return matrix_to_float(M)

    def scalar(self, q: Fraction) -> float:
        """A float."""

        return to_float(q)

    def entries(self, column: Native) -> list[Any]:
        """Floats."""
        return [float(entry) for entry in column[:, 0]]

    def largest(self, column: Native) -> float:
        """The largest absolute value."""
        return float(abs(column).max()) if column.size else 0.0


def arithmetic_named(name: str, digits: int = 60) -> Arithmetic:
    """The arithmetic of this name: "exact", "multiprecision" or "float".

    Raises
    ------
    UsageError
        If there is none.
    """
    from mcexact.errors import UsageError

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
