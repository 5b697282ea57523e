"""Systems from stacked matrices with the channels' sizes, exact and of floats of any precision."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import scipy.sparse
import sympy

from mcexact.errors import InputError
from mcexact.exact.matrix import from_float, matrix_from_float
from mcexact.model.system import MultiChannelSystem, from_stacked

A, B, C = [[0, 1], [0, 0]], [[1, 0, 0], [0, 1, 2]], [[1, 0], [0, 1]]
SIZES: dict[str, Any] = {"inputs": [1, 2, 0], "outputs": (0, 1, 1)}
EXPECTED = MultiChannelSystem(A, [[[1], [0]], [[0, 0], [1, 2]], [[], []]], [[], [[1, 0]], [[0, 1]]])


@pytest.mark.parametrize(
    "kind",
    [
        list,
        np.array,
        sympy.Matrix,
        scipy.sparse.csr_array,
        lambda rows: np.array(rows, dtype=np.int8),
        lambda rows: np.array(rows, dtype=object),
    ],
)
def test_stacked_matrices_of_every_exact_kind_are_split_in_order(kind):
    assert from_stacked(kind(A), kind(B), kind(C), **SIZES) == EXPECTED


def test_floats_are_read_by_a_rounding_which_is_simplest_by_default():
    floats = [np.array(M, dtype=float) for M in (A, B, C)]
    assert from_stacked(*floats, **SIZES) == EXPECTED
    assert from_stacked(*floats, **SIZES, rounding="decimal") == EXPECTED
    rounded = [[0, 1 / 3], [0, 0.1 + 0.2]]
    plant = from_stacked(rounded, B, C, **SIZES)
    assert plant.A.rows() == ((0, Fraction(1, 3)), (0, Fraction(3, 10)))
    assert plant.rounding == "simplest"
    stored = from_stacked(rounded, B, C, **SIZES, rounding="dyadic")
    assert stored.A[0, 1] == Fraction(1 / 3) and stored.rounding == "dyadic"


def test_texts_without_floats_are_read_as_typed():
    plant = from_stacked([[0, "0.30000000000000004"], [0, "1/3"]], B, C, **SIZES)
    assert plant.A[0, 1] == Fraction("0.30000000000000004") and plant.rounding is None
    with pytest.raises(InputError, match=r"A\[0\]\[1\]: expected a real number, found str"):
        from_stacked([[0.5, "1/3"], [0, 0]], B, C, **SIZES)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        ({"inputs": [1, 1]}, "inputs: expected sizes that add up to the 3 columns of B, found 2"),
        (
            {"inputs": [3]},
            "outputs: expected a number of outputs for each of the 1 channels, found",
        ),
        ({"outputs": [3]}, "outputs: expected sizes that add up to the 2 rows of C, found 3"),
        ({"outputs": [1, -1, 2]}, r"outputs\[1\]: expected an integer >= 0, found -1"),
        ({"outputs": [1, 1.0]}, r"outputs\[1\]: expected an integer >= 0, found 1.0"),
        ({"inputs": [True, 2]}, r"inputs\[0\]: expected an integer >= 0, found True"),
    ],
)
def test_sizes_that_do_not_fit_are_refused(changed, message):
    with pytest.raises(InputError, match=message):
        from_stacked(A, B, C, **{**SIZES, **changed})


@pytest.mark.parametrize("wrong", [(A, [[1, 0, 0]], C), (A, B, [[1], [0]])])
def test_shapes_that_do_not_fit_are_refused(wrong):
    with pytest.raises(InputError, match=r"[BC]: expected 2 (rows|columns), found 1"):
        from_stacked(*wrong, **SIZES)


LENGTHS = [np.float16, np.float32, np.float64, np.longdouble]


@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("form", ["scalar", "list", "array", "sparse"])
def test_a_float_of_every_length_is_read_in_its_own_precision(length, form):
    """A float of single precision is the decimal that it prints, and not that of its widening."""
    if form == "sparse" and length not in (np.float32, np.float64):
        pytest.skip("scipy has no sparse arrays of these")
    made = {
        "scalar": lambda x: x,
        "list": lambda x: [[x]],
        "array": lambda x: np.array([[x]]),
        "sparse": lambda x: scipy.sparse.csr_array(np.array([[x]])),
    }[form]

    def read(text, rounding):
        value = made(length(text))
        if form == "scalar":
            return from_float(value, rounding)
        return matrix_from_float(value, rounding)[0, 0]

    for text in ("0.1", "-0.3", "1e-4", "2.5"):
        assert read(text, "decimal") == Fraction(text)
        dyadic = read(text, "dyadic")
        assert dyadic == Fraction(*length(text).as_integer_ratio())
    assert read("0.5", "dyadic") == Fraction(1, 2)
    assert read("0.1", "dyadic") != Fraction(1, 10)


@pytest.mark.parametrize("value", [np.float32("inf"), np.float16("nan"), np.longdouble("-inf")])
def test_no_float_of_another_length_hides_an_infinity(value):
    with pytest.raises(InputError, match="expected a finite number"):
        matrix_from_float(np.array([[value]]), "decimal")
