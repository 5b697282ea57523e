"""Modes against a parameter, hypersurfaces, and uncertainty from both sides.

`parameter_modes` and `hypersurfaces` draw exact answers about one and two parameters; curves are
computed in floating point.  `uncertainty` draws for one plant up to which radii a property is
proved and from which on some plant lacks it; `uncertainty_shares` does so for many plants.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from mcexact.errors import UsageError
from mcexact.exact.matrix import float_above, float_below, to_float
from mcexact.plot.canvas import BLUE, GRAY, NAMED, RED, finished, one_axis, plain_label

# Modes against a parameter with its exceptional values, and hypersurfaces of two parameters.

_STEPS = 201
_FINE = 301
_REACH = Fraction(3)
"""How far a parameter without a range is drawn on both sides of 0 or of its exceptional values."""


def parameter_modes(
    found: Any, ax: Any = None, *, span: tuple[Any, Any] | None = None, title: str | None = None
) -> Any:
    """Draw the real parts of all modes against a parameter, and mark what is fixed.

    Parameters
    ----------
    found : ParametricFixedSpectrum
        The modes of A are thin lines, those that are fixed for every value thick ones.  A real
        exceptional value is a dashed line, with a point for each mode that is fixed there.
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.
    span : pair of numbers, optional
        The values of the parameter to draw; by default its range, or what shows all real
        exceptional values.
    title : str, optional

    Returns
    -------
    matplotlib.figure.Figure
    """
    import numpy as np

    axis = one_axis(ax)
    [t] = found.about.parameters
    marks = [(float(disc.re), each) for each in found.exceptional for disc in each.real]
    low, high = _span(found.about.ranges[0] if span is None else span, [x for x, _ in marks])
    M, delta = found.about.A.reduced
    layers = [layer.to_numpy() for layer in M.matrices]
    below = _floats(delta)
    where = np.linspace(low, high, _STEPS)
    scale = np.polynomial.polynomial.polyval(where, below)
    tops = [sum(layer * x**k for k, layer in enumerate(layers)) for x in where]
    curves = np.full((_STEPS, M.nrows), np.nan)
    for k, (top, bottom) in enumerate(zip(tops, scale, strict=True)):
        if M.nrows and bottom:
            curves[k] = np.sort(np.linalg.eigvals(top / bottom).real)
    for column in curves.T:
        axis.plot(where, column, color=BLUE, linewidth=0.8)
    axis.plot([], [], color=BLUE, linewidth=0.8, label="modes of A")
    for k, p in enumerate(found.generic):
        label = "fixed for every value" if not k else None
        for column in _roots(p, where, scale).T:
            axis.plot(where, column, color=RED, linewidth=2.2, label=label)
            label = None
    for k, (x, each) in enumerate(marks):
        if low <= x <= high:
            axis.axvline(x, color=RED, linestyle="--", linewidth=0.9)
            modes = [
                value
                for mode in each.modes
                for value in _roots(mode.polynomial, np.array([x]), _at(below, x))[0]
            ]
            label = "fixed at this value" if not k else None
            axis.plot([x] * len(modes), modes, "o", color=RED, markersize=5, label=label)
    axis.axhline(0, color=GRAY, linewidth=0.6, zorder=0.5)
    axis.set_xlim(low, high)
    letter = plain_label(t)
    heading = f"fixed modes against {letter}" if title is None else title
    return finished(axis, heading, letter, "real part of the modes")


def hypersurfaces(
    found: Any,
    ax: Any = None,
    *,
    span: Mapping[str, tuple[Any, Any]] | None = None,
    title: str = "where another mode is fixed",
) -> Any:
    """Draw where polynomials in two parameters are 0, as curves.

    Parameters
    ----------
    found : ExceptionalHypersurfaces
    ax : matplotlib.axes.Axes, optional
        By default those of a new figure.
    span : mapping, optional
        For each parameter the least and the largest value to draw; by default its range.
    title : str

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    UsageError
        If there are not two parameters.
    """
    import numpy as np

    names = found.about.parameters
    if len(names) != 2:
        raise UsageError(
            f"expected two parameters, found {', '.join(names)}: give values to the others with "
            ".along({…}, [two of them])"
        )
    axis = one_axis(ax)
    ranges = dict(zip(names, found.about.ranges, strict=True)) | dict(span or {})
    # A curve on the edge of a range is drawn, too.
    first, second = (np.linspace(*_wider(_span(ranges[name], [])), _FINE) for name in names)
    across, up = np.meshgrid(first, second)
    for k, each in enumerate(found.hypersurfaces):
        color, style = _STYLES[k % len(_STYLES)]
        values = each.polynomial.values({names[0]: across, names[1]: up})
        axis.contour(across, up, values, levels=[0.0], colors=[color], linestyles=[style])
        if k < NAMED:
            label = plain_label(str(each), 40)
            axis.plot([], [], color=color, linestyle=style, label=label)
    axis.set_xlim(first[0], first[-1])
    axis.set_ylim(second[0], second[-1])
    return finished(axis, title, *map(plain_label, names))


_STYLES = [(color, style) for style in ("-", "--", ":") for color in (RED, BLUE, GRAY)]


def _span(bounds: Sequence[Any], marks: Sequence[float]) -> tuple[float, float]:
    """The values to draw: the range; where it has no end, some more than the exceptional values."""
    low, high = bounds
    inside = [*(float(end) for end in bounds if end is not None), *marks]
    reach = max([float(_REACH), *(x - min(inside) for x in inside)]) / 3 if inside else 3.0
    least, most = min(inside, default=0.0) - reach, max(inside, default=0.0) + reach
    return least if low is None else float(low), most if high is None else float(high)


def _wider(span: tuple[float, float]) -> tuple[float, float]:
    margin = 0.03 * (span[1] - span[0])
    return span[0] - margin, span[1] + margin


def _floats(p: Any) -> list[float]:
    """The coefficients of a polynomial, at least one."""
    return [to_float(c) for c in p.coefficients] or [0.0]


def _at(coefficients: Sequence[float], x: float) -> Any:
    """The value of a polynomial at one place, as an array."""
    import numpy as np

    return np.polynomial.polynomial.polyval(np.array([x]), coefficients)


def _roots(p: Sequence[Any], where: Any, scale: Any) -> Any:
    """The real parts of the roots in x of a polynomial at values of the parameter, divided."""
    import numpy as np

    parts = np.full((len(where), len(p) - 1), np.nan)
    values = [np.polynomial.polynomial.polyval(where, _floats(c)) for c in p]
    for k, coefficients in enumerate(zip(*values, strict=True)):
        if scale[k]:
            roots = np.polynomial.polynomial.polyroots(coefficients)
            parts[k] = np.sort(roots.real) / scale[k]
    return parts


# Uncertainty: the radii that are proved, and those at which some plant fails.

_RANGE = 1e6
"""The largest uncertainty of a picture of several plants, as a multiple of the smallest."""


def uncertainty(found: Any, ax: Any = None) -> Any:
    """Draw the uncertainty up to which a property is proved, and that at which a plant lacks it.

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
    """Draw the share of plants for which a property is proved, or fails, against the uncertainty.

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
    """A logarithmic scale whose powers of ten are written out, with these multiples between."""
    from matplotlib.ticker import FuncFormatter, LogLocator

    axis.set_xscale("log")
    for locate, tell, parts in (
        (axis.xaxis.set_major_locator, axis.xaxis.set_major_formatter, (1.0,)),
        (axis.xaxis.set_minor_locator, axis.xaxis.set_minor_formatter, between),
    ):
        locate(LogLocator(subs=parts))
        tell(FuncFormatter(lambda value, _: f"{value:g}"))
