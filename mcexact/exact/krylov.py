"""Krylov sequences modulo primes so small that sums of products are exact in floating point.

A double holds every integer up to 2**53, and a single up to 2**24.  With n(ℓ/2)² below that, a
product of n × n matrices of symmetric residues is exact for every order of its additions, and the
processor's fastest routine for floats computes it.  The numbers c Mᵏ b of 2n terms, in steps of
some powers of two and of one, determine their least recurrence; its polynomial divides the minimal
polynomial of M, so where it has degree n it is the characteristic polynomial.

At n = 200, 400 and 800 a characteristic polynomial takes 0.5, 0.27 and 0.1 times as long as with
flint.
"""

from __future__ import annotations

import random
from array import array
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import flint

from mcexact.exact.blocks import offsets
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular_polynomial import ModularPolynomial
from mcexact.exact.recurrence import least_recurrence

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.floating[Any]]

_EXACT = 2**53
_EXACT_IN_SINGLE = 2**24

# A squaring costs as much as 25 products with a row at n = 130, and 600 at n = 1600.
_FEW_SQUARINGS = 256
# From so many states on, products with a row cost more than to reduce the row.
_REDUCED_ALWAYS = 512
_PART = 2**14

Start = tuple[int, Sequence[int], Sequence[int]]
"""A channel q and residues x, y: b = B_q x and c = y C_q."""


def exact_bits(terms: int) -> int:
    """The largest bit length of a modulus for which sums of this many products are exact.

    Notes
    -----
    `reduced` leaves residues of at most ℓ/2 + 3, and takes off a multiple of ℓ.  One more residue
    may be added to a sum before.

    Examples
    --------
    >>> exact_bits(200), exact_bits(800)
    (23, 22)
    """
    bits = 26
    while _largest_sum(terms, 2**bits) > _EXACT:
        bits -= 1
    return bits


def _largest_sum(terms: int, ell: int) -> int:
    return (terms + 1) * (ell // 2 + 3) ** 2 + ell


class FloatLoop:
    """A, B = [B_1 … B_m] and C = [C_1; …; C_m] as arrays of symmetric residues modulo ℓ.

    Parameters
    ----------
    A : Matrix
        n × n.
    B, C : sequences of Matrix
        n × p_i and q_i × n.
    ell : int
        A prime of at most ``exact_bits`` of the longest sum: n, Σ p_i, or a q_i.  It divides no
        denominator.
    """

    def __init__(self, A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix], ell: int) -> None:
        import numpy as np

        self.ell, n = ell, A.nrows
        widths = [M.ncols for M in B]
        self.inputs, self.outputs = offsets(widths), offsets([M.nrows for M in C])
        terms = max(n, self.inputs[-1], self.outputs[-1])
        single = _largest_sum(terms, ell) <= _EXACT_IN_SINGLE
        self.kind: type[np.floating[Any]] = np.float32 if single else np.float64
        self.A = residues([A], ell, self.kind).reshape(n, n)
        self.C = residues(C, ell, self.kind).reshape(self.outputs[-1], n)
        inputs = residues(B, ell, self.kind)
        if set(widths) == {1}:
            self.B = inputs.reshape(len(B), n).T
        else:
            ends = pairwise(n * start for start in self.inputs)
            blocks = [
                inputs[slice(*end)].reshape(n, p) for end, p in zip(ends, widths, strict=True)
            ]
            self.B = np.hstack([np.zeros((n, 0), self.kind), *blocks])

    def closed(self, gains: Sequence[Any]) -> Floats:
        """A + Σ B_i F_i C_i, for p_i × q_i rows of integers."""
        import numpy as np

        single = range(len(gains) + 1)
        if self.inputs == self.outputs == list(single):
            scales = np.array([F[0][0] for F in gains], self.kind)
            heard = reduce(scales, self.ell)[:, None] * self.C
        else:
            F = np.zeros((self.inputs[-1], self.outputs[-1]), self.kind)
            places = pairwise(self.inputs), pairwise(self.outputs)
            for (top, bottom), (left, right), rows in zip(*places, gains, strict=True):
                if rows:
                    F[top:bottom, left:right] = rows
            heard = reduce(F, self.ell) @ self.C
        moved = self.B @ reduce(heard, self.ell)
        moved += self.A
        return reduce(moved, self.ell)

    def ends(self, q: int, x: Sequence[int], y: Sequence[int]) -> tuple[Floats, Floats]:
        """The row y C_q and the column B_q x."""
        some_inputs = self.B[:, self.inputs[q] : self.inputs[q + 1]]
        some_outputs = self.C[self.outputs[q] : self.outputs[q + 1]]
        row = reduce(self._vector(y) @ some_outputs, self.ell)
        return row, reduce(some_inputs @ self._vector(x), self.ell)

    def _vector(self, x: Sequence[int]) -> Floats:
        import numpy as np

        return reduce(np.array(x, dtype=self.kind), self.ell)


class KrylovSteps:
    """An n × n array of symmetric residues and a power of it, with which sequences are computed."""

    def __init__(self, M: Floats, ell: int) -> None:
        import numpy as np

        self.ell, self.M, self.power, self.steps = ell, M, M, 1
        other: Floats | None = None
        for _ in range(min(3 if len(M) < _FEW_SQUARINGS else 2, len(M).bit_length() // 2)):
            squared = np.matmul(self.power, self.power, out=other)
            other = None if self.power is M else self.power
            self.power, self.steps = reduce(squared, ell), 2 * self.steps
        self.at_once = 1
        if 0 < len(M) < _REDUCED_ALWAYS:
            exact = _EXACT_IN_SINGLE if M.dtype == np.float32 else _EXACT
            growth = np.abs(self.power, out=other).sum(axis=0).max()
            self.at_once = products_at_once(int(growth), ell, exact)

    def sequence(self, row: Floats, column: Floats) -> list[int]:
        """The numbers c Mᵏ b, k < 2n: (c M^{hg})(M^j b) for k = hg + j, j < h."""
        import numpy as np

        n, h = len(row), self.steps
        columns = np.empty((h, n), dtype=row.dtype)
        rows = np.empty((-(-2 * n // h), n), dtype=row.dtype)
        columns[0], rows[:1] = column, row
        for j in range(1, h):
            reduce(np.matmul(self.M, columns[j - 1], out=columns[j]), self.ell)
        for g in range(1, len(rows)):
            np.matmul(rows[g - 1], self.power, out=rows[g])
            if g % self.at_once == 0:
                reduce(rows[g], self.ell)
        numbers = reduce(reduce(rows, self.ell) @ columns.T, self.ell).ravel()[: 2 * n]
        found: list[int] = (numbers.astype(np.int64) % self.ell).tolist()
        return found


def loop_sequences(
    A: Matrix,
    B: Sequence[Matrix],
    C: Sequence[Matrix],
    gains: Sequence[Any],
    ell: int,
    starts: Iterable[Start],
) -> Iterator[list[int]]:
    """Compute y C_q (A + Σ B_i F_i C_i)ᵏ B_q x modulo ℓ, k < 2n, for each (q, x, y).

    The other arguments are those of `FloatLoop`.  Its arrays are let go before there are powers:
    at n = 200, pages of memory that are new to the process take a fifth of the time.
    """
    loop = FloatLoop(A, B, C, ell)
    M, ends = loop.closed(gains), [loop.ends(*start) for start in starts]
    del loop
    steps = KrylovSteps(M, ell)
    return (steps.sequence(row, column) for row, column in ends)


def products_at_once(growth: int, ell: int, exact: int) -> int:
    """How many products with a matrix keep residues exact, so that a multiple of ℓ can go.

    Parameters
    ----------
    growth : int
        The largest sum of the sizes of entries that are multiplied: of a row in M v, of a column in
        v M.
    ell : int
    exact : int
        Integers of at most this size are exact.

    Examples
    --------
    >>> products_at_once(300, 7, 2**24), products_at_once(300, 7, 2**53)
    (2, 6)
    """
    largest, products = ell // 2 + 3, 0
    while products < 64 and largest * growth <= exact - ell:
        largest, products = largest * growth, products + 1
    return products


def loop_polynomials(
    A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix], gains: Sequence[Any], ell: int
) -> tuple[ModularPolynomial, ModularPolynomial]:
    """Compute χ_A and χ_{A + Σ B_i F_i C_i} modulo ℓ; the arguments are those of `FloatLoop`."""
    loop = FloatLoop(A, B, C, ell)
    closed = loop.closed(gains)
    return characteristic_polynomial(loop.A, ell), characteristic_polynomial(closed, ell)


def characteristic_polynomial(M: Floats, ell: int) -> ModularPolynomial:
    """Compute det(xI − M) for an n × n array of symmetric residues modulo a prime ℓ.

    If the sequence has a shorter recurrence, flint computes the polynomial.  This is always so for
    a matrix whose minimal polynomial is not its characteristic polynomial.
    """
    import numpy as np

    n, draw = len(M), random.Random(ell).randrange
    drawn = np.array([draw(ell) for _ in range(2 * n)], dtype=M.dtype)
    row, column = reduce(drawn, ell).reshape(2, n)
    sequence = KrylovSteps(M, ell).sequence(row, column)
    recurrence = least_recurrence(sequence, ell)
    if recurrence.degree == n:
        return recurrence
    entries = (M.astype(np.int64) % ell).ravel().tolist()
    return ModularPolynomial(ell, flint.nmod_mat(n, n, entries, ell).charpoly())


def residues(parts: Sequence[Matrix], ell: int, kind: type[np.floating[Any]]) -> Floats:
    """The symmetric residues of rational matrices, row by row, one matrix after the other."""
    import numpy as np

    words = [_words(M, ell) for M in parts]
    together = np.frombuffer(words[0] if len(words) == 1 else b"".join(words), dtype=np.int64)
    found = together.astype(kind)
    most = max(found.max(initial=0), -found.min(initial=0))
    if most >= _EXACT_IN_SINGLE // 2:
        found[:] = together % ell
    if most > ell // 2:
        reduce(found, ell)
    if any(M.denominator != 1 for M in parts):
        inverses = [pow(M.denominator, -1, ell) for M in parts]
        found *= np.array(inverses, kind).repeat([M.nrows * M.ncols for M in parts])
        reduce(found, ell)
    return found


def _words(M: Matrix, ell: int) -> array[int]:
    """The numerators row by row, or residues of them if some are longer than a word."""
    words = M.words
    if words is None:
        return array("q", [entry % ell for row in M.numerators for entry in row])
    return words


def reduce(table: Floats, ell: int) -> Floats:
    """Take multiples of ℓ off integers of at most 2**53 − ℓ in size: at most ℓ/2 + 3 is left.

    In place, for arrays without gaps, and part by part: new arrays take longer than the arithmetic.

    Notes
    -----
    The quotient has an error of at most 2 units of 2**−53 relative to |x|/ℓ, so that what is left
    exceeds ℓ/2 by at most 2; the multiple and the difference are integers below 2**53.  In singles
    the same holds with 24 in place of 53.
    """
    import numpy as np

    numbers, inverse = table.ravel(order="K"), table.dtype.type(1.0 / ell)
    quotients = np.empty(min(len(numbers), _PART), dtype=table.dtype)
    for start in range(0, len(numbers), _PART):
        part = numbers[start : start + _PART]
        quotient = np.multiply(part, inverse, out=quotients[: len(part)])
        np.rint(quotient, out=quotient)
        quotient *= ell
        part -= quotient
    return table
