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

Start = tuple[int, Sequence[int], Sequence[int]]
"""A channel q and residues x, y: b = B_q x and c = y C_q."""


def exact_bits(terms: int) -> int:
    """The largest bit length of a modulus for which sums of this many products are exact.

    Notes
    -----
    `reduced` leaves residues of at most ℓ/2 + 3, and takes off a multiple of ℓ.

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
    return terms * (ell // 2 + 3) ** 2 + ell


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

        self.ell, self.n = ell, A.nrows
        self.inputs = offsets([M.ncols for M in B])
        self.outputs = offsets([M.nrows for M in C])
        terms = max(self.n, self.inputs[-1], self.outputs[-1])
        single = _largest_sum(terms, ell) <= _EXACT_IN_SINGLE
        self.kind: type[np.floating[Any]] = np.float32 if single else np.float64
        self.A = _residues([A], ell, self.kind)[0]
        if all(M.ncols == M.denominator == 1 for M in B):
            self.B = _numbers(B, ell, self.kind).reshape(len(B), self.n).T
        else:
            self.B = np.hstack([np.zeros((self.n, 0), self.kind), *_residues(B, ell, self.kind)])
        if all(M.denominator == 1 for M in C):
            self.C = _numbers(C, ell, self.kind).reshape(self.outputs[-1], self.n)
        else:
            self.C = np.vstack([np.zeros((0, self.n), self.kind), *_residues(C, ell, self.kind)])

    def closed(self, gains: Sequence[Any]) -> Floats:
        """A + Σ B_i F_i C_i, for p_i × q_i rows of integers."""
        import numpy as np

        F = np.zeros((self.inputs[-1], self.outputs[-1]), self.kind)
        for i, rows in enumerate(gains):
            if rows:
                F[self.inputs[i] : self.inputs[i + 1], self.outputs[i] : self.outputs[i + 1]] = rows
        heard = reduced(reduced(F, self.ell) @ self.C, self.ell)
        return reduced(self.A + reduced(self.B @ heard, self.ell), self.ell)

    def sequences(self, M: Floats, starts: Iterable[Start]) -> Iterator[list[int]]:
        """The numbers y C_q Mᵏ B_q x modulo ℓ, k < 2n, for each (q, x, y)."""
        steps = KrylovSteps(M, self.ell)
        for q, x, y in starts:
            some_inputs = self.B[:, self.inputs[q] : self.inputs[q + 1]]
            some_outputs = self.C[self.outputs[q] : self.outputs[q + 1]]
            column = reduced(some_inputs @ self._vector(x), self.ell)
            row = reduced(self._vector(y) @ some_outputs, self.ell)
            yield steps.sequence(row, column)

    def _vector(self, x: Sequence[int]) -> Floats:
        import numpy as np

        return reduced(np.array(x, dtype=self.kind), self.ell)


class KrylovSteps:
    """Powers of an n × n array of symmetric residues, with which sequences are computed."""

    def __init__(self, M: Floats, ell: int) -> None:
        self.ell, self.powers = ell, [M]
        # at n = 800: three squarings, and 200 products with a row for each sequence
        for _ in range(min(3, len(M).bit_length() // 2)):
            self.powers.append(reduced(self.powers[-1] @ self.powers[-1], ell))

    def sequence(self, row: Floats, column: Floats) -> list[int]:
        """The numbers c Mᵏ b, k < 2n: (c M^{hg})(M^j b) for k = hg + j, j < h."""
        import numpy as np

        *small, power = self.powers
        columns = column[:, None]
        for M in small:
            columns = np.hstack([columns, reduced(M @ columns, self.ell)])
        n, h = columns.shape
        rows = np.empty((-(-2 * n // h), n), dtype=power.dtype)
        for k in range(len(rows)):
            rows[k] = row if k == 0 else reduced(rows[k - 1] @ power, self.ell)
        numbers = reduced(rows @ columns, self.ell).ravel()[: 2 * n]
        found: list[int] = (numbers.astype(np.int64) % self.ell).tolist()
        return found


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
    row, column = reduced(drawn, ell).reshape(2, n)
    sequence = KrylovSteps(M, ell).sequence(row, column)
    recurrence = least_recurrence(sequence, ell)
    if recurrence.degree == n:
        return recurrence
    entries = (M.astype(np.int64) % ell).ravel().tolist()
    return ModularPolynomial(ell, flint.nmod_mat(n, n, entries, ell).charpoly())


def _residues(parts: Sequence[Matrix], ell: int, kind: type[np.floating[Any]]) -> list[Floats]:
    """The symmetric residues of rational matrices, all of them reduced at once."""
    residues, found, start = _numbers(parts, ell, kind), [], 0
    for M in parts:
        part = residues[start : start + M.nrows * M.ncols].reshape(M.shape)
        start += part.size
        if M.denominator != 1:
            part = reduced(part * pow(M.denominator, -1, ell), ell)
        found.append(part)
    return found


def _numbers(parts: Sequence[Matrix], ell: int, kind: type[np.floating[Any]]) -> Floats:
    """The symmetric residues of the numerators of all parts, row by row, one after the other."""
    import numpy as np

    words = b"".join(_words(M, ell) for M in parts)
    together = np.frombuffer(words, dtype=np.int64)
    if max(int(together.max(initial=0)), -int(together.min(initial=0))) >= _EXACT_IN_SINGLE // 2:
        together = together % ell
    return reduced(together.astype(kind), ell)


def _words(M: Matrix, ell: int) -> array[int]:
    """The numerators row by row, or residues of them if some are longer than a word."""
    words = M.words
    if words is None:
        return array("q", [entry % ell for row in M.numerators for entry in row])
    return words


def reduced(table: Floats, ell: int) -> Floats:
    """Integers of at most 2**53 − ℓ in size, each less a multiple of ℓ: at most ℓ/2 + 3 is left.

    The quotient has an error of at most 2 units of 2**−53 relative to |x|/ℓ, so that what is left
    exceeds ℓ/2 by at most 2; the multiple and the difference are integers below 2**53.  In singles
    the same holds with 24 in place of 53.
    """
    import numpy as np

    quotient = table * table.dtype.type(1.0 / ell)
    np.rint(quotient, out=quotient)
    quotient *= ell
    return np.subtract(table, quotient, out=quotient)
