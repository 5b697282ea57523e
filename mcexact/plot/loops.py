"""Pictures of a stable loop: eigenvalues, robustness, decay, effort or step responses."""

from __future__ import annotations

from typing import Any, Protocol

from mcexact.exact.roots import StabilityRegion
from mcexact.plot.canvas import (
    BLUE,
    GRAY,
    NAMED,
    PANEL,
    RED,
    elapsed_label,
    empty_figure,
    finished,
    one_axis,
    plain_label,
    several_axes,
)
from mcexact.plot.eigenvalues import draw_places

_FRAGILE = 1 / 0.3


class LoopCurves(Protocol):
    """What the pictures show."""

    @property
    def region(self) -> StabilityRegion: ...
    @property
    def eigenvalues(self) -> list[complex]: ...
    def keeps(self, eigenvalue: complex) -> bool: ...
    @property
    def frequencies(self) -> list[float]: ...
    @property
    def sensitivity(self) -> list[float]: ...
    @property
    def times(self) -> list[float]: ...
    @property
    def growth(self) -> list[float]: ...
    @property
    def effort(self) -> list[float]: ...
    @property
    def steps(self) -> list[tuple[str, list[float]]]: ...


def loop(curves: LoopCurves, ax: Any = None) -> Any:
    """Draw the eigenvalues, the sensitivity, the decay, and the effort or the step responses.

    Parameters
    ----------
    curves : Curves
        Computed in floating point, not certified.
    ax : four axes, optional
        By default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    if ax is None:
        ax = empty_figure(2 * PANEL[0], 2 * PANEL[1]).subplots(2, 2)
    drawn = (poles, sensitivity, decay, steps if curves.steps else effort)
    for draw, axis in zip(drawn, several_axes(ax, 4), strict=True):
        figure = draw(curves, axis)
    return figure


def _panel(ax: Any, title: str) -> Any:
    """The given axes, or new ones, with a title and a grid."""
    axis = one_axis(ax, *PANEL)
    axis.set_title(title, fontsize="medium")
    axis.grid(visible=True, which="major", alpha=0.3)
    return axis


def poles(curves: LoopCurves, ax: Any = None) -> Any:
    """Draw the eigenvalues, and the edges of the region that was asked for."""
    axis = _panel(ax, "Eigenvalues")
    draw_places(axis, curves.eigenvalues, curves.region.time, curves.region)
    return axis.figure


def sensitivity(curves: LoopCurves, ax: Any = None) -> Any:
    """Draw the complementary sensitivity at all inputs together, over the frequency."""
    axis = _panel(ax, "Robustness at the inputs")
    unit = "radians per step" if curves.region.discrete else "radians per unit of time"
    axis.plot(curves.frequencies, curves.sensitivity, color=BLUE)
    axis.axhline(_FRAGILE, color=RED, linestyle="--", linewidth=1)
    axis.annotate(
        "margin 0.3", (0.02, _FRAGILE), (0, 2), xycoords=("axes fraction", "data"),
        textcoords="offset points", color=RED, fontsize="small",
    )  # fmt: skip
    seen = [*curves.sensitivity, _FRAGILE]
    axis.set_ylim(max(min(seen), 1e-4 * max(seen)) / 1.3, 1.6 * max(seen))
    _logarithmic(axis.yaxis)
    if not curves.region.discrete:
        _logarithmic(axis.xaxis)
    return finished(axis, across=f"frequency, {unit}", up="largest singular value of T")


def _logarithmic(axis: Any) -> None:
    """Make one axis logarithmic, with numbers and not with powers of ten where these are short."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def decay(curves: LoopCurves, ax: Any = None) -> Any:
    """Draw the largest norm of the state from a start of norm 1."""
    axis = _panel(ax, "State, from a start of norm 1")
    return _over_time(axis, curves, curves.growth, "largest norm of the state")


def effort(curves: LoopCurves, ax: Any = None) -> Any:
    """Draw the largest norm of the inputs from a start of norm 1."""
    axis = _panel(ax, "Inputs, from a start of norm 1")
    return _over_time(axis, curves, curves.effort, "largest norm of the inputs")


def _over_time(axis: Any, curves: LoopCurves, values: list[float], label: str) -> Any:
    axis.plot(curves.times, values, color=BLUE, drawstyle=_style(curves))
    axis.set_ylim(bottom=0)
    axis.set_xlim(left=0)
    return finished(axis, across=elapsed_label(curves.region.time), up=label)


def steps(curves: LoopCurves, ax: Any = None) -> Any:
    """Draw outputs that step to their set-points; those beyond some are not named."""
    axis = _panel(ax, "Step responses")
    for k, (name, values) in enumerate(curves.steps):
        label = plain_label(name) if k < NAMED else None
        axis.plot(curves.times, values, label=label, drawstyle=_style(curves))
    axis.axhline(1.0, color=GRAY, linewidth=0.8)
    axis.set_xlim(left=0)
    told = "output after a step of its set-point"
    return finished(axis, across=elapsed_label(curves.region.time), up=told, columns=4)


def _style(curves: LoopCurves) -> str:
    return "steps-post" if curves.region.discrete else "default"
