"""Characteristic polynomials, modulo ℓ and over Q; ``proofs/arithmetic.md``."""

import math
from collections.abc import Iterator
from contextlib import suppress
from fractions import Fraction
from operator import itemgetter, mul

from . import budget
from .arithmetic import Matrix, NotAUnit, Polynomial, Rows, inverse
from .budget import spend

FIRST = 2**150 - 3
"""A prime, and the largest modulus of residues that are combined."""
BITS, LIMBS = 149, 5
"""Each of these moduli is above 2^BITS; with so many limbs, each bit of a residue costs least."""


def characteristic_polynomial_modulo(A: Rows, ell: int) -> Polynomial:
    """The characteristic polynomial of an integer matrix modulo ℓ.

    A L = L H with L unit lower triangular (up to a common permutation of rows and columns) and H
    upper Hessenberg, column by column: one reduction modulo ℓ for each inner product.

    Theorem ``hessenberg.characteristic_polynomial_modulo``.
    """
    n, longest, a = len(A), max(map(budget.limbs, A), default=1), budget.limbs([ell])
    spend(budget.products(n**3, longest, a) + budget.products(n**3 // 2, a, a))
    spend(budget.reductions(2 * n * n, a) + budget.inversions(n, a) + budget.table(3 * n, n, a))
    A = [list(row) for row in A]
    L: Rows = [[int(i == 0)] for i in range(n)]
    H: Rows = []
    below: list[int] = []
    for j in range(n):
        column = [row[j] for row in L]
        w = [sum(map(mul, row, column)) for row in A]
        h: list[int] = []
        for i in range(j + 1):
            h.append((w[i] - sum(map(mul, L[i], h))) % ell)
        rest = [(w[i] - sum(map(mul, L[i], h))) % ell for i in range(j + 1, n)]
        H.append(h)
        if j + 1 == n:
            break
        k = next((k for k, entry in enumerate(rest) if entry), 0)
        below.append(rest[k])
        if rest[k]:
            for items in (A, L, *A):
                items[j + 1], items[j + 1 + k] = items[j + 1 + k], items[j + 1]  # type: ignore[index]
            rest[0], rest[k] = rest[k], rest[0]
            f = inverse(rest[0], ell)
            rest = [f * entry % ell for entry in rest]
        for i in range(n):
            L[i].append(0 if i <= j else rest[i - j - 1])
        L[j + 1][j + 1] = 1
    return _hessenberg_polynomial(H, below, ell)


def _hessenberg_polynomial(H: Rows, below: list[int], ell: int) -> Polynomial:
    """det(xI − H) modulo ℓ for H upper Hessenberg: column k holds H[k], then ``below[k]``.

    p_{k+1} = (x − h_kk) p_k − Σ_{i<k} h_ik (below_i … below_{k−1}) p_i, coefficient by coefficient.
    Theorem ``hessenberg.hessenberg_polynomial``.
    """
    coefficients: Rows = [[1]]  # coefficients[c][k] is the coefficient of x^c in p_k
    for k, weights in enumerate(H):
        chain = 1
        for i in reversed(range(k)):
            chain = chain * below[i] % ell
            weights[i] = weights[i] * chain % ell
        carried = 0
        coefficients.append([0] * (k + 1))
        for column in coefficients:
            shifted, carried = carried, column[k]
            column.append((shifted - sum(map(mul, weights, column))) % ell)
    return [column[-1] for column in coefficients]


def characteristic_polynomial(A: Matrix, ell: int = 0) -> Polynomial:
    """The characteristic polynomial over Q, or modulo ℓ if one is given.

    For M = A, its transpose or its integer numerators, whichever has the least bound, the integers
    D·det(xI − M) are combined from their residues, one modulus after the other.

    Theorems ``characteristic_polynomial.combined``,
    ``characteristic_polynomial.characteristic_polynomial_rule``.
    """
    if ell:
        return characteristic_polynomial_modulo(A.modulo(ell), ell)
    choices = ((*scaled_bound(M), M) for M in (A, A.T, Matrix(A.rows, A.ncols)))
    beta, D, M = min(choices, key=itemgetter(0))
    n, longest, product, found = A.nrows, budget.limbs([D]), 1, [0] * (A.nrows + 1)
    moduli = _residues(M)
    for _ in budget.counted(range(beta.bit_length() // BITS + 1)):
        ell, residues = next(moduli)
        a = budget.limbs([product]) + longest + LIMBS
        spend(budget.products(3 * n + 3, a, LIMBS) + budget.reductions(n + 2, a, LIMBS))
        f = inverse(product, ell)
        pairs = zip(found, residues, strict=True)
        found = [old + (D * c - old) * f % ell * product for old, c in pairs]
        product *= ell
    least = [c - product if 2 * c > product else c for c in found]
    e = A.denominator // M.denominator
    spend(budget.fractions(n + 1, budget.limbs([product]) + longest + n * budget.limbs([e])))
    return [Fraction(c, D * e ** (n - k)) for k, c in enumerate(least)]


def scaled_bound(A: Matrix) -> tuple[int, int]:
    """β and D: the coefficients of D·det(xI − A) are integers of absolute value at most β.

    D·det(xI − A) = det(diag(d)x − diag(d)A), d_i the denominator of row i and D = Π d_i, and
    β = Π (d_i + Σ_j |d_i A_ij|).

    Theorem ``closed_loop_spectrum.scaled_bound``.
    """
    D = beta = 1
    n, a = A.nrows, A.limbs
    spend(budget.fractions(n * (n + 1), a) + budget.products(4 * n, n * (a + 1), a + 1))
    for row in A.rows:
        common = math.gcd(A.denominator, *row)
        D *= A.denominator // common
        beta *= (A.denominator + sum(map(abs, row))) // common
    return beta, D


def _residues(M: Matrix) -> Iterator[tuple[int, Polynomial]]:
    """Pairwise coprime ℓ with the characteristic polynomial modulo each, where pivots are units."""
    tried = math.factorial(1000)  # small factors are those of most pivots
    for ell in range(FIRST, 1, -2):
        spend(budget.reductions(2, budget.limbs([tried]), LIMBS) + budget.fractions(1, LIMBS))
        if math.gcd(ell, tried) == 1:
            tried *= ell
            with suppress(NotAUnit):
                yield ell, characteristic_polynomial_modulo(M.modulo(ell), ell)
