"""Characteristic polynomials by floats: the same as flint's, at the edge of exactness too."""

import random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.exact import krylov
from mcexact.exact.matrix import Matrix, hstack, vstack
from mcexact.exact.modular import ModularMatrix, primes, residues
from tests.exact.draws import square_matrices


def prime(terms):
    """A prime of as many bits as sums of this many products allow."""
    return next(primes(terms, krylov.exact_bits(terms)))


def floats(M, ell):
    return krylov.residues([M], ell, np.float64).reshape(M.shape)


@given(square_matrices(), st.integers(0, 50))
def test_the_polynomial_is_that_of_flint(M, seed):
    ell = next(primes(seed, 20))
    if M.denominator % ell == 0:
        return
    expected = residues(M, ell).characteristic_polynomial()
    assert krylov.characteristic_polynomial(floats(M, ell), ell) == expected


def _jordan(n):
    return Matrix.from_integers([[int(j in (i, i + 1)) for j in range(n)] for i in range(n)])


@pytest.mark.parametrize(
    "M",
    [
        Matrix.zeros(0, 0),
        Matrix.zeros(3, 3),
        Matrix.identity(40),
        _jordan(40),
        _jordan(39) * 7,
        Matrix.from_rows([["1/3", 10**400], [-(10**30), "-5/7"]]),
        Matrix.from_rows([[2**53 + 1, 1], [1, -(2**53) - 1]]),
    ],
    ids=["empty", "zero", "identity", "jordan", "scaled", "long", "just-too-long"],
)
def test_matrices_with_a_short_recurrence_or_long_entries_are_no_exception(M):
    ell = prime(40)
    expected = residues(M, ell).characteristic_polynomial()
    assert krylov.characteristic_polynomial(floats(M, ell), ell) == expected


@pytest.mark.parametrize("n", [128, 200, 333])
def test_a_dense_matrix_of_extreme_residues_has_the_right_polynomial(n):
    ell, rng = prime(n), random.Random(n)
    half = ell // 2
    rows = [[rng.choice((half, -half, half - 1)) for _ in range(n)] for _ in range(n)]
    expected = ModularMatrix.from_rows(rows, ell).characteristic_polynomial()
    assert krylov.characteristic_polynomial(np.array(rows, dtype=np.float64), ell) == expected


@pytest.mark.parametrize("terms", [1, 2, 3, 127, 200, 800, 1_000, 4_096, 100_000])
def test_sums_of_the_largest_products_are_exact_and_reduced_well(terms):
    ell = next(p for p in primes(1, krylov.exact_bits(terms)) if p > 2)
    largest = ell // 2 + 3
    total = np.full((1, terms), float(largest)) @ np.full((terms, 1), float(largest))
    assert int(total[0, 0]) == terms * largest**2
    for value in (int(total[0, 0]), -int(total[0, 0]), ell * (2**52 // ell) + ell // 2):
        left = float(krylov.reduce(np.array([float(value)]), ell)[0])
        assert left.is_integer() and (value - int(left)) % ell == 0 and abs(left) <= ell // 2 + 3


@pytest.mark.parametrize("part", [1, 3, 12, 100])
def test_numbers_are_reduced_in_place_part_by_part_in_any_order(part, monkeypatch):
    monkeypatch.setattr(krylov, "_PART", part)
    numbers = np.arange(-12, 12).reshape(4, 6)
    for order in ("C", "F"):
        table = np.array(numbers, dtype=np.float32, order=order)
        assert krylov.reduce(table, 5) is table
        assert np.array_equal(table % 5, numbers % 5) and abs(table).max() == 2
    assert krylov.reduce(np.zeros((0, 3)), 5).shape == (0, 3)


@pytest.mark.parametrize("n", [11 + 13 * 9, 11 + 13 * 14, 11 + 13 * 30, 11 + 13 * 40])
@pytest.mark.parametrize("kind", [np.float32, np.float64])
def test_a_sequence_is_exact_where_all_residues_are_large(n, kind):
    """Modulo 13, 6n is 1 for these n: the matrix of entries 6 is its own square."""
    steps = krylov.KrylovSteps(np.full((n, n), 6, dtype=kind), 13)
    assert abs(steps.power).min() == 6
    row, column = np.full(n, 6, dtype=kind), np.full(n, -5, dtype=kind)
    assert steps.sequence(row, column) == [-30 * n % 13] * (2 * n)


@pytest.mark.parametrize("n", [1, 2, 3, 7, 8, 127, 255, 256])
def test_a_sequence_is_that_of_products_one_by_one(n):
    rng, ell = random.Random(n), 31
    M = np.array([[rng.randrange(ell) - 15 for _ in range(n)] for _ in range(n)], dtype=np.float32)
    row, column = M[0].copy(), M[:, -1].copy()
    found, v, whole = [], column.astype(np.int64), M.astype(np.int64)
    for _ in range(2 * n):
        found.append(int(row.astype(np.int64) @ v) % ell)
        v = whole @ v % ell
    assert krylov.KrylovSteps(M, ell).sequence(row, column) == found


@given(st.data())
def test_a_loop_is_closed_channel_by_channel(data):
    n = data.draw(st.integers(1, 4))
    widths = data.draw(st.lists(st.tuples(st.integers(0, 2), st.integers(0, 2)), min_size=1))
    ell, rng = next(primes(data.draw(st.integers(0, 9)), 20)), data.draw(st.randoms())

    def draw(rows, cols):
        table = [[rng.randint(-5, 5) for _ in range(cols)] for _ in range(rows)]
        return Matrix.from_integers(table, rng.randint(1, 3), ncols=cols)

    A, B, C = draw(n, n), [draw(n, p) for p, _ in widths], [draw(q, n) for _, q in widths]
    gains = [[[rng.randrange(ell) for _ in range(q)] for _ in range(p)] for p, q in widths]
    F = _block_diagonal(gains, widths, ell)
    closed = residues(A, ell) + residues(hstack(B), ell) @ F @ residues(vstack(C), ell)
    found = krylov.loop_polynomials(A, B, C, gains, ell)
    assert found == (
        residues(A, ell).characteristic_polynomial(),
        closed.characteristic_polynomial(),
    )


def _block_diagonal(gains, widths, ell):
    rows, left, total = [], 0, sum(q for _, q in widths)
    for F, (_, q) in zip(gains, widths, strict=True):
        rows += [[0] * left + row + [0] * (total - left - q) for row in F]
        left += q
    return ModularMatrix.from_rows(rows, ell, ncols=total)
