"""Characteristic polynomials, modulo ℓ and over Q; ``proofs/arithmetic.md``."""

import math
from fractions import Fraction
from operator import mul

from . import budget
from .arithmetic import Matrix, NotAUnit, Polynomial, Rows, inverse
from .budget import spend


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

    The coefficients of det(xI − N), N the integer numerators, are at most Π (1 + |row|) in absolute
    value (Hadamard, minor by minor), so they are read off modulo one larger power of an odd q.

    Theorem ``characteristic_polynomial.characteristic_polynomial_rule``.
    """
    if ell:
        return characteristic_polynomial_modulo(A.modulo(ell), ell)
    n, d, a = A.nrows, A.denominator, A.limbs
    spend(budget.products(4 * n * n, a, a) + budget.products(n, n * a, a))
    bound = math.prod(2 + math.isqrt(sum(entry * entry for entry in row)) for row in A.rows)
    q = 2**61 - 1
    while True:
        ell = q ** (bound.bit_length() // 60 + 1)
        try:
            residues = characteristic_polynomial_modulo(A.rows, ell)
            break
        except NotAUnit:
            q += 2
    lifted = [c - ell if 2 * c > ell else c for c in residues]
    spend(budget.fractions(n + 1, n * a + 1))
    return [Fraction(c, d ** (n - k)) for k, c in enumerate(lifted)]
