"""What practice finds, and what it does not."""

import numpy as np
import pytest

from mcexact.floating.verdicts import (
    controllability_matrix,
    controllability_rank,
    rounded_fixed_modes,
)


def test_the_controllability_matrix_has_the_powers_of_A() -> None:
    A = np.array([[1.0, 2.0], [3.0, 4.0]])
    B = np.array([[1.0, 0.0, 2.0], [0.0, 1.0, 1.0]])
    assert np.array_equal(controllability_matrix(A, B), np.hstack([B, A @ B]))


def test_a_well_conditioned_pair_has_its_rank() -> None:
    shift = np.diag(np.ones(5), -1)
    assert controllability_rank(shift, np.eye(6)[:, :1]) == 6
    assert controllability_rank(np.eye(6), np.eye(6)[:, :2]) == 2


@pytest.mark.parametrize("digits", [6, 8, 10])
def test_a_simple_fixed_mode_is_found_and_a_free_one_is_not(digits: int) -> None:
    A = np.diag([1.0, -3.0])
    B, C = [np.array([[1.0], [0.0]])], [np.array([[1.0, 1.0]])]
    assert rounded_fixed_modes(A, B, C, digits=digits, seed=1) == (-3 + 0j,)


def test_a_complex_pair_of_fixed_modes_is_found_whole() -> None:
    A = np.zeros((3, 3))
    A[:2, :2] = [[0.0, 2.0], [-2.0, 0.0]]
    B, C = [np.array([[0.0], [0.0], [1.0]])], [np.array([[0.0, 0.0, 1.0]])]
    assert rounded_fixed_modes(A, B, C, digits=8, seed=2) == (-2j, 2j)
