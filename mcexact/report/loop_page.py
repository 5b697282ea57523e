"""The page of a controller: the verdict, its figures, and the certificates."""

from __future__ import annotations

import cmath
from collections.abc import Sequence
from typing import Any, Protocol

from mcexact.answer.account import Account
from mcexact.report.account_page import AccountPage
from mcexact.report.picture import Picture, empty_figure
from mcexact.report.text import Table

_FRAGILE = 1 / 0.3
_BLUE, _RED, _GRAY = "#1f4e79", "#b03a2e", "#888888"
_TURN, _WIDE, _NAMED = 2 * cmath.pi, 100.0, 8


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
    pictures = [] if curves is None else [loop_picture(curves)]
    return AccountPage(
        title=system.name or "A closed loop",
        heading="A controller and its closed loop. Its figures are computed, not certified; the "
        "certificates prove where the eigenvalues lie.",
        good=install == "yes",
        answer=tuple(said),
        pictures=tuple(each.embedded() for each in pictures),
        tables=tuple(tables),
    )


def loop_picture(curves: LoopCurves) -> Picture:
    """Draw the eigenvalues, the sensitivity, the decay, and the effort or the step responses."""
    figure = empty_figure(9.2, 7.4)
    (poles, sensitivity), (decay, last) = figure.subplots(2, 2)
    _draw_eigenvalues(poles, curves)
    _draw_sensitivity(sensitivity, curves)
    _draw_over_time(decay, curves, curves.growth, "largest norm of the state")
    if curves.steps:
        _draw_steps(last, curves)
    else:
        _draw_over_time(last, curves, curves.effort, "largest norm of the inputs")
    return Picture(figure, "Eigenvalues, robustness and decay", _told(curves))


def _told(curves: LoopCurves) -> str:
    """What the pictures show, in words."""
    largest, count = max(curves.sensitivity, default=0.0), len(curves.eigenvalues)
    margin = "infinite" if not largest else f"{1 / largest:.3g}"
    beyond = "the dashed circle" if curves.discrete else "the dashed line"
    edge = f"{curves.edge:.4g}" if curves.discrete else f"{-curves.edge:.3g}"
    time = "steps" if curves.discrete else "time"
    last = (
        f"Bottom right: each output after a unit step of its own set-point, at most "
        f"{max(max(each) for _, each in curves.steps):.3g}."
        if curves.steps
        else f"Bottom right: the largest norm of all inputs from the same start, at most "
        f"{max(curves.effort, default=0.0):.3g}."
    )
    within = sum(map(curves.keeps, curves.eigenvalues))
    inside = "inside" if within == count else f"{within} of them inside"
    return (
        f"Top left: the {count} eigenvalues of the loop, {inside} {beyond} at {edge}. Top right: "
        "the complementary sensitivity at all inputs of the plant together, at most "
        f"{largest:.3g}, so that the margin is {margin}; it should stay below the dashed line, "
        "which is a margin of 0.3. Bottom left: the largest norm of the plant's state over "
        f"{time} from a start of norm 1, at most {max(curves.growth, default=0.0):.3g}. {last} "
        "Computed, not certified."
    )


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
        widest = max(map(abs, [*re, *im]), default=1.0)
        if widest > _WIDE * max(min(map(abs, curves.eigenvalues), default=1.0), 1e-300):
            # Slow eigenvalues would lie on one spot.
            threshold = min(abs(each) for each in curves.eigenvalues if each)
            axis.set_xscale("symlog", linthresh=threshold)
            axis.set_yscale("symlog", linthresh=threshold)
            axis.set_xlim(right=threshold / 2)
    axis.set_title("Eigenvalues", fontsize="medium")
    axis.set_xlabel("real part")
    axis.set_ylabel("imaginary part")
    axis.grid(visible=True, which="major", alpha=0.3)


def _draw_sensitivity(axis: Any, curves: LoopCurves) -> None:
    unit = "radians per step" if curves.discrete else "radians per unit of time"
    axis.plot(curves.frequencies, curves.sensitivity, color=_BLUE)
    axis.axhline(_FRAGILE, color=_RED, linestyle="--", linewidth=1)
    axis.set_yscale("log")
    if not curves.discrete:
        axis.set_xscale("log")
    axis.set_title("Robustness at the inputs", fontsize="medium")
    axis.set_xlabel(f"frequency, {unit}")
    axis.set_ylabel("largest singular value of T")
    axis.grid(visible=True, which="major", alpha=0.3)


def _draw_over_time(axis: Any, curves: LoopCurves, values: list[float], label: str) -> None:
    axis.plot(curves.times, values, color=_BLUE, drawstyle=_style(curves))
    axis.set_title("From a start of norm 1", fontsize="medium")
    axis.set_ylim(bottom=0)
    axis.set_xlim(left=0)
    axis.set_xlabel("steps" if curves.discrete else "time")
    axis.set_ylabel(label)
    axis.grid(visible=True, which="major", alpha=0.3)


def _draw_steps(axis: Any, curves: LoopCurves) -> None:
    """Outputs that step to their set-points; those beyond some are not named."""
    for k, (name, values) in enumerate(curves.steps):
        label = name if k < _NAMED else None
        axis.plot(curves.times, values, label=label, drawstyle=_style(curves))
    axis.axhline(1.0, color=_GRAY, linewidth=0.8)
    axis.set_xlim(left=0)
    axis.set_xlabel("steps" if curves.discrete else "time")
    axis.set_title("Step responses", fontsize="medium")
    axis.set_ylabel("output after a step of its set-point")
    axis.legend(fontsize="small")
    axis.grid(visible=True, which="major", alpha=0.3)


def _style(curves: LoopCurves) -> str:
    return "steps-post" if curves.discrete else "default"
