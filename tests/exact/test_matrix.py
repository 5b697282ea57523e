"""Rational matrices: what they are, and arithmetic against sympy."""

import math
import pickle
import random
from fractions import Fraction
from math import gcd
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import FloatRefused, InputError, LimitReached
from mcexact.exact.matrix import Matrix, block, block_diagonal, hstack, kronecker, vstack
from tests.exact.draws import (
    domain_matrix,
    from_domain_matrix,
    matrices,
    rationals,
    square_matrices,
)
from tests.wording import refusal

SHAPES = [(0, 0), (0, 3), (3, 0), (1, 1)]


@given(matrices())
def test_a_matrix_is_in_lowest_terms_and_rebuilt_from_its_rows(M):
    assert M.denominator >= 1
    assert gcd(M.denominator, *(entry for row in M.numerators for entry in row)) == 1
    assert Matrix.from_rows(M.rows(), ncols=M.ncols) == M
    assert hash(Matrix.from_integers(M.numerators, M.denominator, ncols=M.ncols)) == hash(M)


@given(matrices())
def test_pickling_keeps_a_matrix_also_after_it_was_used(M):
    M @ Matrix.zeros(M.ncols, 1)
    copy = pickle.loads(pickle.dumps(M))
    assert copy == M
    assert copy @ Matrix.identity(M.ncols) == M


@given(st.data())
def test_sums_and_products_are_those_of_sympy(data):
    r, k, c = (data.draw(st.integers(0, 3)) for _ in range(3))
    A, D = data.draw(matrices(r, k)), data.draw(matrices(r, k))
    B = data.draw(matrices(k, c))
    assert from_domain_matrix(domain_matrix(A) * domain_matrix(B)) == A @ B
    assert from_domain_matrix(domain_matrix(A) + domain_matrix(D)) == A + D
    assert from_domain_matrix(domain_matrix(A) - domain_matrix(D)) == A - D
    assert -A == A * -1
    assert (A @ B).T == B.T @ A.T


@given(matrices(), rationals)
def test_a_scalar_multiplies_every_entry(M, q):
    assert (q * M).rows() == tuple(tuple(q * entry for entry in row) for row in M.rows())
    assert M * q == q * M


@given(square_matrices(3), st.integers(0, 5))
def test_powers_are_repeated_products(M, k):
    expected = Matrix.identity(M.nrows)
    for _ in range(k):
        expected = expected @ M
    assert M.power(k) == expected


@pytest.mark.parametrize("shape", SHAPES)
def test_matrices_without_entries_keep_their_shape(shape):
    Z = Matrix.zeros(*shape)
    assert Z.shape == shape
    assert Z.T.shape == shape[::-1]
    assert (Z + Z).shape == (Z * 2).shape == (-Z).shape == shape
    assert (Z @ Z.T).shape == (shape[0], shape[0])
    assert Z.is_zero()
    assert Z.take(rows=range(shape[0])).shape == shape
    assert pickle.loads(pickle.dumps(Z)) == Z


def test_a_product_over_no_index_is_zero():
    assert Matrix.zeros(2, 0) @ Matrix.zeros(0, 3) == Matrix.zeros(2, 3)


def test_denominators_beyond_a_machine_word():
    q = Fraction(1, 3**60)
    M = Matrix.from_rows([[q, 1], [2, 3]])
    assert M.denominator == 3**60
    assert (M @ M)[0, 0] == q * q + 2


@given(st.data())
def test_blocks_are_put_where_they_belong(data):
    p, q, r, s = (data.draw(st.integers(0, 2)) for _ in range(4))
    A, B = data.draw(matrices(p, r)), data.draw(matrices(p, s))
    C, D = data.draw(matrices(q, r)), data.draw(matrices(q, s))
    M = block([[A, B], [C, D]])
    top, bottom, left, right = range(p), range(p, p + q), range(r), range(r, r + s)
    assert M.take(top, left) == A
    assert M.take(top, right) == B
    assert M.take(bottom, left) == C
    assert M.take(bottom, right) == D
    E = block_diagonal([A, D])
    assert block([[A, Matrix.zeros(p, s)], [Matrix.zeros(q, r), D]]) == E
    assert vstack([A.T, B.T]) == hstack([A, B]).T


@given(matrices(2, 2), matrices(2, 1), matrices(2, 3), matrices(1, 2))
def test_kronecker_products_multiply_factor_by_factor(A, B, C, D):
    assert kronecker(A, C) @ kronecker(B, Matrix.identity(3)) == kronecker(A @ B, C)
    assert kronecker(A, D).shape == (2, 4)
    assert kronecker(A, D)[1, 2] == A[1, 1] * D[0, 0]


def test_stacking_nothing_needs_a_size():
    assert hstack([], nrows=2).shape == (2, 0)
    assert vstack([], ncols=2).shape == (0, 2)
    assert block_diagonal([]).shape == (0, 0)
    with refusal(InputError):
        hstack([])
    with refusal(InputError):
        block([])


def test_unequal_sizes_do_not_stack():
    with refusal(InputError):
        vstack([Matrix.identity(1), Matrix.identity(2)])


def test_columns_and_submatrices():
    M = Matrix.from_rows([[1, 2], [3, 4]])
    assert M.take(cols=[1]) == Matrix.column([2, 4])
    assert M.take(rows=[1, 0], cols=[0]).numerators == ((3,), (1,))
    assert M.take(rows=[]).shape == (0, 2)
    for wrong in ({"rows": [2]}, {"cols": [-1]}):
        with pytest.raises(IndexError, match="in a 2 × 2 matrix"):
            M.take(**wrong)
    for position in ((2, 0), (0, -1)):
        with pytest.raises(IndexError, match="no entry"):
            M[position]


def test_a_submatrix_is_in_lowest_terms():
    M = Matrix.from_rows([["1/2", 1], [1, 1]])
    assert M.take(rows=[1]).denominator == 1


def test_numpy_integers_are_entries():
    assert Matrix.from_rows(np.array([[1, 2], [3, 4]])) == Matrix.from_rows([[1, 2], [3, 4]])


@pytest.mark.parametrize("other", [Matrix.zeros(2, 3), Matrix.zeros(3, 1)])
def test_shapes_must_match(other):
    M = Matrix.identity(2)
    with refusal(InputError):
        M + other
    with refusal(InputError):
        M - other
    with refusal(InputError):
        other.T @ other.T


def test_only_exact_numbers_multiply():
    wrong: Any
    for wrong in (0.5, True, "2"):
        with pytest.raises(TypeError):
            Matrix.identity(1) * wrong
    for wrong in (1, [[1]]):
        with pytest.raises(TypeError):
            Matrix.identity(1) @ wrong
        with pytest.raises(TypeError):
            Matrix.identity(1) + wrong


def test_powers_are_for_square_matrices():
    with pytest.raises(InputError, match="expected a square matrix, found 2 × 3"):
        Matrix.zeros(2, 3).power(2)


def test_negative_powers_are_refused():
    with refusal(InputError):
        Matrix.identity(2).power(-1)


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        (lambda: Matrix.zeros(-1, 0), "number of rows that is at least 0"),
        (lambda: Matrix.zeros(0, True), "number of columns that is at least 0"),
        (lambda: Matrix.from_integers([], ncols=True), "number of columns that is at least 0"),
        (lambda: Matrix.from_integers([[1]], 0), "nonzero integer denominator"),
        (lambda: Matrix.from_integers([[1]], True), "nonzero integer denominator"),
        (lambda: Matrix.from_integers([[1]], ncols=2), "rows of 2 numerators"),
        (lambda: Matrix.from_integers([[1], [1, 2]]), "rows of 1 numerators"),
        (lambda: Matrix.from_integers([[True]]), "numerators of type int"),
        (lambda: Matrix.from_integers([[0.5]]), "numerators of type int"),  # type: ignore[list-item]
    ],
)
def test_the_parts_of_a_matrix_are_examined(operation, message):
    with pytest.raises(InputError, match=message):
        operation()


@pytest.mark.parametrize(
    ("rows", "denominator", "ncols"), [([[2]], 2, 1), ([[0]], 2, 1), ([], 2, 1), ([[-3]], -3, 1)]
)
def test_integers_over_a_denominator_are_brought_to_lowest_terms(rows, denominator, ncols):
    assert Matrix.from_integers(rows, denominator, ncols).denominator == 1


def test_a_matrix_beyond_memory_is_refused():
    for operation in (Matrix.identity, lambda n: Matrix.zeros(n, n), lambda n: Matrix.zeros(0, n)):
        with refusal(LimitReached):
            operation(2**40)


def test_rows_are_examined_and_the_place_is_named():
    with refusal(InputError, where="B[1]"):
        Matrix.from_rows([[1, 2], [3]], where="B")
    with pytest.raises(FloatRefused, match=r"^B\[0\]\[1\]: a float"):
        Matrix.from_rows([[1, 0.5]], where="B")
    with pytest.raises(InputError, match=r"^B\[0\]: expected a row as a list, found int"):
        Matrix.from_rows([1, 2], where="B")  # type: ignore[list-item]
    wrong: Any
    for wrong in ("12", {1: 2}, None, 5):
        with pytest.raises(InputError, match="expected a matrix as a list of rows"):
            Matrix.from_rows(wrong)


def test_integers_over_a_denominator():
    assert Matrix.from_integers([[2, 4]], -6) == Matrix.from_rows([["-1/3", "-2/3"]])
    assert Matrix.from_integers([], 5, ncols=2).denominator == 1


def test_of_very_many_quotients_the_common_denominator_is_the_least() -> None:
    rng = random.Random(3)
    rows = [
        [Fraction(rng.randint(-999, 999), rng.randint(1, 99_999)) for _ in range(30)]
        for _ in range(30)
    ]
    M = Matrix.from_rows(rows)
    assert M.rows() == tuple(map(tuple, rows))
    assert M.denominator.bit_length() > 4096
    assert M.denominator == math.lcm(*(x.denominator for row in rows for x in row))
    assert M == Matrix.from_entries(
        (30, 30), ((i, j, x) for i, row in enumerate(rows) for j, x in enumerate(row) if x)
    )
    thin = [[x if i == j else Fraction(0) for j, x in enumerate(row)] for i, row in enumerate(rows)]
    wide = [[*row, *[Fraction(0)] * 270] for row in thin]
    assert Matrix.from_rows(wide).is_sparse and Matrix.from_rows(wide).rows() == tuple(
        map(tuple, wide)
    )
