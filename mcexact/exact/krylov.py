"""Krylov sequences modulo primes, dense and sparse, recurrences, and invariant subspaces.

For a matrix M, mostly a closed loop A + Σ B_i F_i C_i with drawn gains, modulo a prime ℓ, this
module computes the numbers s_k = c Mᵏ b, k < 2n, and what follows from them.

Recurrences.  A monic d = Σ d_j x^j is a recurrence of s if Σ_j d_j s_{k+j} = 0 for all k.  Its
numerator num = Σ_i x^i Σ_{j>i} d_j s_{j−i−1} is the polynomial part of d·Σ s_k x^{−k−1}, and d is
the least recurrence iff d and num are coprime, which `cofactors` proves.  The least recurrence
divides the minimal polynomial of M; if its degree is n, it is the characteristic polynomial.

Dense loops (`FloatLoop`, `KrylovSteps`).  A double holds every integer up to 2**53, and a single
up to 2**24.  If n(ℓ/2)² is below that, floating-point products of matrices of symmetric residues,
of absolute value at most about ℓ/2, are exact in every order of the additions, so the fastest
routine of the processor computes them (`exact_bits` bounds ℓ).  Sequences are computed from few
powers of M and many products with single vectors.  At n = 200, 400 and 800 a characteristic
polynomial takes 0.5, 0.27 and 0.1 times as long as with flint.  Where the recurrence is too
short, flint computes it.

Sparse loops (`SparseLoop`, if `stays_sparse`).  M is a compressed sparse array, and each number
takes one product of M with a vector.  Residues are reduced modulo ℓ after as many products as
stay exact: modulo 7 with 6 entries a row after 5 products in singles.  `SparsePowers` applies
polynomials of such a matrix to vectors.

Invariant subspaces.  `controllable_subspace` computes ⟨A | B⟩ = im B + A im B + … exactly over Q
from its echelon forms modulo word-size primes, and tests the result in exact arithmetic.
"""

from __future__ import annotations

import random
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import isqrt
from typing import TYPE_CHECKING, Any

import flint

from mcexact.errors import InternalError
from mcexact.exact.matrix import LARGEST_WHOLE, Matrix, offsets
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    combine,
    primes,
    rationals,
    require_prime,
    vstack,
)
from mcexact.exact.modular import residues as modular_residues
from mcexact.exact.tables import is_mostly_zero

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Floats = npt.NDArray[np.floating[Any]]
    import scipy.sparse

    Integers = scipy.sparse.csr_array[np.int64]
    Residues = npt.NDArray[np.int64]


# Linear recurrences modulo primes, and the proof that one of them is the least.


def least_recurrence(sequence: Sequence[int], ell: int) -> ModularPolynomial:
    """The monic recurrence of least degree L of residues modulo a prime; 2L of them determine it.

    By flint's half-gcd.

    Examples
    --------
    >>> least_recurrence([0, 1, 1, 2, 3, 5, 8, 13], 31).coefficients
    (30, 30, 1)
    """
    require_prime(ell)
    ring = flint.fmpz_mod_poly_ctx(flint.fmpz_mod_ctx(ell))
    if not any(sequence):
        return ModularPolynomial.from_coefficients([1], ell)
    coefficients = list(map(int, ring.minpoly(list(sequence)).coeffs()))
    recurrence = ModularPolynomial(ell, flint.nmod_poly(coefficients, ell))
    recurrence.__dict__["coefficients"] = tuple(coefficients)
    return recurrence


def cofactors(
    recurrence: ModularPolynomial, sequence: Sequence[int]
) -> tuple[ModularPolynomial, ModularPolynomial]:
    """The a and e with a·num + e·d = 1, of degrees below those of d and num.

    Parameters
    ----------
    recurrence : ModularPolynomial
        d, of degree L, the least one.
    sequence : sequence of int
        s_0, …, s_{L−1}, and perhaps more.

    Examples
    --------
    >>> a, e = cofactors(least_recurrence([0, 1, 1, 2], 31), [0, 1])
    >>> a.coefficients, e.coefficients
    ((1,), ())
    """
    ell, L = recurrence.modulus, recurrence.degree
    reverse = flint.nmod_poly(list(sequence[:L])[::-1], ell)
    numerator = (recurrence._poly * reverse).right_shift(L)
    _, a, e = numerator.xgcd(recurrence._poly)
    return ModularPolynomial(ell, a), ModularPolynomial(ell, e)


# Dense matrices: Krylov sequences by products that are exact in floating point.

_EXACT_IN_SINGLE = 2**24

# A squaring costs as much as 25 products with a row at n = 130, and 600 at n = 1600.
_FEW_SQUARINGS = 256
# From this number of states on, a product with a row costs more than reducing the row.
_REDUCED_ALWAYS = 512
_PART = 2**14

Start = tuple[int, Sequence[int], Sequence[int]]
"""A channel q and residues x, y: b = B_q x and c = y C_q."""


def exact_bits(terms: int) -> int:
    """The largest bit length of a modulus for which sums of this many products are exact.

    Notes
    -----
    `reduce` leaves residues of at most ℓ/2 + 3 in size.  A sum may also contain one residue besides
    the products.

    Examples
    --------
    >>> exact_bits(200), exact_bits(800)
    (23, 22)
    """
    bits = 26
    while _largest_sum(terms, 2**bits) > LARGEST_WHOLE:
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
        closed = self.B @ reduce(heard, self.ell)
        closed += self.A
        return reduce(closed, self.ell)

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
            exact = _EXACT_IN_SINGLE if M.dtype == np.float32 else LARGEST_WHOLE
            norm = np.abs(self.power, out=other).sum(axis=0).max()
            self.at_once = products_at_once(int(norm), ell, exact)

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
        terms: list[int] = (numbers.astype(np.int64) % self.ell).tolist()
        return terms


def loop_sequences(
    A: Matrix,
    B: Sequence[Matrix],
    C: Sequence[Matrix],
    gains: Sequence[Any],
    ell: int,
    starts: Iterable[Start],
) -> Iterator[list[int]]:
    """Compute y C_q (A + Σ B_i F_i C_i)ᵏ B_q x modulo ℓ, k < 2n, for each (q, x, y).

    The other arguments are those of `FloatLoop`.  Its arrays are freed before powers are computed:
    at n = 200, memory that is new to the process takes a fifth of the time.
    """
    loop = FloatLoop(A, B, C, ell)
    M, ends = loop.closed(gains), [loop.ends(*start) for start in starts]
    del loop
    steps = KrylovSteps(M, ell)
    return (steps.sequence(row, column) for row, column in ends)


def products_at_once(norm: int, ell: int, exact: int) -> int:
    """The number of products with a matrix after which residues have to be reduced to stay exact.

    Parameters
    ----------
    norm : int
        The largest 1-norm of what a vector is multiplied by: of a row in M v, of a column in v M.
    ell : int
    exact : int
        Integers of at most this size are exact.

    Examples
    --------
    >>> products_at_once(300, 7, 2**24), products_at_once(300, 7, 2**53)
    (2, 6)
    """
    largest, products = ell // 2 + 3, 0
    while products < 64 and largest * norm <= exact - ell:
        largest, products = largest * norm, products + 1
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
    table = together.astype(kind)
    most = max(table.max(initial=0), -table.min(initial=0))
    if most >= _EXACT_IN_SINGLE // 2:
        table[:] = together % ell
    if most > ell // 2:
        reduce(table, ell)
    if any(M.denominator != 1 for M in parts):
        inverses = [pow(M.denominator, -1, ell) for M in parts]
        table *= np.array(inverses, kind).repeat([M.nrows * M.ncols for M in parts])
        reduce(table, ell)
    return table


def _words(M: Matrix, ell: int) -> array[int]:
    """The numerators row by row, or residues of them if some are longer than a word."""
    words = M.words
    if words is None:
        return array("q", [entry % ell for row in M.numerators for entry in row])
    return words


def reduce(table: Floats, ell: int) -> Floats:
    """Reduce integers of at most 2**53 − ℓ in size modulo ℓ, to at most ℓ/2 + 3 in size.

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


# Sparse matrices: Krylov sequences by products that are exact in floating point.

# The number of vectors whose needed entries are kept, until one product gives their numbers.
_TOGETHER = 1024


def stays_sparse(A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix]) -> bool:
    """Whether A is sparse, and A + Σ B_i F_i C_i is for all F.

    Examples
    --------
    >>> ring = Matrix.from_entries((99, 99), [(i, (i + 1) % 99, 1) for i in range(99)])
    >>> stays_sparse(ring, [ring.take(cols=[0])], [ring.take(rows=[0])])
    True
    >>> stays_sparse(ring, [Matrix.column([1] * 99)], [Matrix.from_rows([[1] * 99])])
    False
    """
    if not A.is_sparse:
        return False
    most = _entries(A) + sum(_entries(M) * _entries(N) for M, N in zip(B, C, strict=True))
    return is_mostly_zero(A.nrows * A.ncols, most)


def _entries(M: Matrix) -> int:
    return sum(1 for _ in M.nonzero())


class SparseLoop:
    """A, B = [B_1 … B_m] and C = [C_1; …; C_m] modulo ℓ, as sparse arrays of integers.

    Parameters
    ----------
    A : Matrix
        n × n.
    B, C : sequences of Matrix
        n × p_i and q_i × n.
    ell : int
        A prime below 2**24, which divides no denominator.
    """

    def __init__(self, A: Matrix, B: Sequence[Matrix], C: Sequence[Matrix], ell: int) -> None:
        self.ell, self.n = ell, A.nrows
        self.inputs, self.outputs = offsets([M.ncols for M in B]), offsets([M.nrows for M in C])
        self.A = _residues([(A, 0, 0)], A.shape, ell)
        across = [(M, 0, j) for M, j in zip(B, self.inputs, strict=False)]
        down = [(M, i, 0) for M, i in zip(C, self.outputs, strict=False)]
        self.B = _residues(across, (self.n, self.inputs[-1]), ell)
        self.C = _residues(down, (self.outputs[-1], self.n), ell)

    def closed(self, gains: Sequence[Any]) -> Integers:
        """A + Σ B_i F_i C_i, for p_i × q_i rows of integers."""
        import numpy as np
        import scipy.sparse

        listed_gains = [
            (self.inputs[i] + g, self.outputs[i] + h, x)
            for i, rows in enumerate(gains)
            for g, row in enumerate(rows)
            for h, x in enumerate(row)
        ]
        places = np.array(listed_gains, dtype=np.int64).reshape(-1, 3)
        shape = self.inputs[-1], self.outputs[-1]
        F = scipy.sparse.csr_array((places[:, 2], (places[:, 0], places[:, 1])), shape=shape)
        feedback = self._reduced(self.B @ self._reduced(F @ self.C))
        return self._reduced(self.A + feedback)

    def _reduced(self, M: Any) -> Integers:
        """The matrix in symmetric residues modulo ℓ, without stored zeros."""
        import scipy.sparse

        reduced = scipy.sparse.csr_array(M)
        reduced.data = _symmetric(reduced.data, self.ell)
        reduced.eliminate_zeros()
        return reduced

    def sequences(self, M: Integers, starts: Iterable[Start]) -> Iterator[list[int]] | None:
        """The numbers y C_q Mᵏ B_q x modulo ℓ, k < 2n, for each (q, x, y).

        None if not even one step of M is exact in floating point.
        """

        if not steps_at_once(M, self.ell, LARGEST_WHOLE):
            return None
        vectors = (
            (
                _symmetric(self._placed(y, self.outputs[q], self.outputs[-1]) @ self.C, self.ell),
                _symmetric(self.B @ self._placed(x, self.inputs[q], self.inputs[-1]), self.ell),
            )
            for q, x, y in starts
        )
        return (sequence(M, row, column, self.ell, 2 * self.n) for row, column in vectors)

    def _placed(self, entries: Sequence[int], start: int, size: int) -> Any:
        import numpy as np

        vector = np.zeros(size, dtype=np.int64)
        vector[start : start + len(entries)] = entries
        return vector


def steps_at_once(M: Integers, ell: int, exact: int) -> int:
    """`products_at_once` for products M v with a sparse M; 1 if M is 0."""
    return products_at_once(int(abs(M).sum(axis=1).max()), ell, exact) if M.nnz else 1


def sequence(M: Integers, row: Any, column: Any, ell: int, length: int) -> list[int]:
    """The numbers c Mᵏ b modulo ℓ for k below a length, one product with M for each.

    Parameters
    ----------
    M : csr_array of symmetric residues
        `steps_at_once` is at least 1.
    row, column : arrays of symmetric residues
        c and b.
    """
    import numpy as np

    single = steps_at_once(M, ell, _EXACT_IN_SINGLE)
    kind, exact = (np.float32, _EXACT_IN_SINGLE) if single > 1 else (np.float64, LARGEST_WHOLE)
    step, steps = M.astype(kind), steps_at_once(M, ell, exact)
    step.indices, step.indptr = step.indices.astype(np.int32), step.indptr.astype(np.int32)
    where = np.flatnonzero(row)
    v: Any = column.astype(kind)
    numbers: list[int] = []
    for start in range(0, length, _TOGETHER):
        seen = np.empty((min(_TOGETHER, length - start), len(where)), dtype=np.int64)
        for k in range(len(seen)):
            seen[k] = v[where]
            v = step @ v
            if (start + k) % steps == steps - 1:
                v = reduce(v, ell)
        numbers += (seen % ell @ row[where] % ell).tolist()
    return numbers


def _residues(
    parts: Sequence[tuple[Matrix, int, int]], shape: tuple[int, int], ell: int
) -> Integers:
    """The symmetric residues of rational matrices, each placed at its first row and column."""
    import numpy as np
    import scipy.sparse

    entries: list[tuple[int, int, int]] = []
    for M, top, left in parts:
        factor = pow(M.denominator, -1, ell)
        entries += [(top + i, left + j, x * factor % ell) for i, j, x in M.nonzero()]
    table = np.array(entries, dtype=np.int64).reshape(-1, 3)
    values = _symmetric(table[:, 2], ell)
    return scipy.sparse.csr_array((values, (table[:, 0], table[:, 1])), shape=shape)


def _symmetric(values: Any, ell: int) -> Any:
    """Integers less multiples of ℓ, between −ℓ/2 and ℓ/2."""
    return (values + ell // 2) % ell - ell // 2


# Polynomials of a sparse matrix modulo a prime, applied to vectors.


class SparsePowers:
    """An n × n sparse array M of symmetric residues modulo ℓ.

    Parameters
    ----------
    M : csr_array of int64
    ell : int
        A prime for which `largest_prime` is not exceeded.
    """

    def __init__(self, M: Any, ell: int) -> None:
        import numpy as np

        self.M, self.ell, self.n = M.astype(np.float64), ell, M.shape[0]

    def applied(self, p: ModularPolynomial, V: Any) -> Residues:
        """p(M) V modulo ℓ, V n × k residues, by Horner's rule."""
        import numpy as np

        V = reduce(np.array(V, dtype=np.float64), self.ell)
        image: Floats = np.zeros_like(V)
        for c in reversed(p.coefficients):
            factor = c - self.ell if 2 * c > self.ell else c
            image = reduce(self.M @ image + factor * V, self.ell)
        return self._residues(image)

    def product(self, V: Any) -> Residues:
        """M V modulo ℓ, V n × k residues."""
        import numpy as np

        return self._residues(reduce(self.M @ reduce(V.astype(np.float64), self.ell), self.ell))

    def _residues(self, table: Floats) -> Residues:
        import numpy as np

        residues: Residues = table.astype(np.int64) % self.ell
        return residues

    def minimal_polynomial(self, rng: random.Random) -> ModularPolynomial:
        """The least recurrence of c Mᵏ b, c and b drawn: mostly all of the minimal polynomial."""
        import numpy as np

        small = max(1, LARGEST_WHOLE // (max(self.n, 1) * self.ell))
        row = np.array([rng.randrange(small) for _ in range(self.n)], dtype=np.float64)
        drawn = np.array([rng.randrange(self.ell) for _ in range(self.n)], dtype=np.float64)
        v: Floats = reduce(drawn, self.ell)
        numbers = []
        for _ in range(2 * self.n):
            numbers.append(int(row @ v) % self.ell)
            v = reduce(self.M @ v, self.ell)
        return least_recurrence(numbers, self.ell)


def row_echelon(rows: Residues, ell: int) -> tuple[Residues, tuple[int, ...]]:
    """The reduced row echelon form of residues, without rows of zeros, and its pivots."""
    import numpy as np

    left, pivots = np.array(rows, dtype=np.int64) % ell, []
    rank = 0
    while rank < len(left):
        columns = np.flatnonzero(left[rank:].any(axis=0))
        if not len(columns):
            break
        column = int(columns[0])
        at = rank + int(np.flatnonzero(left[rank:, column])[0])
        left[[rank, at]] = left[[at, rank]]
        left[rank] = left[rank] * pow(int(left[rank, column]), -1, ell) % ell
        for i in range(len(left)):
            if i != rank and left[i, column]:
                left[i] = (left[i] - left[i, column] * left[rank]) % ell
        pivots.append(column)
        rank += 1
    return left[:rank], tuple(pivots)


def largest_prime(n: int, terms: int) -> int:
    """A bound for primes modulo which sums of `terms` products and one more are exact.

    Examples
    --------
    >>> largest_prime(10**4, 8).bit_length()
    26
    """
    return min(2**26, 2 * isqrt(LARGEST_WHOLE // (terms + 2)) - 8, 2**52 // max(n, 1))


# The smallest A-invariant subspace that contains im B, over Q.


@dataclass(frozen=True)
class InvariantSubspace:
    """⟨A | B⟩ = im B + A im B + …, as the column space of X.

    Attributes
    ----------
    X : Matrix
        n × d in reduced column echelon form: the rows ``pivots`` form the identity,
        AX = X (AX)[pivots] and B = X B[pivots].
    pivots : tuple of int
    modulus : int
        A prime ℓ modulo which [B, AB, …] has rank d, too.
    """

    X: Matrix
    pivots: tuple[int, ...]
    modulus: int

    @property
    def dimension(self) -> int:
        """d."""
        return len(self.pivots)

    @property
    def free(self) -> tuple[int, ...]:
        """The n − d rows that are not pivots."""
        chosen = set(self.pivots)
        return tuple(i for i in range(self.X.nrows) if i not in chosen)

    def annihilator(self) -> Matrix:
        """W, (n−d) × n with WX = 0, its columns ``free`` the identity."""
        n, free = self.X.nrows, self.free
        place = {pivot: k for k, pivot in enumerate(self.pivots)}
        rows = []
        for f in free:
            row = [0] * n
            for j in range(n):
                if j in place:
                    row[j] = -self.X.numerators[f][place[j]]
            row[f] = self.X.denominator
            rows.append(row)
        return Matrix.from_integers(rows, self.X.denominator, ncols=n)


def krylov_rows(A: Matrix, B: Matrix, ell: int) -> tuple[ModularMatrix, tuple[int, ...]]:
    """The reduced row echelon form of a basis of ⟨A | B⟩', modulo a prime.

    Parameters
    ----------
    A : Matrix
        n × n.
    B : Matrix
        n × p.
    ell : int
        A prime that divides neither denominator.

    Returns
    -------
    rows : ModularMatrix
        d × n; its columns ``pivots`` form the identity.
    pivots : tuple of int

    Notes
    -----
    With S' a basis of im [B, …, A^{k−1}B], [S, A^k S] spans the first 2k blocks: at most 1 + log₂ n
    products.  The iteration ends when a doubling does not raise the rank.
    """
    n = A.nrows
    span, pivots = _row_space(modular_residues(B.T, ell))
    power = modular_residues(A.T, ell)
    while 0 < span.nrows < n:
        wider, wider_pivots = _row_space(vstack([span, span @ power]))
        if wider.nrows == span.nrows:
            break
        span, pivots = wider, wider_pivots
        if span.nrows < n:
            power = power @ power
    return span, pivots


def _row_space(rows: ModularMatrix) -> tuple[ModularMatrix, tuple[int, ...]]:
    """The nonzero rows of the reduced row echelon form, and its pivots."""
    reduced, pivots = rows.rref()
    return reduced.take(rows=range(len(pivots))), pivots


def _usable_primes(A: Matrix, B: Matrix, rng: random.Random) -> Iterator[int]:
    for ell in primes(rng.getrandbits(64)):
        if (A.denominator * B.denominator) % ell:
            yield ell


def controllable_subspace(A: Matrix, B: Matrix, rng: random.Random) -> InvariantSubspace:
    """Compute ⟨A | B⟩ exactly.

    Parameters
    ----------
    A : Matrix
        n × n.
    B : Matrix
        n × p.
    rng : random.Random
        Chooses the primes.

    Notes
    -----
    The reduced echelon form is one matrix over Q; its residues modulo word-size primes are
    combined until a rational matrix of the right pattern passes the exact test AX = X (AX)[pivots],
    B = X B[pivots].  The test makes im X an invariant subspace that contains im B; that its
    dimension is not too large is the rank modulo ℓ.  O(n³ log n) word operations for each prime.
    """
    n = A.nrows
    best: tuple[int, list[int]] = (-1, [])
    table: list[list[int]] = []
    modulus, last, count = 1, 0, 0
    for ell in _usable_primes(A, B, rng):
        span, pivots = krylov_rows(A, B, ell)
        if len(pivots) == n:
            return InvariantSubspace(Matrix.identity(n), tuple(range(n)), ell)
        if not pivots:
            if B.is_zero():
                return InvariantSubspace(Matrix.zeros(n, 0), (), ell)
            continue
        # Primes where the rank drops or the pivots move right are the bad ones.
        pattern = (len(pivots), [-j for j in pivots])
        if pattern < best:
            continue
        rows = span.rows()
        if pattern > best:
            best, table, modulus, count = pattern, [list(row) for row in rows], ell, 1
        else:
            table, modulus, count = combine(table, modulus, rows, ell), modulus * ell, count + 1
        last = ell
        if count & (count - 1) == 0:
            X = _verified(A, B, table, modulus, tuple(pivots))
            if X is not None:
                return InvariantSubspace(X, tuple(pivots), last)
    raise InternalError("the stream of primes is endless")


def _verified(
    A: Matrix, B: Matrix, table: list[list[int]], modulus: int, pivots: tuple[int, ...]
) -> Matrix | None:
    """The rational matrix with these residues, if im X is invariant and contains im B."""
    candidate = rationals(table, modulus)
    if candidate is None:
        return None
    X = Matrix.from_integers(candidate[0], candidate[1], ncols=A.nrows).T
    AX = A @ X
    if X @ AX.take(rows=pivots) != AX or X @ B.take(rows=pivots) != B:
        return None
    return X
