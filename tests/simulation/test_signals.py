"""Set-points and disturbances that change, and the signals that a run records."""

from __future__ import annotations

from fractions import Fraction

import pytest

from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import Trajectory, simulate


def follower(time: str = "discrete", gain: str = "-1/2") -> tuple[MultiChannelSystem, Controller]:
    """x(t+1) = x + u + w with u = gain·x + r; y = 2x."""
    plant = MultiChannelSystem([[1]], [[[1]]], [[[2]]], time=time)
    half = Matrix.from_rows([[Fraction(gain) / 2]])
    program = LinearMap({0: half}, reference=Matrix.identity(1))
    return plant, Controller(time, "", (AgentProgram("1", 0, 0, input=program),))


def states(run: Trajectory) -> list[object]:
    return [snapshot.plant[0] for snapshot in run.snapshots]


def test_a_run_records_outputs_inputs_and_set_points() -> None:
    run = simulate(*follower(), initial=[4], reference=[[1]], horizon=2)
    assert [snapshot.outputs for snapshot in run.snapshots] == [[[8]], [[6]], [[5]]]
    assert [snapshot.inputs for snapshot in run.snapshots] == [
        [[-1]],
        [[Fraction(-1, 2)]],
        [[Fraction(-1, 4)]],
    ]
    assert {str(snapshot.reference) for snapshot in run.snapshots} == {"[[Fraction(1, 1)]]"}


def test_a_step_acts_from_its_time_on() -> None:
    run = simulate(*follower(), initial=[0], steps=[(2, [1])], horizon=4)
    assert states(run) == [0, 0, 0, 1, Fraction(3, 2)]
    assert [snapshot.reference for snapshot in run.snapshots] == [[[0]]] * 2 + [[[1]]] * 3


def test_a_ramp_grows_from_its_time_on() -> None:
    run = simulate(*follower(), initial=[0], ramps=[(1, [3])], horizon=4)
    assert [snapshot.reference[0][0] for snapshot in run.snapshots] == [0, 0, 3, 6, 9]


def test_a_disturbance_acts_at_the_plant_and_is_not_an_input() -> None:
    run = simulate(*follower(), initial=[0], disturbances=[(0, [1])], horizon=1)
    assert states(run) == [0, 1]
    assert run.snapshots[0].inputs == [[0]]


def test_numbers_of_all_channels_can_be_one_list() -> None:
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], time="discrete"
    )
    pull = LinearMap(reference=Matrix.identity(1))
    agents = (AgentProgram("1", 0, 0, input=pull), AgentProgram("2", 0, 0, input=pull))
    controller = Controller("discrete", "", agents)
    flat, nested = (simulate(plant, controller, horizon=1, reference=r) for r in ([3, 5], [[3], 5]))
    assert flat.snapshots == nested.snapshots and flat.snapshots[1].plant == [3, 5]


@pytest.mark.parametrize("arithmetic", ["float", "multiprecision"])
def test_in_continuous_time_steps_and_ramps_are_integrated(arithmetic: str) -> None:
    """x' = u + w with u = 0·x + r from x(0) = 0: x(3) = 2·1 + 3·2²/2 − (3 − 1/2) = 5.5."""
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    program = LinearMap(reference=Matrix.identity(1))
    run = simulate(
        plant,
        Controller("continuous", "", (AgentProgram("1", 0, 0, input=program),)),
        initial=[0],
        steps=[(1, [1])],
        ramps=[(1, [3])],
        disturbances=[("1/2", [-1])],
        horizon=3,
        points=6,
        arithmetic=arithmetic,
    )
    assert len(run.snapshots) == 7
    assert abs(float(run.snapshots[6].plant[0]) - 5.5) < 1e-9
    assert [float(each.reference[0][0]) for each in run.snapshots] == [0, 0, 1, 2.5, 4, 5.5, 7]


def test_a_change_between_two_times_is_not_missed() -> None:
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]])
    program = LinearMap(reference=Matrix.identity(1))
    controller = Controller("continuous", "", (AgentProgram("1", 0, 0, input=program),))
    run = simulate(plant, controller, initial=[0], steps=[("1/3", [3])], horizon=1, points=1)
    assert len(run.snapshots) == 2 and abs(run.snapshots[1].plant[0] - 2) < 1e-9


def test_floats_keep_their_value_in_floating_point() -> None:
    plant, controller = follower("continuous")
    run = simulate(plant, controller, initial=[0.1], horizon=0.5, points=1, reference=[0.25])
    assert run.snapshots[0].plant == [0.1] and run.snapshots[0].reference == [[0.25]]
    assert run.times[-1] == Fraction(1, 2)


def test_floats_are_exact_by_the_rounding_that_is_named() -> None:
    run = simulate(*follower(), initial=[0.1], rounding="decimal", horizon=1)
    assert run.snapshots[0].plant == [Fraction(1, 10)]
