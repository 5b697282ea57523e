"""The table of floating-point verdicts beside exact ones, as text and as plain data."""

from __future__ import annotations

from typing import Any

from mcexact.crosscheck.table import CrossChecks
from mcexact.report.observer_float_view import finite
from mcexact.report.text import Table

_WORDS = {True: "agree", False: "DISAGREE", None: "no answer"}


def crosscheck_view(found: CrossChecks) -> dict[str, Any]:
    """Every row, and the distance to a fixed mode, which is floating point and says so."""
    distance = found.distance
    return {
        "system": {"n": found.system.n, "m": found.system.m, "time": found.system.time},
        "rows": [
            {
                "question": row.question,
                "call": row.call,
                "floating": row.floating,
                "exact": row.exact,
                "agree": row.agree,
            }
            for row in found.rows
        ],
        "disagreements": [row.question for row in found.disagreements],
        "floating_point": {
            "distance_to_fixed_mode": None
            if distance is None
            else {
                "at_most": finite(distance.distance),
                "mode": {"re": distance.mode.real, "im": distance.mode.imag},
                "channels_that_could_act": list(found.system.named(distance.channels)),
                "changed": distance.changed,
            }
        },
    }


def crosscheck_tables(found: CrossChecks) -> tuple[Table, ...]:
    """One row for each question, then how near the system is to having a fixed mode."""
    rows = tuple(
        (row.question, row.floating, row.exact, _WORDS[row.agree], row.call) for row in found.rows
    )
    count = len(found.disagreements)
    said = "no disagreement" if not count else f"{count} wrong in floating point"
    tables = [
        Table(
            f"{found.system.name or 'system'}: floating point beside exact, {said}",
            ("question", "floating point", "exact", "", "floating-point call, default tolerance"),
            rows,
        )
    ]
    distance = found.distance
    if distance is not None:
        names = ", ".join(found.system.named(distance.channels)) or "none"
        mode = f"{distance.mode.real:.6g}"
        if distance.mode.imag:
            mode += f" ± {abs(distance.mode.imag):.6g}i"
        changed = (
            "A and the outputs of the other channels"
            if distance.changed == "outputs"
            else "A and the inputs of these channels"
        )
        lines = (
            ("the mode", mode),
            ("channels that could act on it", names),
            ("distance, at most", f"{distance.distance:.3g}, by changing {changed}"),
        )
        title = "distance to having a fixed mode, in floating point, not proved"
        tables.append(Table(title, (), lines))
    return tuple(tables)
