"""The page of a controller: the verdict, its figures, and the certificates."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from mcexact.answer.account import Account
from mcexact.exact.rational import digits_outward
from mcexact.model.controller import Controller
from mcexact.plot.canvas import NAMED, PANEL, one_axis
from mcexact.plot.eigenvalues import circle_near
from mcexact.plot.loops import LoopCurves, decay, effort, poles, sensitivity, steps
from mcexact.report.answer_page import AnswerPage
from mcexact.report.figures import gains_pictures
from mcexact.report.picture import Picture
from mcexact.report.plant import shown_plant
from mcexact.report.text import Table


def loop_page(
    account: Account,
    install: str,
    said: Sequence[str],
    tables: Sequence[Table],
    curves: LoopCurves | None,
    controller: Controller,
) -> AnswerPage:
    """Return the contents of the page.

    Parameters
    ----------
    account : Account
    install : {"yes", "with care", "no"}
    said : sequence of str
        The verdict, warnings and notes.
    tables : sequence of Table
    curves : LoopCurves or None
        None if the loop is not stable, which leaves out their pictures.
    controller : Controller
    """
    system = account.given.system
    pictures = [*([] if curves is None else loop_pictures(curves)), *gains_pictures(controller)]
    return AnswerPage(
        title=system.name or "A closed loop",
        heading="A controller and its closed loop. Its figures are computed, not certified; the "
        "certificates prove where the eigenvalues lie.",
        good=install == "yes",
        answer=tuple(said),
        pictures=tuple(each.embedded() for each in pictures),
        tables=tuple(tables),
        plant=shown_plant(system),
    )


def loop_pictures(curves: LoopCurves) -> list[Picture]:
    """Draw the eigenvalues, the sensitivity, the decay, and the effort or the step responses."""
    drawn = [_eigenvalues(curves), _sensitivity(curves), _decay(curves)]
    return [*drawn, _steps(curves) if curves.steps else _effort(curves)]


def _picture(
    draw: Callable[[LoopCurves, Any], Any], curves: LoopCurves, title: str, told: str
) -> Picture:
    """A picture that two of fit beside each other."""
    figure = draw(curves, one_axis(None, *PANEL))
    return Picture(figure, title, f"{told} Computed, not certified.")


def _eigenvalues(curves: LoopCurves) -> Picture:
    count, within = len(curves.eigenvalues), sum(map(curves.keeps, curves.eigenvalues))
    many = f"The {count} eigenvalues" if count != 1 else "The eigenvalue"
    inside = "inside" if within == count else f"{within} of them inside"
    told = f"{many} of the loop, {inside} {' and '.join(_edges(curves))}."
    return _picture(poles, curves, "Eigenvalues", told)


def _edges(curves: LoopCurves) -> list[str]:
    """What bounds the region that was asked for, as it is drawn."""
    region = curves.region
    limits = region.limits
    if region.discrete:
        return [f"the dashed circle of radius {digits_outward(region.edge, up=True)}"]
    found = [f"the dashed line at {digits_outward(-region.edge, up=True)}"]
    if "damping" in limits:
        ratio = digits_outward(limits["damping"], up=False)
        found.append(f"the dashed lines of the damping ratio {ratio}")
    if "largest_modulus" in limits:
        circle = f"circle of radius {digits_outward(limits['largest_modulus'], up=True)}"
        near = circle_near(curves.eigenvalues, limits)
        found.append(f"the dashed {circle}" if near else f"the {circle}, beyond the picture")
    return found


def _sensitivity(curves: LoopCurves) -> Picture:
    largest = max(curves.sensitivity, default=0.0)
    margin = "infinite" if not largest else f"{1 / largest:.3g}"
    told = (
        "The complementary sensitivity T at all inputs of the plant together, at most "
        f"{largest:.3g}, so that the margin is {margin}. It should stay below the dashed line, "
        "which is a margin of 0.3."
    )
    return _picture(sensitivity, curves, "Robustness", told)


def _decay(curves: LoopCurves) -> Picture:
    told = (
        "The largest norm of the plant's state from a start of norm 1, at most "
        f"{max(curves.growth, default=0.0):.3g}."
    )
    return _picture(decay, curves, "Decay", told)


def _effort(curves: LoopCurves) -> Picture:
    told = (
        "The largest norm of all inputs from the same start, at most "
        f"{max(curves.effort, default=0.0):.3g}."
    )
    return _picture(effort, curves, "Effort", told)


def _steps(curves: LoopCurves) -> Picture:
    told = (
        "Each output after a unit step of its own set-point, at most "
        f"{max(max(each) for _, each in curves.steps):.3g}."
    )
    if len(curves.steps) > NAMED:
        told += f" Of {len(curves.steps)} outputs the first {NAMED} are named."
    return _picture(steps, curves, "Step responses", told)
