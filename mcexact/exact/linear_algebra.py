"""Linear algebra over Q, Q[x] and number fields.

Over Q, flint computes with integer numerators.  `rank` computes modulo one prime first: full rank
there is full rank over Q; any lower rank is computed again over Q.  `solve` takes any matrix;
`solve_nonsingular` takes a square one, and is faster if the right side has few columns.  Bases of
null spaces are in echelon form, with the positions of their identity block.

`invariant_form` finds a basis in which a matrix is a block-diagonal matrix of companions of its
invariant polynomials; it draws vectors, and its result is exact.

A `PolynomialMatrix` Σ_k x^k M_k is a matrix over Q[x], or over K = Q[x]/(p) with p irreducible.
Ranks and null spaces over K are those at every root of p, so no root is ever approximated.
`field_nullspace` finds the pivots at a root of p modulo a prime, solves for the null space over K,
and proves it by the exact test of M U = 0 modulo p.

`solve_over_field` has two algorithms.  For deg p below 10 each element of K is its matrix of
multiplication over Q (`inflate`), which gives one larger system.  From degree 10 on, the solution
is computed by values at points modulo primes, until its residues determine it: about k⁴ word
operations for each prime, whatever the degree.  This way is no proof; callers test the equation.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, reduce
from itertools import islice, zip_longest
from operator import add, mul
from random import Random
from typing import Any

import flint

from mcexact.errors import InputError, InternalError
from mcexact.exact.matrix import (
    Matrix,
    Rows,
    block_diagonal,
    from_flint,
    from_numerators,
    hstack,
    vstack,
)
from mcexact.exact.modular import (
    ModularMatrix,
    ModularPolynomial,
    combine,
    polynomial_residues,
    primes,
    rationals,
    residues,
)
from mcexact.exact.polynomial import Polynomial

# Linear algebra over the rational numbers.

# Full rank modulo this prime is full rank over Q, so ranks are computed modulo it first.
_PROBE = 2**61 - 1


def rank(M: Matrix) -> int:
    """The rank.

    Examples
    --------
    >>> rank(Matrix.from_rows([[1, 2], ["1/2", 1]]))
    1
    """
    below = int(flint.nmod_mat(M._integer, _PROBE).rank())
    if below == min(M.shape):
        return below
    return int(M._integer.rank())


def row_echelon(M: Matrix) -> tuple[Matrix, tuple[int, ...]]:
    """The reduced row echelon form without its zero rows, and its pivot columns.

    Returns
    -------
    R : Matrix, r × ncols
        The same row space as M, r its rank; the columns `pivots` form the identity.
    pivots : tuple of int
        Ascending.

    Examples
    --------
    >>> R, pivots = row_echelon(Matrix.from_rows([[0, 2, 4], [0, 1, 2]]))
    >>> R.numerators, pivots
    (((0, 1, 2),), (1,))
    """
    reduced, denominator, r = M._integer.rref()
    # at rank 0 flint returns no denominator
    whole = from_flint(reduced, int(denominator) if r else 1)
    pivots = []
    j = 0
    for row in whole.numerators[:r]:
        while not row[j]:
            j += 1
        pivots.append(j)
    return whole.take(rows=range(r)), tuple(pivots)


def nullspace_and_pivots(M: Matrix) -> tuple[Matrix, tuple[int, ...]]:
    """Compute a basis of {x : Mx = 0}, and the rows of it that form the identity.

    Returns
    -------
    X : Matrix, ncols × (ncols − rank M)
    pivots : tuple of int
        The columns of M that are not pivots of its echelon form, ascending.
    """
    reduced, bound = row_echelon(M)
    free = tuple(sorted(set(range(M.ncols)) - set(bound)))
    position = {j: i for i, j in enumerate(bound)}
    rows = []
    for j in range(M.ncols):
        if j in position:
            row = reduced.numerators[position[j]]
            rows.append(tuple(-row[k] for k in free))
        else:
            rows.append(tuple(reduced.denominator if k == j else 0 for k in free))
    return from_numerators(rows, reduced.denominator, len(free)), free


def nullspace(M: Matrix) -> Matrix:
    """A basis of {x : Mx = 0} as columns, in echelon form (see `nullspace_and_pivots`).

    Examples
    --------
    >>> nullspace(Matrix.from_rows([[1, 2]])).numerators
    ((-2,), (1,))
    """
    return nullspace_and_pivots(M)[0]


def left_nullspace(M: Matrix) -> Matrix:
    """A basis of {w : wM = 0} as rows, in echelon form.

    Returns
    -------
    Matrix, (nrows − rank M) × nrows

    Examples
    --------
    >>> left_nullspace(Matrix.column([1, 2])).numerators
    ((-2, 1),)
    """
    return nullspace(M.T).T


def solve(M: Matrix, right: Matrix) -> Matrix | None:
    """Compute an X with MX = right whose free unknowns are 0; None if there is none.

    Parameters
    ----------
    M : Matrix, r × c
    right : Matrix, r × k
        One column for each system of equations; all of them must have a solution.

    Returns
    -------
    Matrix or None
        X, c × k.

    Raises
    ------
    InputError
        If M and the right side have different numbers of rows.

    Examples
    --------
    >>> solve(Matrix.from_rows([[2, 1], [4, 2]]), Matrix.column([1, 2])).rows()
    ((Fraction(1, 2),), (Fraction(0, 1),))
    >>> solve(Matrix.from_rows([[2, 1], [4, 2]]), Matrix.column([1, 3])) is None
    True
    """
    if M.nrows != right.nrows:
        raise InputError(f"expected a right side with {M.nrows} rows, found {right.nrows}")
    reduced, pivots = row_echelon(hstack([M, right]))
    if pivots and pivots[-1] >= M.ncols:
        return None
    position = {j: i for i, j in enumerate(pivots)}
    rows = [
        reduced.numerators[position[j]][M.ncols :] if j in position else (0,) * right.ncols
        for j in range(M.ncols)
    ]
    return from_numerators(rows, reduced.denominator, right.ncols)


def solve_nonsingular(M: Matrix, right: Matrix) -> Matrix | None:
    """Compute the X with MX = right for a square M; None if M is singular.

    This is faster than `solve` if the right side has few columns.

    Raises
    ------
    InputError
        If M is not square, or the right side has another number of rows.

    Examples
    --------
    >>> solve_nonsingular(Matrix.from_rows([[2, 0], [0, 4]]), Matrix.column([1, 1])).rows()
    ((Fraction(1, 2),), (Fraction(1, 4),))
    >>> solve_nonsingular(Matrix.from_rows([[2, 1], [4, 2]]), Matrix.column([1, 2])) is None
    True
    """
    _require_square(M)
    if M.nrows != right.nrows:
        raise InputError(f"expected a right side with {M.nrows} rows, found {right.nrows}")
    if rank(M) < M.nrows:
        return None
    if not M.nrows or not right.ncols:
        return Matrix.zeros(*right.shape)
    solution: Any = M._integer.solve(right._integer)
    numerators, denominator = solution.numer_denom()
    # (N/d) X = R/e has the solution N⁻¹R · d/e
    return from_flint(numerators * M.denominator, int(denominator) * right.denominator)


def inverse(M: Matrix) -> Matrix | None:
    """The inverse of a square matrix; None if it is singular.

    Raises
    ------
    InputError
        If the matrix is not square.

    Examples
    --------
    >>> inverse(Matrix.from_rows([[1, 1], [0, 2]])).rows()[0]
    (Fraction(1, 1), Fraction(-1, 2))
    >>> inverse(Matrix.from_rows([[1, 1], [1, 1]])) is None
    True
    """
    _require_square(M)
    return solve(M, Matrix.identity(M.nrows)) if rank(M) == M.nrows else None


def determinant(M: Matrix) -> Fraction:
    """The determinant of a square matrix; 1 if it is 0 × 0.

    Raises
    ------
    InputError
        If the matrix is not square.

    Examples
    --------
    >>> determinant(Matrix.from_rows([["1/2", 1], [1, 4]]))
    Fraction(1, 1)
    """
    _require_square(M)
    return Fraction(int(M._integer.det()), M.denominator**M.nrows)


def characteristic_polynomial(M: Matrix) -> Polynomial:
    """det(xI − M) of a square matrix.

    Examples
    --------
    >>> str(characteristic_polynomial(Matrix.from_rows([[0, "1/2"], [1, 0]])))
    'x^2 - 1/2'
    """
    _require_square(M)
    return _unscaled(M._integer.charpoly(), M.denominator)


def minimal_polynomial(M: Matrix) -> Polynomial:
    """The monic polynomial of least degree that M satisfies; 1 if M is 0 × 0.

    It has the same irreducible factors as the characteristic polynomial.

    Raises
    ------
    InputError
        If the matrix is not square.

    Examples
    --------
    >>> identity = Matrix.identity(3)
    >>> str(minimal_polynomial(identity)), characteristic_polynomial(identity).degree
    ('x - 1', 3)
    """
    _require_square(M)
    if M.nrows == 0:
        return Polynomial.of(1)
    return _unscaled(M._integer.minpoly(), M.denominator)


def _unscaled(p: flint.fmpz_poly, d: int) -> Polynomial:
    """From the monic p of N to that of N/d: p(d x) / d^k for p of degree k."""
    coefficients = [int(c) for c in p.coeffs()]
    degree = len(coefficients) - 1
    return Polynomial(tuple(Fraction(c, d ** (degree - k)) for k, c in enumerate(coefficients)))


def _require_square(M: Matrix) -> None:
    if not M.is_square():
        raise InputError(f"expected a square matrix, found {M.nrows} × {M.ncols}")


# The rational canonical form: invariant polynomials of a matrix, and a basis that shows them.


def companion(p: Polynomial) -> Matrix:
    """The matrix of multiplication by x modulo a monic p: ones below the diagonal, −p on the right.

    Parameters
    ----------
    p : Polynomial
        Monic of degree d ≥ 1.

    Examples
    --------
    >>> companion(Polynomial.of(3, 2, 1)).numerators
    ((0, -3), (1, -2))
    """
    d = p.degree
    rows = [[int(i == j + 1) for j in range(d - 1)] + [-p.coefficients[i]] for i in range(d)]
    return Matrix.from_rows(rows, ncols=d)


def invariant_form(Z: Matrix, rng: Random) -> tuple[Matrix, tuple[Polynomial, ...]]:
    """Find T with Z T = T diag(companions of f_1, …, f_h), f_1 | f_2 | … | f_h.

    Parameters
    ----------
    Z : Matrix
        b × b.
    rng : Random
        Draws vectors; almost all suffice.

    Returns
    -------
    T : Matrix
        b × b, nonsingular.
    polynomials : tuple of Polynomial
        The invariant polynomials of degree at least 1.

    Notes
    -----
    A drawn v generates a space of the dimension d of the minimal polynomial, a drawn row w has
    w Z^{i+j} v nonsingular, and then the null space of w, wZ, …, wZ^{d−1} is an invariant
    complement, on which the algorithm continues.  Exact.

    Examples
    --------
    >>> from random import Random
    >>> _, found = invariant_form(Matrix.from_rows([[1, 0, 0], [0, 1, 0], [0, 0, 2]]), Random(0))
    >>> [str(f) for f in found]
    ['x - 1', 'x^2 - 3*x + 2']
    """
    b = Z.nrows
    basis, parts, found = Matrix.identity(b), [], []
    while Z.nrows:
        f = minimal_polynomial(Z)
        K, rows = _cyclic_pair(Z, f.degree, rng)
        parts.append(basis @ K)
        found.append(f)
        rest, pivots = nullspace_and_pivots(rows)
        basis, Z = basis @ rest, (Z @ rest).take(rows=pivots)
    return hstack(parts[::-1], nrows=b), tuple(found[::-1])


def _cyclic_pair(Z: Matrix, d: int, rng: Random) -> tuple[Matrix, Matrix]:
    """[v, Zv, …, Z^{d−1}v] and [w; wZ; …] of small integers, with a nonsingular product."""
    n = Z.nrows
    for trial in range(10**4):
        bound = 1 + trial // 4
        v = Matrix.column([rng.randint(-bound, bound) for _ in range(n)])
        w = Matrix.column([rng.randint(-bound, bound) for _ in range(n)]).T
        columns, rows = [v], [w]
        for _ in range(d - 1):
            columns.append(Z @ columns[-1])
            rows.append(rows[-1] @ Z)
        K, W = hstack(columns, nrows=n), vstack(rows, ncols=n)
        if rank(W @ K) == d:
            return K, W
    raise InternalError("a generating vector was not found")


def companions(polynomials: tuple[Polynomial, ...]) -> Matrix:
    """The block-diagonal matrix of the companions."""
    return block_diagonal([companion(f) for f in polynomials])


# Matrices of rational polynomials.


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

    def at(self, x: Fraction | int) -> Matrix:
        """The matrix at a rational number."""
        total = Matrix.zeros(*self.shape)
        for M in reversed(self.matrices):
            total = total * Fraction(x) + M
        return total

    def at_residue(self, mu: int, ell: int) -> ModularMatrix:
        """The matrix at x = mu modulo a prime that does not divide the denominator."""
        total = ModularMatrix.zeros(self.nrows, self.ncols, ell)
        for M in reversed(self.matrices):
            total = total * mu + residues(M, ell)
        return total

    def __repr__(self) -> str:
        return f"PolynomialMatrix.from_matrices({', '.join(map(repr, self.matrices))})"


def stacked(matrices: Sequence[PolynomialMatrix], ncols: int) -> PolynomialMatrix:
    """The matrix [M1; M2; …] of matrices with a number of columns."""
    length = max((len(M.matrices) for M in matrices), default=1)
    layers = [
        [M.matrices[k] if k < len(M.matrices) else Matrix.zeros(*M.shape) for M in matrices]
        for k in range(length)
    ]
    return PolynomialMatrix.from_matrices(*(vstack(layer, ncols) for layer in layers))


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


# Linear equations over K = Q[x]/(p), by their values at points modulo primes.

# Fields of less degree are faster as matrices over Q.
_DEGREE = 10


def solve_over_field(
    N: PolynomialMatrix, right: PolynomialMatrix, p: Polynomial
) -> PolynomialMatrix | None:
    """Compute the X with N X = right over Q[x]/(p), entries of degree below deg p.

    Parameters
    ----------
    N : PolynomialMatrix, k × k
    right : PolynomialMatrix, k × u
    p : Polynomial
        Monic, irreducible, of degree at least 1.

    Returns
    -------
    PolynomialMatrix or None
        X, k × u; None if N is found to be singular.

    Notes
    -----
    In a field of small degree every element is its matrix of multiplication, which makes one system
    of k deg p equations over Q.  Otherwise X is found modulo primes until its residues determine
    it, which costs about k⁴ word operations for each prime, whatever the degree of the field is.
    X agrees with the solution modulo one more prime, which is no proof: test the equation, or what
    is to follow from it.

    Examples
    --------
    >>> N = PolynomialMatrix.from_polynomials([[Polynomial.x()]])
    >>> X = solve_over_field(N, PolynomialMatrix.identity(1), Polynomial.of(-2, 0, 1))
    >>> str(X.entry(0, 0))
    '1/2*x'
    """
    if p.degree < _DEGREE or not right.ncols:
        return _as_rationals(N, right, p)
    N, right = N % p, right % p
    known: list[list[int]] = []
    modulus = 1
    for ell in primes(0, bits=62):
        if N.denominator * right.denominator * p.denominator % ell == 0:
            continue
        found = _modulo(N, right, p, ell)
        if found is None:
            return None
        guess = rationals(known, modulus) if known else None
        if guess is not None and _agree(*guess, found, ell):
            return _layers(*guess, right.ncols)
        known = combine(known, modulus, found, ell) if known else found
        modulus *= ell
    raise InternalError("the stream of primes is endless")


def _as_rationals(
    N: PolynomialMatrix, right: PolynomialMatrix, p: Polynomial
) -> PolynomialMatrix | None:
    """X by matrices of multiplication, whose first columns are the elements themselves."""
    firsts = [j * p.degree for j in range(right.ncols)]
    X = solve_nonsingular(inflate(N, p), inflate(right, p).take(cols=firsts))
    if X is None:
        return None
    return PolynomialMatrix.from_matrices(
        *(X.take(rows=range(k, X.nrows, p.degree)) for k in range(p.degree))
    )


def _modulo(
    N: PolynomialMatrix, right: PolynomialMatrix, p: Polynomial, ell: int
) -> list[list[int]] | None:
    """X modulo ℓ: row k has the coefficients of x^k of all entries; None if det N is no unit.

    The minors of [N, right] have at most the degree that its rows have together, and are known by
    their values at one point more.
    """
    size = 1 + sum(max(both) for both in zip(_degrees(N), _degrees(right), strict=True))
    values = list(islice(_values(N, right, ell, 2 * size), size))
    if len(values) < size:
        return None
    linear = [ModularPolynomial.from_coefficients([-t, 1], ell) for t, _, _ in values]
    whole = reduce(mul, linear)
    basis = [whole // factor for factor in linear]
    shares = [d * pow(L(t), -1, ell) % ell for L, (t, d, _) in zip(basis, values, strict=True)]
    constants = [ModularPolynomial.from_coefficients([c], ell) for c in shares]
    field = polynomial_residues(p, ell)
    inverse = reduce(add, map(mul, basis, constants)).inverse_modulo(field)
    if inverse is None:
        return None
    weights = [(L * inverse % field).coefficients for L in basis]
    table = [[*weight, *(0,) * (p.degree - len(weight))] for weight in weights]
    scaled = [X * c for c, (_, _, X) in zip(shares, values, strict=True)]
    return [
        reduce(add, (X * w for X, w in zip(scaled, row, strict=True))).entries()
        for row in zip(*table, strict=True)
    ]


def _degrees(M: PolynomialMatrix) -> list[int]:
    """The degree of every row; 0 for a row of zeros."""
    found = [0] * M.nrows
    for k, layer in enumerate(M.matrices):
        for i, row in enumerate(layer.numerators):
            if any(row):
                found[i] = k
    return found


def _values(
    N: PolynomialMatrix, right: PolynomialMatrix, ell: int, end: int
) -> Iterator[tuple[int, int, ModularMatrix]]:
    """t, det N(t) and N(t)⁻¹ right(t) modulo ℓ for the points below ``end`` where it is not 0."""
    for t in range(end):
        at = N.at_residue(t, ell)
        X = at.solve(right.at_residue(t, ell))
        if X is not None:
            yield t, at.determinant(), X


def _agree(numerators: list[list[int]], denominator: int, found: list[list[int]], ell: int) -> bool:
    """Whether rational numbers have these residues."""
    return all(
        (numerator - denominator * residue) % ell == 0
        for row, others in zip(numerators, found, strict=True)
        for numerator, residue in zip(row, others, strict=True)
    )


def _layers(numerators: list[list[int]], denominator: int, ncols: int) -> PolynomialMatrix:
    """The matrix of polynomials whose coefficients of x^k are in row k, entry by entry."""
    return PolynomialMatrix.from_matrices(
        *(
            Matrix.from_integers(
                [row[i : i + ncols] for i in range(0, len(row), ncols)], denominator, ncols
            )
            for row in numerators
        )
    )


# Linear algebra over K = Q[x]/(p) for irreducible p.


def field_nullspace(M: PolynomialMatrix, p: Polynomial) -> tuple[PolynomialMatrix, tuple[int, ...]]:
    """The null space of a polynomial matrix over K = Q[x]/(p), in echelon form.

    Parameters
    ----------
    M : PolynomialMatrix, r × c
    p : Polynomial
        Irreducible over Q, of degree at least 1.

    Returns
    -------
    U : PolynomialMatrix, c × u
        M U = 0 modulo p, entries of degree below deg p; u = c − rank of M over K.
    pivots : tuple of int
        The u rows of U that form the identity.

    Raises
    ------
    InputError
        The polynomial is constant, or found to be reducible.

    Notes
    -----
    Exact.  Pivots are found at a root of p modulo a prime, where the rank is never too large.  Then
    the null space for these pivots is computed over K, and the exact test of M U = 0 modulo p
    proves that the rank is not larger.

    Examples
    --------
    The eigenvectors of [0 2; 1 0] over Q(√2):

    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2], [-1, 0]]), Matrix.identity(2))
    >>> U, pivots = field_nullspace(M, Polynomial.of(-2, 0, 1))
    >>> [str(U.entry(i, 0)) for i in range(2)], pivots
    (['x', '1'], (1,))
    """
    field = monic_modulus(p)
    for ell in primes(0, bits=62):
        if M.denominator * field.denominator % ell == 0:
            continue
        roots = polynomial_residues(field, ell).roots()
        if not roots:
            continue
        found = _nullspace_at_pivots(M, field, M.at_residue(min(roots), ell))
        if found is not None and (M @ found[0] % field).is_zero():
            return found
        if not field.is_irreducible():
            raise InputError(f"expected an irreducible polynomial, found {p}")
    raise InternalError("the stream of primes is endless")


def _nullspace_at_pivots(
    M: PolynomialMatrix, p: Polynomial, value: ModularMatrix
) -> tuple[PolynomialMatrix, tuple[int, ...]] | None:
    """The candidate with the pivots of a value of M; None if these are dependent."""
    bound = value.rref()[1]
    rows = value.take(cols=bound).T.rref()[1]
    free = tuple(sorted(set(range(M.ncols)) - set(bound)))
    X = solve_over_field(M.take(rows, bound), M.take(rows, free), p)
    if X is None:
        return None
    order = {j: i for i, j in enumerate([*bound, *free])}
    both = [
        vstack([-layer, Matrix.identity(len(free)) if k == 0 else Matrix.zeros(*2 * (len(free),))])
        for k, layer in enumerate(X.matrices)
    ]
    U = PolynomialMatrix.from_matrices(*both).take(rows=[order[j] for j in range(M.ncols)])
    return U, free


def nullspace_at(M0: Matrix, M1: Matrix, p: Polynomial) -> tuple[PolynomialMatrix, tuple[int, ...]]:
    """The null space of M0 + x M1 over Q[x]/(p), as `field_nullspace` gives it."""
    return field_nullspace(PolynomialMatrix.pencil(M0, M1), p)


def field_rank(M: PolynomialMatrix, p: Polynomial) -> int:
    """The rank of a polynomial matrix over Q[x]/(p), p irreducible: its rank at every root of p.

    Examples
    --------
    >>> M = PolynomialMatrix.pencil(Matrix.from_rows([[0, -2], [-1, 0]]), Matrix.identity(2))
    >>> field_rank(M, Polynomial.of(-2, 0, 1)), field_rank(M, Polynomial.of(-3, 0, 1))
    (1, 2)
    """
    if M.nrows < M.ncols:
        M = M.T
    return M.ncols - field_nullspace(M, p)[0].ncols
