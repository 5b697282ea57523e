"""Disk margins, Nyquist curves with the certified disks, and responses to steps with their peaks.

`margins` draws margins and Nyquist curves beside each other.  A margin that is proved is a filled
bar, and one that is computed alone is hollow.  The curves are computed in floating point; the disk
that no curve enters is that of the least single margin, and is drawn only if this is proved.
`step_peaks` draws computed responses, and as dashed lines the peaks that are proved.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Protocol

from mcexact.exact.matrix import to_float
from mcexact.exact.rational import digits_outward
from mcexact.exact.roots import is_discrete
from mcexact.plot.canvas import (
    BLUE,
    GRAY,
    LIGHT,
    NAMED,
    PANEL,
    RED,
    elapsed_label,
    finished,
    one_axis,
    plain_label,
    several_axes,
)

AIMED = 0.4
"""The margin of a single loop below which a verdict hears it."""
_LIMIT = 2.0
"""No disk margin is larger."""
_WINDOW = 3.0
"""How far a picture of Nyquist curves reaches, if the disk is not larger."""
_FAR = 20.0
"""How far away a curve is still drawn, as a multiple of how far the picture reaches."""


class SingleLoop(Protocol):
    """A loop opened at one input or output, with the usual sign of feedback."""

    @property
    def name(self) -> str: ...
    @property
    def curve(self) -> Sequence[complex]: ...


class Step(Protocol):
    """The response of an input or output to a step, and what it is proved not to exceed."""

    @property
    def name(self) -> str: ...
    @property
    def times(self) -> Sequence[float]: ...
    @property
    def values(self) -> Sequence[float]: ...
    @property
    def peak(self) -> Fraction | None: ...


class Steps(Protocol):
    """The responses of a loop to steps, by where the step is."""

    @property
    def steps(self) -> Mapping[str, Sequence[Step]]: ...
    @property
    def time(self) -> str: ...


class Margins(Steps, Protocol):
    """The margins of a loop by their labels, its single loops, and its responses to steps."""

    @property
    def bars(self) -> Mapping[str, tuple[float, bool]]: ...
    @property
    def loops(self) -> Sequence[SingleLoop]: ...
    @property
    def margin(self) -> Fraction | None: ...


def margins(performance: Margins, ax: Any = None) -> Any:
    """Draw the disk margins of a loop, and beside them Nyquist curves with the certified disk.

    Parameters
    ----------
    performance : Performance
    ax : two axes, optional
        By default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    left, right = several_axes(ax, 2, 4.8, 3.8)
    margin_bars(performance, left)
    return nyquist(performance, right)


def margin_bars(performance: Margins, ax: Any = None) -> Any:
    """Draw the disk margins: of inputs and outputs, each by itself and all together."""
    axis = one_axis(ax, *PANEL)
    bars = performance.bars
    for place, (value, proved) in enumerate(bars.values()):
        axis.barh(
            place, value, 0.6, color=BLUE if proved else "white", edgecolor=BLUE, linewidth=1.2
        )
        text = f"{'≥ ' if proved else ''}{value:.3g}"
        axis.annotate(
            text,
            (value, place),
            (4, 0),
            textcoords="offset points",
            va="center",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
        )
    axis.axvline(AIMED, color=RED, linestyle="--", linewidth=1)
    axis.set_yticks(range(len(bars)), [*bars])
    axis.invert_yaxis()
    axis.set_xlim(0, 1.25 * max([AIMED, *(value for value, _ in bars.values())]))
    axis.grid(visible=True, axis="x", alpha=0.3)
    return finished(axis, "Disk margins", "margin; hollow bars are computed alone")


def nyquist(performance: Margins, ax: Any = None) -> Any:
    """Draw the weakest single loops in the complex plane, and the certified disk around −1."""
    axis = one_axis(ax, *PANEL)
    named = len(performance.loops) <= NAMED // 2
    alpha, reach = performance.margin, _WINDOW
    certified = None if alpha is None or not 0 < alpha < _LIMIT else disk(to_float(alpha))
    if certified is not None:
        reach = min(max(reach, 1.2 * (certified[1] - certified[0])), 3 * _WINDOW)
    for k, each in enumerate(performance.loops):
        # the curve of negative frequencies is its mirror image
        points = [*(z.conjugate() for z in reversed(each.curve)), *each.curve]
        label = plain_label(each.name, 28) if named else None
        curve = _coordinates(points, _FAR * reach)
        axis.plot(*curve, color=f"C{k % 10}", linewidth=1.3, label=label)
    if alpha is not None and certified is not None:
        _draw_disk(axis, *certified, to_float(alpha))
    axis.plot([-1], [0], "+", color=RED, markersize=9)
    axis.axhline(0, color=GRAY, linewidth=0.6)
    axis.axvline(0, color=GRAY, linewidth=0.6)
    axis.set(xlim=(-reach, reach), ylim=(-reach, reach), aspect="equal")
    axis.grid(visible=True, alpha=0.3)
    return finished(
        axis, "Nyquist curves of single loops", "real part", "imaginary part", columns=1
    )


def step_peaks(performance: Steps, ax: Any = None) -> Any:
    """Draw the responses to steps at inputs, and of set-points, with the peaks that are proved.

    Parameters
    ----------
    performance : Performance
    ax : axes, optional
        As many as there are kinds of steps; by default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure

    Notes
    -----
    The curves are computed in floating point.  A dashed line of the color of a curve is what the
    curve is proved not to cross, on the side where its largest absolute value is.
    """
    kinds = performance.steps
    axes = several_axes(ax, len(kinds), *PANEL)
    for axis, (title, steps) in zip(axes, kinds.items(), strict=True):
        figure = step_picture(steps, title, performance.time, axis)
    return figure


def step_picture(steps: Sequence[Step], title: str, time: str, axis: Any) -> Any:
    """Draw the responses to one kind of steps."""
    for k, step in enumerate(steps):
        color, label = f"C{k}", plain_label(step.name, 28)
        if step.peak is not None:
            label += f": at most {digits_outward(step.peak, up=True)}, proved"
            line = math.copysign(to_float(step.peak), max(step.values, key=abs))
            axis.axhline(line, color=color, linestyle="--", linewidth=1)
        style = "steps-post" if is_discrete(time) else "default"
        axis.plot(step.times, step.values, color=color, linewidth=1.4, label=label, drawstyle=style)
    axis.axhline(0, color=GRAY, linewidth=0.6)
    axis.set_xlim(left=0)
    axis.grid(visible=True, alpha=0.3)
    return finished(axis, f"Peak of {title}", elapsed_label(time), columns=1)


def disk(alpha: float) -> tuple[float, float]:
    """The center and the radius of the disk of −1/f, f = (1 + d/2)/(1 − d/2), abs(d) ≤ α < 2.

    Examples
    --------
    >>> center, radius = disk(0.4)
    >>> round(center - radius, 3), round(center + radius, 3)
    (-1.5, -0.667)
    """
    far, near = -(1 + alpha / 2) / (1 - alpha / 2), -(1 - alpha / 2) / (1 + alpha / 2)
    return (far + near) / 2, (near - far) / 2


def _draw_disk(axis: Any, center: float, radius: float, alpha: float) -> None:
    turns = [2 * math.pi * k / 240 for k in range(241)]
    xs = [center + radius * math.cos(turn) for turn in turns]
    ys = [radius * math.sin(turn) for turn in turns]
    label = f"certified: no curve enters the disk of margin {alpha:.3g}"
    axis.fill(xs, ys, facecolor=LIGHT, edgecolor=RED, linewidth=1, zorder=0, label=label)


def _coordinates(points: Sequence[complex], far: float) -> tuple[list[float], list[float]]:
    """The coordinates of points; a curve is interrupted where it is far away, as at a pole.

    At a pole on the border of stability the points are rounding errors, and a line from one to the
    next one would cross the picture.
    """
    kept = [z if abs(z) <= far else complex(math.nan, math.nan) for z in points]
    return [z.real for z in kept], [z.imag for z in kept]
