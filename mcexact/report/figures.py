"""Figures of a trajectory with the certified rate, and of the eigenvalues of a closed loop."""

from __future__ import annotations

import io
import math
from fractions import Fraction
from typing import Any

from mcexact.answer.loop_spectrum import LoopSpectrum
from mcexact.errors import MissingExtra
from mcexact.exact.floats import to_float
from mcexact.exact.location import StabilityRegion, is_discrete
from mcexact.report.trajectory import error_norms, state_norms
from mcexact.simulation.trajectory import Trajectory


def simulation_png(run: Trajectory, spectrum: LoopSpectrum | None, title: str = "") -> bytes:
    """Draw three panels: the state with the certified rate, the estimation errors, the spectrum.

    Parameters
    ----------
    run : Trajectory
    spectrum : LoopSpectrum, optional
        The spectrum of the whole loop.  Without it, or if it exceeds floats, the line of the rate
        and the third panel are left out.
    title : str

    Returns
    -------
    bytes
        A PNG image.
    """
    with MissingExtra.named("plot"):
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

    spectrum = _drawable(spectrum)
    errors = error_norms(run)
    panels = 1 + bool(errors) + (spectrum is not None)
    figure = Figure(figsize=(4.6 * panels, 4.0), layout="constrained")
    FigureCanvasAgg(figure)
    axes = list(figure.subplots(1, panels, squeeze=False)[0])
    if title:
        figure.suptitle(title)
    draw_decay(
        axes.pop(0), run, {"state": state_norms(run)}, spectrum, "largest entry of the state"
    )
    if errors:
        named = {f"agent {name}": values for name, values in errors.items()}
        draw_decay(axes.pop(0), run, named, spectrum, "largest entry of the estimation errors")
    if spectrum is not None:
        draw_eigenvalues(axes.pop(0), run.time, spectrum)
    image = io.BytesIO()
    figure.savefig(image, format="png", dpi=120, metadata={"Software": None})
    return image.getvalue()


def _drawable(spectrum: LoopSpectrum | None) -> LoopSpectrum | None:
    """Return the spectrum, or None if an eigenvalue exceeds the range of floats."""
    if spectrum is None:
        return None
    parts = (to_float(part) for disc in spectrum.discs for part in (disc.re, disc.im))
    return spectrum if all(map(math.isfinite, parts)) else None


def draw_decay(
    axis: Any,
    run: Trajectory,
    curves: dict[str, list[float]],
    spectrum: LoopSpectrum | None,
    label: str,
) -> None:
    """Draw norms on a logarithmic axis, with a line of the certified rate.

    Parameters
    ----------
    axis : matplotlib.axes.Axes
    run : Trajectory
    curves : dict of str to list of float
        Norms at the times of the run, keyed by the label in the legend.  Zeros, infinities and NaN
        leave gaps.
    spectrum : LoopSpectrum or None
        Its rate is drawn as a dashed line; None draws no line.
    label : str
        The title of the panel.
    """
    times = [to_float(t) for t in run.times]
    marker = "." if is_discrete(run.time) else ""
    shown = [value for values in curves.values() for value in values if 0 < value < float("inf")]
    for name, values in curves.items():
        visible = [value if 0 < value < float("inf") else float("nan") for value in values]
        axis.plot(times, visible, marker=marker, label=name)
    if spectrum is not None and shown:
        line = _slope(run.time, spectrum, times, list(curves.values()))
        floor = min(shown) / 10
        visible = [value if value >= floor else float("nan") for value in line]
        if line:
            label_of_line = f"slope of the certified {rate_text(run.time, spectrum)}"
            axis.plot(times, visible, "k--", linewidth=1, label=label_of_line)
    if shown:
        axis.set_yscale("log")
    axis.set_xlabel(elapsed_label(run.time))
    axis.set_title(label, fontsize="medium")
    axis.legend(fontsize="small")


def elapsed_label(time: str) -> str:
    """The label of the axis of times."""
    return "step" if is_discrete(time) else "time"


def _slope(
    time: str, spectrum: LoopSpectrum, times: list[float], curves: list[list[float]]
) -> list[float]:
    """Draw the certified rate as a line from the highest point, except for a radius of 0."""
    rate = spectrum.rate
    if rate is None:
        return []
    tops = [
        max((v for v in values if v < math.inf), default=0.0)
        for values in zip(*curves, strict=True)
    ]
    top = max(tops)
    start = tops.index(top)
    decay = to_float(rate.lower)
    if is_discrete(time):
        radius = to_float(rate.upper)
        if radius <= 0:
            return []
        decay = -math.log(radius)
    elapsed = [t - times[start] for t in times]
    return [
        top * math.exp(-decay * t) if t >= 0 and abs(decay * t) < 600 else math.nan for t in elapsed
    ]


def rate_text(time: str, spectrum: LoopSpectrum) -> str:
    """The certified end of the enclosure of the rate."""
    if spectrum.rate is None:
        return ""
    end = spectrum.rate.upper if is_discrete(time) else spectrum.rate.lower
    return f"{StabilityRegion(time).word} {to_float(end):.4g}"


def draw_eigenvalues(axis: Any, time: str, spectrum: LoopSpectrum) -> None:
    """Draw the eigenvalues, with the stability region in gray."""
    from matplotlib.patches import Circle

    re = [to_float(disc.re) for disc in spectrum.discs]
    im = [to_float(disc.im) for disc in spectrum.discs]
    if is_discrete(time):
        axis.add_patch(Circle((0, 0), 1, color="0.92", zorder=0))
        axis.set_aspect("equal")
        reach = 1.1 * max([1.0, *map(abs, re), *map(abs, im)])
        axis.set_xlim(-reach, reach)
        axis.set_ylim(-reach, reach)
    else:
        left = min([*re, -1.0]) * 1.2 - 0.5
        axis.axvspan(left, 0, color="0.92", zorder=0)
        axis.set_xlim(left, max([*re, 0.0]) + 0.1 * abs(left))
        axis.axvline(0, color="0.6", linewidth=0.8)
    reach = max([1.0, *map(abs, im)]) * 1.15
    axis.set_ylim(-reach, reach)
    for x, y, disc in zip(re, im, spectrum.discs, strict=True):
        axis.add_patch(Circle((x, y), to_float(disc.radius), color="C3", alpha=0.4))
    axis.plot(re, im, "x", color="C3", label="eigenvalue")
    enclosed = [
        (x, y) for x, y, disc in zip(re, im, spectrum.discs, strict=True) if Fraction(disc.radius)
    ]
    if enclosed:
        largest = max(to_float(disc.radius) for disc in spectrum.discs)
        axis.plot(
            *zip(*enclosed, strict=True),
            "o",
            markersize=11,
            markerfacecolor="none",
            color="C0",
            label=f"certified disc, radius below {largest:.0e}, enlarged",
        )
        axis.legend(fontsize="small", loc="best")
    axis.axhline(0, color="0.6", linewidth=0.8)
    axis.set_title("eigenvalues of the closed loop", fontsize="medium")
    axis.set_xlabel("real part")
    axis.set_ylabel("imaginary part")
