"""Matrices and polynomials modulo word-size primes, and rational reconstruction from residues.

Exact decisions compute modulo a prime ℓ first, since a residue is one machine word whatever the
length of the entries.  The rank modulo ℓ is at most the rank over Q, so it proves a lower bound;
an upper bound needs a proof over Q.

`primes` draws primes from a seed, the same on every machine; by default they have 30 bits, so
that the checker, which uses no library, multiplies residues quickly.  `ModularMatrix` and
`ModularPolynomial` are immutable and compute with flint; moduli for which flint would abort are
refused.

`combine` joins residues for coprime moduli, and `rational` and `rationals` find the fractions
with small numerators and denominators that have these residues.  They are candidates: the caller
verifies them.
"""

from __future__ import annotations

import math
import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from math import isqrt
from typing import Any

import flint

from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import Matrix, require_positions, require_sizes
from mcexact.exact.polynomial import Polynomial

# Word-size primes, and rational numbers modulo them.

# A product of two residues below 2**30 has two digits of a Python integer, so the checker, which
# has no library, is fast at such moduli; flint is fast at any modulus below 2**63.
_BITS = 30


@lru_cache(maxsize=1024)
def _is_prime(ell: int) -> bool:
    return bool(flint.fmpz(ell).is_prime())


def require_prime(ell: int) -> None:
    """Raise an error for a modulus for which flint would abort."""
    if type(ell) is not int or not 2 <= ell < 2**63 or not _is_prime(ell):
        raise InputError(f"expected a prime modulus below 2**63, found {ell!r}")


def primes(seed: int, bits: int = _BITS) -> Iterator[int]:
    """Yield primes with exactly this many bits, drawn from a seed, without end.

    Parameters
    ----------
    seed : int
        The same seed gives the same primes, on every machine.
    bits : int
        From 8 to 63.

    Examples
    --------
    >>> stream = primes(7)
    >>> all(2**29 < next(stream) < 2**30 for _ in range(5))
    True
    """
    if not 8 <= bits <= 63:
        raise InputError(f"expected primes of 8 to 63 bits, found {bits}")
    rng = random.Random(seed)
    while True:
        candidate = rng.getrandbits(bits) | 1 << bits - 1 | 1
        if flint.fmpz(candidate).is_prime():
            yield candidate


def long_prime(rng: random.Random, bits: int) -> int:
    """Draw a prime with exactly this many bits, more than a machine word has."""
    while True:
        candidate = rng.getrandbits(bits) | 1 << bits - 1 | 1
        if flint.fmpz(candidate).is_probable_prime() and flint.fmpz(candidate).is_prime():
            return candidate


def residue(q: Fraction | int, ell: int) -> int:
    """A rational number modulo a prime that does not divide its denominator.

    Examples
    --------
    >>> residue(Fraction(1, 2), 7)
    4
    """
    if q.denominator % ell == 0:
        raise divides_denominator(ell)
    return q.numerator * pow(q.denominator, -1, ell) % ell


def divides_denominator(ell: int) -> InputError:
    return InputError(f"the modulus {ell} divides a denominator; draw another")


# Polynomials modulo word-size primes.


@dataclass(frozen=True, eq=False)
class ModularPolynomial:
    """A polynomial over the field with ℓ elements.

    Attributes
    ----------
    modulus : int
        A prime ℓ below 2**63.

    Examples
    --------
    >>> p = ModularPolynomial.from_coefficients([-1, 0, 1], 7)
    >>> p.degree, p.roots(), p.gcd(ModularPolynomial.from_coefficients([1, 1], 7)).coefficients
    (2, [1, 6], (1, 1))
    """

    modulus: int
    _poly: flint.nmod_poly

    @classmethod
    def from_coefficients(cls, coefficients: Iterable[int], modulus: int) -> ModularPolynomial:
        """The polynomial with integer coefficients, constant term first, reduced modulo ℓ."""
        require_prime(modulus)
        return cls(modulus, flint.nmod_poly([int(c) % modulus for c in coefficients], modulus))

    @cached_property
    def coefficients(self) -> tuple[int, ...]:
        """Residues from 0 to ℓ − 1, constant term first, the last one not 0."""
        return tuple(map(int, self._poly.coeffs()))

    @property
    def degree(self) -> int:
        """The degree; −1 for 0."""
        return int(self._poly.degree())

    def __call__(self, value: int) -> int:
        """The value at a residue."""
        return int(self._poly(value % self.modulus))

    def _same(self, other: ModularPolynomial) -> None:
        if self.modulus != other.modulus:
            raise InputError(f"moduli do not match: {self.modulus} and {other.modulus}")

    def __add__(self, other: ModularPolynomial) -> ModularPolynomial:
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly + other._poly)

    def __sub__(self, other: ModularPolynomial) -> ModularPolynomial:
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly - other._poly)

    def __mul__(self, other: ModularPolynomial) -> ModularPolynomial:
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly * other._poly)

    def __divmod__(self, other: ModularPolynomial) -> tuple[ModularPolynomial, ModularPolynomial]:
        self._same(other)
        if other.degree < 0:
            raise ZeroDivisionError("division by the zero polynomial")
        quotient, remainder = divmod(self._poly, other._poly)
        return (
            ModularPolynomial(self.modulus, quotient),
            ModularPolynomial(self.modulus, remainder),
        )

    def __floordiv__(self, other: ModularPolynomial) -> ModularPolynomial:
        return divmod(self, other)[0]

    def __mod__(self, other: ModularPolynomial) -> ModularPolynomial:
        return divmod(self, other)[1]

    def gcd(self, other: ModularPolynomial) -> ModularPolynomial:
        """The monic greatest common divisor; 0 only of two zeros."""
        self._same(other)
        return ModularPolynomial(self.modulus, self._poly.gcd(other._poly))

    def inverse_modulo(self, other: ModularPolynomial) -> ModularPolynomial | None:
        """The inverse modulo another polynomial; None if they have a common factor."""
        self._same(other)
        divisor, inverse, _ = self._poly.xgcd(other._poly)
        return ModularPolynomial(self.modulus, inverse) if divisor.degree() == 0 else None

    def divides(self, other: ModularPolynomial) -> bool:
        """Whether other is a multiple of this polynomial."""
        if self.degree < 0:
            return other.degree < 0
        return (other % self).degree < 0

    def multiplicity_in(self, other: ModularPolynomial) -> int:
        """The largest e with this polynomial, of degree ≥ 1, to the e dividing other, not 0."""
        if self.degree < 1 or other.degree < 0:
            raise InputError("expected a divisor of degree at least 1 and a nonzero polynomial")
        count = 0
        quotient, remainder = divmod(other, self)
        while remainder.degree < 0:
            count += 1
            quotient, remainder = divmod(quotient, self)
        return count

    def roots(self) -> list[int]:
        """The distinct roots in the field with ℓ elements, ascending."""
        if self.degree < 0:
            raise InputError("expected a nonzero polynomial: every residue is a root of 0")
        if self.degree == 0:
            return []
        return sorted(int(root) for root, _ in self._poly.roots())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ModularPolynomial):
            return NotImplemented
        return self.modulus == other.modulus and self.coefficients == other.coefficients

    def __hash__(self) -> int:
        return hash((self.modulus, self.coefficients))

    def __reduce__(self) -> tuple[Any, ...]:
        return ModularPolynomial.from_coefficients, (self.coefficients, self.modulus)

    def __repr__(self) -> str:
        return f"ModularPolynomial({list(self.coefficients)}, modulus={self.modulus})"


def polynomial_residues(p: Polynomial, ell: int) -> ModularPolynomial:
    """A rational polynomial modulo a prime that divides no denominator of its coefficients."""
    return ModularPolynomial.from_coefficients([residue(c, ell) for c in p.coefficients], ell)


# Matrices modulo word-size primes.


@dataclass(frozen=True, eq=False)
class ModularMatrix:
    """A matrix over the field with ℓ elements.

    Attributes
    ----------
    modulus : int
        A prime ℓ below 2**63.

    Notes
    -----
    Immutable and hashable.  Made by `residues`, `from_rows`, `scalar`, `zeros`, `random_matrix`.

    Examples
    --------
    >>> M = ModularMatrix.from_rows([[1, 2], [2, 4]], 7)
    >>> M.rank(), M.nullspace()[0].rows()
    (1, [[5], [1]])
    """

    modulus: int
    _table: flint.nmod_mat

    @classmethod
    def from_rows(
        cls, rows: Iterable[Iterable[int]], modulus: int, ncols: int | None = None
    ) -> ModularMatrix:
        """The matrix with rows of integers, reduced modulo ℓ; `ncols` where there are no rows."""
        require_prime(modulus)
        table = [list(row) for row in rows]
        width = (len(table[0]) if table else 0) if ncols is None else ncols
        require_sizes(len(table), width)
        if any(len(row) != width for row in table):
            raise InputError(f"expected rows of {width} entries each")
        entries = [entry for row in table for entry in row]
        try:
            return cls(modulus, flint.nmod_mat(len(table), width, entries, modulus))
        except (OverflowError, TypeError):
            raise InputError("expected integer entries") from None

    @classmethod
    def zeros(cls, nrows: int, ncols: int, modulus: int) -> ModularMatrix:
        """The nrows × ncols zero matrix."""
        require_prime(modulus)
        require_sizes(nrows, ncols)
        return cls(modulus, flint.nmod_mat(nrows, ncols, modulus))

    @classmethod
    def scalar(cls, n: int, value: int, modulus: int) -> ModularMatrix:
        """The n × n matrix value·I."""
        diagonal = cls.zeros(n, n, modulus)
        for i in range(n):
            diagonal._table[i, i] = value % modulus
        return diagonal

    @classmethod
    def identity(cls, n: int, modulus: int) -> ModularMatrix:
        """The n × n identity matrix."""
        return cls.scalar(n, 1, modulus)

    @property
    def nrows(self) -> int:
        """Number of rows."""
        return self._table.nrows()

    @property
    def ncols(self) -> int:
        """Number of columns."""
        return self._table.ncols()

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self.nrows, self.ncols

    @property
    def T(self) -> ModularMatrix:
        """The transpose."""
        return ModularMatrix(self.modulus, self._table.transpose())

    def rows(self) -> list[list[int]]:
        """The entries, residues from 0 to ℓ − 1."""
        return [list(map(int, row)) for row in self._table.tolist()]

    def entries(self) -> list[int]:
        """The entries row by row, residues from 0 to ℓ − 1."""
        return list(map(int, self._table.entries()))

    def __getitem__(self, position: tuple[int, int]) -> int:
        i, j = position
        if not (0 <= i < self.nrows and 0 <= j < self.ncols):
            raise IndexError(f"no entry ({i}, {j}) in a {self.nrows} × {self.ncols} matrix")
        return int(self._table[i, j])

    def take(
        self, rows: Sequence[int] | None = None, cols: Sequence[int] | None = None
    ) -> ModularMatrix:
        """The submatrix with these rows and columns, in the order given; None takes all."""
        chosen_rows = range(self.nrows) if rows is None else rows
        chosen_cols = range(self.ncols) if cols is None else cols
        require_positions(self.shape, rows, cols)
        entries = [self._table[i, j] for i in chosen_rows for j in chosen_cols]
        table = flint.nmod_mat(len(chosen_rows), len(chosen_cols), entries, self.modulus)
        return ModularMatrix(self.modulus, table)

    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        return not bool(self._table)

    def _like(self, other: ModularMatrix, operation: str, fits: bool) -> None:
        if self.modulus != other.modulus:
            raise InputError(f"moduli do not match: {self.modulus} and {other.modulus}")
        if not fits:
            raise InputError(
                f"shapes do not match: {self.nrows} × {self.ncols} {operation} "
                f"{other.nrows} × {other.ncols}"
            )

    def __add__(self, other: ModularMatrix) -> ModularMatrix:
        self._like(other, "+", self.shape == other.shape)
        return ModularMatrix(self.modulus, self._table + other._table)

    def __sub__(self, other: ModularMatrix) -> ModularMatrix:
        self._like(other, "-", self.shape == other.shape)
        return ModularMatrix(self.modulus, self._table - other._table)

    def __neg__(self) -> ModularMatrix:
        return ModularMatrix(self.modulus, -self._table)

    def __matmul__(self, other: ModularMatrix) -> ModularMatrix:
        self._like(other, "@", self.ncols == other.nrows)
        return ModularMatrix(self.modulus, self._table * other._table)

    def __mul__(self, factor: int) -> ModularMatrix:
        return ModularMatrix(self.modulus, self._table * (factor % self.modulus))

    __rmul__ = __mul__

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ModularMatrix):
            return NotImplemented
        return (
            self.modulus == other.modulus
            and self.shape == other.shape
            and bool(self._table == other._table)
        )

    def __hash__(self) -> int:
        return hash((self.modulus, self.shape, tuple(map(tuple, self.rows()))))

    def __reduce__(self) -> tuple[Any, ...]:
        return ModularMatrix.from_rows, (self.rows(), self.modulus, self.ncols)

    def __repr__(self) -> str:
        return f"ModularMatrix({self.rows()}, modulus={self.modulus}, shape={self.shape})"

    def rank(self) -> int:
        """The rank over the field with ℓ elements."""
        return int(self._table.rank())

    def characteristic_polynomial(self) -> ModularPolynomial:
        """det(xI − M) of a square matrix."""
        self._require_square()
        return ModularPolynomial(self.modulus, self._table.charpoly())

    def minimal_polynomial(self) -> ModularPolynomial:
        """The minimal polynomial of a square matrix."""
        self._require_square()
        return ModularPolynomial(self.modulus, self._table.minpoly())

    def _require_square(self) -> None:
        if self.nrows != self.ncols:
            raise InputError(f"expected a square matrix, found {self.nrows} × {self.ncols}")

    def rref(self) -> tuple[ModularMatrix, tuple[int, ...]]:
        """The reduced row echelon form, of the same shape, and its pivot columns."""
        reduced, rank = self._table.rref()
        return ModularMatrix(self.modulus, reduced), _pivots(reduced, rank)

    def nullspace(self) -> tuple[ModularMatrix, tuple[int, ...]]:
        """A basis of {x : Mx = 0} as columns, and its rows that form the identity."""
        reduced, rank = self._table.rref()
        pivots = _pivots(reduced, rank)
        bound = set(pivots)
        free = tuple(j for j in range(self.ncols) if j not in bound)
        basis = ModularMatrix.zeros(self.ncols, len(free), self.modulus)
        for k, j in enumerate(free):
            basis._table[j, k] = 1
            for i, pivot in enumerate(pivots):
                if pivot > j:
                    break
                basis._table[pivot, k] = -reduced[i, j]
        return basis, free

    def determinant(self) -> int:
        """The determinant of a square matrix, a residue from 0 to ℓ − 1; 1 if it is 0 × 0."""
        self._require_square()
        return int(self._table.det())

    def solve(self, right: ModularMatrix) -> ModularMatrix | None:
        """The X with M X = right for a square M; None if M is singular."""
        self._require_square()
        self._like(right, "solved for", self.nrows == right.nrows)
        try:
            return ModularMatrix(self.modulus, self._table.solve(right._table))
        except ZeroDivisionError:
            return None

    def inverse(self) -> ModularMatrix | None:
        """The inverse of a square matrix; None if it is singular."""
        self._require_square()
        try:
            return ModularMatrix(self.modulus, self._table.inv())
        except ZeroDivisionError:
            return None


def _pivots(reduced: flint.nmod_mat, rank: int) -> tuple[int, ...]:
    """The pivot columns of a reduced row echelon form."""
    pivots, j = [], 0
    for i in range(rank):
        while not reduced[i, j]:
            j += 1
        pivots.append(j)
    return tuple(pivots)


def hstack(matrices: Sequence[ModularMatrix]) -> ModularMatrix:
    """Return the matrix [M1 M2 …] of one or more modular matrices with equally many rows.

    Each is multiplied by [0 I 0], which is faster than copying its entries.
    """
    if not matrices:
        raise InputError("expected at least one matrix to stack")
    first, width = matrices[0], sum(M.ncols for M in matrices)
    total = flint.nmod_mat(first.nrows, width, first.modulus)
    left = 0
    for M in matrices:
        first._like(M, "stacked with", M.nrows == first.nrows)
        place = flint.nmod_mat(M.ncols, width, first.modulus)
        for j in range(M.ncols):
            place[j, left + j] = 1
        total, left = total + M._table * place, left + M.ncols
    return ModularMatrix(first.modulus, total)


def vstack(matrices: Sequence[ModularMatrix]) -> ModularMatrix:
    """Return the matrix [M1; M2; …] of one or more modular matrices with equally many columns."""
    return hstack([M.T for M in matrices]).T


def residues(M: Matrix, ell: int) -> ModularMatrix:
    """Reduce a rational matrix modulo a prime that does not divide its denominator.

    Raises
    ------
    InputError
        The modulus is not a prime below 2**63, or divides the denominator.

    Examples
    --------
    >>> residues(Matrix.from_rows([["1/2", 3]]), 7).rows()
    [[4, 3]]
    """
    require_prime(ell)
    if M.denominator % ell == 0:
        raise divides_denominator(ell)
    table = flint.nmod_mat(M._integer, ell)
    if M.denominator != 1:
        table = table * pow(M.denominator, -1, ell)
    return ModularMatrix(ell, table)


def residues_modulo_each(M: Matrix, ells: Sequence[int]) -> list[ModularMatrix]:
    """As `residues`, modulo several primes: long entries are first reduced modulo the product.

    For entries of 13,000 bits and 16 primes of 61 bits at a time this takes a third of the time.
    """
    product = flint.fmpz(math.prod(ells))
    short = flint.fmpz_mat(M.nrows, M.ncols, [entry % product for entry in M._integer.entries()])
    matrices = []
    for ell in ells:
        require_prime(ell)
        if M.denominator % ell == 0:
            raise divides_denominator(ell)
        table = flint.nmod_mat(short, ell) * pow(M.denominator, -1, ell)
        matrices.append(ModularMatrix(ell, table))
    return matrices


def sparse_rank(M: Matrix, ell: int, most: int) -> int:
    """The rank modulo ℓ < 128 of a sparse matrix, eliminated in a narrow band.

    Parameters
    ----------
    M : Matrix
    ell : int
        A prime that does not divide the denominator.
    most : int
        The most entries of rows in the band, summed over all columns.

    Raises
    ------
    LimitReached
        No narrow band was found: elimination would take more entries.

    Notes
    -----
    Columns are in the order of Cuthill and McKee: entries of a row are near each other.
    """
    entries = [(i, j, x % ell) for i, j, x in M.nonzero() if x % ell]
    place = _band_order([(i, j) for i, j, _ in entries], M.shape)
    rows: list[list[tuple[int, int]]] = [[] for _ in range(M.nrows)]
    for i, j, x in entries:
        rows[i].append((place[j], x))
    waiting: list[list[tuple[int, int]]] = [[] for _ in range(M.ncols)]
    for i, row in enumerate(rows):
        if row:
            first = min(row)[0]
            waiting[first].append((i, sum(x << 8 * (k - first) for k, x in row)))
    return len(_banded_pivots(waiting, ell, most))


def krylov_pivots(A: Matrix, B: Matrix, blocks: int, ell: int, most: int) -> list[tuple[int, int]]:
    """The columns A^k b_j, k < blocks, that do not depend modulo ℓ on those before, as (k, j).

    Parameters
    ----------
    A, B : Matrix
        n × n, with few entries that are not 0, and n × p.
    blocks : int
        The columns are those of [B, AB, …], so many blocks.
    ell, most : int
        As for `sparse_rank`.

    Raises
    ------
    LimitReached
        No narrow band was found, or the columns have more than ``most`` entries.

    Examples
    --------
    >>> A = Matrix.from_integers([[0, 1, 0], [0, 0, 0], [0, 0, 0]])
    >>> B = Matrix.from_integers([[0, 0], [1, 0], [0, 1]])
    >>> krylov_pivots(A, B, 2, 7, 1000)
    [(0, 0), (0, 1), (1, 0)]
    """
    # start-up: few plants need it
    import numpy as np
    from scipy.sparse import coo_array

    n, p = B.shape
    if n * p * blocks > most:
        raise LimitReached(f"a Krylov matrix of {n} rows and {p * blocks} columns")
    places = _band_order([(i, j) for i, j, _ in A.nonzero()], A.shape)
    place = np.array([places.get(a, -1) for a in range(n)], dtype=np.int64)
    place[place < 0] = np.setdiff1d(np.arange(n), place)
    tables = []
    for M in (A, B):
        f = pow(M.denominator, -1, ell)
        cells = [(place[i], place[j] if M is A else j, x * f % ell) for i, j, x in M.nonzero()]
        rows, cols, entries = np.array(cells, dtype=np.int64).reshape(-1, 3).T
        tables.append(coo_array((entries, (rows, cols)), shape=M.shape).tocsr())
    waiting: list[list[tuple[int, int]]] = [[] for _ in range(n)]
    power = tables[1].toarray()
    for k in range(blocks):
        for j, column in enumerate(np.ascontiguousarray(power.T, dtype=np.uint8)):
            if kept := column.tobytes().lstrip(b"\0"):
                waiting[n - len(kept)].append((k * p + j, int.from_bytes(kept, "little")))
        power = np.asarray(tables[0] @ power) % ell
    return [divmod(number, p) for number in sorted(_banded_pivots(waiting, ell, most))]


def _band_order(cells: list[tuple[int, int]], shape: tuple[int, int]) -> dict[int, int]:
    """Places of the columns with entries in the order of Cuthill and McKee.

    Rows and columns are nodes of a graph with an edge for each entry.
    """
    # start-up: few plants need it
    import numpy as np
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    r, size = shape[0], sum(shape)
    ends = np.array([(i, r + j) for i, j in cells], dtype=np.int64).reshape(-1, 2).T
    graph = coo_array((np.ones(len(cells), dtype=np.int8), ends), shape=(size, size)).tocsr()
    order = reverse_cuthill_mckee((graph + graph.T).tocsr(), symmetric_mode=True)
    return {int(node) - r: k for k, node in enumerate(order[order >= r])}


def _banded_pivots(waiting: list[list[tuple[int, int]]], ell: int, most: int) -> list[int]:
    """The numbers of the rows that do not depend on rows of lower numbers.

    A row waits for its first column, and is one integer from then on, with a byte for each entry.
    The pivot in a column is the row of the lowest number, so that rows take nothing of later ones.
    """
    pivots, active = list[int](), list[tuple[int, int]]()
    multiples = [bytes(f * x % ell for x in range(256)) for f in range(ell)]
    room = 0  # how many more residues a byte of each row can take
    for new in waiting:
        active += new
        most -= sum(row.bit_length() for _, row in active) // 8
        if most < 0:
            size = f"{sum(map(len, waiting))} × {len(waiting)}"
            raise LimitReached(f"elimination in a {size} matrix, which has no narrow band")
        if not room:
            room = 255 // (ell - 1) - 1
            reduced = ((number, _times(row, multiples[1])) for number, row in active)
            active = [(number, row) for number, row in reduced if row]
        room -= 1
        meeting = [(number, row) for number, row in active if (row & 255) % ell]
        if not meeting:
            active = [(number, row >> 8) for number, row in active]
            continue
        number, pivot = min(meeting)
        active.remove((number, pivot))
        pivots.append(number)
        f = -pow(pivot & 255, -1, ell)
        taken = [_times(pivot, multiples[f * x % ell]) for x in range(ell)]
        active = [(number, (row + taken[(row & 255) % ell]) >> 8) for number, row in active]
    return pivots


def _times(row: int, table: bytes) -> int:
    data = row.to_bytes((row.bit_length() + 7) // 8, "little")
    return int.from_bytes(data.translate(table), "little")


def random_matrix(nrows: int, ncols: int, ell: int, rng: random.Random) -> ModularMatrix:
    """Draw a matrix of independent uniform residues, row by row."""
    require_prime(ell)
    require_sizes(nrows, ncols)
    entries = [rng.randrange(ell) for _ in range(nrows * ncols)]
    return ModularMatrix(ell, flint.nmod_mat(nrows, ncols, entries, ell))


def low_rank_update(
    A: ModularMatrix, B: ModularMatrix, F: ModularMatrix, C: ModularMatrix
) -> ModularMatrix:
    """Compute A + B F C for stacked inputs and outputs, which may be empty."""
    if not B.ncols or not C.nrows:
        return A
    return A + (B @ F) @ C if B.ncols > C.nrows else A + B @ (F @ C)


# Rational numbers from their residues: Chinese remainders and rational reconstruction.


def combine(
    first: Sequence[Sequence[int]], modulus: int, second: Sequence[Sequence[int]], ell: int
) -> list[list[int]]:
    """Compute residues modulo ``modulus·ell`` that agree with both tables of residues.

    Parameters
    ----------
    first : rows of int
        Residues modulo ``modulus``.
    modulus, ell : int
        Coprime.
    second : rows of int
        Residues modulo ``ell``, the same shape as ``first``.

    Examples
    --------
    >>> combine([[2]], 3, [[3]], 5)
    [[8]]
    """
    inverse = pow(modulus, -1, ell)
    return [
        [a + modulus * ((b - a) * inverse % ell) for a, b in zip(row, other, strict=True)]
        for row, other in zip(first, second, strict=True)
    ]


def rational(residue: int, modulus: int, bound: int) -> tuple[int, int] | None:
    """Find the fraction p/q with |p| ≤ bound, 0 < q ≤ bound, p ≡ q·residue, if it exists.

    Examples
    --------
    >>> rational(pow(7, -1, 10007) * 3 % 10007, 10007, 70)
    (3, 7)
    """
    r0, r1, s0, s1 = modulus, residue % modulus, 0, 1
    while r1 > bound:
        quotient = r0 // r1
        r0, r1 = r1, r0 - quotient * r1
        s0, s1 = s1, s0 - quotient * s1
    if s1 == 0 or abs(s1) > bound:
        return None
    return (r1, s1) if s1 > 0 else (-r1, -s1)


def rationals(rows: Sequence[Sequence[int]], modulus: int) -> tuple[list[list[int]], int] | None:
    """Find numerators over one denominator with the given residues; None if an entry has none.

    Returns
    -------
    numerators : rows of int
    denominator : int
        At least 1.

    Notes
    -----
    The result must be verified: residues determine only entries whose numerator and denominator are
    below √(modulus/2).  The denominators found so far are tried first, since the entries of one
    matrix mostly share them.

    Examples
    --------
    >>> rationals([[pow(2, -1, 101), 100]], 101)
    ([[1, -2]], 2)
    """
    bound = isqrt(modulus // 2)
    denominator = 1
    numerators: list[list[tuple[int, int]]] = []
    for row in rows:
        fractions: list[tuple[int, int]] = []
        for value in row:
            if value == 0:
                fractions.append((0, 1))
                continue
            scaled = value * denominator % modulus
            if 2 * scaled > modulus:
                scaled -= modulus
            if -bound <= scaled <= bound:
                fractions.append((scaled, denominator))
                continue
            guess = rational(value * denominator, modulus, bound)
            if guess is None:
                return None
            denominator *= guess[1]
            fractions.append((guess[0], denominator))
        numerators.append(fractions)
    return [[p * (denominator // q) for p, q in fractions] for fractions in numerators], denominator


def integers(residues: Sequence[int], modulus: int) -> list[int]:
    """The representatives in −modulus/2 … modulus/2."""
    return [value - modulus if 2 * value > modulus else value for value in residues]
