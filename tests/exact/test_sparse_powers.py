"""Polynomials of sparse matrices modulo primes, beside those of dense ones."""

from __future__ import annotations

import random

import flint
import numpy as np
import pytest
import scipy.sparse

from mcexact.exact.krylov import SparsePowers, largest_prime, row_echelon
from mcexact.exact.modular import ModularPolynomial, primes

ELL = next(primes(1, 24))


def drawn(n: int, seed: int) -> tuple[SparsePowers, list[list[int]]]:
    rng = random.Random(seed)
    rows = [[rng.randrange(-ELL // 2, ELL // 2) for _ in range(n)] for _ in range(n)]
    rows = [[x if rng.random() < 0.5 else 0 for x in row] for row in rows]
    return SparsePowers(scipy.sparse.csr_array(np.array(rows, dtype=np.int64)), ELL), rows


@pytest.mark.parametrize("n", [1, 2, 5, 12])
def test_a_polynomial_of_a_matrix_is_applied_to_columns(n: int) -> None:
    powers, rows = drawn(n, n)
    rng = random.Random(n)
    p = [rng.randrange(ELL) for _ in range(4)]
    V = [[rng.randrange(ELL) for _ in range(3)] for _ in range(n)]
    M, one = (
        flint.nmod_mat(rows, ELL),
        flint.nmod_mat(n, n, np.eye(n, dtype=int).ravel().tolist(), ELL),
    )
    whole = one * p[0] + M * p[1] + M * M * p[2] + M * M * M * p[3]
    expected = (whole * flint.nmod_mat(V, ELL)).table()
    found = powers.applied(ModularPolynomial.from_coefficients(p, ELL), np.array(V))
    assert found.tolist() == [list(map(int, row)) for row in expected]
    once = (M * flint.nmod_mat(V, ELL)).table()
    assert powers.product(np.array(V)).tolist() == [list(map(int, row)) for row in once]


@pytest.mark.parametrize("n", [1, 2, 5, 12])
def test_the_minimal_polynomial_is_found(n: int) -> None:
    powers, rows = drawn(n, n)
    expected = flint.nmod_mat(rows, ELL).minpoly()
    found = powers.minimal_polynomial(random.Random(n))
    assert found.coefficients == tuple(map(int, expected.coeffs()))


def test_rows_that_depend_on_others_are_left_out() -> None:
    reduced, pivots = row_echelon(np.array([[0, 2, 4], [0, 1, 2], [0, 3, 0], [0, 0, 0]]), 7)
    assert (reduced.tolist(), pivots) == ([[0, 1, 0], [0, 0, 1]], (1, 2))
    reduced, pivots = row_echelon(np.zeros((0, 3), dtype=np.int64), 7)
    assert (reduced.shape, pivots) == ((0, 3), ())


@pytest.mark.parametrize(("n", "terms"), [(10, 1), (10**4, 8), (10**5, 40), (10**6, 1000)])
def test_all_sums_are_integers_that_doubles_represent(n: int, terms: int) -> None:
    ell = largest_prime(n, terms)
    assert (terms + 1) * (ell // 2 + 3) ** 2 + ell <= 2**53
    assert 2 * n * ell <= 2**53
