"""Shifted Riccati equations: what they promise about the spectrum, in both time domains."""

import numpy as np
import pytest

from mcexact.floating.margins import spectral_bound
from mcexact.synthesis.riccati import riccati_feedback


@pytest.mark.parametrize("effort", [1e-2, 1.0, 1e2])
@pytest.mark.parametrize(("time", "bound"), [("continuous", 3.0), ("discrete", 0.5)])
def test_the_spectrum_meets_the_bound(time, bound, effort):
    rng = np.random.default_rng(7)
    A, B = rng.standard_normal((8, 8)), rng.standard_normal((8, 2))
    F = riccati_feedback(A, B, time, bound, effort=effort)
    reached = spectral_bound(A + B @ F, time)
    assert reached < (-bound if time == "continuous" else bound)


@pytest.mark.parametrize(("time", "bound"), [("continuous", 1.0), ("discrete", 0.5)])
def test_a_mode_outside_that_no_input_reaches_leaves_no_solution(time, bound):
    A, B = np.diag([2.0, 3.0]), np.array([[1.0], [0.0]])
    assert riccati_feedback(A, B, time, bound) is None


def test_a_mode_inside_may_be_unreachable():
    A, B = np.diag([2.0, -5.0]), np.array([[1.0], [0.0]])
    F = riccati_feedback(A, B, "continuous", 1.0)
    assert spectral_bound(A + B @ F, "continuous") < -1


def test_no_states_and_no_inputs_have_gains_without_entries():
    assert riccati_feedback(np.zeros((0, 0)), np.zeros((0, 2)), "continuous", 1.0).shape == (2, 0)
    assert riccati_feedback(-np.eye(2), np.zeros((2, 0)), "continuous", 0.5).shape == (0, 2)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_bound_beyond_floats_has_no_gain(time):
    bound = np.inf if time == "continuous" else 0.0
    assert riccati_feedback(np.eye(2), np.eye(2), time, bound) is None
