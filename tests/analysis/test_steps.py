"""Peaks after steps: known answers, the response in another way, units, and what is left out."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from mcexact.analysis.in_units import step_peaks
from mcexact.analysis.steps import computed_steps, steps_of
from mcexact.answer.check import check
from mcexact.answer.performance import StepPeaks
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from tests.oracle.certificates.controllers import Loop, read_agents
from tests.oracle.certificates.performance import disturbed
from tests.oracle.certificates.steps import seen_peaks, signals
from tests.oracle.certificates.systems import read_plant
from tests.oracle.drawn.performance import drawn_loop

SIDES: Any = ("inputs", "outputs", "setpoints")


def oscillator(damping: str, time: str = "continuous") -> MultiChannelSystem:
    """x'' + 2ζx' + x = u, the output x."""
    twice = -2 * Fraction(damping)
    return MultiChannelSystem([[0, 1], [-1, twice]], [[[0], [1]]], [[[1, 0]]], time=time)


def uncontrolled(plant: MultiChannelSystem) -> Controller:
    return local_controllers(plant, [[[0]]])


def bounds(peaks: StepPeaks) -> np.ndarray:
    """One row for each step, the inputs before the outputs."""
    rows = zip(peaks.inputs, peaks.outputs, strict=True)
    return np.array([[float(x) for x in u + y] for u, y in rows])


@pytest.mark.parametrize("damping", ["1/20", "1/4", "1/2", "9/10"])
def test_an_oscillator_overshoots_as_the_formula_says(damping: str) -> None:
    plant, zeta = oscillator(damping), float(Fraction(damping))
    peak = 1 + math.exp(-math.pi * zeta / math.sqrt(1 - zeta**2))
    [[bound]] = step_peaks(plant, uncontrolled(plant), "inputs").outputs
    assert peak <= float(bound) <= 1.001 * peak


def test_what_only_approaches_its_limit_is_bounded_by_it() -> None:
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    [[bound]] = step_peaks(plant, uncontrolled(plant), "inputs").outputs
    assert 1 <= bound <= Fraction(1001, 1000)


def test_a_deadbeat_loop_is_told_at_its_instants() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    peaks = step_peaks(plant, local_controllers(plant, [[[-1]]]), "outputs")
    # u = -(x + 1), so that x is -1 from the time 1 on
    assert [[round(float(x), 3)] for x in bounds(peaks)[0]] == [[1.0], [1.0]]
    assert check(peaks).valid


def test_a_set_point_that_is_followed_moves_its_own_output_alone() -> None:
    plant = MultiChannelSystem(
        [[0, 0], [0, -1]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], time="continuous"
    )
    agent = AgentProgram(
        "1",
        0,
        0,
        input=LinearMap({0: Matrix.from_rows([[-2]])}, reference=Matrix.from_rows([[2]])),
    )
    controller = Controller("continuous", "", (agent, AgentProgram("2", 0, 0)))
    found = bounds(step_peaks(plant, controller, "setpoints"))
    assert np.allclose(found[0, [0, 2]], [2, 1], rtol=1e-3)
    assert np.all(found[0, [1, 3]] < 1e-5) and np.all(found[1] < 1e-5)


@pytest.mark.parametrize("seed", range(25))
def test_drawn_loops_stay_within_their_bounds_and_reach_nearly_all_of_them(seed: int) -> None:
    drawn = drawn_loop(random.Random(seed))
    if drawn is None:
        return
    plant, controller, loop = drawn
    steps = [{"construction": "closed_loop", "controller": controller}]
    system = read_plant(plant)
    layout = Loop(system, read_agents(system, controller))
    own = disturbed({"system": plant, "subject": steps})
    for at in SIDES:
        proved = steps_of(loop, at, most=2000)
        if proved is None:
            continue
        seen = seen_peaks(*signals(own, layout, at), plant["time"]).T
        told = bounds(proved).reshape(seen.shape)
        assert np.all(told >= seen * (1 - 1e-9))
        large = seen > 1e-5 * np.max(seen, initial=0.0)
        assert np.all(told[large] <= 1.002 * seen[large])
        rough = computed_steps(loop, at)
        assert rough is not None
        told_rough = np.hstack([rough.inputs, rough.outputs])
        assert np.all(told_rough[large] <= seen[large] * (1 + 1e-4))
        assert np.all(told_rough[large] >= seen[large] * 0.99)


def two_units(by: int) -> ClosedLoop:
    """Two coupled tanks, whose second output and input are measured in another unit."""
    s = Fraction(10) ** by
    plant = MultiChannelSystem(
        [[-1, 1 / s], [s / 2, -2]], [[[1], [0]], [[0], [s]]], [[[1, 0]], [[0, 1]]]
    )
    return closed_loop(plant, local_controllers(plant, [[[-1]], [[-1 / s]]]))


@pytest.mark.parametrize("by", [-9, 6])
def test_other_units_multiply_the_bounds_and_change_nothing_else(by: int) -> None:
    one, other = steps_of(two_units(0), "inputs"), steps_of(two_units(by), "inputs")
    assert one is not None and other is not None
    # u_1, u_2, y_1 and y_2, of which the last one alone has another unit
    units = np.array([1, 1, 1, 10.0**by])
    assert np.allclose(bounds(one), bounds(other) / units, rtol=2e-3)


def test_a_loop_that_is_not_stable_has_no_bounds() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    for at in SIDES:
        assert steps_of(closed_loop(plant, uncontrolled(plant)), at) is None
        assert computed_steps(closed_loop(plant, uncontrolled(plant)), at) is None
    with pytest.raises(LimitReached):
        step_peaks(plant, uncontrolled(plant), "inputs")
    with pytest.raises(UsageError):
        step_peaks(plant, uncontrolled(plant), "disturbances")  # type: ignore[arg-type]


def test_more_work_than_is_allowed_is_not_begun() -> None:
    plant = oscillator("1/1000")
    loop = closed_loop(plant, uncontrolled(plant))
    with pytest.raises(LimitReached, match="prove-all"):
        steps_of(loop, "inputs", work=1e4)
    assert steps_of(loop, "inputs", most=3) is None
    assert steps_of(loop, "inputs") is not None


def test_a_plant_that_does_not_react_passes_an_error_on() -> None:
    plant = MultiChannelSystem([[-1]], [[[0]]], [[[0]]])
    peaks = step_peaks(plant, local_controllers(plant, [[[5]]]), "outputs")
    # the input is 5 times the error of the sensor, and the output does not move
    assert np.allclose(bounds(peaks), [[5, 0]], atol=1e-3)
