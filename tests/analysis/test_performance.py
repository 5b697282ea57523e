"""Default weights, frequency responses of loops, and proofs where one mode is very slow."""

from fractions import Fraction

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are

from mcexact.analysis.performance import (
    HALF,
    PortResponse,
    Side,
    _largest_gain,
    _osborne,
    computed_cost,
    computed_margins,
    cost_of,
    default_weights,
    margin_of,
    response_of,
)
from mcexact.exact.matrix import Matrix, matrix_to_float, to_float
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem

PLANT = MultiChannelSystem(
    [[0, 1, 0], [-1, 0, 2], [0, 0, -3]],
    [[[0], [1], [0]], [[0], [0], [5]]],
    [[[1, 0, 0]], [[0, 0, 1], [0, 7, 0], [1, 1, 0]]],
)


@pytest.mark.parametrize("channels", [1, 2])
def test_the_bandwidth_is_near_ten_times_the_fastest_eigenvalue_for_any_number_of_outputs(
    channels: int,
) -> None:
    plant = MultiChannelSystem(
        PLANT.A, [PLANT.B(i) for i in range(channels)], [PLANT.C(i) for i in range(channels)]
    )
    A, B, C = map(matrix_to_float, (plant.A, plant.input_matrix(), plant.output_matrix()))
    P = solve_continuous_are(A, B, np.eye(3), np.eye(B.shape[1]))
    S = solve_continuous_are(A.T, C.T, np.eye(3), np.eye(len(C)) / 100)
    loops = A - B @ B.T @ P, A - 100 * S @ C.T @ C
    fastest = max(float(np.max(np.abs(np.linalg.eigvals(M)))) for M in loops)
    bandwidth = default_weights(plant).bandwidth
    assert bandwidth is not None
    assert 10**0.5 <= to_float(bandwidth) / fastest <= 10**1.5


def _loop_with_a_slow_mode(
    fast: int, decay: Fraction, gain: int, time: str, *, mixed: bool
) -> ClosedLoop:
    """A cascade that a mode of a small decay drives, which no input moves; states may be sums."""
    n = fast + 1
    A = [[Fraction(0)] * n for _ in range(n)]
    for i in range(fast):
        A[i][i], A[i][fast] = Fraction(-1 - i, 4), Fraction(gain)
        if i + 1 < fast:
            A[i][i + 1] = Fraction(1, 2)
    A[fast][fast] = -decay
    if time == "discrete":
        A = [[Fraction(i == j) + x / 4 for j, x in enumerate(row)] for i, row in enumerate(A)]
    T = Matrix.from_rows([[int(j <= i if mixed else j == i) for j in range(n)] for i in range(n)])
    back = Matrix.from_rows(
        [[int(i == j) - int(mixed and i == j + 1) for j in range(n)] for i in range(n)]
    )
    B = Matrix.from_rows([[int(i == fast - 1)] for i in range(n)])
    C = Matrix.from_rows([[int(i == 0) for i in range(n)]])
    plant = MultiChannelSystem(T @ Matrix.from_rows(A) @ back, [T @ B], [C @ back], time=time)
    return closed_loop(plant, local_controllers(plant, [[["-1/10"]]]))


@pytest.mark.parametrize(
    ("time", "decay", "gain"),
    [("continuous", Fraction(1, 10**5), 1), ("discrete", Fraction(1, 10**4), 10)],
)
def test_a_cost_is_proved_tightly_where_one_mode_has_nearly_all_of_it(
    time: str, decay: Fraction, gain: int
) -> None:
    loop = _loop_with_a_slow_mode(4, decay, gain, time, mixed=True)
    weights = default_weights(loop.plant)
    proved = cost_of(loop, weights)
    assert proved is not None
    assert 1 <= to_float(proved.cost) / computed_cost(loop, weights) < 1.001


@pytest.mark.parametrize("at", ["inputs", "outputs"])
def test_a_margin_is_proved_tightly_beside_a_mode_far_slower_than_the_others(at: Side) -> None:
    loop = _loop_with_a_slow_mode(6, Fraction(1, 10**6), 1, "continuous", mixed=False)
    proved = margin_of(loop, at)
    assert proved is not None
    [seen], _ = computed_margins(response_of(loop, at))
    assert 0.98 * seen <= to_float(proved.margin) <= 1.001 * seen


def chain(n: int, spread: int) -> PortResponse:
    """The response through a chain of lags; without spread it has one eigenvector alone."""
    rows = [[-1 - spread * i if i == j else int(i == j + 1) for j in range(n)] for i in range(n)]
    enter = [[1, 0], [0, 1], *([0, 0] for _ in range(n - 2))]
    leave = [[0] * (n - 1) + [-1], [0, -1] + [0] * (n - 2)]
    M, E, Y = map(Matrix.from_rows, (rows, enter, leave))
    return PortResponse((M, E, Y), False, HALF)


@pytest.mark.parametrize(("length", "spread"), [(3, 1), (12, 0), (12, 1)])
def test_responses_are_those_of_linear_systems_whatever_the_eigenvectors_are(
    length: int, spread: int
) -> None:
    response = chain(length, spread)
    assert (response._modal is None) == (spread == 0)
    M, E, Y = map(matrix_to_float, response.exact)
    for z, seen in zip(response._points(), response._samples, strict=True):
        expected = Y @ np.linalg.solve(z * np.eye(length) - M, E) + np.eye(2) / 2
        assert np.allclose(seen, expected, rtol=1e-6, atol=1e-8)
    single, together = computed_margins(response)
    assert 0 < together <= min(single) <= 2


def test_the_largest_norm_is_that_of_all_samples() -> None:
    rng = np.random.default_rng(5)
    samples = rng.normal(size=(200, 4, 4)) + 1j * rng.normal(size=(200, 4, 4))
    samples *= rng.uniform(0.5, 1, size=(200, 1, 1))
    scaling = np.array([1.0, 4.0, 0.25, 16.0])
    h = np.sqrt(scaling)
    norms = [np.linalg.norm(h[:, None] * G / h, 2) for G in samples]
    value, worst = _largest_gain(samples, np.abs(samples), scaling)
    assert value == pytest.approx(max(norms))
    assert np.array_equal(worst, samples[int(np.argmax(norms))])


def test_a_matrix_is_balanced_whose_rows_and_columns_differ_by_orders_of_magnitude() -> None:
    rng = np.random.default_rng(7)
    d = 10.0 ** rng.uniform(-4, 4, size=6)
    G = (rng.normal(size=(6, 6)) * d[:, None] / d).astype(np.complex128)
    h = np.sqrt(_osborne(G))
    size = np.abs(h[:, None] * G / h) ** 2
    assert size.sum(axis=0) == pytest.approx(size.sum(axis=1), rel=1e-4)
    apart = _osborne(np.array([[1, 2], [0, 1]], dtype=np.complex128))
    assert np.array_equal(apart, np.ones(2))
    rounded = _osborne(np.array([[1, 2], [1e-17, 1]], dtype=np.complex128))
    assert np.array_equal(rounded, np.ones(2))


def test_without_ports_nothing_is_amplified() -> None:
    nothing = Matrix.from_rows([[-1]]), Matrix.zeros(1, 0), Matrix.zeros(0, 1)
    assert computed_margins(PortResponse(nothing, False, HALF)) == ([], 2.0)
    assert PortResponse(nothing, False, HALF).scaled_norm([])[0] == 0
