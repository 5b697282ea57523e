"""The two crossings, of numbers and of arrays."""

import math
from fractions import Fraction

import numpy as np
import pytest
import scipy.sparse
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix, from_float, matrix_from_float, matrix_to_float, to_float
from tests.exact.draws import matrices

finite = st.floats(allow_nan=False, allow_infinity=False)


@given(finite)
def test_both_roundings_come_back_as_the_same_float(x):
    assert to_float(from_float(x, "decimal")) == x
    assert to_float(from_float(x, "dyadic")) == x
    assert from_float(x, "dyadic") == Fraction(x)


def test_the_roundings_differ_on_a_tenth():
    assert from_float(0.1, "decimal") == Fraction(1, 10)
    assert from_float(np.float64(0.1), "decimal") == Fraction(1, 10)
    assert from_float(0.1, "dyadic").denominator == 2**55


@pytest.mark.parametrize("x", [math.nan, math.inf, -math.inf])
def test_only_finite_floats_come_in(x):
    with pytest.raises(InputError, match="expected a finite number"):
        from_float(x, "dyadic")


def test_an_unknown_rounding_is_refused():
    with pytest.raises(InputError, match='rounding: expected "decimal", "dyadic" or "simplest"'):
        from_float(0.5, "nearest")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="rounding: expected"):
        matrix_from_float([[0.5]], "up")  # type: ignore[arg-type]


def test_numbers_beyond_the_range_of_floats_become_infinities():
    assert to_float(Fraction(10**400)) == math.inf
    assert to_float(Fraction(-(10**400))) == -math.inf
    assert to_float(Fraction(1, 10**400)) == 0.0


@given(
    st.lists(st.tuples(finite, finite), min_size=1, max_size=3),
    st.sampled_from(["decimal", "dyadic"]),
)
def test_arrays_come_back_unchanged(rows, rounding):
    array = np.array(rows)
    assert np.array_equal(matrix_to_float(matrix_from_float(array, rounding)), array)


@given(matrices())
def test_every_entry_is_the_nearest_float(M):
    array = matrix_to_float(M)
    assert array.shape == M.shape
    assert array.dtype == np.float64
    for row, exact in zip(array, M.rows(), strict=True):
        assert [float(q) for q in exact] == list(row)


def test_the_two_roundings():
    assert matrix_from_float([[0.1]], "decimal")[0, 0] == Fraction(1, 10)
    assert matrix_from_float([[0.1]], "dyadic")[0, 0] == Fraction(0.1)


def test_large_integers_are_not_rounded():
    M = matrix_from_float(np.array([[2**62 + 1]]))
    assert M[0, 0] == 2**62 + 1


@pytest.mark.parametrize("beside", [0.5, -1, np.float32(0.5), 2**63, 10**40])
def test_integers_in_a_list_are_not_rounded_whatever_stands_beside_them(beside):
    M = matrix_from_float([[2**60 + 1, beside], np.array([2**62 + 1, 1])])
    assert M.rows() == (
        (Fraction(2**60 + 1), Fraction(int(2 * beside), 2)),
        (Fraction(2**62 + 1), Fraction(1)),
    )


def test_single_precision_is_read_as_the_number_it_is():
    assert matrix_from_float(np.array([[0.5]], dtype=np.float32))[0, 0] == Fraction(1, 2)


@pytest.mark.parametrize("shape", [(0, 0), (0, 3), (3, 0)])
def test_arrays_without_entries_keep_their_shape(shape):
    assert matrix_from_float(np.zeros(shape)).shape == shape
    assert matrix_to_float(Matrix.zeros(*shape)).shape == shape


def test_lists_and_sparse_arrays():
    assert matrix_from_float([]).shape == (0, 0)
    assert matrix_from_float([[], []]).shape == (2, 0)
    assert matrix_from_float(scipy.sparse.eye(2)) == Matrix.identity(2)


@pytest.mark.parametrize(
    ("array", "message"),
    [
        (np.zeros(3), "expected a two-dimensional array, found 1 dimensions"),
        (np.zeros((1, 1, 1)), "expected a two-dimensional array, found 3 dimensions"),
        (np.zeros((1, 1), dtype=complex), "expected an array of real numbers, found complex"),
        (np.array([[True]]), "expected an array of real numbers, found bool"),
        (np.array([["1"]]), "expected an array of real numbers"),
        ([[True, 0.5]], r"^B\[0\]\[0\]: expected a real number, found bool"),
        ([[1.0, "2"]], r"^B\[0\]\[1\]: expected a real number, found str"),
        ([[1j]], r"^B\[0\]\[0\]: expected a real number, found complex"),
        ([[1.0], [2.0, 3.0]], "expected 1 entries as in row 0, found 2"),
        ([1.0, 2.0], "expected a row as a list, found float"),
        ("12", "expected a matrix as a list of rows, found a string"),
        (3.0, "expected a matrix as a list of rows, found float"),
        ([[0.0, float("nan")]], r"^B\[0\]\[1\]: expected a finite number, found nan"),
        ([[float("inf")]], r"^B\[0\]\[0\]: expected a finite number, found inf"),
    ],
)
def test_what_is_no_real_matrix_is_refused(array, message):
    with pytest.raises(InputError, match=message):
        matrix_from_float(array, where="B")


def test_a_matrix_of_long_numbers_is_rounded_entry_by_entry():
    M = Matrix.from_rows([[10**400, "-1/3"], [f"{2**53 + 1}", Fraction(1, 10**400)]])
    assert matrix_to_float(M).tolist() == [[math.inf, -1 / 3], [float(2**53), 0.0]]
    assert to_float("1e400") == math.inf
