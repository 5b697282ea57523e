"""The change that makes a number a fixed mode is not above what is known."""

from __future__ import annotations

import numpy as np
import pytest

from mcexact.floating.verdicts import distance_at


def test_it_is_not_above_the_distance_to_uncontrollability() -> None:
    B, C = [np.array([[1.0], [1e-5]])], [np.eye(2)]
    distance, channels = distance_at(np.diag([1.0, 2.0]), B, C, 2.0)
    assert 0 < distance <= 1e-5 and channels == (0,)


def test_what_is_fixed_is_at_distance_zero() -> None:
    A = np.array([[1.0, 0.0], [0.0, 2.0]])
    B, C = [np.array([[1.0], [0.0]])] * 2, [np.eye(2)[:1], np.eye(2)[1:]]
    assert distance_at(A, B, C, 2.0)[0] == pytest.approx(0, abs=1e-12)
    assert distance_at(A, B, C, 1.0)[0] > 0.1
