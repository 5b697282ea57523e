"""New figures without global state, and the axes to draw on."""

from __future__ import annotations

import io
from collections.abc import Iterable
from functools import cache
from typing import Any

from mcexact.errors import MissingExtra, UsageError
from mcexact.exact.roots import is_discrete

BLUE, RED, GRAY, LIGHT = "#1f4e79", "#b03a2e", "#888888", "#ebebeb"
ON_DARK, ON_LIGHT = "#fefefe", "#010101"
"""Inks on colors that stay as they are in the dark, where white and black change."""
PANEL = 4.4, 3.5
"""The size in inches of a picture of which two fit beside each other on a page."""
NAMED = 8
"""The largest number of curves that are named in a legend."""


@cache
def _figure_class() -> Any:
    """A figure that a notebook shows without pyplot."""
    with MissingExtra.named("plot"):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

    class ShownFigure(Figure):
        """A matplotlib figure with a picture for notebooks."""

        def __init__(self, *arguments: Any, **options: Any) -> None:
            super().__init__(*arguments, **options)
            FigureCanvasAgg(self)

        def _repr_png_(self) -> bytes:
            image = io.BytesIO()
            self.savefig(image, format="png", dpi=96, metadata={"Software": None})
            return image.getvalue()

    return ShownFigure


def empty_figure(width: float, height: float) -> Any:
    """Make a figure of a size in inches, with a white background and without global state.

    Raises
    ------
    MissingExtra
        If matplotlib is not installed.
    """
    return _figure_class()(figsize=(width, height), layout="constrained", facecolor="white")


def one_axis(ax: Any, width: float = 5.0, height: float = 3.8) -> Any:
    """Return the axes ``ax``, or those of a new figure."""
    return empty_figure(width, height).subplots() if ax is None else ax


def several_axes(ax: Any, count: int, width: float = 4.6, height: float = 3.6) -> list[Any]:
    """Return a list of the axes ``ax``, or those of a new figure side by side.

    Raises
    ------
    UsageError
        If ``ax`` has another number of axes than ``count``.
    """
    if ax is None:
        return list(empty_figure(width * count, height).subplots(1, count, squeeze=False)[0])
    axes = list(getattr(ax, "flat", ax) if isinstance(ax, Iterable) else [ax])
    if len(axes) != count:
        raise UsageError(f"expected {count} axes, found {len(axes)}", where="ax")
    return axes


def elapsed_label(time: str) -> str:
    """The label of the axis of times."""
    return "step" if is_discrete(time) else "time"


def finished(
    axis: Any, title: str = "", across: str = "", up: str = "", *, columns: int = 2
) -> Any:
    """Set the title, the labels and the legend of a picture, and return its figure.

    A legend that the axis already has stays; a new one stands below the axis.
    """
    if title:
        axis.set_title(title, fontsize="medium")
    if across:
        axis.set_xlabel(across)
    if up:
        axis.set_ylabel(up)
    if axis.get_legend() is None:
        legend_below(axis, columns)
    return axis.figure


def legend_below(axis: Any, columns: int = 2) -> None:
    """Put the legend of an axis below it, where it hides no data."""
    handles, labels = axis.get_legend_handles_labels()
    if handles:
        axis.legend(
            handles,
            labels,
            fontsize="small",
            frameon=False,
            ncols=min(columns, len(handles)),
            loc="upper center",
            bbox_to_anchor=(0.5, 0),
            # in sizes of its letters, so that it clears the label of a small axis, too
            borderaxespad=4,
        )


def cut(text: str, longest: int) -> str:
    """Cut the middle out of a long name, since names differ more often at their ends.

    Examples
    --------
    >>> cut("subsystem 1 of the grid", 12), cut("pump", 12)
    ('subsys… grid', 'pump')
    """
    if len(text) <= longest:
        return text
    half = (longest - 1) // 2
    return f"{text[: longest - 1 - half]}…{text[-half:]}"


def plain_label(text: str, longest: int = 24) -> str:
    """Shorten a name, and escape its dollar signs, which would start formulas."""
    return cut(text, longest).replace("$", r"\$")
