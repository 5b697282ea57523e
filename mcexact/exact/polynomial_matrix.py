"""Matrices of rational polynomials."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import zip_longest

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, Rows
from mcexact.exact.modular import ModularMatrix, residues
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class PolynomialMatrix:
    """A matrix of rational polynomials, Σ_k x^k M_k.

    Parameters
    ----------
    matrices : tuple of at least one Matrix
        M_0, M_1, …, of one shape; the last one is not zero unless it is the only one.

    Notes
    -----
    Exact, immutable, hashable.  Made by `from_matrices`, `pencil` and `from_polynomials`.

    Examples
    --------
    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2]]), Matrix.from_rows([["1/2", 0]]))
    >>> str(M.entry(0, 0)), str(M.entry(0, 1))
    ('1/2*x', '-2')
    """

    matrices: tuple[Matrix, ...]

    def __post_init__(self) -> None:
        if len({M.shape for M in self.matrices}) != 1:
            raise InputError("expected at least one coefficient matrix, all of one shape")
        if len(self.matrices) > 1 and self.matrices[-1].is_zero():
            raise InputError("expected a last coefficient matrix that is not zero")

    @classmethod
    def from_matrices(cls, *coefficients: Matrix) -> PolynomialMatrix:
        """Σ_k x^k M_k of rational matrices of one shape, at least one."""
        length = len(coefficients)
        while length > 1 and coefficients[length - 1].is_zero():
            length -= 1
        return cls(coefficients[:length])

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
        length = max((len(p.coefficients) for row in rows for p in row), default=1)
        return cls.from_matrices(
            *(
                Matrix.from_rows(
                    [[p.coefficients[k] if k <= p.degree else 0 for p in row] for row in rows],
                    ncols=width,
                )
                for k in range(max(length, 1))
            )
        )

    @classmethod
    def identity(cls, n: int) -> PolynomialMatrix:
        """The n × n identity matrix."""
        return cls.from_matrices(Matrix.identity(n))

    @property
    def nrows(self) -> int:
        """Number of rows."""
        return self.matrices[0].nrows

    @property
    def ncols(self) -> int:
        """Number of columns."""
        return self.matrices[0].ncols

    @property
    def shape(self) -> tuple[int, int]:
        """Numbers of rows and columns."""
        return self.matrices[0].shape

    @cached_property
    def denominator(self) -> int:
        """The least common denominator of all entries."""
        return math.lcm(*(M.denominator for M in self.matrices))

    @property
    def coefficients(self) -> tuple[Rows, ...]:
        """The integer rows of the M_k times `denominator`."""
        return tuple((M * self.denominator).numerators for M in self.matrices)

    @property
    def T(self) -> PolynomialMatrix:
        """The transpose."""
        return PolynomialMatrix(tuple(M.T for M in self.matrices))

    def entry(self, i: int, j: int) -> Polynomial:
        """One entry."""
        return Polynomial.from_coefficients([M[i, j] for M in self.matrices])

    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        return self.matrices[-1].is_zero()

    def take(
        self, rows: Sequence[int] | None = None, cols: Sequence[int] | None = None
    ) -> PolynomialMatrix:
        """The submatrix with these rows and columns, in the order given; None takes all."""
        return PolynomialMatrix.from_matrices(*(M.take(rows, cols) for M in self.matrices))

    def __add__(self, other: PolynomialMatrix | Matrix) -> PolynomialMatrix:
        addend = _as_polynomial_matrix(other)
        pairs = zip_longest(self.matrices, addend.matrices)
        return PolynomialMatrix.from_matrices(*(a + b if a and b else a or b for a, b in pairs))

    def __neg__(self) -> PolynomialMatrix:
        return PolynomialMatrix(tuple(-M for M in self.matrices))

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
        matrices = list(self.matrices)
        for k in range(len(matrices) - 1, degree - 1, -1):
            top = matrices.pop()
            if not top.is_zero():
                for i in range(degree):
                    if lead[i]:
                        matrices[k - degree + i] -= top * lead[i]
        return PolynomialMatrix.from_matrices(*matrices)

    def times_x(self) -> PolynomialMatrix:
        """x times the matrix."""
        return PolynomialMatrix.from_matrices(Matrix.zeros(*self.shape), *self.matrices)

    def at_residue(self, mu: int, ell: int) -> ModularMatrix:
        """The matrix at x = mu modulo a prime that does not divide the denominator."""
        total = ModularMatrix.zeros(self.nrows, self.ncols, ell)
        for M in reversed(self.matrices):
            total = total * mu + residues(M, ell)
        return total

    def __repr__(self) -> str:
        return f"PolynomialMatrix.from_matrices({', '.join(map(repr, self.matrices))})"


def _as_polynomial_matrix(M: PolynomialMatrix | Matrix) -> PolynomialMatrix:
    return PolynomialMatrix.from_matrices(M) if isinstance(M, Matrix) else M


def _product(left: PolynomialMatrix, right: PolynomialMatrix) -> PolynomialMatrix:
    if left.ncols != right.nrows:
        raise InputError(
            f"shapes do not match: {left.nrows} × {left.ncols} @ {right.nrows} × {right.ncols}"
        )
    sums = [Matrix.zeros(left.nrows, right.ncols)] * (len(left.matrices) + len(right.matrices) - 1)
    for i, a in enumerate(left.matrices):
        for j, b in enumerate(right.matrices):
            sums[i + j] += a @ b
    return PolynomialMatrix.from_matrices(*sums)


def inflate(M: PolynomialMatrix, p: Polynomial) -> Matrix:
    """The rational matrix of M over Q, K = Q[x]/(p) in the basis 1, x, …, x^(deg p − 1).

    Parameters
    ----------
    M : PolynomialMatrix, r × c
    p : Polynomial
        Of degree d ≥ 1.

    Returns
    -------
    Matrix, rd × cd
        Block (i, j) is the matrix of multiplication by the entry (i, j); its column k holds the
        coefficients of x^k times the entry.
    """
    degree = monic_modulus(p).degree
    columns = []
    power = M % p
    for k in range(degree):
        columns.append(power.matrices + (Matrix.zeros(*M.shape),) * degree)
        if k + 1 < degree:
            power = power.times_x() % p
    denominator = math.lcm(*(E.denominator for column in columns for E in column))
    scaled = [
        [(E.numerators, denominator // E.denominator) for E in column[:degree]]
        for column in columns
    ]
    rows = [
        [
            factor * table[i][j]
            for j in range(M.ncols)
            for table, factor in (scaled[k][r] for k in range(degree))
        ]
        for i in range(M.nrows)
        for r in range(degree)
    ]
    return Matrix.from_integers(rows, denominator, ncols=M.ncols * degree)


def monic_modulus(p: Polynomial) -> Polynomial:
    """The monic multiple of a polynomial of degree at least 1."""
    if p.degree < 1:
        raise InputError(f"expected a polynomial of degree at least 1, found {p}")
    return p.monic()
