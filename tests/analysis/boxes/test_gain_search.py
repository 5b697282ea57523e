"""Gains that keep a pencil regular far from the nominal values, and their rounding."""

from __future__ import annotations

import numpy as np
import pytest

from mcexact import Box, MultiChannelSystem
from mcexact.analysis.boxes.float_pencils import FloatBox, gain_pencil
from mcexact.analysis.boxes.gain_search import best_gains, exact_gains

PLANT = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])


def test_gains_are_found_for_each_mode_that_is_not_fixed() -> None:
    box = Box.relative(PLANT, "1/100")
    floats = FloatBox.of(box.system, box.radii)
    for mode in (1.0, 2.0):
        found = best_gains(floats, mode, np.random.default_rng(0))
        assert found is not None and found[0] > 4
        X, W = exact_gains(found[1])
        exact = gain_pencil(box.system, box.radii, floats.scale, X, W)
        assert exact.margin(mode) == pytest.approx(found[0], rel=1e-3)


def test_without_inputs_there_are_no_gains() -> None:
    plant = MultiChannelSystem([[1]], [[[]]], [[[1]]])
    floats = FloatBox.of(plant, Box(plant).radii)
    assert best_gains(floats, 1.0, np.random.default_rng(0)) is None


def test_rounding_keeps_the_digits_of_small_entries_beside_large_ones() -> None:
    [X], [W] = exact_gains(((np.array([[1e9]]),), (np.array([[3e-9]]),)))
    assert float(W[0, 0] / X[0, 0]) == pytest.approx(3e-18, rel=1e-5)
    [X], [W] = exact_gains(((np.zeros((1, 1)),), (np.zeros((1, 1)),)))
    assert X.is_zero() and W.is_zero()
