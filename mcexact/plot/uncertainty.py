"""How far data may be from their values: the proved part, and where a plant fails."""

from __future__ import annotations

from typing import Any

from mcexact.exact.floats import to_float
from mcexact.plot.canvas import BLUE, GRAY, RED, finished, one_axis


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
    from matplotlib.ticker import FuncFormatter, LogLocator

    axis = one_axis(ax, 5.4, 1.8)
    scale = 100 if found.relative else 1
    low = scale * to_float(found.lower)
    high = None if found.upper is None else scale * to_float(found.upper)
    ends = [end for end in (low, high) if end]
    right = 2 * max(ends, default=1.0)
    left = min(ends) / 4 if low and high else 0.0
    if low:
        axis.barh(0, low - left, left=left, height=0.5, color=BLUE, label="proved for every plant")
    if high is not None:
        axis.barh(0, high - low, left=low or left, height=0.5, color=GRAY, alpha=0.35, label="open")
        axis.barh(0, right - high, left=high, height=0.5, color=RED, label="a plant fails")
    if low and high:
        axis.set_xscale("log")
        for locate, tell, parts in (
            (axis.xaxis.set_major_locator, axis.xaxis.set_major_formatter, (1.0,)),
            (axis.xaxis.set_minor_locator, axis.xaxis.set_minor_formatter, (2.0, 5.0)),
        ):
            locate(LogLocator(subs=parts))
            tell(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_xlim(left, right)
    axis.set_ylim(-0.35, 0.75)
    axis.set_yticks([])
    if ends:
        axis.legend(fontsize="small", frameon=False, ncols=3, loc="upper center")
    counted = "part of each entry, in %" if found.relative else "multiple of the radii"
    return finished(axis, found.wanted, counted)
