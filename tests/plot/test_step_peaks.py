"""Responses to steps, which stay below the peaks that are proved."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.figure import Figure

from mcexact.analysis.steps import step_curves
from mcexact.errors import UsageError
from mcexact.exact.matrix import to_float
from mcexact.model import gallery
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.margins import step_peaks
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.performance import Performance, loop_performance, performance_of
from mcexact.synthesis.setpoint import design_setpoint
from tests.wording import worded

DOUBLE = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0], [0, 1]]])
"""A double integrator with its position and its speed measured."""


def of(gains: list[int], time: str = "continuous") -> Performance:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time=time)
    if len(gains) == 2:
        plant = DOUBLE
    return loop_performance(plant, local_controllers(plant, [[gains]]))


def test_a_response_that_is_known() -> None:
    """From rest, x' = x − 3x + 1 and u = −3x give u(t) = −3/2 (1 − e^(−2t))."""
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    [curve] = step_curves(closed_loop(plant, local_controllers(plant, [[[-3]]])), "inputs", 4)
    times = np.array(curve.times)
    assert np.allclose(curve.values, -1.5 * (1 - np.exp(-2 * times)), atol=1e-9)
    assert len(times) > 100 and 1 < times[-1] < 10


def test_in_discrete_time_every_instant_is_drawn_until_the_loop_rests() -> None:
    plant = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time="discrete")
    [curve] = step_curves(closed_loop(plant, local_controllers(plant, [[["-1/4"]]])), "inputs", 4)
    x, expected = 0.0, []
    for _ in curve.times:
        expected.append(-x / 4)
        x = x / 2 - x / 4 + 1
    assert np.allclose(curve.values, expected) and curve.times[:3] == (0.0, 1.0, 2.0)
    assert len(curve.times) < 30


@pytest.mark.parametrize("gains", [[-3], [-1, -1]])
def test_the_dashed_line_is_the_proved_peak_on_the_side_of_the_curve(gains: list[int]) -> None:
    performance = of(gains)
    [steps] = performance.steps.values()
    (axis,) = performance.plot_steps().axes
    lines = [line for line in axis.lines if line.get_linestyle() == "--"]
    curves = [line for line in axis.lines if len(line.get_xdata()) > 10]
    assert len(lines) == len(curves) == len(steps)
    for line, curve, step in zip(lines, curves, steps, strict=True):
        assert step.peak is not None
        height, values = line.get_ydata()[0], np.asarray(curve.get_ydata())
        assert abs(height) == to_float(step.peak) and line.get_color() == curve.get_color()
        extreme = values[np.argmax(np.abs(values))]
        assert 1 <= height / extreme < 1.01
    assert "proved" in axis.get_legend().get_texts()[0].get_text()


def test_steps_of_set_points_have_a_picture_of_their_own() -> None:
    plant = gallery.load("quadruple-tank-pminus")
    loop = design_setpoint(plant, arithmetic="float", aims=Aims(effort=0.3)).loop.closed
    performance = performance_of(loop)
    left, right = performance.plot_steps().axes
    assert worded(performance.steps)
    for axis, steps in zip((left, right), performance.steps.values(), strict=True):
        assert steps[0].name.split()[0] in axis.get_title()
        for step in steps:
            assert step.peak is not None
            assert max(map(abs, step.values)) <= to_float(step.peak)
    assert right.get_xlabel() == "time"
    # an output comes to rest at its set-point
    assert all(
        abs(step.values[-1] - 1) < 0.05 for step in performance.steps[[*performance.steps][1]]
    )


def test_a_peak_that_is_not_proved_has_no_line() -> None:
    performance = of([-3])
    bare = replace(performance, answers={}, closed=performance.closed)
    (axis,) = bare.plot_steps().axes
    assert not [line for line in axis.lines if line.get_linestyle() == "--"]
    assert "proved" not in axis.get_legend().get_texts()[0].get_text()


def test_axes_can_be_given_and_an_unstable_loop_has_nothing_to_draw() -> None:
    figure = Figure()
    assert step_peaks(of([-3]), figure.subplots()) is figure
    with pytest.raises(UsageError, match="expected 1 axes, found 2"):
        step_peaks(of([-3]), Figure().subplots(1, 2))
    with pytest.raises(UsageError, match="no step has a response"):
        of([3]).plot_steps()
