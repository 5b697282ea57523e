"""Trajectories over time, and the curves of a stable loop.

`responses` and `decay` draw one simulated trajectory, beside proved bounds if there are some.
`loop` draws eigenvalues, sensitivity, decay, and effort or step responses of a stable loop; these
curves are computed in floating point and not certified.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Protocol

from mcexact.exact.matrix import float_above, float_below, to_float
from mcexact.exact.rational import digits_outward
from mcexact.exact.roots import StabilityRegion, is_discrete
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

# Trajectories over time: outputs with set-points and proved bounds, inputs, and decay.

_MARKED = 60
"""The largest number of times in discrete time that are marked by dots."""
_BOUNDED = 4
"""The largest number of outputs whose proved bounds are drawn; more would hide the curves."""


class Run(Protocol):
    """The parts of a trajectory that are drawn."""

    @property
    def time(self) -> str: ...
    @property
    def times(self) -> Sequence[Fraction]: ...
    def values(self, kind: str) -> dict[str, list[float]]: ...
    def state_norms(self, rest: Sequence[float] | None = None) -> list[float]: ...
    def error_norms(self) -> dict[str, list[float]]: ...


class Bounds(Protocol):
    """Proved bounds on a trajectory: a value at rest and a size for each output."""

    @property
    def outputs(self) -> Sequence[tuple[Fraction, Fraction]]: ...
    @property
    def state(self) -> Sequence[tuple[Fraction, Fraction]]: ...
    @property
    def bound(self) -> Fraction: ...
    def decay(self, times: Sequence[Fraction]) -> list[float]: ...


class Beside(Protocol):
    """A real loop beside the ideal one, as it is drawn."""

    @property
    def times(self) -> Sequence[Fraction]: ...
    @property
    def unit(self) -> str: ...
    @property
    def ideal(self) -> Run: ...
    @property
    def real(self) -> Run: ...


class Located(Protocol):
    """A spectrum whose rate is enclosed between decimals."""

    @property
    def rate(self) -> Any: ...


def responses(run: Run, ax: Any = None, *, envelope: Bounds | None = None) -> Any:
    """Draw the outputs of a trajectory with their set-points, and the inputs beside them.

    Parameters
    ----------
    run : Trajectory
    ax : two axes, optional
        For the outputs and the inputs; by default those of a new figure.
    envelope : Envelope, optional
        Proved bounds, drawn as dotted curves for up to four outputs and named as proved.

    Returns
    -------
    matplotlib.figure.Figure
    """
    upper, lower = several_axes(ax, 2)
    outputs, references = run.values("outputs"), run.values("reference")
    _draw_curves(upper, run, outputs, "outputs")
    # A set-point of 0 may belong to an output that nobody holds.
    nonzero = [(k, values) for k, values in enumerate(references.values()) if any(values)]
    if len(outputs) <= NAMED:
        for number, (k, values) in enumerate(nonzero):
            label = None if number else "set-points"
            _draw(upper, run, values, f"C{k}", label, linestyle="--", linewidth=1)
    if envelope is not None and len(outputs) <= _BOUNDED:
        _draw_bounds(upper, run, envelope)
    _draw_curves(lower, run, run.values("inputs"), "inputs")
    for axis in (upper, lower):
        finished(axis, across=elapsed_label(run.time), columns=4)
    return upper.figure


def real_responses(run: Beside, ax: Any = None) -> Any:
    """Draw the outputs and the inputs of the real loop, and those of the ideal one dashed.

    Parameters
    ----------
    run : RealRun
    ax : two axes, optional
        For the outputs and the inputs; by default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure
    """
    times = list(map(to_float, run.times))
    for axis, kind in zip(several_axes(ax, 2), ("outputs", "inputs"), strict=True):
        real, ideal = run.real.values(kind), run.ideal.values(kind)
        named = len(real) <= NAMED
        # Inputs are held between samples, but not those of an ideal loop in continuous time.
        style = "steps-post" if kind == "inputs" else "default"
        ideally = "steps-post" if is_discrete(run.ideal.time) and kind == "inputs" else "default"
        for k, (name, values) in enumerate(real.items()):
            color, label = f"C{k % 10}", plain_label(name) if named else None
            axis.plot(times, values, color=color, linewidth=1.4, label=label, drawstyle=style)
            beside = {"color": color, "linewidth": 1, "linestyle": "--", "drawstyle": ideally}
            axis.plot(times, ideal[name], label=None if k else "ideal loop", **beside)
        what = kind if named else f"{len(real)} {kind}"
        axis.set_title(f"{what} of the real loop", fontsize="medium")
        axis.margins(x=0)
        axis.grid(visible=True, alpha=0.3)
        figure = finished(axis, across=run.unit, columns=4)
    return figure


def _draw_curves(axis: Any, run: Run, curves: Mapping[str, list[float]], what: str) -> None:
    """Curves with names, if there are few."""
    named = len(curves) <= NAMED
    for k, (name, values) in enumerate(curves.items()):
        _draw(axis, run, values, f"C{k % 10}", plain_label(name) if named else None)
    axis.set_title(what if named else f"{len(curves)} {what}", fontsize="medium")
    axis.margins(x=0)
    axis.grid(visible=True, alpha=0.3)


def _draw(
    axis: Any, run: Run, values: Sequence[float], color: str, label: str | None, **style: Any
) -> None:
    discrete = is_discrete(run.time)
    marked = discrete and len(run.times) <= _MARKED and "linestyle" not in style
    axis.plot(
        list(map(to_float, run.times)),
        [value if math.isfinite(value) else math.nan for value in values],
        color=color,
        label=label,
        marker="." if marked else "",
        drawstyle="steps-post" if discrete else "default",
        **{"linewidth": 1.4, **style},
    )


def _draw_bounds(axis: Any, run: Run, envelope: Bounds) -> None:
    """Curves between which the exact outputs are proved to stay; the picture keeps its limits."""
    low, high = axis.get_ylim()
    # Bounds that are much wider than the curves would make these flat.
    low, high = low - 0.15 * (high - low), high + 0.15 * (high - low)
    shrinking = [Fraction(d) for d in envelope.decay(run.times)]
    seen = False
    for k, (rest, size) in enumerate(envelope.outputs):
        above = [float_above(rest + size * d) for d in shrinking]
        for values in (above, [float_below(rest - size * d) for d in shrinking]):
            if any(low <= value <= high for value in values):
                label = None if seen else "proved bounds"
                _draw(axis, run, values, f"C{k}", label, linestyle=":", linewidth=1)
                seen = True
    axis.set_ylim(low, high)


def has_bounds(run: Run, envelope: Bounds | None) -> bool:
    """Whether the picture of the responses shows proved bounds."""
    return envelope is not None and 0 < len(run.values("outputs")) <= _BOUNDED


def decay(
    run: Run,
    ax: Any = None,
    *,
    spectrum: Located | None = None,
    envelope: Bounds | None = None,
    errors: bool = False,
) -> Any:
    """Draw the distance of the state from rest on a logarithmic axis, with its proved bounds.

    Parameters
    ----------
    run : Trajectory
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.
    spectrum : LoopSpectrum, optional
        Its certified rate is drawn as the slope of a dashed line; the line itself is no bound.
    envelope : Envelope, optional
        The proved bound on every entry of the state, and where the state rests; by default at 0.
    errors : bool
        Draw the estimation errors of the agents instead of the state.

    Returns
    -------
    matplotlib.figure.Figure
    """
    axis = one_axis(ax)
    rest = None if envelope is None else [to_float(each) for each, _ in envelope.state]
    away = rest is not None and any(rest)
    what = "distance of the state from rest" if away else "largest entry of the state"
    curves = {"largest entry of x": run.state_norms(rest)}
    if errors:
        what = "largest entry of the estimation errors"
        curves = {f"agent {name}": values for name, values in run.error_norms().items()}
    shown = [v for values in curves.values() for v in values if 0 < v < math.inf]
    for k, (name, values) in enumerate(curves.items()):
        visible = [value if value > 0 else math.nan for value in values]
        label = plain_label(name) if len(curves) <= NAMED else None
        _draw(axis, run, visible, f"C{k % 10}", label)
    times = list(map(to_float, run.times))
    if shown:
        axis.set_yscale("log")
        axis.set_ylim(min(shown) / 3, max(shown) * 3)
    if shown and spectrum is not None and spectrum.rate is not None:
        line = _slope(run.time, spectrum, times, list(curves.values()))
        label = f"slope of the certified {rate_text(run.time, spectrum)}"
        if line:
            axis.plot(times, line, "k--", linewidth=1, label=label)
    if shown and envelope is not None and not errors:
        largest = max((size for _, size in envelope.state), default=Fraction(0))
        bound = [float_above(largest * Fraction(d)) or math.nan for d in envelope.decay(run.times)]
        axis.plot(times, bound, color=GRAY, linewidth=1.4, label="proved bound")
        top = min(2 * float_above(largest), 1000 * max(shown))
        axis.set_ylim(top=max(3 * max(shown), top))
    axis.margins(x=0)
    axis.grid(visible=True, which="major", alpha=0.3)
    return finished(axis, what, elapsed_label(run.time))


def _slope(
    time: str, spectrum: Located, times: list[float], curves: list[list[float]]
) -> list[float]:
    """Draw the certified rate as a line from the highest point, except for a radius of 0."""
    tops = [
        max((v for v in values if v < math.inf), default=0.0)
        for values in zip(*curves, strict=True)
    ]
    top = max(tops)
    start = tops.index(top)
    speed = to_float(spectrum.rate.lower)
    if is_discrete(time):
        radius = to_float(spectrum.rate.upper)
        if radius <= 0:
            return []
        speed = -math.log(radius)
    elapsed = [t - times[start] for t in times]
    return [
        top * math.exp(-speed * t) if t >= 0 and abs(speed * t) < 600 else math.nan for t in elapsed
    ]


def rate_text(time: str, spectrum: Located) -> str:
    """The certified end of the enclosure of the rate, rounded to the safe side."""
    if spectrum.rate is None:
        return ""
    discrete = is_discrete(time)
    end = Fraction(spectrum.rate.upper if discrete else spectrum.rate.lower)
    return f"{StabilityRegion(time).word} {digits_outward(end, up=discrete)}"


# Pictures of a stable loop: eigenvalues, robustness, decay, effort or step responses.

_FRAGILE = 1 / 0.3


class LoopCurves(Protocol):
    """The curves of a stable loop that are drawn."""

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
    drawn = (poles, sensitivity, loop_decay, steps if curves.steps else effort)
    for draw, axis in zip(drawn, several_axes(ax, 4), strict=True):
        figure = draw(curves, axis)
    return figure


def _panel(ax: Any, title: str) -> Any:
    """Return the axes ``ax``, or new ones, with a title and a grid."""
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


def loop_decay(curves: LoopCurves, ax: Any = None) -> Any:
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
    """Draw the step response of every output; the first eight are named."""
    axis = _panel(ax, "Step responses")
    for k, (name, values) in enumerate(curves.steps):
        label = plain_label(name) if k < NAMED else None
        axis.plot(curves.times, values, label=label, drawstyle=_style(curves))
    axis.axhline(1.0, color=GRAY, linewidth=0.8)
    axis.set_xlim(left=0)
    caption = "output after a step of its set-point"
    return finished(axis, across=elapsed_label(curves.region.time), up=caption, columns=4)


def _style(curves: LoopCurves) -> str:
    return "steps-post" if curves.region.discrete else "default"
