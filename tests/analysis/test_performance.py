"""Default weights and Riccati solutions of plants with any number of outputs."""

import numpy as np
import pytest
from scipy.linalg import solve_continuous_are

from mcexact.analysis.performance import default_weights
from mcexact.exact.matrix import matrix_to_float, to_float
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
