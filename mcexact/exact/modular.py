"""Matrices and polynomials modulo word-size primes: the workhorse of every exact decision."""

from __future__ import annotations

import random
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any

import flint

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial

# A product of two residues below 2**30 stays in two digits of a Python integer: the checker, which
# has no library, is quick at such moduli, and flint is at any below 2**63.
_BITS = 30


@lru_cache(maxsize=1024)
def _is_prime(ell: int) -> bool:
    return bool(flint.fmpz(ell).is_prime())


def _require_prime(ell: int) -> None:
    """Refuse a modulus that flint would abort on."""
    if type(ell) is not int or not 2 <= ell < 2**63 or not _is_prime(ell):
        raise InputError(f"expected a prime modulus below 2**63, found {ell!r}")


def primes(seed: int, bits: int = _BITS) -> Iterator[int]:
    """An endless stream of primes with exactly this many bits, drawn from a seed.

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


def residue(q: Fraction | int, ell: int) -> int:
    """A rational number modulo a prime that does not divide its denominator.

    Examples
    --------
    >>> residue(Fraction(1, 2), 7)
    4
    """
    if q.denominator % ell == 0:
        raise _divides_denominator(ell)
    return q.numerator * pow(q.denominator, -1, ell) % ell


def _divides_denominator(ell: int) -> InputError:
    return InputError(f"the modulus {ell} divides a denominator; draw another")


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
    >>> M.rank(), M.nullspace().rows()
    (1, [[5], [1]])
    """

    modulus: int
    _table: flint.nmod_mat

    @classmethod
    def from_rows(
        cls, rows: Iterable[Iterable[int]], modulus: int, ncols: int | None = None
    ) -> ModularMatrix:
        """The matrix with rows of integers, reduced modulo ℓ; `ncols` where there are no rows."""
        _require_prime(modulus)
        table = [list(row) for row in rows]
        width = (len(table[0]) if table else 0) if ncols is None else ncols
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
        _require_prime(modulus)
        if min(nrows, ncols) < 0:
            raise InputError(f"expected sizes that are at least 0, found {nrows} × {ncols}")
        return cls(modulus, flint.nmod_mat(nrows, ncols, modulus))

    @classmethod
    def scalar(cls, n: int, value: int, modulus: int) -> ModularMatrix:
        """The n × n matrix value·I."""
        made = cls.zeros(n, n, modulus)
        for i in range(n):
            made._table[i, i] = value % modulus
        return made

    @classmethod
    def identity(cls, n: int, modulus: int) -> ModularMatrix:
        """The n × n identity matrix."""
        return cls.scalar(n, 1, modulus)

    @classmethod
    def block_diagonal(
        cls, blocks: Sequence[Sequence[Sequence[int]] | Matrix], modulus: int, *, ncols: int
    ) -> ModularMatrix:
        """The matrix diag(F_1, F_2, …) of integer blocks, only nonzero entries being touched.

        Parameters
        ----------
        blocks : sequence of matrices
            Rows of integers, or rational matrices.
        modulus : int
        ncols : int
            Total number of columns; a block of rows without length takes none.
        """
        tables = [
            [[residue(entry, modulus) for entry in row] for row in block.rows()]
            if isinstance(block, Matrix)
            else block
            for block in blocks
        ]
        widths = [
            block.ncols if isinstance(block, Matrix) else (len(block[0]) if block else 0)
            for block in blocks
        ]
        if sum(widths) > ncols:
            raise InputError(f"expected blocks of {ncols} columns in all, found {sum(widths)}")
        made = cls.zeros(sum(map(len, tables)), ncols, modulus)
        top = left = 0
        for table, width in zip(tables, widths, strict=True):
            for i, row in enumerate(table):
                for j, entry in enumerate(row):
                    if entry:
                        made._table[top + i, left + j] = entry % modulus
            top, left = top + len(table), left + width
        return made

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

    def __getitem__(self, position: tuple[int, int]) -> int:
        i, j = position
        if not (0 <= i < self.nrows and 0 <= j < self.ncols):
            raise IndexError(f"no entry ({i}, {j}) in a {self.nrows} × {self.ncols} matrix")
        return int(self._table[i, j])

    def take(
        self, rows: Sequence[int] | None = None, cols: Sequence[int] | None = None
    ) -> ModularMatrix:
        """The submatrix with these rows and columns, in the order given; None takes all."""
        table = self.rows()
        if rows is not None:
            table = [table[i] for i in rows]
        if cols is not None:
            table = [[row[j] for j in cols] for row in table]
        width = self.ncols if cols is None else len(cols)
        return ModularMatrix.from_rows(table, self.modulus, ncols=width)

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

    def determinant(self) -> int:
        """The determinant of a square matrix."""
        self._require_square()
        return int(self._table.det())

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

    def nullspace(self) -> ModularMatrix:
        """A basis of {x : Mx = 0} as columns, the identity in its rows at the free columns of M."""
        return self.kernel()[0]

    def kernel(self) -> tuple[ModularMatrix, tuple[int, ...]]:
        """`nullspace` and the rows of it that form the identity."""
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

    def solve(self, right: ModularMatrix) -> ModularMatrix | None:
        """One X with MX = right, free unknowns 0; None if there is none."""
        self._like(right, "against", self.nrows == right.nrows)
        reduced, pivots = hstack([self, right]).rref()
        if pivots and pivots[-1] >= self.ncols:
            return None
        X = ModularMatrix.zeros(self.ncols, right.ncols, self.modulus)
        for i, pivot in enumerate(pivots):
            for j in range(right.ncols):
                X._table[pivot, j] = reduced._table[i, self.ncols + j]
        return X

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
    """Modular matrices beside each other, at least one, equally high."""
    return _stacked([M.T for M in matrices]).T


def vstack(matrices: Sequence[ModularMatrix]) -> ModularMatrix:
    """Modular matrices below each other, at least one, equally wide."""
    return _stacked(matrices)


def _stacked(matrices: Sequence[ModularMatrix]) -> ModularMatrix:
    if not matrices:
        raise InputError("expected at least one matrix to stack")
    first = matrices[0]
    for M in matrices:
        first._like(M, "stacked with", M.ncols == first.ncols)
    entries = [entry for M in matrices for entry in M._table.entries()]
    height = sum(M.nrows for M in matrices)
    table = flint.nmod_mat(height, first.ncols, entries, first.modulus)
    return ModularMatrix(first.modulus, table)


def residues(M: Matrix, ell: int) -> ModularMatrix:
    """A rational matrix modulo a prime that does not divide its denominator.

    Raises
    ------
    InputError
        The modulus is not a prime below 2**63, or divides the denominator.

    Examples
    --------
    >>> residues(Matrix.from_rows([["1/2", 3]]), 7).rows()
    [[4, 3]]
    """
    _require_prime(ell)
    if M.denominator % ell == 0:
        raise _divides_denominator(ell)
    table = flint.nmod_mat(M._integer, ell)
    if M.denominator != 1:
        table = table * pow(M.denominator, -1, ell)
    return ModularMatrix(ell, table)


def random_matrix(nrows: int, ncols: int, ell: int, rng: random.Random) -> ModularMatrix:
    """A matrix of independent uniform residues, drawn row by row."""
    _require_prime(ell)
    entries = [rng.randrange(ell) for _ in range(nrows * ncols)]
    return ModularMatrix(ell, flint.nmod_mat(nrows, ncols, entries, ell))


def low_rank_update(
    A: ModularMatrix, B: ModularMatrix, F: ModularMatrix, C: ModularMatrix
) -> ModularMatrix:
    """A + B F C, the closed loop of stacked inputs and outputs; any of them may be empty."""
    if not B.ncols or not C.nrows:
        return A
    return A + (B @ F) @ C if B.ncols > C.nrows else A + B @ (F @ C)


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
        _require_prime(modulus)
        return cls(modulus, flint.nmod_poly([int(c) % modulus for c in coefficients], modulus))

    @property
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
