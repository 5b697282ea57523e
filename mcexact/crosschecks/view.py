"""Floating-point verdicts beside exact ones, and where floating point was recorded to be wrong."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from mcexact.crosschecks.gallery import Shown, shown_in
from mcexact.crosschecks.records import Libraries
from mcexact.crosschecks.table import CrossChecks
from mcexact.exact.floats import finite
from mcexact.report.page import page
from mcexact.report.plant import shown_plant
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
        "libraries": found.libraries.document(),
        "exhibits": exhibits_view(shown_in(found)),
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
            note=f"in floating point: {found.libraries}",
        )
    ]
    recorded = shown_in(found)
    if recorded:
        tables += exhibit_tables(recorded)
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


def exhibit_tables(shown: Sequence[Shown]) -> tuple[Table, ...]:
    """What was recorded, what this machine says and what is true; then the machines, and why."""
    machines = [("recorded", str(libraries)) for libraries in _recorded_by(shown)]
    machines += [("here", str(libraries)) for libraries in _answered_by(shown)]
    return (
        Table(
            "where floating point was recorded to be wrong",
            ("exhibit", "question", "recorded", "here", "exact"),
            tuple(
                (
                    each.exhibit.name,
                    each.here.question,
                    each.exhibit.record.floating,
                    each.here.floating,
                    each.here.exact,
                )
                for each in shown
            ),
        ),
        Table("what answered in floating point", (), tuple(machines)),
        Table("why it erred", (), tuple((each.exhibit.name, each.exhibit.why) for each in shown)),
    )


def exhibits_view(shown: Sequence[Shown]) -> list[dict[str, Any]]:
    """The exhibits as plain data."""
    return [
        {
            "exhibit": each.exhibit.name,
            "question": each.here.question,
            "call": each.here.call,
            "exact": each.here.exact,
            "recorded": {
                "floating": each.exhibit.record.floating,
                "libraries": each.exhibit.record.libraries.document(),
            },
            "here": {
                "floating": each.here.floating,
                "agree": each.here.agree,
                "libraries": each.libraries.document(),
            },
            "why": each.exhibit.why,
        }
        for each in shown
    ]


def exhibits_page(shown: Sequence[Shown]) -> str:
    """The exhibits as one page of HTML."""
    return page(
        "exhibits",
        title="Where floating point was recorded to be wrong",
        exhibits=[
            view | {"plant": shown_plant(each.exhibit.make())}
            for each, view in zip(shown, exhibits_view(shown), strict=True)
        ],
        recorded=[str(libraries) for libraries in _recorded_by(shown)],
        here=[str(libraries) for libraries in _answered_by(shown)],
    )


def _recorded_by(shown: Sequence[Shown]) -> list[Libraries]:
    """What answered where these exhibits were recorded, each once."""
    return list(dict.fromkeys(each.exhibit.record.libraries for each in shown))


def _answered_by(shown: Sequence[Shown]) -> list[Libraries]:
    """What answered on this machine, once."""
    return list(dict.fromkeys(each.libraries for each in shown))
