"""Sparse and dense tables answer alike; which of them a matrix has is decided by its zeros."""

import pickle
import random
from fractions import Fraction

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import FloatRefused, InputError, LimitReached
from mcexact.exact import tables
from mcexact.exact.matrix import (
    Matrix,
    block,
    block_diagonal,
    from_numerators,
    hstack,
    kronecker,
    matrix_from_float,
    matrix_to_float,
    vstack,
)
from mcexact.exact.tables import DenseTable, SparseTable, listed
from tests.exact.draws import matrices, rationals
from tests.wording import refusal


def in_sparse_form(M: Matrix) -> Matrix:
    return Matrix(listed(M._table), M.denominator)


def both(draw, nrows, ncols):
    """A matrix with many zeros, and the same in a form that is drawn."""
    entries = st.one_of(st.just(Fraction(0)), st.just(Fraction(0)), rationals)
    M = draw(matrices(nrows, ncols, entries))
    return M, in_sparse_form(M) if draw(st.booleans()) else M


@given(st.data())
def test_every_operation_is_that_of_the_dense_form(data):
    r, k, c = (data.draw(st.integers(0, 3)) for _ in range(3))
    (A, a), (B, b), (D, d) = (both(data.draw, *shape) for shape in ((r, k), (k, c), (r, k)))
    q = data.draw(rationals)
    pairs = [
        (A, a),
        (A + D, a + d),
        (A - D, a - d),
        (A - A, a - a),
        (A @ B, a @ b),
        (-A, -a),
        (A * q, a * q),
        (A.T, a.T),
        (hstack([A, D]), hstack([a, d])),
        (vstack([A, D]), vstack([a, d])),
        (block([[A, D], [D, A]]), block([[a, d], [d, a]])),
        (block_diagonal([A, B, D]), block_diagonal([a, b, d])),
        (kronecker(A, B), kronecker(a, b)),
        (A, pickle.loads(pickle.dumps(a))),
        (A, a.suited()),
    ]
    for dense, other in pairs:
        assert other == dense
        assert dense == other
        assert hash(other) == hash(dense)
        assert (other.shape, other.denominator) == (dense.shape, dense.denominator)
        assert other.numerators == dense.numerators
        assert list(other.nonzero()) == list(dense.nonzero())
        assert other.is_zero() == dense.is_zero()
        assert other.words == dense.words
    assert (a == D) == (A == D)


@given(st.data())
def test_submatrices_and_entries_are_those_of_the_dense_form(data):
    r, c = data.draw(st.integers(1, 4)), data.draw(st.integers(1, 4))
    M, S = both(data.draw, r, c)
    rows = data.draw(st.none() | st.lists(st.integers(0, r - 1), max_size=5))
    cols = data.draw(st.none() | st.lists(st.integers(0, c - 1), max_size=5))
    assert S.take(rows, cols) == M.take(rows, cols)
    assert [[S[i, j] for j in range(c)] for i in range(r)] == [list(row) for row in M.rows()]
    assert Matrix.from_entries((r, c), [(i, j, M[i, j]) for i in range(r) for j in range(c)]) == M


@pytest.mark.parametrize(
    ("nrows", "ncols", "nonzero", "sparse"),
    [(32, 64, 256, True), (32, 64, 257, False), (1, 2048, 0, True), (23, 89, 0, False)],
)
def test_a_large_matrix_of_zeros_but_an_eighth_is_sparse(nrows, ncols, nonzero, sparse):
    cells = [*range(1, nonzero + 1), *[0] * (nrows * ncols - nonzero)]
    for order in (cells, cells[::-1]):
        rows = [order[i * ncols : (i + 1) * ncols] for i in range(nrows)]
        entries = ((*divmod(k, ncols), x) for k, x in enumerate(order))
        made = [
            Matrix.from_rows(rows),
            Matrix.from_integers(rows),
            Matrix.from_entries((nrows, ncols), entries),
            Matrix(DenseTable(Matrix.from_rows(rows)._integer), 1).suited(),
        ]
        assert [M.is_sparse for M in made] == [sparse] * 4
        assert all(M == made[0] for M in made)
        assert len({hash(M) for M in made}) == 1


def test_long_numbers_are_counted_where_they_do_not_fit_into_words():
    M = from_numerators([[0] * 60 + [2**70]] * 60, 1, 61)
    assert M.is_sparse
    assert M.words is None
    dense = Matrix(DenseTable(M._integer), 1)
    assert dense.suited().is_sparse
    assert dense == M


def test_sparse_matrices_stay_sparse():
    n = 10**5
    M = Matrix.from_entries((n, n), [(i, (7 * i + 3) % n, i % 7) for i in range(0, n, 1000)])
    results = [M, M.T, M + M, M - M, 3 * M, -M, M @ M, M @ Matrix.identity(n)]
    results += [M.take(range(0, n, 2), range(n)), pickle.loads(pickle.dumps(M))]
    results += [hstack([M, M]), vstack([M, Matrix.zeros(1, n)]), block_diagonal([M, M])]
    assert all(result.is_sparse for result in results)
    assert M @ Matrix.identity(n) == M
    column = Matrix.from_entries((n, 1), [(7003, 0, 2)])
    assert list((M @ column).nonzero()) == list((2 * M.take(cols=[7003])).nonzero())
    assert "100000" in repr(M)
    for needs_zeros in (lambda: M.numerators, lambda: M.words, lambda: M._integer, M.rows):
        with refusal(LimitReached):
            needs_zeros()


def test_products_that_fill_are_computed_densely():
    rng = random.Random(3)
    rows = [[rng.choice([0] * 9 + [1]) for _ in range(60)] for _ in range(60)]
    S = Matrix.from_rows(rows)
    assert S.is_sparse
    assert not (S @ S).is_sparse
    assert S @ S == Matrix(DenseTable(S._integer), 1) @ Matrix(DenseTable(S._integer), 1)


def test_a_product_that_is_too_large_for_the_dense_form_is_still_computed(monkeypatch):
    monkeypatch.setattr(tables, "LARGEST_WRITTEN_OUT", 10)
    S = in_sparse_form(Matrix.from_rows([[1, 2, 3, 4], [5, 6, 7, 8], [9, 1, 2, 3], [4, 5, 6, 7]]))
    assert (S @ S)[0, 0] == 1 + 10 + 27 + 16
    assert (S - S).is_zero()


@pytest.mark.parametrize(
    ("entries", "message"),
    [
        ([(2, 0, 1)], r"A: expected a position inside 2 × 3, found \(2, 0\)"),
        ([(0, 3, 1)], r"A: expected a position inside 2 × 3, found \(0, 3\)"),
        ([(-1, 0, 1)], r"A: expected a position inside 2 × 3, found \(-1, 0\)"),
        ([(1, 1, 1), (1, 1, 2)], r"A: the position \(1, 1\) is given twice"),
        ([(1, 2, "x")], r"A\[1\]\[2\]: "),
    ],
)
def test_entries_are_examined(entries, message):
    with pytest.raises(InputError, match=message):
        Matrix.from_entries((2, 3), entries, where="A")
    with pytest.raises(FloatRefused, match=r"A\[0\]\[1\]: a float"):
        Matrix.from_entries((2, 3), [(0, 1, 0.5)], where="A")


@pytest.mark.parametrize("form", ["coo", "csr", "csc", "lil", "dok", "dia"])
def test_sparse_arrays_of_floats_are_converted_entry_by_entry(form):
    dense = np.zeros((50, 60))
    dense[3, 4], dense[0, 59], dense[49, 0] = 0.1, -2.5, 3.0
    M = matrix_from_float(scipy.sparse.coo_array(dense).asformat(form))
    assert M.is_sparse
    assert M == matrix_from_float(dense)
    assert M[3, 4] == Fraction(1, 10)
    assert np.array_equal(matrix_to_float(M), dense)
    with pytest.raises(InputError, match=r"B\[0\]\[1\]: expected a finite number"):
        matrix_from_float(scipy.sparse.coo_array([[0.0, np.inf]]), where="B")


def test_sparse_tables_have_dense_neighbors():
    table = SparseTable(2, 2, [1], [5])
    assert not tables.equal(table, Matrix.zeros(2, 3)._table)
    assert tables.equal(table, Matrix.from_rows([[0, 5], [0, 0]])._table)
