"""Matrices and polynomials over Q, as python-flint has them, put together from blocks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import pairwise

from flint import fmpq, fmpq_mat, fmpq_poly

X = fmpq_poly([0, 1])
ONE = fmpq_poly([1])


def identity(n: int) -> fmpq_mat:
    """The n×n identity matrix."""
    return fmpq_mat(n, n, [int(i == j) for i in range(n) for j in range(n)])


def stacked(blocks: Sequence[Sequence[fmpq_mat]], nrows: int, ncols: int) -> fmpq_mat:
    """The matrix of these blocks, which must fill nrows×ncols."""
    rows: list[list[fmpq]] = []
    for line in blocks:
        height = {block.nrows() for block in line}
        if len(height) > 1:
            raise ValueError("blocks of unequal heights beside each other")
        for i in range(height.pop() if height else 0):
            rows.append([value for block in line for value in block.tolist()[i]])
    if len(rows) != nrows or any(len(row) != ncols for row in rows):
        raise ValueError("the blocks do not fill the matrix")
    return fmpq_mat(nrows, ncols, [value for row in rows for value in row])


def beside(blocks: Sequence[fmpq_mat], nrows: int) -> fmpq_mat:
    """Blocks of ``nrows`` rows side by side."""
    return (
        stacked([blocks], nrows, sum(b.ncols() for b in blocks)) if blocks else fmpq_mat(nrows, 0)
    )


def below(blocks: Sequence[fmpq_mat], ncols: int) -> fmpq_mat:
    """Blocks of ``ncols`` columns below each other."""
    return stacked([[b] for b in blocks], sum(b.nrows() for b in blocks), ncols)


def selection(total: int, positions: Iterable[int]) -> fmpq_mat:
    """The rows of the identity matrix at these positions."""
    chosen = list(positions)
    return fmpq_mat(len(chosen), total, [int(j == k) for k in chosen for j in range(total)])


def krylov(A: fmpq_mat, B: fmpq_mat, blocks: int) -> fmpq_mat:
    """[B, A B, …, A^(blocks−1) B]."""
    parts = []
    for _ in range(blocks):
        parts.append(B)
        B = A * B
    return beside(parts, A.nrows())


def quotient_polynomial(A: fmpq_mat, K: fmpq_mat) -> fmpq_poly:
    """det(xI − A) on the quotient by the column space of K, which A maps into itself."""
    n = A.nrows()
    reduced, rank = K.transpose().rref()
    basis = [reduced.tolist()[k] for k in range(rank)]
    leading = [next(j for j in range(n) if row[j] != 0) for row in basis]
    units = selection(n, [j for j in range(n) if j not in leading])
    T = below([fmpq_mat(rank, n, [v for row in basis for v in row]), units], n).transpose()
    moved = (T.inv() * A * T).tolist() if n else []
    size = n - rank
    return fmpq_mat(
        size, size, [moved[i][j] for i in range(rank, n) for j in range(rank, n)]
    ).charpoly()


def fraction_polynomial(values: Iterable[Fraction]) -> fmpq_poly:
    """The polynomial of these coefficients, constant term first."""
    return fmpq_poly([fmpq(v.numerator, v.denominator) for v in values])


def monic(p: fmpq_poly) -> fmpq_poly:
    """The monic multiple of a polynomial that is not 0."""
    return p / p.leading_coefficient()


def coefficients(p: fmpq_poly) -> tuple[fmpq, ...]:
    """The coefficients, constant term first; what polynomials are compared by."""
    return tuple(p.coeffs())


def irreducible_factors(p: fmpq_poly) -> list[tuple[fmpq_poly, int]]:
    """The monic irreducible factors of a polynomial that is not 0, with their exponents."""
    return [(monic(f), e) for f, e in p.factor()[1]]


def multiplicity(p: fmpq_poly, f: fmpq_poly) -> int:
    """How often p divides f."""
    count = 0
    while f.degree() >= p.degree():
        f, rest = divmod(f, p)
        if rest != 0:
            break
        count += 1
    return count


def companion(p: fmpq_poly) -> fmpq_mat:
    """The companion matrix of a monic polynomial."""
    d = p.degree()
    return fmpq_mat(
        d, d, [-p[i] if j == d - 1 else int(i == j + 1) for i in range(d) for j in range(d)]
    )


def rank_at(constant: fmpq_mat, slope: fmpq_mat, p: fmpq_poly) -> int:
    """The rank of ``constant + x·slope`` at any root of an irreducible monic polynomial."""
    K = companion(p).tolist()
    d = p.degree()
    rows, ncols = constant.nrows(), constant.ncols()
    M, S = constant.tolist(), slope.tolist()
    entries = [
        S[i][j] * K[a][b] + (M[i][j] if a == b else 0)
        for i in range(rows)
        for a in range(d)
        for j in range(ncols)
        for b in range(d)
    ]
    return fmpq_mat(rows * d, ncols * d, entries).rank() // d


Polynomials = list[list[fmpq_poly]]


def invariant_factors(rows: Polynomials) -> list[fmpq_poly]:
    """The monic invariant factors of a polynomial matrix that are not 0, by Euclid."""
    work = [list(row) for row in rows]
    found: list[fmpq_poly] = []
    while work and work[0] and any(v != 0 for row in work for v in row):
        work = _pivot_first(work)
        if not _cleared(work):
            continue
        pivot = work[0][0]
        spoiled = next((r for r in work[1:] if any(v % pivot != 0 for v in r)), None)
        if spoiled is not None:
            work[0] = [a + b for a, b in zip(work[0], spoiled, strict=True)]
            _cleared(work)
            continue
        found.append(monic(pivot))
        work = [row[1:] for row in work[1:]]
    if any((b % a) != 0 for a, b in pairwise(found)):
        raise ArithmeticError("invariant factors do not divide each other")
    return found


def _pivot_first(work: Polynomials) -> Polynomials:
    """An entry of least degree moved to the corner."""
    _, i, j = min(
        (v.degree(), i, j) for i, row in enumerate(work) for j, v in enumerate(row) if v != 0
    )
    work = [work[i], *work[:i], *work[i + 1 :]]
    return [[row[j], *row[:j], *row[j + 1 :]] for row in work]


def _cleared(work: Polynomials) -> bool:
    """One round of division by the corner, in place; whether row and column are now 0."""
    pivot = work[0][0]
    for row in work[1:]:
        if row[0] != 0:
            q = row[0] // pivot
            for j, v in enumerate(work[0]):
                row[j] -= q * v
    for j in range(1, len(work[0])):
        if work[0][j] != 0:
            q = work[0][j] // pivot
            for row in work:
                row[j] -= q * row[0]
    return all(row[0] == 0 for row in work[1:]) and all(v == 0 for v in work[0][1:])
