"""The perturbation that is handed out does make the obstruction exact, up to rounding."""

from typing import Any

import numpy as np
import pytest

from mcexact.floating.anderson_clements import pencil
from mcexact.floating.fixed_mode_distance import fixed_mode_distance


@pytest.mark.parametrize("seed", range(8))
def test_the_perturbed_system_has_the_fixed_mode(seed):
    rng = np.random.default_rng(seed)
    n, m = 5, 3
    A: Any = rng.standard_normal((n, n))
    B = [rng.standard_normal((n, 1)) for _ in range(m)]
    C = [rng.standard_normal((1, n)) for _ in range(m)]
    found = fixed_mode_distance(A, B, C)
    moved: Any = [each + d for each, d in zip(B, found.dB, strict=True)]
    seen: Any = [each + d for each, d in zip(C, found.dC, strict=True)]
    outside = frozenset(range(m)) - frozenset(found.channels)
    P = pencil(A + found.dA, moved, seen, outside, found.mode)
    assert np.linalg.svd(P, compute_uv=False)[n - 1] < 1e-10
    stacked = (
        np.vstack([found.dA, *found.dC])
        if found.changed == "outputs"
        else np.hstack([found.dA, *found.dB])
    )
    assert np.linalg.norm(stacked, 2) == pytest.approx(found.distance, rel=1e-8)


def test_it_is_not_above_the_distance_to_uncontrollability():
    B, C = [np.array([[1.0], [1e-5]])], [np.eye(2)]
    found = fixed_mode_distance(np.diag([1.0, 2.0]), B, C)
    assert 0 < found.distance <= 1e-5


def test_no_states_have_no_mode_to_fix():
    assert fixed_mode_distance(np.zeros((0, 0)), [np.zeros((0, 1))], [np.zeros((1, 0))]) is None
