"""Closed loops in pictures: certified discs, decay beside the rate, set-points, delays."""

from __future__ import annotations

from collections.abc import Sequence

from mcexact.answer.loop_spectrum import LoopSpectrum
from mcexact.exact.floats import to_float
from mcexact.report.figures import draw_decay, draw_eigenvalues, elapsed_label, rate_text
from mcexact.report.picture import Picture, empty_figure
from mcexact.report.trajectory import error_norms, state_norms
from mcexact.simulation.trajectory import Trajectory


def spectrum_picture(spectrum: LoopSpectrum, time: str, title: str) -> Picture:
    """Draw the certified discs around all eigenvalues, and the stability region.

    Parameters
    ----------
    spectrum : LoopSpectrum
    time : {"continuous", "discrete"}
    title : str
    """
    figure = empty_figure(5.0, 3.8)
    axis = figure.subplots()
    draw_eigenvalues(axis, time, spectrum)
    axis.set_title(title, fontsize="medium")
    told = ", ".join(_point(disc.re, disc.im) for disc in spectrum.discs[:20])
    told += ", …" if len(spectrum.discs) > 20 else ""
    largest = max((to_float(disc.radius) for disc in spectrum.discs), default=0.0)
    verdict = "all in the stability region" if spectrum.stable else "not all stable"
    sure = f"in a certified disc of radius at most {largest:.1e}" if largest else "known exactly"
    words = f"{len(spectrum.discs)} distinct eigenvalues, {verdict} (gray): {told}; each is {sure}."
    return Picture(figure, title, words)


def _point(re: str, im: str) -> str:
    """A complex number in four digits."""
    real, imaginary = to_float(re), to_float(im)
    return f"{real:.4g}" if imaginary == 0 else f"{real:.4g}{imaginary:+.4g}i"


def decay_picture(run: Trajectory, spectrum: LoopSpectrum | None, title: str) -> Picture:
    """Draw the state and the agents' errors on a log axis against the certified rate.

    Parameters
    ----------
    run : Trajectory
    spectrum : LoopSpectrum, optional
        Whose rate is drawn as a line.
    title : str
    """
    errors = error_norms(run)
    panels = 1 + bool(errors)
    figure = empty_figure(4.6 * panels, 3.7)
    axes = list(figure.subplots(1, panels, squeeze=False)[0])
    norms = state_norms(run)
    draw_decay(axes[0], run, {"state": norms}, spectrum, "largest entry of the state")
    if errors:
        named = {f"agent {name}": values for name, values in errors.items()}
        draw_decay(axes[1], run, named, spectrum, "largest entry of the estimation errors")
    words = f"The state goes from {norms[0]:.2e} to {norms[-1]:.2e}"
    if errors:
        last = max(values[-1] for values in errors.values())
        words += f", the largest estimation error ends at {last:.2e}"
    if spectrum is not None and spectrum.rate is not None:
        words += f"; the dashed line has the certified {rate_text(run.time, spectrum)}"
    return Picture(figure, title, words + ".")


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
        norms = state_norms(run)
        axis.plot([to_float(t) for t in run.times], norms, marker=".", label=f"delay {delay}")
        rest = next((k for k, value in enumerate(norms) if value == 0), None)
        ends = f"exactly 0 from step {rest}" if rest is not None else f"ends at {norms[-1]:.1e}"
        words.append(f"delay {delay}: largest {max(norms):.1e}, {ends}")
    least = min(v for _, run in runs for v in state_norms(run) if v > 0)
    # Linear around 0, so that a state that has come to rest is seen.
    axis.set_yscale("symlog", linthresh=least, linscale=0.4)
    axis.set_ylim(bottom=0)
    axis.set_xlabel("step")
    axis.set_title("largest entry of the state", fontsize="medium")
    axis.legend(fontsize="small")
    return Picture(figure, "The effect of delays", "; ".join(words) + ".")


def setpoint_picture(
    run: Trajectory,
    outputs: Sequence[Sequence[float]],
    wanted: Sequence[float],
    names: Sequence[str],
) -> Picture:
    """Draw every output beside its set-point.

    Parameters
    ----------
    run : Trajectory
    outputs : sequence of sequences
        For every output its values at the run's times.
    wanted : sequence of float
        The set-points.
    names : sequence of str
        What to call the outputs.
    """
    figure = empty_figure(6.0, 3.7)
    axis = figure.subplots()
    words = []
    for k, (name, values) in enumerate(zip(names, outputs, strict=True)):
        axis.plot([to_float(t) for t in run.times], values, color=f"C{k}", label=name)
        axis.axhline(wanted[k], color=f"C{k}", linestyle="--", linewidth=1)
        words.append(f"{name} ends at {values[-1]:.6g}, its set-point is {wanted[k]:g}")
    axis.set_xlabel(elapsed_label(run.time))
    axis.set_title("outputs and their set-points (dashed)", fontsize="medium")
    axis.legend(fontsize="small")
    return Picture(figure, "Set-point responses", "; ".join(words) + ".")
