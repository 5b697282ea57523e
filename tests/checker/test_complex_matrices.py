"""Absolute values of complex numbers, rounded up to integers."""

from __future__ import annotations

import itertools

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.discs import ComplexMatrix, magnitude


def test_a_magnitude_is_the_least_integer_that_is_not_below() -> None:
    for re, im in itertools.product(range(-6, 7), repeat=2):
        found = magnitude(re, im)
        assert re**2 + im**2 <= found**2
        assert found == 0 or re**2 + im**2 > (found - 1) ** 2


def test_the_magnitudes_of_a_matrix_have_its_shape_and_its_denominator() -> None:
    found = ComplexMatrix(Matrix([[3, -1], [0, 2]], 2, 7), Matrix([[-4, 1], [0, 0]], 2, 7))
    sizes = found.magnitudes()
    assert (sizes.rows, sizes.ncols, sizes.denominator) == ([[5, 2], [0, 2]], 2, 7)
