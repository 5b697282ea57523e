"""Corners of boxes at which loops fail first, beside all corners of small boxes."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import product

import numpy as np
import pytest

from mcexact.analysis.boxes.corners import PencilFamily, distance_of, first_to_fail
from mcexact.analysis.boxes.failure import severed_plants
from mcexact.analysis.boxes.largest import failing_loop, refuted_loop
from mcexact.analysis.boxes.loops import StabilitySearch
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem

COUPLED = closed_loop(
    plant := MultiChannelSystem(
        [[1, "1/2"], ["1/3", -1]], [[[1], [0]], [[0], [2]]], [[[1, 0]], [[0, 1]]]
    ),
    local_controllers(plant, [[[-4]], [["-1/2"]]]),
)
SAMPLED = closed_loop(
    plant := MultiChannelSystem(
        [["1.1", "0.1"], ["0.2", "0.7"]], [[[1], ["0.2"]]], [[[1, 0], ["0.1", 1]]], time="discrete"
    ),
    local_controllers(plant, [[["-0.6", "-0.1"]]]),
)
LOOPS = [COUPLED, SAMPLED]


def fails_at(loop: ClosedLoop, signs: tuple[int, ...]) -> float:
    """The size at which the loop fails if the entries of its plant move with these signs."""
    plant = loop.plant
    K = np.zeros((sum(map(plant.p, range(plant.m))), sum(map(plant.q, range(plant.m)))))
    row = column = 0
    for i, agent in enumerate(loop.controller.agents):
        gain = np.array(agent.input.outputs[i].rows(), dtype=float)
        K[row : row + len(gain), column : column + gain.shape[1]] = gain
        row, column = row + len(gain), column + gain.shape[1]

    def edge(size: float) -> float:
        moves = iter(signs)
        A, B, C = (
            np.array([[float(x) * (1 + size * next(moves)) if x else 0.0 for x in r] for r in rows])
            for rows in (plant.A.rows(), plant.input_matrix().rows(), plant.output_matrix().rows())
        )
        values = np.linalg.eigvals(A + B @ K @ C)
        return float(max(np.abs(values)) - 1 if plant.time == "discrete" else max(values.real))

    low, high = 0.0, 1.0
    if edge(high) <= 1e-9:
        return np.inf
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if edge(middle) < 0 else (low, middle)
    return high


def searched(loop: ClosedLoop) -> StabilitySearch:
    """The search around the loop, whose radii are the moduli of all entries."""
    unit = Box.relative(loop.plant, 1).system
    return StabilitySearch(replace(loop, plant=unit), StabilityRegion(loop.plant.time))


@pytest.mark.parametrize("loop", LOOPS)
def test_no_corner_fails_before_the_one_that_is_found(loop: ClosedLoop) -> None:
    matrices = loop.plant.A, loop.plant.input_matrix(), loop.plant.output_matrix()
    count = sum(1 for M in matrices for _ in M.nonzero())
    least = min(fails_at(loop, signs) for signs in product((1, -1), repeat=count))
    search = searched(loop)
    near = failing_loop(search, 0)
    assert near is not None
    assert least <= float(near.distance) < 1.0001 * least
    assert refuted_loop(search, near.plant) is not None
    assert Box.relative(loop.plant, near.distance).contains(near.plant)


def test_what_moves_with_no_radius_stays() -> None:
    box = Box.absolute(COUPLED.plant, A=[["1/10", 0], [0, 0]])
    search = StabilitySearch(replace(COUPLED, plant=box.system), StabilityRegion("continuous"))
    assert failing_loop(search, 0) is None
    wide = Box.absolute(COUPLED.plant, A=[[8, 0], [0, 0]])
    search = StabilitySearch(replace(COUPLED, plant=wide.system), StabilityRegion("continuous"))
    near = failing_loop(search, 0)
    assert near is not None
    moved = near.plant.A - COUPLED.plant.A
    assert [(i, j) for i, j, _ in moved.nonzero()] == [(0, 0)]
    # the loop is [x − 4, 1/2; 1/3, −2] with x = 1 + 8s, which is singular at x = 4 − 1/12
    assert near.distance == pytest.approx(Fraction(35, 12) / 8, rel=2e-5)


def test_failures_are_found_that_are_nearer_than_plants_without_a_channel() -> None:
    search = searched(COUPLED)
    near = failing_loop(search, 2)
    [severed, *_] = severed_plants(COUPLED.plant, Box(search.loop.plant).radii)
    assert near is not None
    assert near.distance < Fraction(1, 2) < severed.distance


@pytest.mark.parametrize("discrete", [False, True])
def test_slopes_are_those_of_differences(discrete: bool) -> None:
    dice = np.random.default_rng(5)
    Z, D = dice.normal(size=(5, 5)), dice.uniform(size=(5, 5))
    Z[3:, 3:] -= 3 * np.eye(2)
    family = PencilFamily(Z, D, 3, 1.0 if discrete else 0.0, discrete)
    signs, size = (np.sign(dice.normal(size=(5, 5))),), 0.1
    w, v = dice.normal(size=(2, 3)) + 1j * dice.normal(size=(2, 3))
    [slopes] = family.slopes(signs, size, w, v)
    for i, j in product(range(5), repeat=2):
        step = np.zeros((5, 5))
        step[i, j] = 1e-6
        ends = [replace(family, Z=Z + s * step).loop(signs, size) for s in (1, -1)]
        assert slopes[i, j] == pytest.approx(w @ (ends[0] - ends[1]) @ v / 2e-6, rel=1e-5, abs=1e-7)


def test_a_loop_that_every_corner_keeps_stable_does_not_fail() -> None:
    family = PencilFamily(-np.eye(2), np.diag([0.5, 0.5]), 2, 0.0, discrete=False)
    assert first_to_fail(family) == []
    assert distance_of(family, (np.eye(2),)) == np.inf
