"""Complex matrices, of pairs of integers over one denominator, and their absolute values."""

from __future__ import annotations

import math
from dataclasses import dataclass

from . import budget, reading
from .arithmetic import Matrix
from .reading import Json, fields


def magnitude(re: int, im: int) -> int:
    """The least integer that is not below |re + i·im|."""
    if not im:
        return abs(re)
    square = re * re + im * im
    return math.isqrt(square - 1) + 1


def extractions(number: int, a: int) -> int:
    """The units of so many absolute values of pairs of numbers of a limbs."""
    return budget.reductions(4 * number, 2 * a)


@dataclass(frozen=True)
class ComplexMatrix:
    """re + i·im; both have the same shape and the same denominator."""

    re: Matrix
    im: Matrix

    @property
    def limbs(self) -> int:
        """The limbs of the longest entry, or of the denominator."""
        return max(self.re.limbs, self.im.limbs)

    def __matmul__(self, other: ComplexMatrix) -> ComplexMatrix:
        re = self.re @ other.re - self.im @ other.im
        return ComplexMatrix(re, self.re @ other.im + self.im @ other.re)

    def after(self, M: Matrix) -> ComplexMatrix:
        """The product M (re + i·im), M real."""
        return ComplexMatrix(M @ self.re, M @ self.im)

    def before(self, M: Matrix) -> ComplexMatrix:
        """The product (re + i·im) M, M real."""
        return ComplexMatrix(self.re @ M, self.im @ M)

    def magnitudes(self) -> Matrix:
        """The absolute values of all entries, rounded up to integers over the denominator."""
        nrows, ncols, a = self.re.nrows, self.re.ncols, self.limbs
        budget.spend(budget.table(nrows, ncols, a) + extractions(nrows * ncols, a))
        pairs = zip(self.re.rows, self.im.rows, strict=True)
        return Matrix([list(map(magnitude, *pair)) for pair in pairs], ncols, self.re.denominator)


def complex_matrix(value: Json, place: str, nrows: int, ncols: int) -> ComplexMatrix:
    """Read a complex matrix of the prescribed shape."""
    denominator, *parts = fields(value, place, "denominator", "re", "im")
    re, im = (
        reading.matrix({"denominator": denominator, "entries": part}, place, nrows, ncols)
        for part in parts
    )
    return ComplexMatrix(re, im)
