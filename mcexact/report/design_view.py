"""A design as a table for people and as plain data for programs."""

from __future__ import annotations

from typing import Any

from mcexact.answer.wording import design as say
from mcexact.report.text import Table
from mcexact.synthesis.observer import ObserverDesign


def observer_view(design: ObserverDesign) -> dict[str, Any]:
    """The summary of a distributed observer; a polynomial is its coefficients as strings."""
    return {
        "design": "observer",
        "agent": design.agent,
        "order": design.controller.order,
        "feedback_polynomial": [str(c) for c in design.feedback.polynomial.coefficients],
        "error_polynomial": [str(c) for c in design.error.coefficients],
        "bits_of_longest_number": design.height,
        "controller": design.controller.document(),
    }


def observer_tables(design: ObserverDesign) -> tuple[Table, ...]:
    """The summary of a distributed observer."""
    rows = (
        say.CARRIER.row(agent=design.agent, order=design.channel.order),
        say.ORDER.row(order=design.controller.order),
        say.FEEDBACK.row(p=design.feedback.polynomial),
        say.ERRORS.row(p=design.error),
        say.LONGEST.row(bits=design.height),
    )
    return (Table(say.OBSERVER(), (), rows),)
