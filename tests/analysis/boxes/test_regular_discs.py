"""Moduli, weights and rounded matrices: what the exact test of a disc is made of."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.analysis.boxes.pencils import (
    Members,
    dyadic,
    gain_pencil,
    modulus_above,
    perron,
    weights,
    whole_weights,
)
from mcexact.exact.matrix import Matrix
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem


@given(st.integers(-(10**20), 10**20), st.integers(-(10**20), 10**20))
def test_a_modulus_is_rounded_up_by_less_than_one(a: int, b: int) -> None:
    m = modulus_above(a, b)
    assert (m - 1) ** 2 < a * a + b * b <= m * m or m == a == b == 0


@given(st.lists(st.floats(1e-9, 1e9), min_size=1, max_size=5))
def test_weights_are_positive_integers_in_proportion(given_weights: list[float]) -> None:
    w = np.array(given_weights)
    found = whole_weights(w)
    assert min(found) > 0
    ratios = np.array([float(x) for x in found]) / w
    assert ratios.max() <= ratios.min() * (1 + 1e-3)


@pytest.mark.parametrize("largest", [1e20, 1e300])
def test_weights_are_within_the_range_of_floats(largest: float) -> None:
    small, large = whole_weights(np.array([1e-300, largest]))
    assert 0 < small < large and np.isfinite(float(large) ** 1.1)


@given(st.lists(st.floats(-1e6, 1e6), min_size=4, max_size=4), st.floats(1e-6, 1e3))
def test_rounding_moves_entries_by_less_than_their_unit(parts: list[float], unit: float) -> None:
    V = np.array(parts).reshape(2, 2) * (1 + 2j)
    exact = dyadic(V, np.full((2, 2), unit))
    for i in range(2):
        for j in range(2):
            assert abs(float(exact.re[i, j]) - V[i, j].real) <= unit * 2.0**-26
            assert abs(float(exact.im[i, j]) - V[i, j].imag) <= unit * 2.0**-26


def test_a_positive_vector_shows_a_small_spectral_radius() -> None:
    small = np.array([[0.0, 0.9], [1.0, 0.0]])
    w = weights(small)
    assert w is not None and np.all(small @ w < w)
    assert weights(small * 1.2) is None and weights(small + np.inf) is None
    assert perron(small)[0] == pytest.approx(0.9**0.5)
    assert perron(np.zeros((2, 2)))[0] == 0
    assert 0 <= perron(np.array([[0.0, 1.0], [0.0, 0.0]]))[0] < 1e-3


@pytest.mark.parametrize("spread", [0, 3, 6])
def test_the_spectral_radius_is_that_of_badly_scaled_matrices_as_well(spread: int) -> None:
    """Row sums are then many powers of ten above the spectral radius."""
    rng = np.random.default_rng(spread)
    for size in range(2, 14):
        scale = 10.0 ** rng.uniform(-spread, spread, size)
        plain = rng.uniform(0.1, 1, (size, size))
        value, right, left = perron(scale[:, None] * plain / scale[None, :])
        assert value == pytest.approx(np.abs(np.linalg.eigvals(plain)).max(), rel=1e-4)
        assert plain @ (right / scale) == pytest.approx(value * right / scale, rel=1e-2)
        assert (left * scale) @ plain == pytest.approx(value * left * scale, rel=1e-2)


def test_a_disc_passes_where_no_member_is_singular_and_fails_elsewhere() -> None:
    """λ − a with |a − 2| ≤ 1/2 is regular on |λ − c| ≤ ρ exactly if |c − 2| > ρ + 1/2."""
    plant = MultiChannelSystem([[2]], [[[1]]], [[[1]]])
    radii = Radii([["1/2"]], [[[0]]], [[[0]]])
    pencil = gain_pencil(Members(plant, radii), np.ones(1))
    test = pencil.proposal(4.0, 1.0, Fraction(1))
    assert test is not None
    center = Fraction(4), Fraction(0)
    assert test.hold(center, Fraction(149, 100)) and test.seem(4.0, 1.49)
    assert not test.hold(center, Fraction(3, 2)) and not test.seem(4.0, 1.51)
    assert pencil.proposal(4.0, 1.6, Fraction(1)) is None
    assert pencil.proposal(2.0, 0.1, Fraction(1)) is None
    assert pencil.margin(4.0) == pytest.approx(4) and pencil.margin(2.0) == 0


def test_the_pencil_with_gains_has_the_radii_of_its_entries() -> None:
    plant = MultiChannelSystem([[2]], [[[3]], [[]]], [[[5]], [[7]]])
    radii = Radii([[1]], [[[2]], [[]]], [[[3]], [[4]]])
    one = Matrix.from_rows([[-2]])
    none = Matrix.zeros(0, 1), Matrix.zeros(0, 0)
    pencil = gain_pencil(Members(plant, radii), np.ones(1), [one, none[0]], [one, none[1]])
    assert pencil.Z0.rows() == ((2, 3), (10, 2)) and pencil.D.rows() == ((1, 2), (6, 0))
