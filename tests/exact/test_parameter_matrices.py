"""Determinants and kernels of matrices of polynomials, against determinants of sympy."""

from __future__ import annotations

import random
from typing import Any

import pytest
import sympy

from mcexact.exact.bivariate import (
    determinant,
    determinant_modulo,
    entries_of,
    generic_kernel,
    kernel_modulo,
    matrix_product,
)
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.polynomial import Polynomial

t = sympy.Symbol("t")
PRIME = 1000003


def drawn(rng: random.Random, nrows: int, ncols: int) -> PolynomialMatrix:
    def entry() -> Polynomial:
        return Polynomial.of(*(rng.randint(-3, 3) for _ in range(rng.randint(0, 3))))

    rows = [[entry() for _ in range(ncols)] for _ in range(nrows)]
    return PolynomialMatrix.from_polynomials(rows, ncols=ncols)


@pytest.mark.parametrize("n", range(4))
def test_determinants_are_those_of_sympy(n: int) -> None:
    M = drawn(random.Random(n), n, n)
    entries = [M.entry(i, j).coefficients for i in range(n) for j in range(n)]
    values = [sum(c * t**k for k, c in enumerate(entry)) for entry in entries]
    expected = sympy.Poly(sympy.Matrix(n, n, values).det(), t)
    coefficients = [int(c) for c in reversed(expected.all_coeffs())]
    found = determinant(M)
    assert [int(c.p) for c in found.coeffs()] == (coefficients if any(coefficients) else [])
    modular = [int(c) for c in determinant_modulo(M, PRIME).coeffs()]
    assert modular == [int(c.p) % PRIME for c in found.coeffs()]


def test_kernels_are_annihilated_generically_and_at_a_value() -> None:
    left, right = drawn(random.Random(5), 3, 2), drawn(random.Random(6), 2, 4)
    M: Any = entries_of(left @ right)
    pivots, vectors = generic_kernel(M, 4)
    assert len(pivots) == len(vectors) == 2
    columns = [[v[i][0] for v in vectors] for i in range(4)]
    assert all(entry == 0 for row in matrix_product(M, columns) for entry in row)
    q = Polynomial.of(-2, 0, 1)
    square = entries_of(PolynomialMatrix.from_polynomials([[q, Polynomial.of(1)]], ncols=2))
    pivots, vectors = kernel_modulo(square, 2, q)
    assert pivots == (0,) and [str(e[0]) for e in vectors[0]] == ["1", "0"]
