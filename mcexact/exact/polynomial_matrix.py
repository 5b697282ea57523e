"""Matrices of rational polynomials."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, Rows
from mcexact.exact.modular import ModularMatrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class PolynomialMatrix:
    """A matrix of rational polynomials, Σ_k x^k E_k / d with integer matrices E_k.

    Parameters
    ----------
    nrows, ncols : int
        Either may be 0.
    denominator : int
        d ≥ 1, coprime to the entries of all E_k taken together.
    coefficients : tuple of at least one tuple of nrows tuples of ncols int
        E_0, E_1, …; the last one is not zero unless it is the only one.

    Notes
    -----
    Exact, immutable, hashable.  Made by `from_matrices`, `pencil` and `from_polynomials`.

    Examples
    --------
    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2]]), Matrix.from_rows([["1/2", 0]]))
    >>> str(M.entry(0, 0)), str(M.entry(0, 1))
    ('1/2*x', '-2')
    """

    nrows: int
    ncols: int
    denominator: int
    coefficients: tuple[Rows, ...]

    def __post_init__(self) -> None:
        if not self.coefficients:
            raise InputError("expected at least one coefficient matrix")
        for table in self.coefficients:
            Matrix(self.nrows, self.ncols, table, 1)
        if type(self.denominator) is not int or self.denominator < 1:
            raise InputError(f"expected a denominator of at least 1, found {self.denominator!r}")
        if self.denominator != _content(self.coefficients, self.denominator) * self.denominator:
            raise InputError("expected lowest terms; use PolynomialMatrix.from_matrices")
        if len(self.coefficients) > 1 and not any(map(any, self.coefficients[-1])):
            raise InputError("expected a last coefficient matrix that is not zero")

    @classmethod
    def from_matrices(cls, *coefficients: Matrix) -> PolynomialMatrix:
        """Σ_k x^k M_k of rational matrices of one shape, at least one."""
        if not coefficients or len({M.shape for M in coefficients}) != 1:
            raise InputError("expected at least one coefficient matrix, all of one shape")
        denominator = math.lcm(*(M.denominator for M in coefficients))
        tables = [
            tuple(tuple(entry * (denominator // M.denominator) for entry in row) for row in rows)
            for M in coefficients
            for rows in (M.numerators,)
        ]
        return reduced(*coefficients[0].shape, tables, denominator)

    @classmethod
    def pencil(cls, M0: Matrix, M1: Matrix) -> PolynomialMatrix:
        """M0 + x M1."""
        return cls.from_matrices(M0, M1)

    @classmethod
    def from_polynomials(
        cls, rows: Sequence[Sequence[Polynomial]], ncols: int | None = None
    ) -> PolynomialMatrix:
        """The matrix with rows of polynomials; `ncols` where there are no rows."""
        width = (len(rows[0]) if rows else 0) if ncols is None else ncols
        if any(len(row) != width for row in rows):
            raise InputError(f"expected rows of {width} polynomials each")
        denominator = math.lcm(*(p.denominator for row in rows for p in row))
        length = max((len(p.coefficients) for row in rows for p in row), default=0)

        def numerator(p: Polynomial, k: int) -> int:
            known = p.numerators
            return known[k] * (denominator // p.denominator) if k < len(known) else 0

        tables = [
            tuple(tuple(numerator(p, k) for p in row) for row in rows)
            for k in range(max(length, 1))
        ]
        return reduced(len(rows), width, tables, denominator)

    @classmethod
    def identity(cls, n: int) -> PolynomialMatrix:
        """The n × n identity matrix."""
        return cls.from_matrices(Matrix.identity(n))

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self.nrows, self.ncols

    @property
    def T(self) -> PolynomialMatrix:
        """The transpose."""
        return PolynomialMatrix.from_matrices(*(M.T for M in self.matrices()))

    def matrices(self) -> tuple[Matrix, ...]:
        """The rational coefficient matrices E_k / d."""
        return tuple(
            Matrix.from_integers(table, self.denominator, ncols=self.ncols)
            for table in self.coefficients
        )

    def entry(self, i: int, j: int) -> Polynomial:
        """One entry."""
        return Polynomial.from_coefficients([M[i, j] for M in self.matrices()])

    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        return not any(any(map(any, table)) for table in self.coefficients)

    def take(
        self, rows: Sequence[int] | None = None, cols: Sequence[int] | None = None
    ) -> PolynomialMatrix:
        """The submatrix with these rows and columns, in the order given; None takes all."""
        return PolynomialMatrix.from_matrices(*(M.take(rows, cols) for M in self.matrices()))

    def __add__(self, other: PolynomialMatrix | Matrix) -> PolynomialMatrix:
        addend = _as_polynomial_matrix(other)
        zero = Matrix.zeros(*self.shape)
        ours, theirs = self.matrices(), addend.matrices()
        length = max(len(ours), len(theirs))
        ours += (zero,) * (length - len(ours))
        theirs += (Matrix.zeros(*addend.shape),) * (length - len(theirs))
        return PolynomialMatrix.from_matrices(*(a + b for a, b in zip(ours, theirs, strict=True)))

    def __neg__(self) -> PolynomialMatrix:
        return PolynomialMatrix.from_matrices(*(-M for M in self.matrices()))

    def __sub__(self, other: PolynomialMatrix | Matrix) -> PolynomialMatrix:
        return self + -_as_polynomial_matrix(other)

    def __matmul__(self, other: PolynomialMatrix | Matrix) -> PolynomialMatrix:
        return _product(self, _as_polynomial_matrix(other))

    def __rmatmul__(self, other: Matrix) -> PolynomialMatrix:
        return _product(_as_polynomial_matrix(other), self)

    def __mod__(self, p: Polynomial) -> PolynomialMatrix:
        """Every entry reduced modulo p of degree ≥ 1."""
        lead = monic_modulus(p).coefficients
        degree = p.degree
        matrices = list(self.matrices())
        for k in range(len(matrices) - 1, degree - 1, -1):
            top = matrices.pop()
            if not top.is_zero():
                for i in range(degree):
                    if lead[i]:
                        matrices[k - degree + i] -= top * lead[i]
        return PolynomialMatrix.from_matrices(*matrices)

    def times_x(self) -> PolynomialMatrix:
        """x times the matrix."""
        return PolynomialMatrix.from_matrices(Matrix.zeros(*self.shape), *self.matrices())

    def at_residue(self, mu: int, ell: int) -> ModularMatrix:
        """The matrix at x = mu modulo a prime that does not divide the denominator."""
        total = ModularMatrix.zeros(self.nrows, self.ncols, ell)
        if self.denominator % ell == 0:
            raise InputError(f"the modulus {ell} divides a denominator; draw another")
        for table in reversed(self.coefficients):
            total = total * mu + ModularMatrix.from_rows(table, ell, ncols=self.ncols)
        return total * pow(self.denominator, -1, ell)

    def __repr__(self) -> str:
        return f"PolynomialMatrix.from_matrices({', '.join(map(repr, self.matrices()))})"


def _content(tables: Sequence[Rows], denominator: int) -> int:
    content = denominator
    for table in tables:
        for row in table:
            content = math.gcd(content, *row)
            if content == 1:
                return 1
    return content


def reduced(nrows: int, ncols: int, tables: Sequence[Rows], denominator: int) -> PolynomialMatrix:
    """The matrix Σ x^k tables[k] / denominator, denominator ≥ 1, brought to lowest terms."""
    kept = list(tables)
    while len(kept) > 1 and not any(map(any, kept[-1])):
        kept.pop()
    content = _content(kept, denominator)
    if content != 1:
        kept = [tuple(tuple(entry // content for entry in row) for row in table) for table in kept]
    made = object.__new__(PolynomialMatrix)
    made.__dict__.update(
        nrows=nrows, ncols=ncols, denominator=denominator // content, coefficients=tuple(kept)
    )
    return made


def _as_polynomial_matrix(M: PolynomialMatrix | Matrix) -> PolynomialMatrix:
    return PolynomialMatrix.from_matrices(M) if isinstance(M, Matrix) else M


def _product(left: PolynomialMatrix, right: PolynomialMatrix) -> PolynomialMatrix:
    if left.ncols != right.nrows:
        raise InputError(
            f"shapes do not match: {left.nrows} × {left.ncols} @ {right.nrows} × {right.ncols}"
        )
    ours, theirs = left.matrices(), right.matrices()
    sums: list[Matrix | None] = [None] * (len(ours) + len(theirs) - 1)
    for i, a in enumerate(ours):
        for j, b in enumerate(theirs):
            term, known = a @ b, sums[i + j]
            sums[i + j] = term if known is None else known + term
    return PolynomialMatrix.from_matrices(*(M for M in sums if M is not None))


def monic_modulus(p: Polynomial) -> Polynomial:
    if p.degree < 1:
        raise InputError(f"expected a polynomial of degree at least 1, found {p}")
    return p.monic()


def vstack(matrices: Sequence[PolynomialMatrix]) -> PolynomialMatrix:
    """Polynomial matrices below each other, at least one, equally wide."""
    if not matrices or len({M.ncols for M in matrices}) != 1:
        raise InputError("expected at least one matrix, all equally wide")
    length = max(len(M.coefficients) for M in matrices)
    denominator = math.lcm(*(M.denominator for M in matrices))
    tables: list[Rows] = []
    for k in range(length):
        rows: list[tuple[int, ...]] = []
        for M in matrices:
            factor = denominator // M.denominator
            zero: Rows = ((0,) * M.ncols,) * M.nrows
            table = M.coefficients[k] if k < len(M.coefficients) else zero
            rows += [tuple(factor * entry for entry in row) for row in table]
        tables.append(tuple(rows))
    return reduced(sum(M.nrows for M in matrices), matrices[0].ncols, tables, denominator)


def hstack(matrices: Sequence[PolynomialMatrix]) -> PolynomialMatrix:
    """Polynomial matrices beside each other, at least one, equally high."""
    return vstack([M.T for M in matrices]).T
