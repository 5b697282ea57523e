"""The programs behind plants that fail, against a slow independent method."""

import numpy as np
import pytest

from mcexact.analysis.boxes.failure import _least_part, _optimum


@pytest.mark.parametrize("steps", [0, 1, 2])
def test_where_steps_leave_one_equation_its_optimum_is_that_of_the_linear_program(steps) -> None:
    rng = np.random.default_rng(5)
    for _ in range(20):
        equations = rng.standard_normal((steps + 1, 7 + steps))
        right = rng.standard_normal(steps + 1)
        quick, slow = _least_part(equations, right, 7), _optimum(equations, right, 7)
        assert quick is not None and slow is not None
        for part, moved in (quick, slow):
            assert np.allclose(equations @ np.concatenate([part, moved]), right, atol=1e-7)
        assert np.max(np.abs(quick[0])) == pytest.approx(np.max(np.abs(slow[0])), rel=1e-6)


def test_what_moves_nothing_is_left_to_the_linear_program() -> None:
    parallel = np.array([[1.0, 2.0, 0.0], [3.0, 4.0, 0.0]])
    assert _least_part(parallel, np.ones(2), 2) is None
    assert _least_part(np.zeros((1, 3)), np.ones(1), 3) is None
