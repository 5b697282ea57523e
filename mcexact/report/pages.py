"""The pages of analyze, allocate and certify."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from mcexact.answer.account import Account
from mcexact.answer.several_parameters import Hypersurfaces
from mcexact.exact.rational import digits_outward
from mcexact.model.controller import Controller
from mcexact.plot.canvas import NAMED, PANEL, one_axis
from mcexact.plot.eigenvalues import circle_near
from mcexact.plot.margins import Margins, margin_bars, nyquist, step_picture
from mcexact.plot.parameters import hypersurfaces, parameter_modes
from mcexact.plot.responses import LoopCurves, effort, loop_decay, poles, sensitivity, steps
from mcexact.report.figures import (
    LEAST,
    allocation_picture,
    dimensions_picture,
    gains_pictures,
    graph_pictures,
    links_picture,
    mode_picture,
)
from mcexact.report.html import AnswerPage, Picture, shown_plant
from mcexact.report.text import Table, answer, parameter_tables, tables

# The pages that `mcexact analyze --html` and `mcexact allocate --html` write.

_SHARED = (
    "The least that the agents must share, with a proof that less does not suffice.",
    "The least dimensions",
)
_WITHIN = (
    "What suffices for the agents to share, with a proof of the cost below which nothing does.",
    "Dimensions that suffice",
)
_LINKS = (
    "The cheapest links to add, with a proof that cheaper ones do not suffice.",
    "The links to add",
)


def account_page(account: Account) -> AnswerPage:
    """Return the page of an analysis."""
    system, sentences = account.given.system, account.sentences
    first, *rest = tables(sentences)
    spectrum = account.answers.get("fixed_spectrum")
    return AnswerPage(
        title=system.name or "A multi-channel system",
        heading="".join(sentences.at("page")),
        good=spectrum is None or spectrum.stabilizable,
        answer=tuple(answer(sentences)),
        pictures=tuple(drawn.embedded() for drawn in _pictures(account)),
        tables=(replace(first, title="All answers"), *rest),
        plant=shown_plant(system),
    )


def _pictures(account: Account) -> list[Picture]:
    """Return pictures of the graphs, and of shared dimensions if these were asked about."""
    drawn = []
    known = account.answers.get("fixed_spectrum")
    if known is not None and known.factors and not account.given.system.parameters:
        drawn.append(mode_picture(account))
    if {"fixed_spectrum", "transfer_graph"} <= account.answers.keys():
        drawn += graph_pictures(account)
    if set(LEAST.values()) & account.answers.keys():
        drawn.append(dimensions_picture(account))
    return drawn


def allocation_page(account: Account) -> AnswerPage:
    """Return the page of the least dimensions, or of the links to add.

    Parameters
    ----------
    account : Account
        As `account_of_dimensions` or `account_of_links` returns it.
    """
    system, sentences = account.given.system, account.sentences
    linked = account.answers.get("minimal_communication")
    least = account.answers["minimal_shared_dimensions"] if linked is None else linked
    heading, title = _LINKS
    if linked is None:
        heading, title = _SHARED if least.at_least is None else _WITHIN
    drawn = []
    if least.feasible:
        drawn.append((allocation_picture if linked is None else links_picture)(account))
    first, *rest = tables(sentences)
    answers = [replace(first, title=title)] if first.rows else []
    words = sentences.at("title", *([] if first.rows else ["table.note"]))
    return AnswerPage(
        title=system.name or "A multi-channel system",
        heading=heading,
        good=least.feasible,
        answer=tuple(words),
        pictures=tuple(each.embedded() for each in drawn),
        tables=(*answers, *rest),
        plant=shown_plant(system),
    )


# The page of a controller: the verdict, its figures, and the certificates.


def loop_page(
    account: Account,
    install: str,
    words: Sequence[str],
    tables: Sequence[Table],
    curves: LoopCurves | None,
    controller: Controller,
    margins: Margins | None = None,
) -> AnswerPage:
    """Return the contents of the page.

    Parameters
    ----------
    account : Account
    install : {"yes", "with care", "no"}
    words : sequence of str
        The verdict, warnings and notes.
    tables : sequence of Table
    curves : LoopCurves or None
        None if the loop is not stable, which leaves out their pictures.
    controller : Controller
    margins : Performance, optional
        The disk margins of the loop, and its single loops.
    """
    system = account.given.system
    # What outputs do after steps of their set-points is drawn once, with its peaks if it has some.
    peaks = margins is not None and len(margins.steps) > 1
    pictures = [] if curves is None else loop_pictures(curves, peaks=peaks)
    pictures += [] if margins is None or not margins.bars else margin_pictures(margins)
    pictures += gains_pictures(controller)
    return AnswerPage(
        title=system.name or "A closed loop",
        heading="A controller and its closed loop. Certificates prove where the eigenvalues lie, "
        "what the first line says, and the rows of the first table; other figures are computed.",
        good=install == "yes",
        answer=tuple(words),
        pictures=tuple(each.embedded() for each in pictures),
        tables=tuple(tables),
        plant=shown_plant(system),
    )


def loop_pictures(curves: LoopCurves, *, peaks: bool = False) -> list[Picture]:
    """Draw the eigenvalues, the sensitivity, the decay, and the effort or the step responses.

    The effort is drawn in place of the step responses if these are drawn with their peaks.
    """
    drawn = [_eigenvalues(curves), _sensitivity(curves), _decay(curves)]
    return [*drawn, _steps(curves) if curves.steps and not peaks else _effort(curves)]


def margin_pictures(margins: Margins) -> list[Picture]:
    """Draw the disk margins, and the Nyquist curves of the weakest single loops."""
    bars = ", ".join(f"{name} {value:.3g}" for name, (value, _) in margins.bars.items())
    names = ", ".join(each.name for each in margins.loops)
    proved = "" if margins.margin is None else " No curve enters the disk, which is proved."
    return [
        Picture(
            margin_bars(margins),
            "Disk margins",
            f"The largest ones known: {bars}. Filled bars are proved.",
        ),
        Picture(
            nyquist(margins),
            "Nyquist curves",
            f"The loops opened at the {names}.{proved} The curves are computed, not certified.",
        ),
        *_step_pictures(margins),
    ]


def _step_pictures(performance: Margins) -> list[Picture]:
    """Draw the responses to steps, with the peaks that are proved."""
    drawn = list[Picture]()
    for title, found in performance.steps.items():
        proved = " Dashed lines are proved peaks." if any(step.peak for step in found) else ""
        names = ", ".join(step.name for step in found)
        figure = step_picture(found, title, performance.time, one_axis(None, *PANEL))
        words = f"The {names}.{proved} The curves are computed, not certified."
        drawn.append(Picture(figure, f"Peak of {title}", words))
    return drawn


def _picture(
    draw: Callable[[LoopCurves, Any], Any], curves: LoopCurves, title: str, words: str
) -> Picture:
    """A picture of half the width of a page."""
    figure = draw(curves, one_axis(None, *PANEL))
    return Picture(figure, title, f"{words} Computed, not certified.")


def _eigenvalues(curves: LoopCurves) -> Picture:
    count, within = len(curves.eigenvalues), sum(map(curves.keeps, curves.eigenvalues))
    many = f"The {count} distinct eigenvalues" if count != 1 else "The eigenvalue"
    inside = "inside" if within == count else f"{within} of them inside"
    words = f"{many} of the loop, {inside} {' and '.join(_edges(curves))}."
    return _picture(poles, curves, "Eigenvalues", words)


def _edges(curves: LoopCurves) -> list[str]:
    """The lines that bound the requested region, as they are drawn."""
    region = curves.region
    limits = region.limits
    if region.discrete:
        return [f"the dashed circle of radius {digits_outward(region.edge, up=True)}"]
    lines = [f"the dashed line at {digits_outward(-region.edge, up=True)}"]
    if "damping" in limits:
        ratio = digits_outward(limits["damping"], up=False)
        lines.append(f"the dashed lines of the damping ratio {ratio}")
    if "largest_modulus" in limits:
        circle = f"circle of radius {digits_outward(limits['largest_modulus'], up=True)}"
        near = circle_near(curves.eigenvalues, limits)
        lines.append(f"the dashed {circle}" if near else f"the {circle}, beyond the picture")
    return lines


def _sensitivity(curves: LoopCurves) -> Picture:
    largest = max(curves.sensitivity, default=0.0)
    margin = "infinite" if not largest else f"{1 / largest:.3g}"
    words = (
        "The complementary sensitivity T at all inputs of the plant together, at most "
        f"{largest:.3g}, so that the margin is {margin}. It should stay below the dashed line, "
        "which is a margin of 0.3."
    )
    return _picture(sensitivity, curves, "Robustness", words)


def _decay(curves: LoopCurves) -> Picture:
    words = (
        "The largest norm of the plant's state from a start of norm 1, at most "
        f"{max(curves.growth, default=0.0):.3g}."
    )
    return _picture(loop_decay, curves, "Decay", words)


def _effort(curves: LoopCurves) -> Picture:
    words = (
        "The largest norm of all inputs from the same start, at most "
        f"{max(curves.effort, default=0.0):.3g}."
    )
    return _picture(effort, curves, "Effort", words)


def _steps(curves: LoopCurves) -> Picture:
    words = (
        "Each output after a unit step of its own set-point, at most "
        f"{max(max(each) for _, each in curves.steps):.3g}."
    )
    if len(curves.steps) > NAMED:
        words += f" Of {len(curves.steps)} outputs the first {NAMED} are named."
    return _picture(steps, curves, "Step responses", words)


# The answers about a system with parameters: tables, a page, and LaTeX.


def parameter_page(account: Account) -> AnswerPage:
    """Return the page of an analysis for all values of parameters."""
    return AnswerPage(
        title=account.given.system.name or "A system with parameters",
        heading="".join(account.sentences.at("title")),
        good=None,
        answer=tuple(account.at("answer")),
        pictures=tuple(drawn.embedded() for drawn in _parameter_pictures(account)),
        tables=parameter_tables(account, whole=True),
        plant=shown_plant(account.given.system),
    )


def _parameter_pictures(account: Account) -> list[Picture]:
    """The modes against one parameter, or the hypersurfaces of two."""
    spectrum, words = account.answers.get("fixed_spectrum"), " ".join(account.at("answer")[:2])
    if spectrum is None:
        return []
    if not isinstance(spectrum, Hypersurfaces):
        return [Picture(parameter_modes(spectrum), "Modes against the parameter", words)]
    if len(account.given.system.parameters) == 2 and spectrum.hypersurfaces:
        return [Picture(hypersurfaces(spectrum), "Where another mode is fixed", words)]
    return []
