"""The way in from python-control, and the way back."""

from fractions import Fraction

import control
import numpy as np
import pytest

from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.model import gallery
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import from_statespace, loop_from_statespace, to_statespace
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.setpoint import design_setpoint


def plant(D=0.0, dt=0):
    """Two states, two inputs and two outputs with labels."""
    return control.ss(
        [[0, 1], [0, -0.1]],
        [[0, 1], [1, 0]],
        [[1, 0], [0, 1]],
        [[0, D], [0, 0]],
        dt,
        inputs=["valve", "pump"],
        outputs=["level", "flow"],
    )


def test_channels_are_split_by_position_or_label():
    by_label = from_statespace(plant(), [("pump", "level"), (["valve"], 1)], rounding="decimal")
    by_position = from_statespace(plant(), [(1, 0), ([0], [1])], rounding="decimal")
    assert by_label == by_position and by_label.time == "continuous"
    assert by_label.A[1, 1] == Fraction(-1, 10) and by_label.B(0).numerators == ((1,), (0,))
    assert from_statespace(plant(), [([0, 1], [])], rounding="dyadic").A[1, 1] == Fraction(-0.1)


@pytest.mark.parametrize(
    ("dt", "time", "sample_time"),
    [
        (0, "continuous", None),
        (None, "continuous", None),
        (True, "discrete", None),
        (0.1, "discrete", Fraction(1, 10)),
    ],
)
def test_the_time_domain_is_taken_over(dt, time, sample_time):
    system = from_statespace(plant(dt=dt), [(0, 0), (1, 1)], rounding="decimal")
    assert (system.time, system.sample_time) == (time, sample_time)


@pytest.mark.parametrize(
    ("statespace", "channels", "message"),
    [
        (control.tf([1], [1, 1]), [(0, 0)], "expected a control.StateSpace, found Transfer"),
        (plant(), [("valv", 0)], r"channels\[0\] inputs: there is no signal 'valv' \(did you mean"),
        (plant(), {"a": (0, "x")}, r"channels\['a'\] outputs: .* the signals are 'level', 'flow'"),
        (plant(), [(0, 0), ([0], 1)], r"channels\[1\] inputs: the signal 0 is used twice"),
        (plant(), [(2, 0)], r"channels\[0\] inputs: expected positions 0 … 1, found 2"),
        (plant(), [(0, -1)], r"channels\[0\] outputs: expected positions 0 … 1, found -1"),
        (plant(), [(True, 0)], r"channels\[0\] inputs: expected a position or a label, found True"),
        (plant(), [([1.0], 0)], r"channels\[0\] inputs: expected a position or a label, found 1.0"),
        (plant(), [0], r"channels\[0\]: expected a pair \(inputs, outputs\), found 0; write"),
        (plant(), {"a": "io"}, r"channels\['a'\]: expected a pair \(inputs, outputs\), found 'io'"),
        (plant(), [], "channels: expected at least one channel"),
    ],
)
def test_what_does_not_fit_is_refused(statespace, channels, message):
    with pytest.raises(InputError, match=message):
        from_statespace(statespace, channels, rounding="decimal")


def test_fractions_that_python_control_rounded_come_back():
    tanks = gallery.load("quadruple-tank-pminus")
    again = from_statespace(to_statespace(tanks), {"1": (0, 0), "2": (1, 1)})
    assert again == tanks and again.rounding == "simplest"
    loop = loop_from_statespace(to_statespace(tanks))
    assert loop.A == tanks.A and loop.rounding == "simplest"


def test_a_sample_time_is_read_by_the_rounding_too():
    sampled = control.ss([[1.0]], [[1.0]], [[1.0]], [[0.0]], dt=0.1 + 0.2)
    system = from_statespace(sampled, [(0, 0)])
    assert system.sample_time == Fraction(3, 10) and system.rounding == "simplest"
    assert from_statespace(control.ss(1.0, 1.0, 1.0, 0.0), [(0, 0)]).rounding is None


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_a_plant_goes_out_and_comes_back(time):
    made = MultiChannelSystem(
        [[1, "1/8"], [0, -2]],
        [[[1, 0], [0, 1]], [[], []]],
        [[], [[0, 1]]],
        time=time,
        sample_time="1/4" if time == "discrete" else None,
        names=["two inputs", "an output"],
    )
    out = to_statespace(made)
    assert out.input_labels == ["u[two inputs,0]", "u[two inputs,1]"]
    assert out.output_labels == ["y[an output]"] and out.dt == (0.25 if time == "discrete" else 0)
    channels = {"two inputs": ([0, 1], []), "an output": ([], "y[an output]")}
    assert from_statespace(out, channels, rounding="dyadic") == made


def agents(*programs, time="discrete"):
    return Controller(time, "", programs)


def test_a_controller_closes_the_loop_in_python_control_as_here():
    """Agent 2 uses a state and an output of agent 1, which arrive one and two steps late."""
    made = MultiChannelSystem(
        [["1/2", 1], [0, "1/4"]],
        [[[0], [1]], [[1], [0]]],
        [[[1, 0]], [[0, 1]]],
        time="discrete",
        neighbors=NeighborGraph.from_names(["1", "2"], {"1": [], "2": ["1"]}, {"2": {"1": 1}}),
    )
    one = Matrix.from_rows([["1/8"]])
    controller = agents(
        AgentProgram(
            "1", 1, 0, LinearMap({0: one}, {0: one}), input=LinearMap({0: -one}), hold={1: 1}
        ),
        AgentProgram("2", 0, 1, private_update=LinearMap({1: one}, private=one),
                     input=LinearMap({0: one, 1: -one}, {0: one}, one)),
    )  # fmt: skip
    loop = closed_loop(made, controller)
    P, K = to_statespace(made), to_statespace(controller, made)
    assert K.nstates == loop.dimension - made.n == 5
    assert K.input_labels == ["y[1]", "y[2]"] and K.output_labels == ["u[1]", "u[2]"]
    assert np.array_equal(control.feedback(P, K, sign=1).A, matrix_to_float(loop.matrix))
    out = to_statespace(loop)
    assert out.input_labels == ["d[1]", "d[2]"] and out.dt is True
    assert loop_from_statespace(out, rounding="dyadic").A == loop.matrix


def test_a_loop_with_set_points_has_them_as_inputs():
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    design = design_setpoint(plant, spectrum=[-2, -3, -4])
    for out in (to_statespace(design), to_statespace(design.loop)):
        assert out.input_labels == ["d[1]", "r[1]"]
        assert np.allclose(out.dcgain(), [[0, 1]])
    K = to_statespace(design.controller, plant)
    assert K.input_labels == ["y[1]", "r[1]"]
    closed = to_statespace(plant) * control.ss(K.A, K.B[:, 1:], K.C, K.D[:, 1:])
    assert closed.nstates == 1 + K.nstates


def test_what_python_control_has_no_form_for_is_refused():
    controller = agents(AgentProgram("1", 0, 0), time="continuous")
    with pytest.raises(UsageError, match=r"write to_statespace\(controller, plant\)"):
        to_statespace(controller)
    with pytest.raises(UsageError, match="a closed loop or a Design, found list"):
        to_statespace([[1]])
    system = MultiChannelSystem([[0]], [[[1]]], [[[1]]], names=["other"])
    with pytest.raises(UsageError, match="expected the agents 'other'"):
        to_statespace(controller, system)
