"""Every controller of a structure is a gain matrix, and every gain matrix a controller."""

import numpy as np
import pytest

from mcexact.exact.matrix import matrix_to_float
from mcexact.model.loop import closed_loop
from mcexact.synthesis.optimum.problem import (
    FeedbackProblem,
    Sizes,
    Weights,
    balanced,
    controller_of,
    problem_of,
    rounded,
)
from tests.synthesis.optimum.plants import networks

NETWORKS = networks()


def problem(kind: str, sizes: Sizes | None = None) -> FeedbackProblem:
    network = NETWORKS[kind]
    return FeedbackProblem.of(network, (1, 2, 0), Weights.unit(network.plant), sizes)


def drawn(of: FeedbackProblem, seed: int = 1) -> np.ndarray:
    return rounded(np.random.default_rng(seed).standard_normal(of.mask.shape) * of.mask, 4)


def polynomial(M: np.ndarray) -> np.ndarray:
    return np.poly(np.linalg.eigvals(M)).real


@pytest.mark.parametrize("kind", NETWORKS)
def test_the_loop_is_that_of_the_programs(kind):
    of = problem(kind)
    K, given = drawn(of), of.network.plant
    loop = closed_loop(given, controller_of(of, K), of.network.graph)
    exact, found = matrix_to_float(loop.matrix), of.loop(of.entries(K))
    # The derived system may have states that no program uses, with the mode 0.
    unused = len(found) - len(exact)
    assert unused >= 0
    expected = np.concatenate([polynomial(exact), np.zeros(unused)])
    assert np.allclose(polynomial(found), expected, atol=1e-8 * np.max(np.abs(expected)))


@pytest.mark.parametrize("kind", NETWORKS)
def test_a_controller_is_read_back_as_the_gain_matrix_that_it_was(kind):
    of = problem(kind)
    K = drawn(of)
    again, found = problem_of(of.network, controller_of(of, K), Weights.unit(of.network.plant))
    assert again.orders == of.orders
    assert np.array_equal(found, K)


@pytest.mark.parametrize("kind", NETWORKS)
def test_balancing_keeps_the_spectrum_and_the_structure(kind):
    of = problem(kind)
    K = drawn(of)
    for row, columns in enumerate(of.columns_of_states, start=of.p):
        K[row] *= 2.0 ** (3 * row)
        K[:, columns] /= 2.0 ** (3 * row)
    found = balanced(of, K)
    before, after = (polynomial(of.loop(of.entries(each))) for each in (K, found))
    assert np.allclose(before, after, rtol=1e-6, atol=1e-8 * np.max(np.abs(before)))
    assert not found[~of.mask].any()
    assert np.max(np.abs(found)) < np.max(np.abs(K)) / 100


def test_scaled_entries_give_the_same_gain():
    sizes = Sizes(np.array([1.0, 2.0, 4.0]), np.array([1.0, 8.0, 1.0, 2.0]), 16.0)
    plain, scaled = problem("extended"), problem("extended", sizes)
    K = drawn(plain)
    assert np.allclose(scaled.gain(scaled.entries(K)), K)
    assert scaled.scale[1, scaled.agents[1].own[0]] == 2 / 8
    assert scaled.scale[-1, -1] == 16


def test_an_output_that_two_agents_receive_has_one_noise():
    of = problem("extended")
    # Four outputs and three sub-states are sent; three private states have no noise.
    assert of.mask.shape == (3 + 3 + 3, 4 + 3 + 3)
    assert np.linalg.matrix_rank(of.V) == 4
    lifted = problem("lifted")
    # Each age of an output is another signal, with a noise of its own.
    received = {(j, tuple(c)) for a in lifted.agents for (w, j), c in a.signals.items() if w == "y"}
    assert np.linalg.matrix_rank(lifted.V) == sum(len(columns) for _, columns in received)
    assert np.array_equal(lifted.V, np.diag(np.diag(lifted.V)))
