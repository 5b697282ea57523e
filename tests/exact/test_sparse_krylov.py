"""Sequences of sparse closed loops are those of dense ones, whatever the kind of float."""

import random

import numpy as np
import pytest
import scipy.sparse

from mcexact.exact import krylov
from mcexact.exact.krylov import (
    FloatLoop,
    SparseLoop,
    loop_sequences,
    sequence,
    stays_sparse,
    steps_at_once,
)
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import residues

MODULI = [2, 3, 7, 31, 2**19 - 1]


def drawn(rng, nrows, ncols):
    rows = [[rng.choice([0, 0, 0, 1, -2, 10**20]) for _ in range(ncols)] for _ in range(nrows)]
    return Matrix.from_integers(rows, rng.choice([1, 5]), ncols=ncols)


def drawn_loop(rng, n, m):
    widths = [(rng.randint(0, 2), rng.randint(0, 2)) for _ in range(m)]
    B, C = [drawn(rng, n, p) for p, _ in widths], [drawn(rng, q, n) for _, q in widths]
    gains = [[[rng.randrange(100) for _ in range(q)] for _ in range(p)] for p, q in widths]
    return drawn(rng, n, n), B, C, gains


@pytest.mark.parametrize("ell", MODULI)
@pytest.mark.parametrize("n", [1, 2, 7])
def test_a_sparse_loop_is_the_dense_one(ell, n):
    for seed in range(5):
        rng = random.Random(100 * n + seed)
        A, B, C, gains = drawn_loop(rng, n, rng.randint(0, 3))
        dense, sparse = FloatLoop(A, B, C, ell), SparseLoop(A, B, C, ell)
        M, N = dense.closed(gains), sparse.closed(gains)
        assert np.array_equal(M % ell, N.toarray() % ell)
        assert abs(N).max() <= ell // 2
        starts = [
            (q, [rng.randrange(ell) for _ in range(b.ncols)], [3 % ell] * c.nrows)
            for q, (b, c) in enumerate(zip(B, C, strict=True))
        ]
        found = sparse.sequences(N, starts)
        assert list(found) == list(loop_sequences(A, B, C, gains, ell, starts))


def plain(M, row, column, ell, length):
    """The same by Python's integers."""
    rows, found, v = M.toarray().tolist(), [], column.tolist()
    for _ in range(length):
        found.append(sum(x * y for x, y in zip(row.tolist(), v, strict=True)) % ell)
        v = [sum(x * y for x, y in zip(line, v, strict=True)) % ell for line in rows]
    return found


@pytest.mark.parametrize("ell", [2, 7, 31, 2**19 - 1])
@pytest.mark.parametrize("together", [1, 3, 1024])
def test_every_entry_as_large_as_it_can_be_is_computed_exactly(ell, together, monkeypatch):
    monkeypatch.setattr(krylov, "_TOGETHER", together)
    n, top = 9, ell // 2
    for entry in (top, -top):
        M = scipy.sparse.csr_array(np.full((n, n), entry, dtype=np.int64))
        row, column = np.full(n, top), np.full(n, -top)
        assert sequence(M, row, column, ell, 40) == plain(M, row, column, ell, 40)


def test_steps_are_as_many_as_are_exact():
    for ell, n in ((2, 5), (7, 3), (31, 100), (2**19 - 1, 50)):
        M = scipy.sparse.csr_array(np.full((n, n), ell // 2, dtype=np.int64))
        for exact in (2**24, 2**53):
            steps, growth = steps_at_once(M, ell, exact), n * (ell // 2)
            assert (ell // 2 + 3) * growth**steps <= exact - ell
            assert (ell // 2 + 3) * growth ** (steps + 1) > exact - ell or steps == 64
    assert steps_at_once(scipy.sparse.csr_array((3, 3), dtype=np.int64), 7, 2**24) == 1


def test_no_sequence_is_computed_where_one_step_is_not_exact(monkeypatch):
    monkeypatch.setattr(krylov, "steps_at_once", lambda *_: 0)
    loop = SparseLoop(Matrix.identity(3), [Matrix.column([1] * 3)], [Matrix.zeros(1, 3)], 31)
    assert loop.sequences(loop.closed([[[1]]]), [(0, [1], [1])]) is None


def test_a_loop_is_sparse_if_no_gain_fills_more_than_an_eighth():
    n = 48
    A, C = Matrix.identity(n), Matrix.from_rows([[1] * 15 + [0] * (n - 15)])
    assert A.is_sparse
    for inputs, good in ((15, True), (16, True), (17, False)):
        B = Matrix.column([1] * inputs + [0] * (n - inputs))
        assert stays_sparse(A, [B], [C]) == good
    assert not stays_sparse(Matrix.identity(10), [], [])
    assert residues(A, 7).rank() == n
