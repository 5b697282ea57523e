"""Gains that keep a pencil regular far from the nominal values, and their rounding."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from mcexact import MultiChannelSystem
from mcexact.analysis.boxes.members import best_gains, exact_gains
from mcexact.analysis.boxes.pencils import FloatBox, Members, gain_pencil
from mcexact.boxes import Box

PLANT = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])


def test_gains_are_found_for_each_mode_that_is_not_fixed() -> None:
    box = Box.relative(PLANT, "1/100")
    floats = FloatBox.of(Members.of(box.system))
    for mode in (1.0, 2.0):
        found = best_gains(floats, mode, np.random.default_rng(0))
        assert found is not None and found[0] > 4
        X, W = exact_gains(found[1])
        exact = gain_pencil(Members.of(box.system), floats.scale, X, W)
        assert exact.margin(mode) == pytest.approx(found[0], rel=1e-3)


def test_without_inputs_there_are_no_gains() -> None:
    plant = MultiChannelSystem([[1]], [[[]]], [[[1]]])
    floats = FloatBox.of(Members.of(plant))
    assert best_gains(floats, 1.0, np.random.default_rng(0)) is None


def test_rounding_keeps_the_digits_of_small_entries_beside_large_ones() -> None:
    [X], [W] = exact_gains(((np.array([[1e9]]),), (np.array([[3e-9]]),)))
    assert float(W[0, 0] / X[0, 0]) == pytest.approx(3e-18, rel=1e-5)
    [X], [W] = exact_gains(((np.zeros((1, 1)),), (np.zeros((1, 1)),)))
    assert X.is_zero() and W.is_zero()


def test_a_wider_box_tells_how_far_radii_can_grow_on_a_whole_disc() -> None:
    box = Box.relative(PLANT, "1/100")
    floats = FloatBox.of(Members.of(box.system))
    gains = best_gains(floats.wider(0.01), 1.0, np.random.default_rng(0))
    assert gains is not None and gains[0] > 1
    pencil = gain_pencil(Members.of(box.system), floats.scale, *exact_gains(gains[1]))
    made = pencil.proposal(1.0, 0.01, Fraction(1))
    assert made is not None and made.hold((Fraction(1), Fraction(0)), Fraction(1, 100))


def test_a_search_is_at_least_as_good_as_the_gains_that_are_known() -> None:
    box = Box.relative(PLANT, "1/100")
    floats = FloatBox.of(Members.of(box.system))
    good = best_gains(floats, 1.0, np.random.default_rng(0), target=1e9)
    assert good is not None
    again = best_gains(floats, 1.0, np.random.default_rng(1), starts=1, known=[good[1]])
    assert again is not None and again[0] > 0.999 * good[0]
