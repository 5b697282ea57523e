"""The objective and its gradient, against finite differences and slow independent formulas."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_continuous_lyapunov, solve_discrete_lyapunov

from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.descent import Objective
from mcexact.synthesis.optimum.figures import Sensitivity, Shape, frequencies, quadratic_costs
from mcexact.synthesis.optimum.problem import FeedbackProblem, SchurForm, Sizes, Weights
from tests.synthesis.optimum.plants import coupled, networks

NETWORKS = networks()


def stable(kind: str) -> tuple[FeedbackProblem, np.ndarray]:
    """A problem with plain weights, its plant made stable, and small gains."""
    network = NETWORKS[kind]
    given, rng = network.plant, np.random.default_rng(2)

    def positive(size: int) -> np.ndarray:
        root = rng.standard_normal((size, size))
        return np.eye(size) + root @ root.T

    weights = Weights(positive(4), positive(3), positive(4), positive(4))
    sizes = Sizes(np.array([1.0, 0.5, 2.0]), np.array([1.0, 3.0, 1.0, 2.0]), 1.5)
    of = FeedbackProblem.of(network, (1, 1, 0), weights, sizes)
    A = of.A / 4 if of.discrete else of.A - 3 * np.eye(len(of.A))
    assert given.n == 4
    return replace(of, A=A), 0.05 * rng.standard_normal(of.size)


def differences(function, x: np.ndarray, step: float = 1e-5) -> np.ndarray:
    moved = [step * row for row in np.eye(len(x))]
    return np.array([(function(x + h)[0] - function(x - h)[0]) / (2 * step) for h in moved])


@pytest.mark.parametrize("kind", NETWORKS)
@pytest.mark.parametrize("part", ["cost", "margin", "gains", "shape"])
def test_the_gradient_agrees_with_finite_differences(kind, part):
    of, x = stable(kind)
    shift = 0.9 if of.discrete else 0.5
    objective = Objective(of, shift)
    if part == "margin":
        modes = np.linalg.eigvals(of.loop(x)).astype(complex)
        points = frequencies(modes, discrete=of.discrete, count=5)
        limit = Sensitivity(of, of.gain(x)).peak(points) / 2
        objective = replace(objective, weight=10.0, limit=limit, points=points)
    elif part == "gains":
        objective = replace(objective, largest_gain=0.02)
    elif part == "shape":
        sizes = np.abs(np.linalg.eigvals(of.loop(x)))
        limits = Shape(damping=0.97, largest=0.9 * float(np.max(sizes)))
        objective = replace(objective, shape=limits)
    value, gradient = objective(x)
    assert value > Objective(of, shift)(x)[0] or part == "cost"
    expected = differences(objective, x)
    assert np.allclose(gradient, expected, rtol=1e-5, atol=1e-6 * np.max(np.abs(expected)))


@pytest.mark.parametrize("kind", NETWORKS)
def test_the_cost_is_that_of_the_lyapunov_equation(kind):
    of, x = stable(kind)
    K = of.gain(x)
    M, noise = of.loop(x), of.B @ K @ of.V @ K.T @ of.B.T + of.W
    weight = of.Q + of.C.T @ K.T @ of.R @ K @ of.C
    for shift in (1.0, 0.9) if of.discrete else (0.0, 0.7):
        if of.discrete:
            S = solve_discrete_lyapunov(M / shift, noise)
        else:
            S = solve_continuous_lyapunov(M + shift * np.eye(len(M)), -noise)
        expected = np.trace(S @ weight) + np.trace(of.R @ K @ of.V @ K.T)
        [(cost, _)] = quadratic_costs(of, K, (shift,))
        assert cost == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_cost_is_infinite_exactly_outside_the_region(time):
    plant = coupled(time)
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0, 0), Weights.unit(plant))
    K = np.zeros(of.mask.shape)
    bound = SchurForm.of(of.A, discrete=of.discrete).bound
    inside, outside = (1.01, 0.99) if of.discrete else (-1.01, -0.99)
    (held, _), (beyond, _) = quadratic_costs(of, K, (inside * bound, outside * bound))
    assert np.isfinite(held) and beyond == np.inf


@pytest.mark.parametrize("discrete", [False, True])
def test_equations_that_an_unstable_loop_solves_by_chance_are_not_its_cost(discrete):
    time = "discrete" if discrete else "continuous"
    plant, rng = coupled(time), np.random.default_rng(4)
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0, 0), Weights.unit(plant))
    solved = 0
    for _ in range(200):
        A = rng.standard_normal((4, 4))
        form = SchurForm.of(A, discrete=discrete)
        if form.bound < float(discrete):
            continue
        solved += form.gramians(of.W, of.Q, float(discrete)) is not None
        [(cost, _)] = quadratic_costs(replace(of, A=A), np.zeros(of.mask.shape), (float(discrete),))
        assert cost == np.inf
    assert solved > 0


def test_a_matrix_that_is_not_finite_has_an_infinite_cost():
    plant = coupled()
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0, 0), Weights.unit(plant))
    K = np.where(of.mask, 1e308, 0.0)
    with np.errstate(over="ignore", invalid="ignore"):
        assert quadratic_costs(of, K, (0.0,))[0][0] == np.inf


@pytest.mark.parametrize("kind", NETWORKS)
def test_the_sensitivity_is_the_response_at_the_inputs_of_the_plant(kind):
    of, x = stable(kind)
    K, M = of.gain(x), of.loop(x)
    points = frequencies(np.linalg.eigvals(M).astype(complex), discrete=of.discrete, count=9)
    expected = 0.0
    for z in points:
        inner = np.linalg.solve(z * np.eye(len(M)) - M, of.B[:, :3])
        expected = max(expected, float(np.linalg.norm((K @ of.C)[:3] @ inner, 2)))
    assert Sensitivity(of, K).peak(points) == pytest.approx(expected, rel=1e-9)


def test_a_plant_without_inputs_is_not_sensitive():
    plant = coupled()
    of = FeedbackProblem.of(decentralized_network(plant), (0, 0, 0), Weights.unit(plant))
    none = replace(of, p=0)
    seen = Sensitivity(none, np.zeros(of.mask.shape))
    assert seen.peak(np.array([1j])) == 0
    assert seen.excess(np.array([1j]), 1.0)[0] == 0
