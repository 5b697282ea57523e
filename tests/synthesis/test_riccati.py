"""Shifted Riccati equations: what they promise about the spectrum, in both time domains."""

from fractions import Fraction

import numpy as np
import pytest

from mcexact.exact.roots import StabilityRegion
from mcexact.floating.margins import is_within
from mcexact.synthesis.channel_controller import riccati_feedback

SLOW = StabilityRegion("continuous", Fraction(1))


@pytest.mark.parametrize("effort", [1e-2, 1.0, 1e2])
@pytest.mark.parametrize(("time", "bound"), [("continuous", 3), ("discrete", Fraction(1, 2))])
def test_the_spectrum_meets_the_bound(time, bound, effort):
    rng = np.random.default_rng(7)
    A, B = rng.standard_normal((8, 8)), rng.standard_normal((8, 2))
    F = riccati_feedback(A, B, StabilityRegion(time, bound), effort=effort)
    assert is_within(A + B @ F, StabilityRegion(time, bound))


@pytest.mark.parametrize(("time", "bound"), [("continuous", 1), ("discrete", Fraction(1, 2))])
def test_a_mode_outside_that_no_input_reaches_leaves_no_solution(time, bound):
    A, B = np.diag([2.0, 3.0]), np.array([[1.0], [0.0]])
    assert riccati_feedback(A, B, StabilityRegion(time, bound)) is None


def test_a_mode_inside_may_be_unreachable():
    A, B = np.diag([2.0, -5.0]), np.array([[1.0], [0.0]])
    F = riccati_feedback(A, B, SLOW)
    assert is_within(A + B @ F, SLOW)


def test_no_states_and_no_inputs_have_gains_without_entries():
    assert riccati_feedback(np.zeros((0, 0)), np.zeros((0, 2)), SLOW).shape == (2, 0)
    assert riccati_feedback(-np.eye(2), np.zeros((2, 0)), SLOW).shape == (0, 2)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_bound_beyond_floats_has_no_gain(time):
    bound = Fraction(10**400) if time == "continuous" else Fraction(1, 10**400)
    assert riccati_feedback(np.eye(2), np.eye(2), StabilityRegion(time, bound)) is None
