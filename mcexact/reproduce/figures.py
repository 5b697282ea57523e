"""A picture of the effect of delays."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.exact.matrix import to_float
from mcexact.plot.canvas import empty_figure
from mcexact.report.html import Picture
from mcexact.simulation.trajectory import Trajectory


def delays_picture(runs: Sequence[tuple[int, Trajectory]]) -> Picture:
    """Draw the state of the plant for several delays on the links.

    Parameters
    ----------
    runs : sequence of (delay, trajectory)
    """
    figure = empty_figure(6.0, 3.7)
    axis = figure.subplots()
    words = []
    for delay, run in runs:
        norms = run.state_norms()
        axis.plot([to_float(t) for t in run.times], norms, marker=".", label=f"delay {delay}")
        rest = next((k for k, value in enumerate(norms) if value == 0), None)
        ends = f"exactly 0 from step {rest}" if rest is not None else f"ends at {norms[-1]:.1e}"
        words.append(f"delay {delay}: largest {max(norms):.1e}, {ends}")
    least = min(v for _, run in runs for v in run.state_norms() if v > 0)
    # Linear around 0, so that a state that has come to rest is seen.
    axis.set_yscale("symlog", linthresh=least, linscale=0.4)
    axis.set_ylim(bottom=0)
    axis.set_xlabel("step")
    axis.set_title("largest entry of the state", fontsize="medium")
    axis.legend(fontsize="small")
    return Picture(figure, "The effect of delays", "; ".join(words) + ".")
