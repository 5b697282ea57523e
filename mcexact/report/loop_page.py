"""The page of a controller: the verdict, its figures, and the certificates."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from typing import Any, Protocol

from mcexact.answer.account import Account
from mcexact.report.account_page import AccountPage
from mcexact.report.picture import Picture, empty_figure
from mcexact.report.text import Table

_FRAGILE = 1 / 0.3
_BLUE, _RED, _GRAY = "#1f4e79", "#b03a2e", "#888888"
_TURN, _WIDE, _POWERS, _NAMED = 2 * cmath.pi, 100.0, 3, 8


class LoopCurves(Protocol):
    """What the pictures show."""

    @property
    def discrete(self) -> bool: ...
    @property
    def edge(self) -> float: ...
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


def loop_page(
    account: Account,
    install: str,
    said: Sequence[str],
    tables: Sequence[Table],
    curves: LoopCurves | None,
) -> AccountPage:
    """Return the contents of the page.

    Parameters
    ----------
    account : Account
    install : {"yes", "with care", "no"}
    said : sequence of str
        The verdict, warnings and notes.
    tables : sequence of Table
    curves : LoopCurves or None
        None if the loop is not stable, which leaves out the picture.
    """
    system = account.given.system
    pictures = [] if curves is None else loop_pictures(curves)
    return AccountPage(
        title=system.name or "A closed loop",
        heading="A controller and its closed loop. Its figures are computed, not certified; the "
        "certificates prove where the eigenvalues lie.",
        good=install == "yes",
        answer=tuple(said),
        pictures=tuple(each.embedded() for each in pictures),
        tables=tuple(tables),
    )


def loop_pictures(curves: LoopCurves) -> list[Picture]:
    """Draw the eigenvalues, the sensitivity, the decay, and the effort or the step responses."""
    drawn = [_eigenvalues(curves), _sensitivity(curves), _decay(curves)]
    return [*drawn, _steps(curves) if curves.steps else _effort(curves)]


def _panel(title: str) -> tuple[Any, Any]:
    """A figure that two of fit beside each other, and its axis."""
    figure = empty_figure(4.4, 3.5)
    axis = figure.subplots()
    axis.set_title(title, fontsize="medium")
    axis.grid(visible=True, which="major", alpha=0.3)
    return figure, axis


def _picture(figure: Any, title: str, told: str) -> Picture:
    return Picture(figure, title, f"{told} Computed, not certified.")


def _eigenvalues(curves: LoopCurves) -> Picture:
    figure, axis = _panel("Eigenvalues")
    _draw_eigenvalues(axis, curves)
    count, within = len(curves.eigenvalues), sum(map(curves.keeps, curves.eigenvalues))
    many = f"The {count} eigenvalues" if count != 1 else "The eigenvalue"
    inside = "inside" if within == count else f"{within} of them inside"
    edge = f"{curves.edge:.4g}" if curves.discrete else f"{0.0 - curves.edge:.3g}"
    beyond = "the dashed circle of radius" if curves.discrete else "the dashed line at"
    return _picture(figure, "Eigenvalues", f"{many} of the loop, {inside} {beyond} {edge}.")


def _sensitivity(curves: LoopCurves) -> Picture:
    figure, axis = _panel("Robustness at the inputs")
    _draw_sensitivity(axis, curves)
    largest = max(curves.sensitivity, default=0.0)
    margin = "infinite" if not largest else f"{1 / largest:.3g}"
    told = (
        "The complementary sensitivity T at all inputs of the plant together, at most "
        f"{largest:.3g}, so that the margin is {margin}. It should stay below the dashed line, "
        "which is a margin of 0.3."
    )
    return _picture(figure, "Robustness", told)


def _decay(curves: LoopCurves) -> Picture:
    figure, axis = _panel("State, from a start of norm 1")
    _draw_over_time(axis, curves, curves.growth, "largest norm of the state")
    told = (
        "The largest norm of the plant's state from a start of norm 1, at most "
        f"{max(curves.growth, default=0.0):.3g}."
    )
    return _picture(figure, "Decay", told)


def _effort(curves: LoopCurves) -> Picture:
    figure, axis = _panel("Inputs, from a start of norm 1")
    _draw_over_time(axis, curves, curves.effort, "largest norm of the inputs")
    told = (
        "The largest norm of all inputs from the same start, at most "
        f"{max(curves.effort, default=0.0):.3g}."
    )
    return _picture(figure, "Effort", told)


def _steps(curves: LoopCurves) -> Picture:
    figure, axis = _panel("Step responses")
    _draw_steps(axis, curves)
    told = (
        "Each output after a unit step of its own set-point, at most "
        f"{max(max(each) for _, each in curves.steps):.3g}."
    )
    if len(curves.steps) > _NAMED:
        told += f" Of {len(curves.steps)} outputs the first {_NAMED} are named."
    return _picture(figure, "Step responses", told)


def _draw_eigenvalues(axis: Any, curves: LoopCurves) -> None:
    """Poles as crosses, and the border of what was asked for."""
    re = [each.real for each in curves.eigenvalues]
    im = [each.imag for each in curves.eigenvalues]
    axis.plot(re, im, linestyle="none", marker="x", color=_BLUE)
    if curves.discrete:
        for radius, color, style in ((1.0, _GRAY, "-"), (curves.edge, _RED, "--")):
            points = [complex(0, _TURN * k / 180) for k in range(181)]
            circle = [radius * cmath.exp(each) for each in points]
            x, y = [each.real for each in circle], [each.imag for each in circle]
            axis.plot(x, y, color=color, linestyle=style, linewidth=1)
        axis.set_aspect("equal", adjustable="datalim")
    else:
        axis.axvline(0.0, color=_GRAY, linewidth=0.8)
        axis.axvline(-curves.edge, color=_RED, linestyle="--", linewidth=1)
        sizes = [abs(each) for each in curves.eigenvalues if each]
        if sizes and max(sizes) > _WIDE * min(sizes):
            # Slow eigenvalues would lie on one spot.
            _both_ways_logarithmic(axis, min(sizes), max(sizes))
    axis.set_xlabel("real part")
    axis.set_ylabel("imaginary part")


def _both_ways_logarithmic(axis: Any, least: float, most: float) -> None:
    """Make both axes logarithmic on both sides of 0, linear up to the least modulus."""
    powers = range(math.ceil(math.log10(least)), math.floor(math.log10(most)) + 1)
    shown = [10.0**k for k in powers[:: -(-len(powers) // _POWERS) or 1]]
    ticks = [*(-each for each in reversed(shown)), 0.0, *shown]
    for scale in (axis.set_xscale, axis.set_yscale):
        scale("symlog", linthresh=least, linscale=0.6)
    for ticked in (axis.xaxis, axis.yaxis):
        ticked.set_ticks(ticks, [f"{each:g}" for each in ticks])
    axis.set_xlim(-2 * most, least)
    axis.set_ylim(-2 * most, 2 * most)


def _draw_sensitivity(axis: Any, curves: LoopCurves) -> None:
    unit = "radians per step" if curves.discrete else "radians per unit of time"
    axis.plot(curves.frequencies, curves.sensitivity, color=_BLUE)
    axis.axhline(_FRAGILE, color=_RED, linestyle="--", linewidth=1)
    axis.annotate(
        "margin 0.3", (0.02, _FRAGILE), (0, 2), xycoords=("axes fraction", "data"),
        textcoords="offset points", color=_RED, fontsize="small",
    )  # fmt: skip
    seen = [*curves.sensitivity, _FRAGILE]
    axis.set_ylim(max(min(seen), 1e-4 * max(seen)) / 1.3, 1.6 * max(seen))
    _logarithmic(axis.yaxis)
    if not curves.discrete:
        _logarithmic(axis.xaxis)
    axis.set_xlabel(f"frequency, {unit}")
    axis.set_ylabel("largest singular value of T")


def _logarithmic(axis: Any) -> None:
    """Make one axis logarithmic, with numbers and not with powers of ten where these are short."""
    from matplotlib.ticker import FuncFormatter, NullFormatter

    axis.axes.set(**{f"{axis.axis_name}scale": "log"})
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _draw_over_time(axis: Any, curves: LoopCurves, values: list[float], label: str) -> None:
    axis.plot(curves.times, values, color=_BLUE, drawstyle=_style(curves))
    axis.set_ylim(bottom=0)
    axis.set_xlim(left=0)
    axis.set_xlabel("steps" if curves.discrete else "time")
    axis.set_ylabel(label)


def _draw_steps(axis: Any, curves: LoopCurves) -> None:
    """Outputs that step to their set-points; those beyond some are not named."""
    for k, (name, values) in enumerate(curves.steps):
        label = name if k < _NAMED else None
        axis.plot(curves.times, values, label=label, drawstyle=_style(curves))
    axis.axhline(1.0, color=_GRAY, linewidth=0.8)
    axis.set_xlim(left=0)
    axis.set_xlabel("steps" if curves.discrete else "time")
    axis.set_ylabel("output after a step of its set-point")
    axis.legend(fontsize="small", title="output", title_fontsize="small")


def _style(curves: LoopCurves) -> str:
    return "steps-post" if curves.discrete else "default"
