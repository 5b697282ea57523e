"""Pictures of trajectories with what is proved of them, and of the eigenvalues of a closed loop."""

from __future__ import annotations

import io
import math

from mcexact.answer.loop_spectrum import LoopSpectrum
from mcexact.exact.floats import to_float
from mcexact.plot.canvas import empty_figure
from mcexact.plot.eigenvalues import eigenvalues
from mcexact.plot.responses import decay, has_bounds, rate_text, responses
from mcexact.report.picture import Picture
from mcexact.simulation.envelope import Envelope
from mcexact.simulation.run import SimulatedLoop
from mcexact.simulation.trajectory import Trajectory


def simulation_pictures(done: SimulatedLoop) -> list[Picture]:
    """Draw the responses, the decay, and the eigenvalues if they are known."""
    spectrum, run, envelope = drawable(done.spectrum), done.run, done.envelope
    drawn = [
        response_picture(run, "Outputs and inputs", envelope),
        decay_picture(run, _at_rest(done, spectrum), "Decay", envelope),
    ]
    if spectrum is not None:
        drawn.append(spectrum_picture(spectrum, done.run.time, "Eigenvalues of the closed loop"))
    return drawn


def simulation_png(done: SimulatedLoop) -> bytes:
    """Draw the same in one PNG image, always with the same bytes."""
    spectrum = drawable(done.spectrum)
    errors = bool(done.run.error_norms())
    panels = 3 + errors + (spectrum is not None)
    rows = 1 if panels <= 3 else 2
    figure = empty_figure(4.6 * math.ceil(panels / rows), 3.8 * rows)
    axes = list(figure.subplots(rows, math.ceil(panels / rows)).flat)
    figure.suptitle(done.title, parse_math=False)
    responses(done.run, axes[:2], envelope=done.envelope)
    decay(done.run, axes[2], spectrum=_at_rest(done, spectrum), envelope=done.envelope)
    if errors:
        decay(done.run, axes[3], spectrum=spectrum, errors=True)
    if spectrum is not None:
        eigenvalues(spectrum, axes[panels - 1], time=done.run.time)
    for axis in axes[panels:]:
        axis.remove()
    image = io.BytesIO()
    figure.savefig(image, format="png", dpi=120, metadata={"Software": None})
    return image.getvalue()


def _at_rest(done: SimulatedLoop, spectrum: LoopSpectrum | None) -> LoopSpectrum | None:
    """Return the spectrum if it says how the state decays: to 0, or to a point that is known."""
    return spectrum if done.envelope is not None or not done.run.drive.changes else None


def drawable(spectrum: LoopSpectrum | None) -> LoopSpectrum | None:
    """Return the spectrum, or None if an eigenvalue exceeds the range of floats."""
    if spectrum is None:
        return None
    parts = (to_float(part) for disc in spectrum.discs for part in (disc.re, disc.im))
    return spectrum if all(map(math.isfinite, parts)) else None


def response_picture(run: Trajectory, title: str, envelope: Envelope | None = None) -> Picture:
    """Draw the outputs with set-points and proved bounds, and the inputs.

    Parameters
    ----------
    run : Trajectory
    title : str
    envelope : Envelope, optional
        Proved bounds.
    """
    figure = responses(run, envelope=envelope)
    outputs, inputs = run.values("outputs"), run.values("inputs")
    words = []
    for what, curves in (("outputs", outputs), ("inputs", inputs)):
        values = [v for each in curves.values() for v in each if math.isfinite(v)]
        if values:
            least, largest = min(values), max(values)
            words.append(f"The {len(curves)} {what} lie between {least:.3g} and {largest:.3g}")
    if any(map(any, run.values("reference").values())):
        words.append("Dashed: set-points")
    if has_bounds(run, envelope):
        words.append("Dotted: proved bounds on the exact outputs; the other curves are computed")
    return Picture(figure, title, ". ".join(words) + ".")


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
    eigenvalues(spectrum, axis, time=time, title=title)
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


def decay_picture(
    run: Trajectory,
    spectrum: LoopSpectrum | None,
    title: str,
    envelope: Envelope | None = None,
) -> Picture:
    """Draw the state and the agents' errors on a log axis against the certified rate.

    Parameters
    ----------
    run : Trajectory
    spectrum : LoopSpectrum, optional
        Whose rate is drawn as a line.
    title : str
    envelope : Envelope, optional
        Proved bounds.
    """
    errors = run.error_norms()
    panels = 1 + bool(errors)
    figure = empty_figure(4.6 * panels, 3.7)
    axes = list(figure.subplots(1, panels, squeeze=False)[0])
    norms = run.state_norms()
    decay(run, axes[0], spectrum=spectrum, envelope=envelope)
    if errors:
        decay(run, axes[1], spectrum=spectrum, errors=True)
    words = f"The state goes from {norms[0]:.2e} to {norms[-1]:.2e}"
    if errors:
        last = max(values[-1] for values in errors.values())
        words += f", the largest estimation error ends at {last:.2e}"
    if spectrum is not None and spectrum.rate is not None:
        words += f"; the dashed line has the certified {rate_text(run.time, spectrum)}"
    if envelope is not None:
        words += "; the gray curve is a proved bound on every entry of the exact state"
    return Picture(figure, title, words + ".")
