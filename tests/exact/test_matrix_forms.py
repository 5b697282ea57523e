"""Matrices as users of numpy, scipy, sympy, pandas and python-control expect them."""

from fractions import Fraction
from typing import Any

import control
import numpy as np
import pytest
import scipy.linalg
import sympy
from hypothesis import given

from mcexact.exact.matrix import Matrix
from mcexact.shown import LINE
from tests.exact.draws import matrices

M = Matrix.from_rows([[1, "1/3"], [0, -2]])
LARGE = Matrix.from_rows([[i * j - 3 for j in range(40)] for i in range(30)])
SIZES = [(0, 0), (0, 3), (3, 0), (1, 1), (12, 13), (300, 2), (100_000, 100_000)]


def test_a_matrix_becomes_an_array_of_the_nearest_floats():
    found = np.array(M)
    assert found.dtype == np.float64 and found.tolist() == [[1.0, 1 / 3], [0.0, -2.0]]
    assert type(np.asanyarray(M)) is np.ndarray
    assert np.array(M, dtype=np.float32).dtype == np.float32
    assert np.array(Matrix.zeros(0, 3)).shape == (0, 3)
    assert M.to_numpy().tolist() == found.tolist()


def test_an_array_of_objects_keeps_the_exact_entries():
    assert np.array(M, dtype=object)[0, 1] == Fraction(1, 3)
    assert type(np.asarray(M, object)[0, 0]) is Fraction
    assert M.to_numpy(object).shape == (2, 2)


def test_integers_stay_integers_and_nothing_is_cut_off():
    large = Matrix.from_rows([[2**62, 5]])
    assert np.array(large, dtype=np.int64).tolist() == [[2**62, 5]]
    assert np.array(Matrix.zeros(0, 3), dtype=int).shape == (0, 3)
    with pytest.raises(ValueError, match="not integers"):
        np.array(M, dtype=int)
    with pytest.raises(ValueError, match="int8 cannot hold"):
        np.array(large, dtype=np.int8)


def test_an_array_never_shares_the_memory_of_a_matrix():
    copy = np.asarray(M)
    copy[0, 0] = 7
    assert M[0, 0] == 1
    with pytest.raises(ValueError, match="leave out copy=False"):
        M.__array__(copy=False)


def test_functions_of_other_libraries_take_matrices():
    assert np.linalg.eigvals(M).tolist() == [1, -2]
    assert (M @ np.ones(2)).tolist() == [1 + 1 / 3, -2]
    assert (np.eye(2) @ M).tolist() == np.array(M).tolist()
    assert scipy.linalg.expm(Matrix.zeros(2, 2)).tolist() == np.eye(2).tolist()  # type: ignore[call-overload]
    assert control.ss(M, [[1], [0]], [[1, 0]], 0).A.tolist() == np.array(M).tolist()


@given(matrices())
def test_sympy_gets_the_exact_entries(M):
    found = sympy.Matrix(M)
    assert found.shape == M.shape
    assert found == M.to_sympy() == sympy.sympify(M) == sympy.ImmutableMatrix(M)
    assert Matrix.from_rows(found.tolist(), ncols=M.ncols) == M
    assert all(entry.is_Rational for entry in found)


def test_sympy_computes_with_a_matrix():
    assert sympy.eye(2) * M == sympy.Matrix(M)


@given(matrices())
def test_lists_and_rows_give_the_matrix_again(M):
    assert Matrix.from_rows(M.tolist(), ncols=M.ncols) == M
    assert tuple(M) == M.rows() == tuple(M[i] for i in range(M.nrows))
    assert M / 3 * 3 == M


def test_a_row_is_found_by_its_position_and_a_submatrix_is_taken():
    assert M[1] == M[np.int64(1)] == (0, -2)  # type: ignore[call-overload]
    for missing in (2, -1):
        with pytest.raises(IndexError, match=f"no row {missing}"):
            M[missing]
    position: Any
    for position in (slice(1), (0, slice(None)), None):
        with pytest.raises(TypeError, match=r"take\(rows=\[…\], cols=\[…\]\) gives a submatrix"):
            M[position]
    with pytest.raises(TypeError):
        M / 0.5  # type: ignore[operator]


@given(matrices())
def test_the_repr_of_a_small_matrix_makes_it_again(M):
    small = Matrix.from_integers(
        [[entry % 100 for entry in row] for row in M.numerators], 7, M.ncols
    )
    assert eval(repr(small)) == small
    assert repr(M).startswith("<") or eval(repr(M)) == M


@pytest.mark.parametrize("shape", SIZES)
def test_a_matrix_of_any_size_is_shown_in_little_room(shape):
    found = Matrix.zeros(*shape)
    assert len(repr(found)) <= LINE and "\n" not in repr(found)
    assert max(map(len, str(found).splitlines())) <= LINE
    assert len(found._repr_html_()) < 10_000
    assert len(found._repr_latex_()) < 2_000


def test_long_numbers_are_rounded_where_they_are_shown():
    long = Matrix.from_rows([[10**5000, "1/3"]])
    assert repr(long) == "<1 × 2 matrix [[about 1e+5000, 1/3]]>"
    assert str(long) == "[about 1e+5000  1/3]"
    assert r"\text{about 1e+5000} & \tfrac{1}{3}" in long._repr_latex_()


def test_a_large_matrix_is_shown_with_its_corners_and_its_size():
    assert repr(LARGE) == "<30 × 40 matrix [[-3, -3, -3, -3, … 36 more], … 29 more]>"
    lines = str(LARGE).splitlines()
    assert lines[0].split() == ["[-3", *["-3"] * 5, "…", *["-3"] * 5, "-3]"]
    assert lines[6].split() == ["[", *"⋮⋮⋮⋮⋮⋮⋱⋮⋮⋮⋮⋮", "⋮]"]
    assert lines[-1] == "(30 × 40)"
    html = LARGE._repr_html_()
    assert html.count("<tr>") == 13 and "30 × 40" in html
    assert r"\ddots" in LARGE._repr_latex_()


def test_a_matrix_is_aligned_on_the_right():
    assert str(M) == "[1  1/3]\n[0   -2]"
    assert str(Matrix.zeros(0, 2)) == "[] (0 × 2)"
