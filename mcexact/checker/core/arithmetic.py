"""Exact arithmetic: integers, polynomials, matrices dense and sparse.

A rational matrix is a table of integers over one denominator, so that sums and products take no
gcd for each entry.  Polynomials have Fractions as coefficients over Q, and integers modulo an ℓ.
A modulus need not be prime; inverting a number that is not a unit raises :class:`NotAUnit`.  Every
operation charges its units to the budget before it is done.

- Products of tables and of polynomials modulo ℓ pack many numbers into one long integer, with a
  slot of bytes for each, since one operation of Python then works on all of them.  Up to the
  modulus ``SMALL`` a residue takes one byte.
- Ranks over Q are computed by fraction-free elimination (`rank`).  Ranks modulo ℓ bound those over
  Q from below, and take much shorter numbers (`Echelon`, `rank_modulo`).  Up to ``SMALL`` vectors
  are strings of bytes, and many rows are taken off at once (`ByteEchelon`): 1,000 rows in 0.3 s.
- Characteristic polynomials modulo ℓ come from a Hessenberg form, by about n³ products.  Over Q
  they are combined from residues modulo pairwise coprime numbers, whose product is more than twice
  a bound on all coefficients.
- Polynomials in a parameter t are interpolated from their values at t = 0, 1, ….
- `SparseMatrix` keeps only nonzero entries; `listed` says which matrices are worth it.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from itertools import chain, compress, count
from operator import itemgetter, mul
from typing import Any

from . import budget
from .budget import build, counted, spend

# Rows and polynomials as long integers, with slots for their entries.

SMALL = 64
"""Up to this modulus a residue is a byte, and rows with equal coefficients are added up first."""

Table = Sequence[Sequence[int]]
FEW, LONG = 16, 64
"""Fewer rows, and entries of more bytes, are multiplied one by one."""


class PackedRows:
    """Rows modulo ℓ, each one long integer with a slot of so many bytes for every entry."""

    def __init__(self, rows: Sequence[Sequence[int]], ncols: int, ell: int) -> None:
        self.ell, self.ncols = ell, ncols
        self.size = 1 if ell <= SMALL else _slot(len(rows), ell)
        spend((len(rows) + 1) * (64 + (8 + self.size) * ncols))
        self.rows = [_packed(row, self.size) for row in rows]

    def combined(self, u: Sequence[int]) -> Sequence[int]:
        """Σ u_i row_i modulo ℓ."""
        if self.ell <= SMALL:
            return self._by_coefficient(u)
        spend(budget.products(len(self.rows) + 1, self._limbs, budget.limbs(u)))
        total = sum(map(mul, u, self.rows))
        return _unpacked(total, self.ncols, self.size, self.ell)

    @property
    def _limbs(self) -> int:
        return self.ncols * self.size * 8 // budget.LIMB + 1

    def _by_coefficient(self, u: Sequence[int]) -> bytes:
        """`combined` for bytes."""
        spend(by_coefficient_units(len(self.rows), self.ncols, self.ell))
        pairs = zip(u, self.rows, strict=True)
        return byte_sum(by_coefficient(pairs, self.ncols, self.ell), self.ncols, self.ell)


def by_coefficient(pairs: Iterable[tuple[int, int]], ncols: int, ell: int) -> Iterator[bytes]:
    """Parts of the sum of f·row over pairs (f, row), for residues f and rows as long integers.

    The rows of equal coefficients are added, at most as many as a byte holds, then multiplied.
    """
    most, tables = most_addends(ell), multiples(ell)
    alike: list[list[int]] = [[] for _ in range(ell)]
    for factor, row in pairs:
        alike[factor].append(row)
    for factor in range(1, ell):
        for k in range(0, len(alike[factor]), most):
            total = sum(alike[factor][k : k + most])
            yield total.to_bytes(ncols, "little").translate(tables[factor])


def by_coefficient_units(rows: int, ncols: int, ell: int) -> int:
    """The units of `by_coefficient` for so many rows."""
    parts = rows // most_addends(ell) + min(rows, ell) + 1
    return rows * (4 + ncols // 60) + parts * (40 + ncols // 8)


def byte_sum(rows: Iterable[bytes], ncols: int, ell: int) -> bytes:
    """The sum modulo ℓ of rows of residues, which are added as long integers."""
    most, table = most_addends(ell), multiples(ell)[1]
    numbers = [int.from_bytes(row, "little") for row in rows]
    total = sum(numbers[:most]).to_bytes(ncols, "little").translate(table)
    for k in range(most, len(numbers), most - 1):
        more = int.from_bytes(total, "little") + sum(numbers[k : k + most - 1])
        total = more.to_bytes(ncols, "little").translate(table)
    return total


def most_addends(ell: int) -> int:
    """How many residues can be added in one byte: at least four up to ``SMALL``."""
    return 255 // (ell - 1)


@cache
def multiples(ell: int) -> list[bytes]:
    """The multiples of all bytes modulo ℓ, by the factor."""
    return [bytes(factor * byte % ell for byte in range(256)) for factor in range(ell)]


class Logarithms:
    """Products of residues modulo a small prime, byte by byte, as sums of logarithms.

    Attributes
    ----------
    of : bytes
        The logarithms of the residues, as a table.
    zero : int
        That of 0: more than the sum of two others, and twice as much still is a byte.
    """

    def __init__(self, ell: int, root: int) -> None:
        self.zero = 2 * ell - 3
        powers = [pow(root, k, ell) for k in range(self.zero)]
        self.of = bytes([self.zero, *map(powers.index, range(1, ell))]).ljust(256, b"\0")
        self._powers = bytes(powers).ljust(256, b"\0")

    def packed(self, residues: Iterable[int]) -> int:
        """The logarithms of some residues, as one long integer."""
        return int.from_bytes(bytes(residues).translate(self.of), "little")

    def products(self, sums: int, many: int) -> bytes:
        """So many products, by the sums of the logarithms of their factors."""
        return sums.to_bytes(many, "little").translate(self._powers)


@cache
def logarithms(ell: int) -> Logarithms | None:
    """The logarithms modulo ℓ ≤ ``SMALL``, to the least primitive root; None if ℓ is not prime."""
    if ell > SMALL:
        return None
    orders = ((root, {pow(root, k, ell) for k in range(ell - 1)}) for root in range(1, ell))
    root = next((root for root, powers in orders if powers == set(range(1, ell))), None)
    return None if root is None else Logarithms(ell, root)


class Combination:
    """Σ f_k u_k modulo ℓ, for rows u_k of residues that come one after the other.

    Up to ``SMALL`` the rows with equal factors are added first, at most as many as a byte holds; a
    row may be one long integer, with bytes up to ℓ.
    """

    def __init__(self, ncols: int, ell: int) -> None:
        self.ell, self.ncols = ell, ncols
        self.row: Sequence[int] = bytes(ncols)
        self.sums = [[0, 0] for _ in range(ell if ell <= SMALL else 0)]

    def add(self, factor: int, u: Sequence[int] | int) -> None:
        """Add a multiple of a row."""
        ell, ncols = self.ell, self.ncols
        if isinstance(u, int):
            row = u
        elif ell <= SMALL:
            row = int.from_bytes(bytes(u), "little")
        else:
            spend(budget.reductions(ncols, budget.limbs([ell])))
            self.row = [(x + factor * y) % ell for x, y in zip(self.row, u, strict=True)]
            return
        spend(40 + ncols // 20)
        many, total = self.sums[factor]
        if many >= 255 // ell:
            spend(ncols // 8)
            many, total = 1, _packed(self._reduced(total, 1), 1)
        self.sums[factor] = [many + 1, total + row]

    def _reduced(self, total: int, factor: int) -> bytes:
        return total.to_bytes(self.ncols, "little").translate(multiples(self.ell)[factor])

    def is_zero(self) -> bool:
        """Whether the sum so far is 0."""
        if self.ell > SMALL:
            return not any(self.row)
        spend(self.ell * (40 + self.ncols // 4))
        parts = (self._reduced(total, factor) for factor, (_, total) in enumerate(self.sums))
        return not any(byte_sum(parts, self.ncols, self.ell))


def integer_product(A: Table, B: Table, ncols: int) -> list[list[int]]:
    """A·B over the integers; long rows of short entries are added up as long integers."""
    size = (_bits(A) + _bits(B) + len(B).bit_length()) // 8 + 1
    if min(len(A), len(B), ncols) < FEW or size > LONG:
        columns: Iterable[Any] = list(zip(*B, strict=True)) if B else [()] * ncols
        return [[sum(map(mul, row, column)) for column in columns] for row in A]
    # what is added to every entry keeps slots from borrowing of each other
    half = 1 << (8 * size - 1)
    halves = _packed([half] * ncols, size)
    rows = [_packed([entry + half for entry in row], size) - halves for row in B]
    slots, table = range(0, ncols * size, size), []
    for u in A:
        total = sum([factor * row for factor, row in zip(u, rows, strict=True) if factor], halves)
        data = total.to_bytes(ncols * size, "little")
        table.append([int.from_bytes(data[k : k + size], "little") - half for k in slots])
    return table


def _bits(M: Table) -> int:
    """The bits of the longest entry."""
    return max((max(map(int.bit_length, row), default=0) for row in M), default=0)


def convolution(f: Sequence[int], g: Sequence[int], ell: int) -> list[int]:
    """The product of two polynomials modulo ℓ, by one product of two integers (Kronecker)."""
    shorter, length = min(len(f), len(g)), len(f) + len(g) - 1
    if not shorter:
        return []
    size = _slot(shorter, ell)
    long, short = ((k * size * 8) // budget.LIMB + 1 for k in (length, shorter))
    spend((8 + size) * 2 * length + budget.products(1, long, short))
    return _unpacked(_packed(f, size) * _packed(g, size), length, size, ell)


def _slot(terms: int, ell: int) -> int:
    """The bytes that hold every sum of so many products of residues."""
    return (terms * (ell - 1) ** 2).bit_length() // 8 + 1


def _packed(numbers: Sequence[int], size: int) -> int:
    if size == 1:
        return int.from_bytes(bytes(numbers), "little")
    return int.from_bytes(b"".join(x.to_bytes(size, "little") for x in numbers), "little")


def _unpacked(number: int, length: int, size: int, ell: int) -> list[int]:
    spend(length * (8 + size))
    data = number.to_bytes(length * size, "little")
    slots = range(0, length * size, size)
    return [int.from_bytes(data[k : k + size], "little") % ell for k in slots]


# Rational matrices, polynomials over Q, and both modulo ℓ.

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

    @cached_property
    def driven(self) -> list[list[int]]:
        """For each column the rows in which it is not 0."""
        entries = entries_of(self)
        spend(40 * (len(entries) + self.ncols))
        rows: list[list[int]] = [[] for _ in range(self.ncols)]
        for i, j, _ in entries:
            rows[j].append(i)
        return rows

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
        chosen = self if rows is None else self.at(rows)
        return chosen if cols is None else chosen.across(cols)

    def at(self, rows: Iterable[int]) -> Matrix:
        """The submatrix of these rows."""
        chosen = list(rows)
        spend(budget.STEP + 8 * len(chosen))
        return Matrix([self.rows[i] for i in chosen], self.ncols, self.denominator)

    def across(self, cols: Iterable[int]) -> Matrix:
        """The submatrix of these columns."""
        chosen = list(cols)
        spend(budget.STEP + budget.table(self.nrows, len(chosen)))
        entries = [[row[j] for j in chosen] for row in self.rows]
        return Matrix(entries, len(chosen), self.denominator)

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
    if above and all(isinstance(part, SparseMatrix) for part in above):
        return _sparse_stack(above, nrows, ncols, d)
    build(nrows, ncols, longest, more)
    rows = [[d // M.denominator * entry for entry in row] for M in above for row in M.rows]
    return Matrix(rows, ncols, d)


def _sparse_stack(above: list[Matrix], nrows: int, ncols: int, d: int) -> Matrix:
    """`stack` of matrices by their entries, over the common denominator d."""
    start, entries, longest = 0, list[Entry](), max(part.limbs for part in above)
    many = sum(len(entries_of(part)) for part in above)
    spend(100 * many + budget.products(many + 1, longest, budget.limbs([d])))
    for M in above:
        f = d // M.denominator
        entries += [(start + i, j, f * x) for i, j, x in entries_of(M)]
        start += M.nrows
    return SparseMatrix(nrows, ncols, entries, d)


def beside(parts: Iterable[Matrix], nrows: int) -> Matrix:
    """The matrices side by side, all of ``nrows`` rows."""
    return stack((part.T for part in parts), nrows).T


def diagonal(A: Matrix, B: Matrix) -> Matrix:
    """[A 0; 0 B]."""
    top = beside([A, Matrix.zeros(A.nrows, B.ncols)], A.nrows)
    bottom = beside([Matrix.zeros(B.nrows, A.ncols), B], B.nrows)
    return stack([top, bottom], A.ncols + B.ncols)


def absolute(M: Matrix) -> Matrix:
    """The absolute values of all entries."""
    spend(budget.table(M.nrows, M.ncols, M.limbs))
    rows = [[abs(entry) for entry in row] for row in M.rows]
    return Matrix(rows, M.ncols, M.denominator)


def product(A: Rows, B: Rows, ncols: int, ell: int = 0) -> Rows:
    """A·B over the integers, or modulo ℓ ≠ 0, which reduces the factors."""
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
    rows, pivots, previous = [list(row) for row in A.rows], 0, 1
    for column in counted(range(A.ncols)):
        pivot = next((i for i in range(pivots, len(rows)) if rows[i][column]), None)
        if pivot is None:
            continue
        rows[pivots], rows[pivot] = rows[pivot], rows[pivots]
        top, p = rows[pivots], rows[pivots][column]
        longest = max(map(budget.limbs, rows[pivots:]))
        spend(budget.reductions((A.nrows - pivots - 1) * A.ncols, longest) + 20 * A.nrows)
        for i in range(pivots + 1, len(rows)):
            f = rows[i][column]
            rows[i] = [(p * a - f * b) // previous for a, b in zip(rows[i], top, strict=True)]
        previous, pivots = p, pivots + 1
    return pivots


class Echelon:
    """Vectors modulo ℓ in echelon form, every pivot 1: their number bounds a rank from below.

    Theorem ``arithmetic.rank_from_below``.
    """

    def __init__(self, ell: int) -> None:
        self.ell = ell
        self.rows: list[tuple[int, list[int]]] = []

    @property
    def count(self) -> int:
        """The number of vectors that are kept."""
        return len(self.rows)

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


BLOCK = 96
"""So many rows of a `ByteEchelon` form the identity matrix at their pivots together."""


class ByteEchelon:
    """`Echelon` for an ℓ of at most ``SMALL``: vectors are strings of bytes, and sums are integers.

    The rows of a block form the identity at the pivots of the block, and are 0 at the pivots of
    all blocks before it.  So the multiples of them that a vector has are its entries there, and
    all are taken off at once, the rows with the same multiple added up first.

    Theorems ``arithmetic.rank_from_below``, ``echelon.block_echelon``.
    """

    def __init__(self, ell: int, ncols: int) -> None:
        self.ell, self.ncols, self.count = ell, ncols, 0
        self.blocks: list[tuple[list[int], list[int]]] = []

    def add(self, vector: Sequence[int]) -> bytes | None:
        """Reduce a vector; keep and return the remainder, or return None if it is zero."""
        ell, n, tables = self.ell, self.ncols, multiples(self.ell)
        spend(n + len(self.blocks) * by_coefficient_units(BLOCK, n, ell))
        left = self._reduced(bytes(vector))
        pivot = n - len(left.lstrip(b"\0"))
        if pivot == n:
            return None
        spend(budget.inversions(1, 1) + BLOCK * (40 + n // 4))
        left = left.translate(tables[inverse(left[pivot], ell)])
        if not self.blocks or len(self.blocks[-1][0]) == BLOCK:
            self.blocks.append(([], []))
        pivots, rows = self.blocks[-1]
        moved = [_packed(left.translate(tables[-f % ell]), 1) for f in range(ell)]
        for k, row in enumerate(rows):
            if f := row >> (8 * pivot) & 255:
                total = (row + moved[f]).to_bytes(n, "little")
                rows[k] = _packed(total.translate(tables[1]), 1)
        pivots.append(pivot)
        rows.append(_packed(left, 1))
        self.count += 1
        return left

    def _reduced(self, vector: bytes) -> bytes:
        """What is left of a vector: it is 0 at all pivots."""
        ell, n = self.ell, self.ncols
        for pivots, rows in self.blocks:
            pairs = ((-vector[pivot] % ell, row) for pivot, row in zip(pivots, rows, strict=True))
            vector = byte_sum(chain([vector], by_coefficient(pairs, n, ell)), n, ell)
        return vector


def echelon(ell: int, ncols: int) -> Echelon | ByteEchelon:
    """An empty echelon form modulo ℓ, for vectors of so many entries."""
    return ByteEchelon(ell, ncols) if ell <= SMALL else Echelon(ell)


def rank_modulo(A: Matrix, ell: int) -> int:
    """The rank modulo ℓ, at most that over Q.

    Theorem ``arithmetic.rank_from_below``.
    """
    if ell <= SMALL and isinstance(A, SparseMatrix):
        return banded_rank(residues(A, ell), A.nrows, A.ncols, ell)
    basis = echelon(ell, A.ncols)
    return sum(basis.add(row) is not None for row in A.modulo(ell))


def banded_rank(entries: list[Entry], nrows: int, ncols: int, ell: int) -> int:
    """The rank modulo ℓ ≤ ``SMALL`` of a matrix of few entries, which are residues.

    Theorem ``arithmetic.rank_from_below``.
    """
    spend(200 * (len(entries) + nrows + ncols))
    place = by_breadth(entries, nrows, ncols)
    lines: list[list[tuple[int, int]]] = [[] for _ in range(nrows)]
    for i, j, x in entries:
        lines[i].append((place[j], x))
    starting: list[list[tuple[int, int]]] = [[] for _ in range(ncols)]
    for line in filter(None, lines):
        first = min(line)[0]
        spend(max(line)[0] - first)
        starting[first].append((0, sum(x << 8 * (k - first) for k, x in line)))
    return sum(banded_pivots(starting, 1, ell))


def banded_pivots(starting: list[list[tuple[int, int]]], turns: int, ell: int) -> list[int]:
    """How many rows of each turn are independent modulo ℓ ≤ ``SMALL`` of those of earlier turns.

    Rows are long integers with a byte for each column from the present one on; for each column
    those that start there are given, each after its turn.  Nothing is added to a row of an earlier
    turn but rows of that turn or earlier ones, as the pivot in a column is of the earliest turn
    there.  So the pivots of the first turns count the rank of the rows of these alone.  Bytes are
    reduced before they overflow.

    Theorem ``arithmetic.rank_from_below``.
    """
    tables = multiples(ell)

    def reduced(row: int, factor: int = 1) -> int:
        data = row.to_bytes((row.bit_length() + 7) // 8, "little")
        return _packed(data.translate(tables[factor % ell]), 1)

    counts, room, active = [0] * turns, 0, list[tuple[int, int]]()
    for new in counted(starting):
        active += new
        spend(80 + sum(row.bit_length() for _, row in active) // 400 + 14 * len(active))
        if not room:
            spend(sum(row.bit_length() for _, row in active) // 100)
            room = most_addends(ell) - 1
            active = [(turn, left) for turn, row in active if (left := reduced(row))]
        room -= 1
        meeting = [(turn, row.bit_length(), row) for turn, row in active if (row & 255) % ell]
        if not meeting:
            active = [(turn, row >> 8) for turn, row in active]
            continue
        turn, length, pivot = min(meeting)
        counts[turn] += 1
        active.remove((turn, pivot))
        f = -inverse((pivot & 255) % ell, ell)
        spend(ell * (40 + length // 30) + budget.inversions(1, 1))
        taken = [reduced(pivot, f * k) for k in range(ell)]
        active = [(turn, (row + taken[(row & 255) % ell]) >> 8) for turn, row in active]
    return counts


def by_breadth(entries: list[Entry], nrows: int, ncols: int) -> list[int]:
    """For each column its place in an order by breadth, from an end of each connected part."""
    columns: list[list[int]] = [[] for _ in range(ncols)]
    rows: list[list[int]] = [[] for _ in range(nrows)]
    for i, j, _ in entries:
        columns[j].append(i)
        rows[i].append(j)

    def connected(start: int) -> list[int]:
        order, seen, met = [start], {start}, set[int]()
        for j in order:
            for i in columns[j]:
                if i not in met:
                    met.add(i)
                    new = [k for k in rows[i] if k not in seen]
                    seen.update(new)
                    order += new
        return order

    place, count = [-1] * ncols, 0
    for start in sorted(range(ncols), key=lambda j: len(columns[j])):
        if place[start] < 0:
            for j in connected(connected(start)[-1]):
                place[j], count = count, count + 1
    return place


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
    """Quotient and remainder of a by b ≠ 0, over Q, or modulo ℓ unless it is 0."""
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


# Characteristic polynomials, modulo ℓ and over Q; ``proofs/arithmetic.md``.

FIRST = 2**150 - 3
"""A prime, and the largest modulus of residues that are combined."""
BITS, LIMBS = 149, 5
"""Each of these moduli is above 2^BITS; with so many limbs, each bit of a residue costs least."""


def characteristic_polynomial_modulo(A: Rows, ell: int) -> Polynomial:
    """The characteristic polynomial of an integer matrix modulo ℓ.

    A L = L H with L unit lower triangular (up to a common permutation of rows and columns) and H
    upper Hessenberg, column by column.  Columns are long integers, with a slot for each entry that
    holds the sum of all products: a multiple of a column is one product.

    Theorem ``hessenberg.characteristic_polynomial_modulo``.
    """
    n, a = len(A), budget.limbs([ell])
    size = _slot(2 * n + 1, ell)
    long = n * size * 8 // budget.LIMB + 1
    spend(
        budget.products(2 * n * n, long, a) + budget.table(3 * n, n, a) + 20 * n * n + n * n * size
    )
    spend(budget.reductions(3 * n * n, a) + budget.inversions(n, a))
    bits, mask = 8 * size, (1 << 8 * size) - 1
    columns = [_packed([row[j] % ell for row in A], size) for j in range(n)]
    current, H = [int(i == 0) for i in range(n)], list[list[int]]()
    lower, below = list[int](), list[int]()  # column i of L from row i + 1 on
    for j in range(n):
        lower.append(_packed(current[j + 1 :], size))
        total, h = sum(map(mul, current[j:], columns[j:])), list[int]()
        for column in lower:
            h.append((total & mask) % ell)
            total >>= bits
            if h[-1]:
                total += (ell - h[-1]) * column
        H.append(h)
        if j + 1 == n:
            break
        rest = _unpacked(total, n - j - 1, size, ell)
        k = next((k for k, entry in enumerate(rest) if entry), 0)
        below.append(rest[k])
        if k:
            rest[0], rest[k] = rest[k], rest[0]
            columns[j + 1], columns[j + 1 + k] = columns[j + 1 + k], columns[j + 1]
            spend(n * long // 4)
            places = ((j + 1) * bits, k * bits, mask)
            columns[j + 1 :] = [_exchanged(column, *places) for column in columns[j + 1 :]]
            lower = [_exchanged(x, (j - i) * bits, k * bits, mask) for i, x in enumerate(lower)]
        f = inverse(rest[0], ell) if rest[0] else 0
        current = [0] * (j + 1) + [1] + [f * entry % ell for entry in rest[1:]]
    return _hessenberg_polynomial(H, below, ell)


def _exchanged(column: int, start: int, distance: int, mask: int) -> int:
    """A column in which two entries have changed places."""
    change = (column >> start + distance & mask) - (column >> start & mask)
    return column - ((change << distance) - change << start) if change else column


def _hessenberg_polynomial(H: Rows, below: list[int], ell: int) -> Polynomial:
    """det(xI − H) modulo ℓ for H upper Hessenberg: column k holds H[k], then ``below[k]``.

    p_{k+1} = (x − h_kk) p_k − Σ_{i<k} h_ik (below_i … below_{k−1}) p_i, each polynomial as one long
    integer.

    Theorem ``hessenberg.hessenberg_polynomial``.
    """
    size, last = _slot(2 * len(H) + 1, ell), [1]
    polynomials = [1]
    for k, weights in enumerate(H):
        chain = 1
        for i in reversed(range(k)):
            chain = chain * below[i] % ell
            weights[i] = weights[i] * chain % ell
        total = polynomials[k] << 8 * size
        for weight, p in zip(weights, polynomials, strict=True):
            if weight:
                total += (ell - weight) * p
        last = _unpacked(total, k + 2, size, ell)
        polynomials.append(_packed(last, size))
    return last


def characteristic_polynomial(A: Matrix, ell: int = 0) -> Polynomial:
    """The characteristic polynomial over Q, or modulo ℓ unless it is 0.

    For M = A, its transpose or its integer numerators, whichever has the least bound, the integers
    D·det(xI − M) are combined from their residues, one modulus after the other.

    Theorems ``characteristic_polynomial.combined``,
    ``characteristic_polynomial.characteristic_polynomial_rule``.
    """
    if ell:
        return characteristic_polynomial_modulo(A.modulo(ell), ell)
    choices = ((*scaled_bound(M), M) for M in (A, A.T, Matrix(A.rows, A.ncols)))
    beta, D, M = min(choices, key=itemgetter(0))
    n, longest, product, coefficients = A.nrows, budget.limbs([D]), 1, [0] * (A.nrows + 1)
    moduli = _residues(M)
    for _ in budget.counted(range(beta.bit_length() // BITS + 1)):
        ell, residues = next(moduli)
        a = budget.limbs([product]) + longest + LIMBS
        spend(budget.products(3 * n + 3, a, LIMBS) + budget.reductions(n + 2, a, LIMBS))
        f = inverse(product, ell)
        pairs = zip(coefficients, residues, strict=True)
        coefficients = [old + (D * c - old) * f % ell * product for old, c in pairs]
        product *= ell
    least = [c - product if 2 * c > product else c for c in coefficients]
    e = A.denominator // M.denominator
    spend(budget.fractions(n + 1, budget.limbs([product]) + longest + n * budget.limbs([e])))
    return [Fraction(c, D * e ** (n - k)) for k, c in enumerate(least)]


def scaled_bound(A: Matrix) -> tuple[int, int]:
    """β and D: the coefficients of D·det(xI − A) are integers of absolute value at most β.

    D·det(xI − A) = det(diag(d)x − diag(d)A), d_i the denominator of row i and D = Π d_i, and
    β = Π (d_i + Σ_j |d_i A_ij|).

    Theorem ``closed_loop_spectrum.scaled_bound``.
    """
    D = beta = 1
    n, a = A.nrows, A.limbs
    spend(budget.fractions(n * (n + 1), a) + budget.products(4 * n, n * (a + 1), a + 1))
    for row in A.rows:
        common = math.gcd(A.denominator, *row)
        D *= A.denominator // common
        beta *= (A.denominator + sum(map(abs, row))) // common
    return beta, D


def _residues(M: Matrix) -> Iterator[tuple[int, Polynomial]]:
    """Pairwise coprime ℓ with the characteristic polynomial modulo each, where pivots are units."""
    tried = math.factorial(1000)  # small factors are those of most pivots
    for ell in range(FIRST, 1, -2):
        spend(budget.reductions(2, budget.limbs([tried]), LIMBS) + budget.fractions(1, LIMBS))
        if math.gcd(ell, tried) == 1:
            tried *= ell
            with suppress(NotAUnit):
                yield ell, characteristic_polynomial_modulo(M.modulo(ell), ell)


# Sparse matrices.

Entry = tuple[int, int, int]
"""Row, column and numerator."""

LEAST, SHARE = 2**11, 8
"""A matrix of so many cells lists its entries if at most one cell of so many is not 0."""


class SparseMatrix(Matrix):
    """A rational matrix by its entries, row by row, which become rows where these are used."""

    entries: list[Entry]

    def __init__(self, nrows: int, ncols: int, entries: list[Entry], denominator: int = 1) -> None:
        parts = {"nrows": nrows, "ncols": ncols, "entries": entries, "denominator": denominator}
        self.__dict__.update(parts)

    @cached_property
    def rows(self) -> Rows:
        """The rows with all zeros."""
        spend(budget.table(self.nrows, self.ncols))
        table = [[0] * self.ncols for _ in range(self.nrows)]
        for i, j, entry in self.entries:
            table[i][j] = entry
        return table

    @cached_property
    def limbs(self) -> int:
        """The limbs of the longest entry, or of the denominator."""
        spend(8 + len(self.entries))
        return budget.limbs([self.denominator, *(entry for _, _, entry in self.entries)])

    @property
    def T(self) -> Matrix:
        """The transpose."""
        spend(100 * len(self.entries))
        turned = sorted((j, i, entry) for i, j, entry in self.entries)
        return SparseMatrix(self.ncols, self.nrows, turned, self.denominator)

    def __matmul__(self, other: Matrix) -> Matrix:
        if self.ncols != other.nrows:
            raise ValueError(f"no product of {self.ncols} columns and {other.nrows} rows")
        a, b, width = self.limbs, other.limbs, other.ncols
        spend(budget.table(self.nrows, width, a + b + 1) + 100 * len(self.entries))
        spend(budget.products(len(self.entries) * width, a, b))
        rows = [[0] * width for _ in range(self.nrows)]
        for i, k, x in self.entries:
            rows[i] = [
                total + x * entry for total, entry in zip(rows[i], other.rows[k], strict=True)
            ]
        return Matrix(rows, width, self.denominator * other.denominator)

    def __rmatmul__(self, other: Matrix) -> Matrix:
        return (self.T @ other.T).T

    def is_zero(self) -> bool:
        """Whether there is no entry."""
        return not self.entries

    def at(self, rows: Iterable[int]) -> Matrix:
        """The submatrix of these rows."""
        chosen = list(rows)
        spend(100 * (len(chosen) + len(self.entries)))
        lines: dict[int, list[Entry]] = {}
        for entry in self.entries:
            lines.setdefault(entry[0], []).append(entry)
        numbered = [(new, j, x) for new, i in enumerate(chosen) for _, j, x in lines.get(i, ())]
        return SparseMatrix(len(chosen), self.ncols, numbered, self.denominator)

    def across(self, cols: Iterable[int]) -> Matrix:
        """The submatrix of these columns."""
        return self.T.at(cols).T


def listed(M: Matrix) -> SparseMatrix | None:
    """A matrix by its entries, if it is large and most cells are 0; otherwise None."""
    cells = M.nrows * M.ncols
    if isinstance(M, SparseMatrix):
        return M if SHARE * len(M.entries) <= cells and cells >= LEAST else None
    if cells < LEAST:
        return None
    spend(M.nrows * (8 + M.ncols))
    nonzero = sum(map(bool, chain.from_iterable(M.rows)))
    if SHARE * nonzero > cells:
        return None
    spend(100 * nonzero)
    entries = [(i, j, x) for i, row in enumerate(M.rows) for j, x in enumerate(row) if x]
    return SparseMatrix(M.nrows, M.ncols, entries, M.denominator)


def entries_of(M: Matrix) -> list[Entry]:
    """The entries of any matrix that are not 0, row by row."""
    if isinstance(M, SparseMatrix):
        return M.entries
    spend(M.nrows * (8 + M.ncols))
    spend(100 * sum(map(bool, chain.from_iterable(M.rows))))
    return [(i, j, row[j]) for i, row in enumerate(M.rows) for j in compress(count(), row)]


def within(M: Matrix, rows: Mapping[int, int] | None, cols: Mapping[int, int] | None) -> Matrix:
    """The submatrix of some rows and columns, whose new places increase; None stands for all."""
    nrows = M.nrows if rows is None else len(rows)
    ncols = M.ncols if cols is None else len(cols)
    if not isinstance(M, SparseMatrix):
        return M.take(rows, cols)
    down = M.entries
    if rows is not None:
        spend(100 * len(rows))
        starts = ((k, *(bisect_left(down, (i + end,)) for end in (0, 1))) for i, k in rows.items())
        down = [(k, j, x) for k, start, end in starts for _, j, x in down[start:end]]
    spend(100 * len(down))
    kept = [(i, j if cols is None else cols.get(j), x) for i, j, x in down]
    renumbered = [(i, j, x) for i, j, x in kept if j is not None]
    return SparseMatrix(nrows, ncols, renumbered, M.denominator)


def residues(M: Matrix, ell: int) -> list[Entry]:
    """The entries modulo ℓ, which is coprime to the denominator."""
    entries, a, b = entries_of(M), M.limbs, budget.limbs([ell])
    spend(budget.inversions(1, b) + budget.reductions(len(entries) + 1, a + b, b))
    f = inverse(M.denominator, ell)
    return [(i, j, f * x % ell) for i, j, x in entries]
