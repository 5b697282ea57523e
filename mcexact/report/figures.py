"""Pictures of trajectories, graphs and dimensions."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from mcexact.answer.account import Account
from mcexact.answer.evidence import LoopSpectrum
from mcexact.exact.matrix import to_float
from mcexact.exact.rational import digits_outward
from mcexact.model.controller import Controller
from mcexact.plot.canvas import PANEL, empty_figure, one_axis
from mcexact.plot.eigenvalues import eigenvalues
from mcexact.plot.graphs import MARKED, fixed_mode, gains, graph, graph_size, structure
from mcexact.plot.responses import decay, has_bounds, rate_text, real_responses, responses
from mcexact.report.html import Picture
from mcexact.simulation.envelope import Envelope, SimulatedLoop
from mcexact.simulation.real import RealRun
from mcexact.simulation.trajectory import Trajectory

# Pictures of trajectories with their proved bounds, and of the eigenvalues of a closed loop.


def simulation_pictures(done: SimulatedLoop) -> list[Picture]:
    """Draw the outputs, the inputs, the decay, and the eigenvalues if they are known."""
    spectrum, run, envelope = drawable(done.spectrum), done.run, done.envelope
    outputs, inputs = (one_axis(None, *PANEL) for _ in range(2))
    responses(run, [outputs, inputs], envelope=envelope)
    drawn = [
        Picture(outputs.figure, "Outputs", _outputs_in_words(run, envelope)),
        Picture(inputs.figure, "Inputs", _range_in_words(run, "inputs")),
        *decay_pictures(run, _at_rest(done, spectrum), "Decay", envelope),
    ]
    if spectrum is not None:
        drawn.append(spectrum_picture(spectrum, done.run.time, "Eigenvalues of the closed loop"))
    return [*drawn, *gains_pictures(run.loop.controller)]


def real_pictures(run: RealRun, done: SimulatedLoop) -> list[Picture]:
    """Draw outputs and inputs of the real loop beside the ideal one, and the eigenvalues.

    Parameters
    ----------
    run : RealRun
    done : SimulatedLoop
        The ideal loop.
    """
    outputs, inputs = (one_axis(None, *PANEL) for _ in range(2))
    real_responses(run, [outputs, inputs])
    beside = "Dashed: the ideal loop."
    words = [f"{_range_in_words(run.real, kind)} {beside}" for kind in ("outputs", "inputs")]
    drawn = [
        Picture(outputs.figure, "Outputs of the real loop", words[0]),
        Picture(inputs.figure, "Inputs of the real loop", words[1]),
    ]
    spectrum = drawable(done.spectrum)
    if spectrum is not None:
        title = "Eigenvalues of the ideal loop"
        drawn.append(spectrum_picture(spectrum, done.run.time, title))
    return [*drawn, *gains_pictures(run.ideal.loop.controller)]


def real_png(run: RealRun, title: str) -> bytes:
    """Draw the real loop beside the ideal one in one PNG image, always with the same bytes."""
    figure = empty_figure(9.2, 3.8)
    figure.suptitle(title, parse_math=False)
    real_responses(run, list(figure.subplots(1, 2).flat))
    return _png(figure)


def _png(figure: Any) -> bytes:
    image = io.BytesIO()
    figure.savefig(image, format="png", dpi=120, metadata={"Software": None})
    return image.getvalue()


def gains_pictures(controller: Controller) -> list[Picture]:
    """Draw the gains of a controller as a matrix, if it has some.

    Parameters
    ----------
    controller : Controller
    """
    largest = to_float(controller.largest_entry())
    if not largest:
        return []
    words = (
        f"Every entry of the agents' programs, the largest {largest:.3g}: rows are what is "
        "computed (u inputs, x shared states, z private states), columns what it is computed from "
        "(y outputs, r set-points). Red is positive, blue negative, white zero."
    )
    return [Picture(gains(controller), "Gains of the controller", words)]


def simulation_png(done: SimulatedLoop) -> bytes:
    """Draw the pictures of a simulation in one PNG image, always with the same bytes."""
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
    return _png(figure)


def _at_rest(done: SimulatedLoop, spectrum: LoopSpectrum | None) -> LoopSpectrum | None:
    """Return the spectrum if it says how the state decays: to 0, or to a point that is known."""
    known = done.envelope is not None or not done.run.drive.changes
    return spectrum if spectrum is not None and spectrum.stable and known else None


def drawable(spectrum: LoopSpectrum | None) -> LoopSpectrum | None:
    """Return the spectrum, or None if an eigenvalue exceeds the range of floats."""
    if spectrum is None:
        return None
    parts = (to_float(part) for disc in spectrum.discs for part in (disc.re, disc.im))
    return spectrum if all(map(math.isfinite, parts)) else None


def response_picture(run: Trajectory, title: str, envelope: Envelope | None = None) -> Picture:
    """Draw the outputs with set-points and proved bounds, and the inputs, in one picture.

    Parameters
    ----------
    run : Trajectory
    title : str
    envelope : Envelope, optional
        Proved bounds.
    """
    words = f"{_outputs_in_words(run, envelope)} {_range_in_words(run, 'inputs')}"
    return Picture(responses(run, envelope=envelope), title, words)


def _outputs_in_words(run: Trajectory, envelope: Envelope | None) -> str:
    """The content of the picture of the outputs, in words."""
    words = _range_in_words(run, "outputs")
    if any(map(any, run.values("reference").values())):
        words += " Dashed: set-points."
    if has_bounds(run, envelope):
        words += " Dotted: proved bounds on the exact outputs; the other curves are computed."
    return words


def _range_in_words(run: Trajectory, kind: str) -> str:
    """The range of a signal in words."""
    curves = run.values(kind)
    values = [v for each in curves.values() for v in each if math.isfinite(v)]
    if not values:
        return f"There are no {kind}."
    least, largest = f"{min(values):.3g}", f"{max(values):.3g}"
    if least == largest:
        each = f"The {kind} stay" if len(curves) > 1 else f"The {kind[:-1]} stays"
        return f"{each} at {least}."
    many = f"The {len(curves)} {kind} lie" if len(curves) > 1 else f"The {kind[:-1]} lies"
    return f"{many} between {least} and {largest}."


def spectrum_picture(spectrum: LoopSpectrum, time: str, title: str) -> Picture:
    """Draw the certified discs around all eigenvalues, and the stability region.

    Parameters
    ----------
    spectrum : LoopSpectrum
    time : {"continuous", "discrete"}
    title : str
    """
    figure = eigenvalues(spectrum, one_axis(None, *PANEL), time=time, title=title)
    places = ", ".join(_point(disc.re, disc.im) for disc in spectrum.discs[:20])
    places += ", …" if len(spectrum.discs) > 20 else ""
    largest = max((Fraction(disc.radius) for disc in spectrum.discs), default=Fraction(0))
    verdict = "all in the stability region" if spectrum.stable else "not all stable"
    sure = (
        f"in a certified disc of radius at most {digits_outward(largest, up=True, digits=2)}"
        if largest
        else "known exactly"
    )
    words = (
        f"{len(spectrum.discs)} distinct eigenvalues, {verdict} (gray): {places}; each is {sure}."
    )
    return Picture(figure, title, words)


def _point(re: str, im: str) -> str:
    """A complex number in four digits."""
    real, imaginary = to_float(re), to_float(im)
    return f"{real:.4g}" if imaginary == 0 else f"{real:.4g}{imaginary:+.4g}i"


def decay_pictures(
    run: Trajectory,
    spectrum: LoopSpectrum | None,
    title: str,
    envelope: Envelope | None = None,
) -> list[Picture]:
    """Draw the state, and the agents' errors if they have estimates, against the certified rate.

    Parameters
    ----------
    run : Trajectory
    spectrum : LoopSpectrum, optional
        The spectrum whose rate is drawn as a line.
    title : str
    envelope : Envelope, optional
        Proved bounds.
    """
    norms, line = run.state_norms(), ""
    if spectrum is not None and spectrum.rate is not None:
        line = f" The dashed line has the certified {rate_text(run.time, spectrum)}."
    words = f"The state goes from {norms[0]:.3g} to {norms[-1]:.3g}.{line}"
    if envelope is not None:
        words += " The gray curve is a proved bound on every entry of the exact state."
    figure = decay(run, one_axis(None, *PANEL), spectrum=spectrum, envelope=envelope)
    drawn = [Picture(figure, title, words)]
    errors = run.error_norms()
    if errors:
        last = max(values[-1] for values in errors.values())
        figure = decay(run, one_axis(None, *PANEL), spectrum=spectrum, errors=True)
        words = f"The largest estimation error ends at {last:.3g}.{line}"
        drawn.append(Picture(figure, f"{title} of the estimation errors", words))
    return drawn


# Pictures of the dimensions that agents share, beside the bound of the paper.

LEAST = {
    "outputs+states": "minimal_shared_dimensions_outputs_states",
    "states": "minimal_shared_dimensions_states",
}
"""The question about each way of sharing."""
_BOUNDS = {
    "outputs+states": "shared_dimension_bound_outputs_states",
    "states": "shared_dimension_bound_states",
}
_SHARING = ("sufficient to share", "least to share")
_NAMED = 12
"""The largest number of agents whose names stand upright below their bars."""


def dimensions_picture(account: Account) -> Picture:
    """Draw bars for every agent: the least dimensions for each way of sharing, and the bound.

    Parameters
    ----------
    account : Account
        An account with the least dimensions for some way of sharing.
    """
    names, sentences, answers = account.given.names, account.sentences, account.answers
    least = {share: answers[name] for share, name in LEAST.items() if name in answers}
    lines = [each for each in sentences.at("table") if each.template.label in _SHARING]
    read = {file for each in lines for file, *_ in each.because}
    holds = any(file.startswith("shared_dimension_bound") for file in read)
    figure = empty_figure(4.4 * len(least), 3.2)
    for axis, (share, answer) in zip(
        figure.subplots(1, len(least), squeeze=False)[0], least.items(), strict=True
    ):
        sizes = (0,) * len(names) if answer.dimensions is None else answer.dimensions
        bound = answers[_BOUNDS[share]].deficiency if holds else None
        _draw_bars(axis, names, sizes, bound, share, _of_bars(answer))
    caption = "; ".join(each.line for each in lines) + "."
    return Picture(figure, "".join(sentences.at("dimensions.title")), caption)


def allocation_picture(account: Account) -> Picture:
    """Draw bars for every agent: the least dimensions, and the bound if its hypotheses hold.

    Parameters
    ----------
    account : Account
        An account as `account_of_dimensions` returns it, with dimensions that suffice.
    """
    least, sentences = account.answers["minimal_shared_dimensions"], account.sentences
    compared = any(each.template.key == "allocate-total-bound" for each in sentences.at("table"))
    bound = account.answers["shared_dimension_bound"].deficiency if compared else None
    names = account.given.names
    figure = empty_figure(max(4.4, min(1.5 + 0.3 * len(names), 9.0)), 3.2)
    label = _of_bars(least)
    _draw_bars(figure.subplots(), names, least.dimensions, bound, least.share, label)
    words = f"The {label} dimension that each agent shares."
    return Picture(
        figure, "Dimensions", words + (" Gray: the bound of the paper." if compared else "")
    )


def _of_bars(answer: Any) -> str:
    """What the bars of dimensions are: proved to be the least, or only to suffice."""
    return "least" if answer.at_least is None else "sufficient"


def _draw_bars(
    axis: Any,
    names: Sequence[str],
    sizes: Sequence[int],
    bound: int | None,
    title: str,
    label: str,
) -> None:
    """A bar for each agent, beside a gray one for the bound."""
    places = range(len(names))
    if bound is not None:
        axis.bar(
            [k - 0.2 for k in places],
            [bound] * len(names),
            0.4,
            color="#bbbbbb",
            label="bound of the paper",
        )
    axis.bar([k + 0.2 for k in places], sizes, 0.4, color=MARKED, label=label)
    turned = 90 if len(names) > _NAMED or max(map(len, names)) > _NAMED else 0
    axis.set_xticks(list(places), names, parse_math=False, rotation=turned)
    axis.set_yticks(range(max(bound or 0, *sizes, 1) + 1))
    axis.set_xlabel("agent")
    axis.set_ylabel("shared dimension")
    axis.set_title(title, fontsize="medium")
    axis.legend(fontsize="small", loc="upper center")
    axis.margins(y=0.35)


# Pictures of a fixed mode, of the neighbor graph and the transfer graph, and of links to add.

_REMOVE = "links", "links-beside-graph"


def mode_picture(account: Account) -> Picture:
    """Draw the first fixed mode between the channels that lack it, and the links that would help.

    Parameters
    ----------
    account : Account
        An account with a fixed mode.
    """
    sentences, answers = account.sentences, account.answers
    links = [each for each in sentences.at("answer") if each.template.key in _REMOVE]
    added = answers["minimal_communication"].added if links else ()
    words = sentences.at("answer.mode")[:1] + links
    figure = fixed_mode(answers["fixed_spectrum"], links=added)
    return Picture(figure, "".join(sentences.at("mode.title")), " ".join(words))


_NEIGHBORS, _TRANSFER = "picture-neighbor-graph", "picture-transfer-graph"


def graph_pictures(account: Account) -> list[Picture]:
    """Draw the neighbor graph, if there is one, and the transfer graph, one picture for each.

    Parameters
    ----------
    account : Account
        An account with the transfer graph and the fixed spectrum; see `structure`.
    """
    system, sentences, answers = account.given.system, account.sentences, account.answers
    panels = [_NEIGHBORS, _TRANSFER] if system.neighbors is not None else [_TRANSFER]
    axes = [one_axis(None, *graph_size(system.m)) for _ in panels]
    structure(system, answers["fixed_spectrum"], answers["transfer_graph"], axes)
    title, captions = "".join(sentences.at("graphs.title")), sentences.at("graphs")
    pictures = []
    for panel, axis in zip(panels, axes, strict=True):
        others = {_NEIGHBORS, _TRANSFER} - {panel}
        words = [each for each in captions if each.template.key not in others]
        pictures.append(Picture(axis.figure, title, "; ".join(words) + "."))
    return pictures


def links_picture(account: Account) -> Picture:
    """Draw the neighbor graph with the links to add.

    Parameters
    ----------
    account : Account
        An account with links to add, as `account_of_links` returns it.
    """
    system, added = account.given.system, account.answers["minimal_communication"].added
    names, there = system.names, system.neighbors
    edges = [] if there is None else [(names[j], names[i]) for j, i in there.edges()]
    axis = one_axis(None, *graph_size(system.m))
    graph((names, [*edges, *added]), axis, added=added, title="neighbor graph")
    links = ", ".join(f"{start} → {end}" for start, end in added)
    words = f"Blue: the links to add, {links}." if added else "No links have to be added."
    return Picture(axis.figure, "Links", words)
