"""The page of a controller: the verdict, its figures, and the certificates."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Protocol

from mcexact.answer.account import Account
from mcexact.report.account_page import AccountPage
from mcexact.report.picture import Picture, empty_figure
from mcexact.report.text import Table

_FRAGILE = 1 / 0.3


class LoopCurves(Protocol):
    """What the pictures show."""

    @property
    def discrete(self) -> bool: ...
    @property
    def frequencies(self) -> list[float]: ...
    @property
    def sensitivity(self) -> list[float]: ...
    @property
    def times(self) -> list[float]: ...
    @property
    def growth(self) -> list[float]: ...


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
    """Draw the complementary sensitivity at the plant's inputs, and the decay of the state."""
    figure = empty_figure(9.2, 3.8)
    left, right = figure.subplots(1, 2)
    _draw_sensitivity(left, curves)
    _draw_growth(right, curves)
    largest = max(curves.sensitivity, default=0.0)
    margin = "infinite" if not largest else f"{1 / largest:.3g}"
    return Picture(
        figure,
        "Robustness and decay",
        f"Left: the complementary sensitivity at all inputs of the plant together, at most "
        f"{largest:.3g}, so that the margin is {margin}; it should stay below the dashed line, "
        f"which is a margin of 0.3. Right: the largest norm of the plant's state over "
        f"{'steps' if curves.discrete else 'time'} from a start of norm 1, at most "
        f"{max(curves.growth, default=0.0):.3g}. Computed, not certified.",
    )


def _draw_sensitivity(axis: Any, curves: LoopCurves) -> None:
    unit = "radians per step" if curves.discrete else "radians per unit of time"
    axis.plot(curves.frequencies, curves.sensitivity, color="#1f4e79")
    axis.axhline(_FRAGILE, color="#b03a2e", linestyle="--", linewidth=1)
    axis.set_yscale("log")
    if not curves.discrete:
        axis.set_xscale("log")
    axis.set_xlabel(f"frequency, {unit}")
    axis.set_ylabel("largest singular value of T")
    axis.grid(visible=True, which="major", alpha=0.3)


def _draw_growth(axis: Any, curves: LoopCurves) -> None:
    axis.plot(curves.times, curves.growth, color="#1f4e79")
    axis.axhline(1.0, color="#888888", linewidth=0.8)
    axis.set_ylim(bottom=0)
    axis.set_xlabel("steps" if curves.discrete else "time")
    axis.set_ylabel("largest norm of the state")
    axis.grid(visible=True, which="major", alpha=0.3)
