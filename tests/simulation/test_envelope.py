"""Proved bounds hold for the trajectory, and are left out where nothing is proved."""

from __future__ import annotations

import pytest

from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.envelope import Envelope, proved_envelope
from mcexact.simulation.trajectory import Trajectory, simulate


def moved(time: str, **options: object) -> Trajectory:
    """Two coupled states, which a controller with a state and a set-point slows down."""
    A = [[0, 1], [-2, -1]] if time == "continuous" else [["1/2", "1/2"], [0, "1/3"]]
    plant = MultiChannelSystem(A, [[[0], [1]]], [[[1, 0]]], time=time)
    keep = LinearMap({0: Matrix.from_rows([["1/8"]])}, private=Matrix.from_rows([["-1/2"]]))
    send = LinearMap(private=Matrix.from_rows([["1/8"]]), reference=Matrix.identity(1))
    agent = AgentProgram("1", 0, 1, private_update=keep, input=send)
    options = {"initial": [3, -1], **options}
    return simulate(plant, Controller(time, "", (agent,)), **options)  # type: ignore[arg-type]


def envelope_of(run: Trajectory) -> Envelope:
    found = proved_envelope(run)
    assert found is not None
    return found


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("reference", [0, 2])
def test_every_output_and_state_stays_inside(time: str, reference: int) -> None:
    run = moved(time, reference=[reference], disturbances=[(0, [1])])
    found = envelope_of(run)
    assert found.proof.stable and found.proof.region.edge == found.bound
    decay = found.decay(run.times)
    for k, snapshot in enumerate(run.snapshots):
        pairs = [*zip(snapshot.outputs[0], found.outputs, strict=True)]
        pairs += zip(snapshot.plant, found.state, strict=True)
        for value, (rest, size) in pairs:
            assert abs(float(value) - rest) <= size * decay[k] * (1 + 1e-9) + 1e-9


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_the_value_at_rest_is_where_the_trajectory_ends(time: str) -> None:
    run = moved(time, reference=[2], horizon=60)
    [(rest, _)] = envelope_of(run).outputs
    assert float(run.snapshots[-1].outputs[0][0]) == pytest.approx(rest, abs=1e-2) and rest


def test_nothing_is_proved_where_a_signal_changes() -> None:
    assert proved_envelope(moved("continuous", steps=[(1, [1])])) is None
    assert proved_envelope(moved("continuous", ramps=[(0, [1])])) is None


def test_nothing_is_proved_of_an_unstable_loop() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    idle = Controller("continuous", "", (AgentProgram("1", 0, 0),))
    assert proved_envelope(simulate(plant, idle, horizon=1)) is None
