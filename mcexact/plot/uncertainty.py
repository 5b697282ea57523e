"""How far data may be from their values: the proved part, where a plant fails, and both of many."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.errors import UsageError
from mcexact.exact.matrix import float_above, float_below
from mcexact.plot.canvas import BLUE, GRAY, RED, finished, one_axis

_RANGE = 1e6
"""The largest uncertainty of a picture of several plants, as a multiple of the smallest."""


def uncertainty(found: Any, ax: Any = None) -> Any:
    """Draw up to which uncertainty a property is proved, and within which a plant lacks it.

    Parameters
    ----------
    found : LargestUncertainty
        Or another object with ``lower``, ``upper``, ``relative`` and ``wanted``.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure

    Notes
    -----
    Blue: proved for every plant.  Gray: nothing is known.  Red: there is a plant that fails.  Where
    both ends are above 0 the scale is logarithmic.
    """
    axis = one_axis(ax, 5.4, 1.8)
    scale = 100 if found.relative else 1
    low = float_below(scale * found.lower)
    high = None if found.upper is None else float_above(scale * found.upper)
    ends = [end for end in (low, high) if end]
    right = 2 * max(ends, default=1.0)
    left = min(ends) / 4 if low and high else 0.0
    if low:
        axis.barh(0, low - left, left=left, height=0.5, color=BLUE, label="proved for every plant")
    if high is not None:
        axis.barh(0, high - low, left=low or left, height=0.5, color=GRAY, alpha=0.35, label="open")
        axis.barh(0, right - high, left=high, height=0.5, color=RED, label="a plant fails")
    if low and high:
        _plain_powers(axis)
    axis.set_xlim(left, right)
    axis.set_ylim(-0.35, 0.75)
    axis.set_yticks([])
    if ends:
        axis.legend(fontsize="small", frameon=False, ncols=3, loc="upper center")
    counted = "part of each entry, in %" if found.relative else "multiple of the radii"
    return finished(axis, found.wanted, counted)


def uncertainty_shares(found: Sequence[Any], ax: Any = None) -> Any:
    """Draw of which share of plants a property is proved, and refuted, against the uncertainty.

    Parameters
    ----------
    found : sequence of LargestUncertainty
        One for each plant, or other objects with ``lower``, ``upper``, ``relative`` and ``wanted``.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    UsageError
        If there are no plants, or they are asked about different properties or in other units.

    Notes
    -----
    Blue: proved for every plant within the radii.  Red: a plant within them fails.  Gray: neither.
    """
    if len({(each.relative, each.wanted) for each in found}) != 1:
        raise UsageError("expected plants, all with one property and in one unit", where="found")
    axis = one_axis(ax, 5.4, 3.6)
    scale = 100 if found[0].relative else 1
    lower = [float_below(scale * each.lower) for each in found]
    upper = [float_above(scale * each.upper) for each in found if each.upper is not None]
    ends = sorted({end for end in (*lower, *upper) if end})
    left, right = (max(ends[0] / 4, ends[-1] / _RANGE), 2 * ends[-1]) if ends else (0.1, 10.0)
    steps = [left, *(end for end in ends if end > left), right]
    proved = [100 * sum(end > x for end in lower) / len(found) for x in steps[:-1]]
    fails = [100 - 100 * sum(end <= x for end in upper) / len(found) for x in steps[:-1]]
    for low, high, color, alpha, label in (
        ([0.0] * len(proved), proved, BLUE, 1.0, "proved for every plant"),
        (proved, fails, GRAY, 0.35, "open"),
        (fails, [100.0] * len(fails), RED, 1.0, "a plant fails"),
    ):
        axis.stairs(high, steps, baseline=low, fill=True, color=color, alpha=alpha, label=label)
    _plain_powers(axis, () if right > 100 * left else (2.0, 5.0))
    axis.set_xlim(left, right)
    axis.set_ylim(0, 100)
    counted = "part of each entry, in %" if found[0].relative else "multiple of the radii"
    return finished(axis, found[0].wanted, counted, "plants, in %", columns=3)


def _plain_powers(axis: Any, between: tuple[float, ...] = (2.0, 5.0)) -> None:
    """A logarithmic scale whose powers of ten are written out, with so many numbers between."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    axis.set_xscale("log")
    for locate, tell, parts in (
        (axis.xaxis.set_major_locator, axis.xaxis.set_major_formatter, (1.0,)),
        (axis.xaxis.set_minor_locator, axis.xaxis.set_minor_formatter, between),
    ):
        locate(LogLocator(subs=parts))
        tell(FuncFormatter(lambda value, _: f"{value:g}"))
