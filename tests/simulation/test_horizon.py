"""Times that follow the slowest and the fastest mode."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import FEWEST, MOST, STEPS, Grid, chosen_grid, simulate


def loop_of(A: list[list[Any]], time: str = "continuous") -> ClosedLoop:
    """A loop without inputs."""
    n = len(A)
    plant = MultiChannelSystem(A, [[[0]] * n], [[[1] + [0] * (n - 1)]], time=time)
    return closed_loop(plant, local_controllers(plant, [[[0]]]))


def times(A: list[list[Any]], time: str = "continuous", last: int = 0) -> Grid:
    return chosen_grid(loop_of(A, time), Fraction(last))


@pytest.mark.parametrize("scale", ["1e-6", "1/100", "1", "1e5"])
def test_six_time_constants_of_the_slowest_mode_are_shown(scale: str) -> None:
    rate = Fraction(scale)
    end = times([[-rate, 0], [0, -3 * rate]]).times[-1]
    assert 6 <= end * rate <= 8


def test_the_fastest_mode_says_how_many_times_there_are() -> None:
    assert len(times([[-1]]).times) == FEWEST + 1
    assert FEWEST < len(times([[-1, 0], [0, -10]]).times) - 1 < MOST
    many = times([[-1, 0], [0, -10000]])
    assert len(many.times) == MOST + 1 and many.fastest == pytest.approx(10000)
    assert many.note is not None and "1e+04" in many.note and times([[-1]]).note is None


def test_what_is_given_is_kept() -> None:
    grid = chosen_grid(loop_of([[-1]]), Fraction(0), Fraction(3), 4)
    assert grid.times == (0, Fraction(3, 4), Fraction(3, 2), Fraction(9, 4), 3)


def test_the_loop_is_shown_after_the_last_change() -> None:
    assert times([[-1]], last=100).times[-1] >= 106


def test_unstable_and_undamped_loops_have_times_too() -> None:
    assert 1 <= times([[2]]).times[-1] <= 2
    assert 15 <= times([[0, 1], [-1, 0]]).times[-1] <= 60
    assert times([[0]]).times[-1] == 10
    assert times([["1e400"]]).times[-1] == 10


def test_steps_follow_the_radius_and_modes_zero_end() -> None:
    assert len(times([["1/2"]], "discrete").times) == 11
    nilpotent = [[int(j == i + 1) for j in range(8)] for i in range(8)]
    assert len(times(nilpotent, "discrete").times) == 12
    assert len(times([[1]], "discrete").times) == STEPS + 1


def test_a_run_says_that_limits_of_the_controller_are_left_out() -> None:
    plant = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    controller = local_controllers(plant, [[["-1/4"]]])
    assert simulate(plant, controller, horizon=2).note is None
    limited = controller.with_saturation((((Fraction(-1), Fraction(1)),),))
    found = simulate(plant, limited, horizon=2)
    assert found.note is not None and "not cut off" in found.note


def test_modes_that_stay_on_the_border_do_not_make_the_times_long() -> None:
    """A double mode 0 seems to have Re λ near 1e-8, and its time constant is 10⁸ seconds."""
    # not a Jordan block: floating point then finds ±1e-8 in place of 0
    shear: list[list[Any]] = [[-1, 1, 0], [-1, 1, 0], [0, 0, "-1/10"]]
    assert 60 <= times(shear).times[-1] <= 80
    assert 10 <= times([[1, 1], [-1, -1]]).times[-1] <= 20
    triple = [[2, 1, 0, 0], [-4, -2, 1, 0], [0, 0, 0, 0], [0, 0, 0, -1]]
    assert 6 <= times(triple).times[-1] <= 8


def test_periods_of_modes_on_the_border_are_shown() -> None:
    end = times([[0, "1/10", 0], ["-1/10", 0, 0], [0, 0, -1]]).times[-1]
    assert 3 * 60 <= end <= 4 * 60
    assert times([[0, 1, 0], [0, 0, 0], [0, 0, "1e-3"]]).times[-1] >= 3000
