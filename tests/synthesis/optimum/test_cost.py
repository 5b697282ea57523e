"""The objective and its gradient, against finite differences and slow independent formulas."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import block_diag, solve_continuous_lyapunov, solve_discrete_lyapunov

from mcexact import design_decentralized
from mcexact.analysis.performance import (
    bound_of,
    computed_bound,
    computed_margins,
    cost_of,
    default_weights,
    response_of,
)
from mcexact.designs import Aims
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float
from mcexact.exact.roots import is_discrete
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.networks import decentralized_network
from mcexact.synthesis.optimum.descent import Objective
from mcexact.synthesis.optimum.diagnosis import least_disk_margin, margin_of
from mcexact.synthesis.optimum.figures import (
    Limits,
    Margins,
    Sensitivity,
    Shape,
    frequencies,
    least_cost,
    quadratic_costs,
)
from mcexact.synthesis.optimum.problem import (
    FeedbackProblem,
    SchurForm,
    Sizes,
    Weights,
    controller_of,
)
from tests.synthesis.optimum.plants import coupled, networks

NETWORKS = networks()


def stable(kind: str) -> tuple[FeedbackProblem, np.ndarray]:
    """A problem with plain weights, its plant made stable, and small gains."""
    network = NETWORKS[kind]
    given, rng = network.plant, np.random.default_rng(2)

    def positive(size: int) -> np.ndarray:
        root = rng.standard_normal((size, size))
        return np.eye(size) + root @ root.T

    bandwidth = None if is_discrete(given.time) else 7.0
    weights = Weights(positive(4), positive(3), positive(4), positive(4), bandwidth)
    sizes = Sizes(np.array([1.0, 0.5, 2.0]), np.array([1.0, 3.0, 1.0, 2.0]), 1.5)
    of = FeedbackProblem.of(network, (1, 1, 0), weights, sizes)
    A = of.A / 4 if of.discrete else of.A - 3 * np.eye(len(of.A))
    assert given.n == 4
    return replace(of, A=A), 0.05 * rng.standard_normal(of.size)


def differences(function, x: np.ndarray, step: float = 1e-5) -> np.ndarray:
    moved = [step * row for row in np.eye(len(x))]
    return np.array([(function(x + h)[0] - function(x - h)[0]) / (2 * step) for h in moved])


@pytest.mark.parametrize("kind", NETWORKS)
@pytest.mark.parametrize(
    "part", ["cost", "single loops", "all inputs", "all ports", "gains", "shape", "members"]
)
def test_the_gradient_agrees_with_finite_differences(kind, part):
    of, x = stable(kind)
    shift = 0.9 if of.discrete else 0.5
    objective = Objective(of, shift, least=3.0)
    if part in ("single loops", "all inputs"):
        modes = np.linalg.eigvals(of.loop(x)).astype(complex)
        points = frequencies(modes, discrete=of.discrete, count=5)
        single, together = Margins(of, of.gain(x)).curves(points)
        half = 2 / float(np.max(single)), 2 / float(np.max(together))
        limits = Limits(half[0], 0.0) if part == "single loops" else Limits(0.0, half[1])
        objective = replace(objective, weight=10.0, limits=limits, points=points)
    elif part == "all ports":
        seen = Margins(of, of.gain(x)).peaks(Limits(0.0, 0.0, 0.5))
        limits = Limits(0.0, 0.0, 1.1 * seen.together)
        modes = np.linalg.eigvals(of.loop(x)).astype(complex)
        points = frequencies(modes, discrete=of.discrete, count=5)
        assert seen.scalings is not None
        first, second = (np.arange(1.0, len(each) + 1) for each in seen.scalings)
        objective = replace(
            objective, weight=10.0, limits=limits, points=points, scalings=(first, second)
        )
    elif part == "gains":
        objective = replace(objective, largest_gain=0.02)
    elif part == "members":
        members = replace(of, A=0.99 * of.A), replace(of, B=1.1 * of.B, C=0.9 * of.C)
        objective = replace(objective, members=members, share=0.3)
    elif part == "shape":
        sizes = np.abs(np.linalg.eigvals(of.loop(x)))
        shape = Shape(damping=0.97, largest=0.9 * float(np.max(sizes)))
        objective = replace(objective, shape=shape)
    value, gradient = objective(x)
    assert value > Objective(of, shift, least=3.0)(x)[0] or part == "cost"
    expected = differences(objective, x)
    assert np.allclose(gradient, expected, rtol=1e-5, atol=1e-6 * np.max(np.abs(expected)))


def test_an_unstable_plant_nearby_makes_the_objective_infinite():
    of, x = stable("decentralized")
    objective = Objective(of, 0.9 if of.discrete else 0.5)
    assert np.isfinite(objective(x)[0])
    far = replace(of, A=of.A + 100 * np.eye(len(of.A)))
    assert not np.isfinite(replace(objective, members=(of, far), share=1e-9)(x)[0])


def with_filters(of: FeedbackProblem) -> FeedbackProblem:
    """The same problem with the filters of the noise as states, for which all noise is white."""
    if of.bandwidth is None:
        return of
    q, omega = len(of.V), of.bandwidth
    return replace(
        of,
        A=block_diag(of.A, -omega * np.eye(q)),
        B=np.vstack([of.B, np.zeros((q, of.B.shape[1]))]),
        C=np.hstack([of.C, np.eye(q)]),
        Q=block_diag(of.Q, np.zeros((q, q))),
        W=block_diag(of.W, omega**2 * of.V),
        V=0 * of.V,
        bandwidth=None,
    )


@pytest.mark.parametrize("kind", NETWORKS)
def test_the_cost_is_that_of_the_lyapunov_equation_with_the_filters_of_the_noise(kind):
    known, x = stable(kind)
    of, K = with_filters(known), known.gain(x)
    M, noise = of.closed(K), of.B @ K @ of.V @ K.T @ of.B.T + of.W
    weight = of.Q + of.C.T @ K.T @ of.R @ K @ of.C
    for shift in (1.0, 0.9) if of.discrete else (0.0, 0.7):
        if of.discrete:
            S = solve_discrete_lyapunov(M / shift, noise)
        else:
            S = solve_continuous_lyapunov(M + shift * np.eye(len(M)), -noise)
        expected = np.trace(S @ weight) + np.trace(of.R @ K @ of.V @ K.T)
        [(cost, _)] = quadratic_costs(known, K, (shift,))
        assert cost == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("kind", ["decentralized", "decentralized, discrete", "extended"])
def test_the_cost_is_the_one_that_certificates_bound(kind):
    network = NETWORKS[kind]
    plant, weights = network.plant, default_weights(network.plant)
    of = FeedbackProblem.of(network, (1, 0, 1), Weights.unit(plant))
    x = np.random.default_rng(3).standard_normal(of.size) * 0.01
    slow = "1/8" if of.discrete else -1
    A = plant.A * Fraction(slow) if of.discrete else plant.A - 1 * Matrix.identity(4)
    calm = MultiChannelSystem(
        A, [plant.B(i) for i in range(3)], [plant.C(i) for i in range(3)],
        time=plant.time, neighbors=plant.neighbors,
    )  # fmt: skip
    K = of.gain(x)
    for row, columns in enumerate(of.columns_of_states, start=of.p):
        K[row, columns] = 0.5 if of.discrete else -1.0
    loop = closed_loop(calm, controller_of(of, K), network.graph)
    stay = replace(
        of.bare,
        A=of.A
        + block_diag(
            matrix_to_float(calm.A) - matrix_to_float(plant.A), np.zeros((len(of.A) - 4,) * 2)
        ),
    )
    [(cost, _)] = quadratic_costs(stay, K, (float(of.discrete),))
    proved = cost_of(loop, weights)
    assert proved is not None
    assert cost <= to_float(proved.cost) <= 1.01 * cost


@pytest.mark.parametrize("kind", NETWORKS)
def test_curves_of_single_loops_open_one_loop_and_close_the_others(kind):
    of, x = stable(kind)
    K, p = of.gain(x), of.p
    outputs = [int(c) for agent in of.agents for c in agent.own]
    for z in [np.exp(0.3j), np.exp(2j)] if of.discrete else [0.2j, 3j]:
        X = np.linalg.inv(z * np.eye(len(of.A)) - of.A)
        P, expected = of.C @ X @ of.B, []
        for i in range(p):
            # The loop with all signals but the i-th input of the plant.
            others = np.delete(np.arange(len(K)), i)
            closed = P + P[:, others] @ np.linalg.solve(
                np.eye(len(others)) - K[others] @ P[:, others], K[others] @ P
            )
            L = (K @ closed)[i, i]
            expected.append(abs(L / (1 - L) + 0.5))
        for j in outputs:
            others = np.delete(np.arange(len(P)), j)
            u = np.linalg.solve(np.eye(len(K)) - K[:, others] @ P[others], K[:, [j]])
            L = (P @ u)[j, 0]
            expected.append(abs(L / (1 - L) + 0.5))
        single, together = Margins(of, K).curves(np.array([z]))
        assert single[0] == pytest.approx(expected, rel=1e-8)
        inner = np.linalg.solve(z * np.eye(len(of.A)) - of.closed(K), of.B[:, :p])
        assert together[0] == pytest.approx(np.linalg.norm((K @ of.C)[:p] @ inner, 2), rel=1e-9)


def test_loops_whose_eigenvectors_coincide_have_accurate_curves():
    plant = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
    of = FeedbackProblem.of(decentralized_network(plant), (0,), Weights.unit(plant))
    K = np.array([[-1.0, -2.0]])
    single, together = Margins(of, K).curves(np.array([1j]))
    T = -(1 + 2j) / (1j + 1) ** 2
    assert together[0] == pytest.approx(abs(T), rel=1e-9)
    assert single[0, 0] == pytest.approx(abs(T + 0.5), rel=1e-9)


def test_peaks_are_those_of_a_fine_grid():
    of, x = stable("decentralized")
    K = 40 * of.gain(x)
    seen = Margins(of, K)
    assert np.max(seen.eigenvalues.real) < 0
    peaks = seen.peaks(Limits(0.4, 0.3))
    single, together = seen.curves(1j * np.concatenate([[0.0], np.geomspace(1e-4, 1e4, 20_000)]))
    assert peaks.disk == pytest.approx(1 / np.max(single), rel=1e-3)
    assert peaks.margin == pytest.approx(1 / np.max(together), rel=1e-3)


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
    margins = Margins(none, np.zeros(of.mask.shape))
    assert margins.excess(np.array([1j]), Limits(0.4, 0.3))[0] == 0


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_search_has_the_bound_the_cost_and_the_margins_of_certificates(time: str) -> None:
    plant = coupled(time)
    exact = default_weights(plant)
    least = least_cost(plant, Weights.unit(plant))
    assert least == pytest.approx(computed_bound(plant, exact), rel=1e-9)
    proved = bound_of(plant, exact)
    assert proved is not None and least is not None
    assert 0.97 * least <= to_float(proved.cost) <= least * (1 + 1e-9)
    design = design_decentralized(plant, aims=Aims(effort=1))
    optimum, loop = design.parts["optimum"], design.loop.closed
    cost = cost_of(loop, exact)
    assert cost is not None
    assert optimum.figures.cost == pytest.approx(to_float(cost.cost), rel=1e-2)
    sides = [min(computed_margins(response_of(loop, side))[0]) for side in ("inputs", "outputs")]
    assert optimum.peaks.disk == pytest.approx(min(sides), rel=1e-2)
    assert optimum.peaks.disk == pytest.approx(least_disk_margin(loop), rel=1e-2)
    assert optimum.peaks.margin == pytest.approx(margin_of(loop), rel=1e-2)
    assert optimum.peaks.disk >= 0.4 and optimum.peaks.margin >= 0.3
    together = [computed_margins(response_of(loop, side))[1] for side in ("inputs", "outputs")]
    assert optimum.peaks.together == pytest.approx(min(together), rel=2e-2)
