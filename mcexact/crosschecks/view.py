"""Floating-point verdicts beside exact ones, and where floating point was recorded to be wrong."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from mcexact.answer.mode_words import blame
from mcexact.crosschecks.gallery import Shown, shown_in
from mcexact.crosschecks.records import Libraries
from mcexact.crosschecks.table import CrossChecks
from mcexact.exact.rational import rounded, written
from mcexact.report.page import page
from mcexact.report.plant import shown_plant
from mcexact.report.text import Table

_WORDS = {True: "agree", False: "DISAGREE", None: "no answer"}


def crosscheck_view(found: CrossChecks) -> dict[str, Any]:
    """Every row, and a plant nearby that has a fixed mode."""
    near = found.nearest
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
        "fixed_mode_nearby": None
        if near is None
        else {
            "within": written(near.distance),
            "channels": list(near.channels),
            "plant": near.plant.to_dict(),
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
    near = found.nearest
    if near is not None:
        lines = (
            ("changes of entries, at most", _part(near.distance)),
            ("the mode that is fixed then", blame(near.channels, near.plant.names)),
        )
        tables.append(Table("a plant nearby with a fixed mode, decided exactly", (), lines))
    return tuple(tables)


def _part(distance: Fraction) -> str:
    """How far entries change, beside the largest ones."""
    return f"{rounded(distance)} times the largest entries of A, of all B_i and of all C_i"


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
