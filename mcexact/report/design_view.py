"""A design as a table for people and as plain data for programs."""

from __future__ import annotations

from typing import Any

from mcexact.report.text import Table, shorten
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
        ("agent with the channel controller", f"{design.agent}, of order {design.channel.order}"),
        ("states of all agents together", str(design.controller.order)),
        ("spectrum of A + sum B_i F_i", shorten(str(design.feedback.polynomial))),
        ("spectrum of the errors", shorten(str(design.error))),
        ("longest number", f"{design.height} bits"),
    )
    return (Table("distributed observer, closed loop certified", (), rows),)
