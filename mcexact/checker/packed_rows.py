"""Rows and polynomials as long integers, with slots for their entries."""

from collections.abc import Iterable, Sequence
from functools import cache
from operator import mul
from typing import Any

from . import budget
from .budget import spend

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
        """The same where no sum of so many rows leaves a byte: rows of one coefficient together."""
        most, tables = most_addends(self.ell), multiples(self.ell)
        parts = len(self.rows) // most + min(len(self.rows), self.ell)
        spend(len(self.rows) * (4 + self._limbs // 16) + (parts + 1) * (40 + self.ncols // 8))
        alike: list[list[int]] = [[] for _ in range(self.ell)]
        for factor, row in zip(u, self.rows, strict=True):
            alike[factor].append(row)
        sums = (
            sum(alike[factor][k : k + most])
            .to_bytes(self.ncols, "little")
            .translate(tables[factor])
            for factor in range(1, self.ell)
            for k in range(0, len(alike[factor]), most)
        )
        return byte_sum(sums, self.ncols, self.ell)


def byte_sum(rows: Iterable[bytes], ncols: int, ell: int) -> bytes:
    """The sum modulo ℓ of rows of residues, which are added as long integers."""
    most, table, total = most_addends(ell), multiples(ell)[1], 0
    for k, row in enumerate(rows, start=1):
        total += int.from_bytes(row, "little")
        if k % (most - 1) == 0:
            total = int.from_bytes(total.to_bytes(ncols, "little").translate(table), "little")
    return total.to_bytes(ncols, "little").translate(table)


def most_addends(ell: int) -> int:
    """How many residues a byte holds the sum of, at least four up to ``SMALL``."""
    return 255 // (ell - 1)


@cache
def multiples(ell: int) -> list[bytes]:
    """The multiples of all bytes modulo ℓ, by the factor."""
    return [bytes(factor * byte % ell for byte in range(256)) for factor in range(ell)]


class Combination:
    """Σ f_k u_k modulo ℓ, for rows u_k of residues that come one after the other."""

    def __init__(self, ncols: int, ell: int) -> None:
        self.ell = ell
        self.row: Sequence[int] = bytes(ncols)

    def add(self, factor: int, u: Sequence[int]) -> None:
        """Add a multiple of a row."""
        ell, ncols = self.ell, len(self.row)
        if ell > SMALL:
            spend(budget.reductions(ncols, budget.limbs([ell])))
            self.row = [(x + factor * y) % ell for x, y in zip(self.row, u, strict=True)]
        else:
            spend(40 + ncols // 8)
            moved = bytes(u).translate(multiples(ell)[factor])
            self.row = byte_sum((bytes(self.row), moved), ncols, ell)

    def is_zero(self) -> bool:
        """Whether the sum so far is 0."""
        return not any(self.row)


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
    slots, found = range(0, ncols * size, size), []
    for u in A:
        total = sum([factor * row for factor, row in zip(u, rows, strict=True) if factor], halves)
        data = total.to_bytes(ncols * size, "little")
        found.append([int.from_bytes(data[k : k + size], "little") - half for k in slots])
    return found


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
