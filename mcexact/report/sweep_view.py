"""The display of a sweep: one row for each system, and counts."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

from mcexact.answer.formats import count, cut
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import polynomial
from mcexact.model.properties import PROPERTIES
from mcexact.report.answer_page import AnswerPage
from mcexact.report.text import Table, shorten
from mcexact.report.tolerances import pictures, tolerance_tables, tolerances

_MOST_ROWS, _MOST_ON_A_PAGE = 60, 5000
_MOST_SKIPPED = 20
_NOT_STABILIZABLE = "not stabilizable: by no linear time-invariant decentralized controller"

Document = Mapping[str, Any]


def sweep_view(
    documents: Sequence[Document],
    questions: Sequence[str],
    skipped: Sequence[tuple[str, str]] = (),
) -> dict[str, Any]:
    """Return counts, all records, and the skipped files with reasons, as plain data.

    Where plants were asked about within parts of their entries, ``tolerances`` has the numbers of
    plants by question and part.
    """
    return {
        "counts": counts(documents),
        "tolerances": tolerances(documents, questions),
        "records": list(documents),
        "skipped": [{"name": name, "reason": reason} for name, reason in skipped],
    }


def skipped_table(skipped: Sequence[tuple[str, str]]) -> Table:
    """Return the table of files in folders that are not system files, with reasons."""
    shown = [(shorten(name, 60), shorten(reason, 70)) for name, reason in skipped[:_MOST_SKIPPED]]
    more = len(skipped) - len(shown)
    return Table(
        "skipped, because they are not system files",
        ("file", "reason"),
        tuple(shown),
        f"and {more} more, which the JSON document lists" if more else "",
    )


def counts(documents: Sequence[Document]) -> dict[str, int]:
    """Return the table of counts: systems, decided systems, and systems with each property."""
    decided = [document["answers"] for document in documents if "error" not in document]
    found = {"systems": len(documents), "decided": len(decided)}
    for question, key in (
        ("fixed_spectrum", "with_fixed_modes"),
        ("fixed_spectrum", "not_stabilizable"),
        ("completeness", "complete"),
        ("joint_controllability", "jointly_controllable"),
        ("joint_observability", "jointly_observable"),
        ("transfer_graph", "strongly_connected"),
    ):
        claims = [answers[question]["claim"] for answers in decided if question in answers]
        if claims:
            found[key] = sum(map(_COUNTED[key], claims))
    return found


_COUNTED = {
    "with_fixed_modes": lambda claim: bool(claim["factors"]),
    "not_stabilizable": lambda claim: not claim["stabilizable"],
    "complete": lambda claim: claim["complete"],
    "jointly_controllable": lambda claim: claim["controllable"],
    "jointly_observable": lambda claim: claim["controllable"],
    "strongly_connected": lambda claim: claim["strongly_connected"],
}


def sweep_page(
    documents: Sequence[Document],
    questions: Sequence[str],
    skipped: Sequence[tuple[str, str]] = (),
) -> AnswerPage:
    """Return the page of a sweep: the counts in words, and the tables."""
    each, summed = sweep_tables(documents, questions, most=_MOST_ON_A_PAGE)
    asked = ", ".join(name.replace("_", " ") for name in questions)
    words = ["; ".join(f"{label}: {number}" for label, number in summed.rows).capitalize()]
    failed = sum("error" in document for document in documents)
    if failed:
        words.append(f"warning: {count(failed, 'system')} without an answer, for reasons below")
    tables = [*tolerance_tables(documents, questions), each]
    tables += [skipped_table(skipped)] if skipped else []
    return AnswerPage(
        title=f"A sweep over {count(len(documents), 'system')}",
        heading=f"Asked about every system: {asked}. The independent checker verified the "
        "certificate of every answer.",
        good=None,
        answer=(*words, *([summed.note.capitalize()] if summed.note else [])),
        pictures=tuple(each.embedded() for each in pictures(documents, questions)),
        tables=tuple(
            replace(found, title=(found.title or "every system").capitalize()) for found in tables
        ),
    )


def sweep_tables(
    documents: Sequence[Document], questions: Sequence[str], most: int = _MOST_ROWS
) -> tuple[Table, Table]:
    """Return a row for each system, or for the most important ones, and the counts."""
    shown = list(documents)
    note = ""
    if len(shown) > most:
        shown = sorted(shown, key=_tells)[:most]
        shown.sort(key=lambda document: int(document["number"]))
        note = f"{most} of {count(len(documents), 'system')}; the JSON document lists all"
    columns = ("system", "n", "m", *(name.replace("_", " ") for name in questions), "seconds")
    short = _short_names(documents)
    rows = tuple(_row(short[document["name"]], document, questions) for document in shown)
    named = counts(documents)
    said = tuple((key.replace("_", " "), str(number)) for key, number in named.items())
    stays = _NOT_STABILIZABLE if named.get("not_stabilizable") else ""
    return (Table("", columns, rows, note), Table("of all systems", (), said, stays))


def _tells(document: Document) -> int:
    """The order of rows: errors first, then systems with fixed modes, then the others."""
    if "error" in document:
        return 0
    claim = document["answers"].get("fixed_spectrum", {"claim": {}})["claim"]
    return 1 if claim.get("factors") else 2


def _short_names(documents: Sequence[Document]) -> dict[str, str]:
    """Shorten paths by their common folder, and members of one family by the name of the file."""
    names = {document["name"] for document in documents}
    if len(names) > 1 and len({name.partition(": ")[0] for name in names}) == 1:
        return {name: shorten(name.partition(": ")[2], 60) for name in names}
    # Behind a colon stands which member of a family it is, possibly with quotients.
    paths = (name.partition(": ")[0] for name in names)
    folders = {os.path.dirname(path) for path in paths if os.sep in path}
    try:
        common = os.path.commonpath(folders) + os.sep if folders else ""
    except ValueError:  # absolute ones and others
        common = ""
    return {name: shorten(name.removeprefix(common), 40) for name in names}


def _row(name: str, document: Document, questions: Sequence[str]) -> tuple[str, ...]:
    if "answers" not in document:
        return (name, "", "", shorten(document["error"]["message"], 70), *[""] * len(questions))
    system, answers = document["system"], document["answers"]
    said = [_said(each, answers[each]) if each in answers else "open" for each in questions]
    seconds = f"{document['seconds']:.3g}"
    return (name, str(system["n"]), str(system["m"]), *said, seconds)


def _said(question: str, answer: Mapping[str, Any]) -> str:
    """Write a claim in a few words."""
    if question in PROPERTIES:
        return "a plant fails" if "member" in answer else "proved"
    claim = answer["claim"]
    if question == "fixed_spectrum":
        if not claim["factors"]:
            return "empty"
        coefficients = tuple(Fraction(coefficient) for coefficient in claim["polynomial"])
        stable = "" if claim["stabilizable"] else ", not stabilizable"
        return polynomial(Polynomial(coefficients), 40) + stable
    if question in {"controllability_indices", "observability_indices"}:
        return ", ".join(cut([str(k) for k in claim["indices"]], 10))
    if question == "assignability":
        parts = [str(block["dimension"]) for block in claim["blocks"] if block["dimension"]]
        return f"parts of degree {', '.join(cut(parts, 6))}" if parts else "no part"
    return "yes" if next(value for value in claim.values() if isinstance(value, bool)) else "no"
