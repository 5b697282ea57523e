"""What became of questions: which took long, and which were not decided."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mcexact.analysis.analyze import Effort
    from mcexact.report.text import Table

_LONG = 10.0
"""The seconds from which on a question is listed with its time."""


def effort_tables(taken: Sequence[Effort]) -> tuple[Table, ...]:
    """A table of the questions that took long, or were not decided, if there are any."""
    from mcexact.report.text import Table

    rows = [
        (
            each.question.replace("_", " "),
            "–" if each.outcome == "left out" else f"{each.seconds:.1f}",
            f"{each.outcome}: {each.reason}" if each.reason else each.outcome,
        )
        for each in taken
        if each.seconds >= _LONG or each.outcome != "decided"
    ]
    left_out = any(each.outcome == "left out" for each in taken)
    note = "Decide a question that is left out by --also and its name." if left_out else ""
    columns = ("question", "seconds", "outcome")
    title = "questions that are open or took long"
    return (Table(title, columns, tuple(rows), note),) if rows else ()
