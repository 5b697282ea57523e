"""A floating-point design as a table and as plain data: what is proved, and what is measured."""

from __future__ import annotations

from math import isfinite
from typing import Any

from mcexact.answer.wording import design as say
from mcexact.exact.floats import matrix_to_float
from mcexact.floating.margins import LoopMargins, loop_margins
from mcexact.report.text import Table
from mcexact.synthesis.observer_float import FloatObserverDesign


def observer_float_view(design: FloatObserverDesign, margins: LoopMargins) -> dict[str, Any]:
    """The summary; what stands under ``floating_point`` is measured, not proved."""
    return {
        "design": "observer",
        "arithmetic": "float",
        "agent": design.agent,
        "order": design.controller.order,
        "certified_bound": str(design.region.bound),
        "bits_of_longest_number": design.height,
        "floating_point": {
            "gain_norms": design.gain_norms(),
            "spectral": finite(margins.spectral),
            "numerical": finite(margins.numerical),
            "distance_to_instability": finite(margins.distance_to_instability),
        },
        "controller": design.controller.document(),
    }


def observer_float_tables(design: FloatObserverDesign, margins: LoopMargins) -> tuple[Table, ...]:
    """The summary: one table of what is certified, one of what is measured."""
    proved = (
        say.CARRIER.row(agent=design.agent, order=design.order),
        say.ORDER.row(order=design.controller.order),
        say.REGION.row(region=design.region),
        say.LONGEST.row(bits=design.height),
    )
    what = "radius" if design.region.discrete else "abscissa"
    norms = ", ".join(f"{name} {norm:.3g}" for name, norm in design.gain_norms().items())
    measured = (
        ("norms of the gains", norms),
        (f"spectral {what}", f"{margins.spectral:.6g}"),
        (f"numerical {what}", f"{margins.numerical:.6g}"),
        ("distance to instability, at most", f"{margins.distance_to_instability:.3g}"),
    )
    return (
        Table(say.OBSERVER_FLOAT(), (), proved),
        Table(say.MEASURED(), (), measured),
    )


def finite(number: float) -> float | None:
    """The number; None for an infinity, which JSON does not have."""
    return number if isfinite(number) else None


def design_margins(design: FloatObserverDesign) -> LoopMargins:
    """The figures of the loop of a design."""
    return loop_margins(matrix_to_float(design.loop.matrix), design.loop.loop.time)
