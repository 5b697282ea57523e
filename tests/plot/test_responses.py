"""Trajectories in the picture, beside what is proved of them; figures without global state."""

from __future__ import annotations

import sys

import pytest
from matplotlib.figure import Figure

from mcexact.errors import UsageError
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.plot.responses import decay, responses
from mcexact.simulation.envelope import proved_envelope, simulated_loop
from mcexact.simulation.trajectory import Trajectory, simulate
from mcexact.synthesis.setpoint import design_setpoint
from tests.wording import worded


def run_of(channels: int = 1, time: str = "discrete", **options: object) -> Trajectory:
    """x(t+1) = x/2 + Σ u_i with u_i = −x/16 or so."""
    plant = MultiChannelSystem(
        [["1/2" if time == "discrete" else -1]],
        [[[1]]] * channels,
        [[[1]]] * channels,
        time=time,
        names=[f"${k}" for k in range(channels)],
    )
    gains = local_controllers(plant, [[["-1/16"]]] * channels)
    return simulate(plant, gains, **{"horizon": 4, **options})  # type: ignore[arg-type]


def labels(axis: object) -> list[str]:
    legend = axis.get_legend()  # type: ignore[attr-defined]
    return [] if legend is None else [text.get_text() for text in legend.get_texts()]


def test_outputs_and_inputs_have_a_panel_each() -> None:
    run = run_of(2)
    outputs, inputs = run.plot().axes
    assert (outputs.get_title(), inputs.get_title()) == ("outputs", "inputs")
    assert labels(outputs) == [r"y \$0", r"y \$1"] and labels(inputs) == [r"u \$0", r"u \$1"]
    assert list(outputs.get_lines()[0].get_ydata()) == run.values("outputs")["y $0"]
    assert outputs.get_xlabel() == "step" and outputs.get_lines()[0].get_drawstyle() == "steps-post"


def test_many_signals_are_counted_and_not_named() -> None:
    outputs, _ = run_of(9).plot().axes
    assert outputs.get_title() == "9 outputs" and labels(outputs) == []


def test_axes_can_be_given_and_have_to_be_two() -> None:
    figure = Figure()
    axes = figure.subplots(2, 1)
    assert run_of().plot(axes) is figure and axes[1].get_title() == "inputs"
    with pytest.raises(UsageError, match="ax: expected 2 axes, found 1"):
        run_of().plot(axes[0])


def test_proved_bounds_are_named_as_proved_and_contain_the_curves() -> None:
    run = run_of(time="continuous", initial=[3])
    found = proved_envelope(run)
    outputs, _ = responses(run, envelope=found).axes
    assert labels(outputs) == [r"y \$0", "proved bounds"]
    curve, upper, lower = (list(line.get_ydata()) for line in outputs.get_lines())
    for below, value, above in zip(lower, curve, upper, strict=True):
        assert below <= value * (1 + 1e-9) and value <= above * (1 + 1e-9)


def test_decay_shows_the_slope_and_the_bound() -> None:
    done = simulated_loop(run_of().loop.plant, run_of().loop.controller)
    [axis] = decay(done.run, spectrum=done.spectrum, envelope=done.envelope).axes
    assert axis.get_yscale() == "log"
    assert worded(labels(axis))  # fmt: skip


def test_a_run_at_rest_is_drawn_without_a_logarithm() -> None:
    [axis] = decay(run_of(initial=[0])).axes
    assert axis.get_yscale() == "linear"


def test_set_points_are_dashed_and_decay_is_towards_rest() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    made = design_setpoint(plant, rate="1/2")
    done = simulated_loop(plant, made.controller, reference=[2], initial=[0])
    outputs, _ = responses(done.run, envelope=done.envelope).axes
    assert "set-points" in labels(outputs)
    [axis] = decay(done.run, envelope=done.envelope).axes
    assert worded(axis.get_title())
    assert axis.get_lines()[0].get_ydata()[0] == pytest.approx(2)
    curves = made.plot().axes
    assert len(curves) == 4 and curves[3].get_title() == "Step responses"


def test_a_figure_shows_itself_without_pyplot() -> None:
    figure = run_of().plot()
    assert isinstance(figure, Figure) and figure._repr_png_().startswith(b"\x89PNG")  # type: ignore[attr-defined]
    assert figure.canvas.manager is None


def test_drawing_does_not_import_pyplot() -> None:
    import subprocess

    code = (
        "import sys; from mcexact import plot; plot.eigenvalues([-1]); "
        "plot.graph((['1'], [])); print('matplotlib.pyplot' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"
