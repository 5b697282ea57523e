"""Margins of loops against definitions."""

import numpy as np
import pytest

from mcexact.floating.margins import loop_margins, smallest_singular_value


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_distance_to_instability_is_that_of_a_fine_grid(time):
    rng = np.random.default_rng(3)
    M = rng.standard_normal((6, 6)) / 6
    M = M - np.eye(6) if time == "continuous" else M
    if time == "continuous":
        boundary = 1j * np.linspace(-10, 10, 4001)
    else:
        boundary = np.exp(1j * np.linspace(0, 2 * np.pi, 4001))
    exact = min(np.linalg.svd(z * np.eye(6) - M, compute_uv=False)[-1] for z in boundary)
    assert loop_margins(M, time).distance_to_instability == pytest.approx(exact, rel=1e-3)


def test_an_unstable_loop_has_no_margin():
    assert loop_margins(np.array([[1.0]]), "continuous").distance_to_instability == 0
    assert loop_margins(np.array([[-2.0]]), "discrete").distance_to_instability == 0


def test_a_normal_loop_has_the_numerical_bound_of_its_spectrum():
    margins = loop_margins(np.diag([-1.0, -3.0]), "continuous")
    assert margins.spectral == pytest.approx(-1) and margins.numerical == pytest.approx(-1)
    assert margins.distance_to_instability == pytest.approx(1)
    assert loop_margins(np.diag([0.5, -0.25]), "discrete").numerical == pytest.approx(0.5)


def test_a_singular_matrix_has_the_singular_value_zero():
    assert smallest_singular_value(np.array([[1.0, 0.0], [0.0, 2.0]]), 1.0) == 0


def test_no_states_are_infinitely_far():
    assert loop_margins(np.zeros((0, 0)), "continuous").distance_to_instability == np.inf
    assert loop_margins(np.zeros((0, 0)), "discrete").spectral == 0
