"""Figures agree with what they mean, and the central optimum is one."""

import math
import re
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import expm, solve_continuous_lyapunov, solve_discrete_lyapunov

from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.diagnosis import diagnosed, slow_modes
from mcexact.synthesis.optimum.figures import central_optimum, figures_of, quadratic_costs, shift_of
from mcexact.synthesis.optimum.problem import FeedbackProblem, Weights
from mcexact.synthesis.optimum.starts import Model, gaussian_controller
from tests.synthesis.optimum.plants import coupled


def one_channel(time: str) -> MultiChannelSystem:
    plant = coupled(time)
    return MultiChannelSystem(plant.A, [plant.input_matrix()], [plant.output_matrix()], time=time)


def central(time: str, shift: float):
    """The problem of all agents together, and the optimal gain matrix."""
    plant = one_channel(time)
    weights = Weights.unit(plant)
    of = FeedbackProblem.of(decentralized_network(plant), (plant.n,), weights)
    n, B, C = of.n, of.B[: of.n, :3], of.C[:4, : of.n]
    rest = weights.Q, weights.R, weights.W, weights.V, of.discrete
    found = gaussian_controller(Model(of.A[:n, :n], B, C, *rest), shift)
    assert found is not None
    A_k, B_k, C_k, D_k = found
    return of, np.block([[D_k, C_k], [B_k, A_k]])


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_no_controller_near_the_central_optimum_costs_less(time):
    shift = 1.0 if time == "discrete" else 0.0
    of, K = central(time, shift)
    [(cost, G)] = quadratic_costs(replace(of.bare, bandwidth=None), K, (shift,))
    if not of.discrete:
        # Gains that pass on the noise at once are not part of the problem in continuous time.
        G[:3, :4] = 0.0
    assert np.max(np.abs(G)) < 1e-6 * cost


@pytest.mark.parametrize(("time", "shift"), [("continuous", 2.0), ("discrete", 0.5)])
def test_the_central_optimum_of_a_shifted_plant_meets_the_rate(time, shift):
    of, K = central(time, shift)
    modes = np.linalg.eigvals(of.A + of.B @ K @ of.C)
    height = np.abs(modes) if of.discrete else modes.real
    assert np.max(height) < (shift if of.discrete else -shift)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_peak_and_margin_are_what_they_mean(time):
    of, K = central(time, 1.0 if time == "discrete" else 0.0)
    M, found = of.A + of.B @ K @ of.C, figures_of(of, K)
    if of.discrete:
        powers = [np.linalg.matrix_power(M, k)[:4, :4] for k in range(60)]
    else:
        powers = [expm(M * t)[:4, :4] for t in np.linspace(0, 20, 4000)]
    peak = max(np.linalg.norm(each, 2) for each in powers)
    assert found.peak == pytest.approx(peak, rel=0.01)
    # Relative errors of all inputs, below the margin in norm, keep the loop stable; the worst do
    # not, if they are a little larger.
    rng = np.random.default_rng(0)
    for _ in range(50):
        error = rng.standard_normal((3, 3))
        error *= 0.99 * found.margin / np.linalg.norm(error, 2)
        wrong = K.copy()
        wrong[:3] += error @ K[:3]
        assert figures_of(of, wrong, peak=False).margin > 0


def test_the_peak_of_a_slow_loop_in_discrete_time_comes_late():
    """x_1(t) = t a^(t−1) x_2(0) has its peak at t = 10,000."""
    plant = MultiChannelSystem(
        [["0.9999", 1], [0, "0.9999"]], [[[0], [1]]], [[[1, 0]]], time="discrete"
    )
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    found = figures_of(of, np.zeros(of.mask.shape))
    assert found.peak == pytest.approx(10_000 / math.e, rel=0.01)


def test_an_unstable_loop_has_no_margin():
    plant = coupled()
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0, 0), Weights.unit(plant))
    found = figures_of(of, np.zeros(of.mask.shape))
    assert (found.margin, found.cost, found.peak) == (0.0, np.inf, np.inf)


def test_the_shift_of_a_region():
    rate, radius = (
        StabilityRegion("continuous", Fraction(3)),
        StabilityRegion("discrete", Fraction(1, 4)),
    )
    assert shift_of(rate) == 3 and shift_of(rate, 2.0) == 6
    assert shift_of(radius) == 0.25 and shift_of(radius, 2.0) == 0.0625
    assert shift_of(StabilityRegion("discrete")) == 1


def test_a_plant_that_nobody_controls_has_no_central_optimum():
    plant = MultiChannelSystem([[1]], [[[0]]], [[[1]]])
    assert (
        central_optimum(plant, Weights.unit(plant), StabilityRegion("continuous", Fraction(1)))
        is None
    )


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_sizes_of_signals_are_standard_deviations(time):
    bound = 1.0 if time == "discrete" else 0.0
    of, K = central(time, bound)
    M, noise = of.A + of.B @ K @ of.C, of.B @ K
    W = of.bare.W + noise @ of.V @ noise.T
    S = solve_discrete_lyapunov(M, W) if of.discrete else solve_continuous_lyapunov(M, -W)
    plant = coupled(time)
    found = central_optimum(plant, Weights.unit(plant), StabilityRegion(time))
    assert found is not None
    seen, driven = of.C[:4], (K @ of.C)[:3]
    assert np.allclose(found.sizes.outputs**2, np.diag(seen @ S @ seen.T))
    assert np.allclose(found.sizes.inputs**2, np.diag(driven @ S @ driven.T))


def nearly_fixed(epsilon: str) -> MultiChannelSystem:
    """The mode −1 is nearly out of reach of both agents; the mode 1 is not."""
    return MultiChannelSystem(
        [[1, 0], [0, -1]], [[[1], [epsilon]], [[1], [0]]], [[[1, epsilon]], [[1, 0]]]
    )


def test_the_diagnosis_names_the_mode_and_the_sensible_rate():
    region = StabilityRegion("continuous", Fraction(3))
    found = diagnosed(nearly_fixed("1e-5"), region)
    assert not found.is_sensible
    assert found.modes[0].mode == -1 and found.modes[0].change < 2e-5
    assert found.sensible is not None and 0.9 < found.sensible.edge < 1.1
    said = r"mode -1: a relative change of \de-0[56] fixes it; sensible rate (0\.9\d*|1|1\.0\d*)"
    assert re.fullmatch(rf"{said} \(computed\)", str(found))


def test_a_sensible_request_is_called_so():
    found = diagnosed(coupled("discrete"), StabilityRegion("discrete", Fraction(9, 10)))
    assert found.is_sensible
    assert found.sensible is not None and found.sensible.edge < Fraction(9, 10)


def test_without_any_sensible_rate_none_is_named():
    # Both of them are unstable and hardly apart.
    plant = MultiChannelSystem([[1, 0], [0, "1.0001"]], [[[1], [1]]], [[[1, 1]]])
    found = diagnosed(plant, StabilityRegion("continuous", Fraction(1)))
    assert not found.is_sensible and found.sensible is None
    assert str(found).endswith("sensible rate none (computed)")


def test_modes_inside_the_region_and_conjugates_are_not_listed():
    A = [[0, 1, 0], [-1, 0, 0], [0, 0, -5]]
    plant = MultiChannelSystem(A, [[[1], [0], [1]]], [[[1, 0, 1]]])
    found = slow_modes(plant, StabilityRegion("continuous", Fraction(1)))
    assert [each.mode.imag > 0 for each in found] == [True]
    assert Matrix.from_rows(A).nrows == 3
