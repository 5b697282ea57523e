"""Exact arithmetic: matrices of integers over one denominator, polynomials, and both modulo an ℓ.

A modulus need not be prime; inverting a number that is not a unit raises :class:`NotAUnit`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import chain
from typing import Any

from . import budget
from .budget import build, counted, spend
from .packed_rows import integer_product

Polynomial = list[Any]
"""Coefficients, constant term first: Fractions over Q, integers modulo ℓ."""

Rows = list[list[int]]


class NotAUnit(Exception):
    """A number to be inverted is not a unit modulo ℓ."""


@dataclass(frozen=True)
class Matrix:
    """A rational matrix: rows of integers over one denominator."""

    rows: Rows
    ncols: int
    denominator: int = 1

    @staticmethod
    def zeros(nrows: int, ncols: int) -> Matrix:
        """The zero matrix."""
        spend(budget.table(nrows, ncols))
        return Matrix([[0] * ncols for _ in range(nrows)], ncols)

    @staticmethod
    def unit_rows(n: int, start: int, size: int) -> Matrix:
        """[0 I 0]: ``size`` rows of the n × n identity from row ``start`` on."""
        spend(budget.table(size, n))
        return Matrix([[int(j == start + i) for j in range(n)] for i in range(size)], n)

    @cached_property
    def nrows(self) -> int:
        """The number of rows."""
        return len(self.rows)

    @cached_property
    def limbs(self) -> int:
        """The limbs of the longest entry, or of the denominator."""
        spend(self.nrows * (8 + self.ncols))
        return budget.limbs(chain(*self.rows, [self.denominator]))

    @property
    def T(self) -> Matrix:
        """The transpose."""
        spend(budget.table(self.ncols, self.nrows))
        columns = [[row[j] for row in self.rows] for j in range(self.ncols)]
        return Matrix(columns, self.nrows, self.denominator)

    def __matmul__(self, other: Matrix) -> Matrix:
        if self.ncols != other.nrows:
            raise ValueError(f"no product of {self.ncols} columns and {other.nrows} rows")
        a, b = self.limbs, other.limbs
        build(self.nrows + 1, other.ncols, a, b, other.nrows)
        rows = product(self.rows, other.rows, other.ncols)
        return Matrix(rows, other.ncols, self.denominator * other.denominator)

    def __add__(self, other: Matrix) -> Matrix:
        a, b = self.limbs, other.limbs
        spend(budget.fractions(1, a + b))
        d = math.lcm(self.denominator, other.denominator)
        f, g = d // self.denominator, d // other.denominator
        c = max(a + budget.limbs([f]), b + budget.limbs([g]))
        build(self.nrows, self.ncols, c, a + b, 2)
        pairs = zip(self.rows, other.rows, strict=True)
        rows = [[f * a + g * b for a, b in zip(r, s, strict=True)] for r, s in pairs]
        return Matrix(rows, self.ncols, d)

    def __sub__(self, other: Matrix) -> Matrix:
        return self + other.times(-1)

    def times(self, factor: Fraction | int) -> Matrix:
        """The multiple by a rational factor."""
        a, b = self.limbs, budget.limbs_of([factor])
        build(self.nrows, self.ncols, a, b)
        rows = [[factor.numerator * entry for entry in row] for row in self.rows]
        return Matrix(rows, self.ncols, self.denominator * factor.denominator)

    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        spend(budget.STEP + self.nrows * (8 + self.ncols))
        return not any(map(any, self.rows))

    def equals(self, other: Matrix) -> bool:
        """Whether all entries agree."""
        return (self - other).is_zero()

    def take(self, rows: Iterable[int] | None = None, cols: Iterable[int] | None = None) -> Matrix:
        """The submatrix of these rows and columns."""
        if cols is not None:
            return self.take(rows).T.take(cols).T
        return self if rows is None else self.at(rows)

    def at(self, rows: Iterable[int]) -> Matrix:
        """The submatrix of these rows."""
        chosen = list(rows)
        spend(budget.STEP + 8 * len(chosen))
        return Matrix([self.rows[i] for i in chosen], self.ncols, self.denominator)

    def modulo(self, ell: int) -> Rows:
        """The residues modulo ℓ; the denominator must be a unit."""
        a, b = self.limbs, budget.limbs([ell])
        spend(budget.table(self.nrows, self.ncols, b) + budget.inversions(1, b))
        spend(budget.reductions(self.nrows * self.ncols + 1, a + b, b))
        f = inverse(self.denominator, ell)
        return [[f * entry % ell for entry in row] for row in self.rows]


def stack(parts: Iterable[Matrix], ncols: int) -> Matrix:
    """The matrices one above the other, all of ``ncols`` columns."""
    above = list(parts)
    longest = max((part.limbs for part in above), default=1)
    denominators = {part.denominator for part in above}
    spend(budget.fractions(len(denominators), sum(budget.limbs([d]) for d in denominators)))
    d = math.lcm(*denominators)
    nrows, more = sum(part.nrows for part in above), budget.limbs([d])
    build(nrows, ncols, longest, more)
    rows = [[d // M.denominator * entry for entry in row] for M in above for row in M.rows]
    return Matrix(rows, ncols, d)


def beside(parts: Iterable[Matrix], nrows: int) -> Matrix:
    """The matrices side by side, all of ``nrows`` rows."""
    return stack((part.T for part in parts), nrows).T


def diagonal(A: Matrix, B: Matrix) -> Matrix:
    """[A 0; 0 B]."""
    top = beside([A, Matrix.zeros(A.nrows, B.ncols)], A.nrows)
    bottom = beside([Matrix.zeros(B.nrows, A.ncols), B], B.nrows)
    return stack([top, bottom], A.ncols + B.ncols)


def product(A: Rows, B: Rows, ncols: int, ell: int = 0) -> Rows:
    """A·B over the integers, or modulo ℓ if one is given, which reduces the factors."""
    if ell:
        a = budget.limbs([ell])
        build(len(A) + 1, ncols, a, a, len(B) + 4)
    rows = integer_product(A, B, ncols)
    return [[entry % ell for entry in row] for row in rows] if ell else rows


def inverse(number: int, ell: int) -> int:
    """The inverse modulo ℓ."""
    if math.gcd(number, ell) != 1:
        raise NotAUnit
    return pow(number, -1, ell)


def rank(A: Matrix) -> int:
    """The rank over Q, by fraction-free elimination (Bareiss): every quotient is exact.

    Theorems ``elimination.bareiss_exact``, ``elimination.bareiss_step``,
    ``elimination.bareiss_rank``.
    """
    spend(budget.table(A.nrows, A.ncols, A.limbs))
    rows, found, previous = [list(row) for row in A.rows], 0, 1
    for column in counted(range(A.ncols)):
        pivot = next((i for i in range(found, len(rows)) if rows[i][column]), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        top, p = rows[found], rows[found][column]
        longest = max(map(budget.limbs, rows[found:]))
        spend(budget.reductions((A.nrows - found - 1) * A.ncols, longest) + 20 * A.nrows)
        for i in range(found + 1, len(rows)):
            f = rows[i][column]
            rows[i] = [(p * a - f * b) // previous for a, b in zip(rows[i], top, strict=True)]
        previous, found = p, found + 1
    return found


class Echelon:
    """Vectors modulo ℓ in echelon form, every pivot 1: their number bounds a rank from below.

    Theorem ``arithmetic.rank_from_below``.
    """

    def __init__(self, ell: int) -> None:
        self.ell = ell
        self.rows: list[tuple[int, list[int]]] = []

    def add(self, vector: Sequence[int]) -> list[int] | None:
        """Reduce a vector; keep and return the remainder, or return None if it is zero."""
        a = budget.limbs([self.ell])
        spend(budget.reductions((len(self.rows) + 1) * len(vector), a) + budget.inversions(1, a))
        spend(budget.table(1, len(vector), a))
        left = list(vector)
        for pivot, row in self.rows:
            if f := left[pivot]:
                left = [(a - f * b) % self.ell for a, b in zip(left, row, strict=True)]
        pivot = next((k for k, entry in enumerate(left) if entry), -1)
        if pivot < 0:
            return None
        f = inverse(left[pivot], self.ell)
        self.rows.append((pivot, [f * entry % self.ell for entry in left]))
        return self.rows[-1][1]


def rank_modulo(A: Matrix, ell: int) -> int:
    """The rank modulo ℓ, at most that over Q.

    Theorem ``arithmetic.rank_from_below``.
    """
    echelon = Echelon(ell)
    return sum(echelon.add(row) is not None for row in A.modulo(ell))


def poly_modulo(p: Polynomial, ell: int) -> Polynomial:
    """A polynomial over Q modulo ℓ; its denominators must be units."""
    a, b = budget.limbs_of(p), budget.limbs([ell])
    spend(budget.inversions(len(p), b) + budget.reductions(2 * len(p), a + b, b))
    return stripped([c.numerator * inverse(c.denominator, ell) % ell for c in p])


def stripped(p: Polynomial) -> Polynomial:
    """The same polynomial without zeros at the end."""
    while p and not p[-1]:
        p.pop()
    return p


def cleared(p: Polynomial) -> tuple[list[int], int]:
    """The integers d·p_k, d the least common denominator of all p_k, and d."""
    longest, different = budget.limbs_of(p), {c.denominator for c in p}
    whole = sum(budget.limbs([q]) for q in different)
    units = budget.fractions(len(different), longest) + budget.table(1, len(p), longest + whole)
    spend(units + budget.reductions(2 * (len(p) + len(different)), whole, longest))
    d = math.lcm(*different)
    return [c.numerator * (d // c.denominator) for c in p], d


def poly_product(a: Polynomial, b: Polynomial) -> Polynomial:
    """The product a·b."""
    modular = _modular(a, b)
    (first, d), (second, e) = ((a, 1), (b, 1)) if modular else (cleared(a), cleared(b))
    nonzero = sum(map(bool, first))
    spend(_terms(nonzero * len(b), first, second, 1))
    result = [0] * (len(a) + len(b) - 1)
    for i, f in enumerate(first):
        if f:
            for k, g in enumerate(second):
                result[i + k] += f * g
    if modular:
        return result
    longest = budget.limbs(result)
    spend(budget.fractions(len(result), longest + budget.limbs([d, e]) * 2))
    return [Fraction(c, d * e) for c in result]


def poly_divide(a: Polynomial, b: Polynomial, ell: int = 0) -> tuple[Polynomial, Polynomial]:
    """Quotient and remainder of a by b ≠ 0, over Q, or modulo ℓ if one is given."""
    turns = max(len(a) - len(b) + 1, 0)
    spend(_terms(turns * len(b) + 1, a, b, 0 if ell else turns))
    f = inverse(b[-1], ell) if ell else 1 / Fraction(b[-1])
    rest, quotient = list(a), []
    while len(rest) >= len(b):
        factor = rest[-1] * f
        quotient.append(factor % ell if ell else factor)
        for k in range(len(b)):
            rest[k - len(b)] -= quotient[-1] * b[k]
        rest.pop()
    return quotient[::-1], stripped([entry % ell for entry in rest] if ell else rest)


def _terms(number: int, a: Polynomial, b: Polynomial, turns: int) -> int:
    """The units of so many products of coefficients, which grow in every turn."""
    units = 200 + 10 * (len(a) + len(b))
    if _modular(a, b):
        longest = max(budget.limbs(a), budget.limbs(b))
        return units + 2 * budget.reductions(number, longest) + budget.inversions(1, longest)
    # sums have the common denominator, which may be longer than each
    first, second = (max(budget.limbs(c), budget.limbs([d])) for c, d in map(cleared, (a, b)))
    return units + budget.fractions(number, first + second * turns)


def _modular(a: Polynomial, b: Polynomial) -> bool:
    """Whether all coefficients are integers, as those modulo ℓ are."""
    return all(type(c) is int for c in (*a, *b))


def exponent(p: Polynomial, f: Polynomial, ell: int = 0) -> tuple[int, Polynomial]:
    """The number of times that p, of degree ≥ 1, divides f ≠ 0, and the last quotient."""
    times = 0
    while True:
        quotient, rest = poly_divide(f, p, ell)
        if rest:
            return times, f
        times, f = times + 1, quotient


def coprime(a: Polynomial, b: Polynomial, ell: int) -> bool:
    """Whether Euclid's algorithm ends with a unit: then u·a + v·b = 1 modulo ℓ for some u, v.

    Theorems ``arithmetic.euclid_step``, ``arithmetic.euclid_end``.
    """
    while b:
        a, b = b, poly_divide(a, b, ell)[1]
    return len(a) == 1 and inverse(a[0], ell) > 0
