"""Determinants, kernels and products of matrices of polynomials in a parameter."""

from __future__ import annotations

from typing import Any

import flint

from mcexact.exact.function_kernels import Kernel, Tower, X, line, over_functions
from mcexact.exact.modular_resultants import interpolated_modulo
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix
from mcexact.exact.two_variables import (
    degree_bound,
    interpolated,
    points,
    value_at,
)

Rows = list[list[Any]]
"""Rows of polynomials of flint."""
ZERO = flint.fmpq_poly([])


def determinant(M: PolynomialMatrix) -> Any:
    """det(M), by values.

    Examples
    --------
    >>> from mcexact.exact.matrix import Matrix
    >>> I = Matrix.identity(2)
    >>> str(determinant(PolynomialMatrix.from_matrices(I * -2, I)))
    'x^2 + (-4)*x + 4'
    """
    where = points(degree_bound(M) + 1)
    values = []
    for t in where:
        part = value_at(M, t)
        entries = [flint.fmpq(v, part.denominator) for row in part.numerators for v in row]
        values.append(flint.fmpq_mat(part.nrows, part.ncols, entries).det())
    return interpolated(values, where)


def determinant_modulo(M: PolynomialMatrix, ell: int) -> flint.nmod_poly:
    """det(M) modulo a prime that divides no denominator, by values."""
    many = degree_bound(M) + 1
    return interpolated_modulo([M.at_residue(t, ell).determinant() for t in range(many)], ell)


def product(left: Rows, right: Rows) -> Rows:
    """The product of two matrices."""
    width = len(right[0]) if right else 0
    return [
        [sum((c * right[k][j] for k, c in enumerate(row) if c != 0), ZERO) for j in range(width)]
        for row in left
    ]


def kernel_modulo(rows: Rows, ncols: int, q: Polynomial) -> Kernel:
    """The kernel over Q[t]/(q), q irreducible, in echelon form."""
    modulus = q._rational
    return Tower(modulus, X).kernel([[[e % modulus] for e in row] for row in rows], ncols)


def generic_kernel(rows: Rows, ncols: int) -> Kernel:
    """The kernel over Q(t), multiplied by the least common denominator."""

    def sample(t: int) -> Kernel:
        values = [[[flint.fmpq_poly([entry(t)])] for entry in row] for row in rows]
        return Tower(line(t), X).kernel(values, ncols)

    return over_functions(sample)
