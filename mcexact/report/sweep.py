"""The display of a sweep."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

from mcexact.answer.templates import count, cut
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import decimal_or_quotient, polynomial, written
from mcexact.model.properties import PROPERTIES
from mcexact.plot.parameters import uncertainty_shares
from mcexact.report.html import AnswerPage, Picture
from mcexact.report.text import Table, shorten

# Sweeps over tolerances: the part of the entries up to which properties are proved, or fail.

_WITHIN = re.compile(r"within ([0-9]+(?:/[0-9]+)?)")

Document = Mapping[str, Any]


@dataclass(frozen=True)
class Known:
    """The tolerance up to which a property of a plant is proved, and one within which it fails.

    Attributes
    ----------
    wanted : str
        The property.
    lower : Fraction
        0 if it is proved for no part.
    upper : Fraction or None
        None if no plant that fails is known.
    """

    wanted: str
    lower: Fraction
    upper: Fraction | None
    relative: bool = True


def tolerance_tables(documents: Sequence[Document], questions: Sequence[str]) -> tuple[Table, ...]:
    """The table of how many plants are proved within each part, and how many fail."""
    columns = ("property", "within", "proved", "a plant fails", "open", "plants")
    rows = tuple(
        (
            PROPERTIES[each["question"]],
            f"{decimal_or_quotient(100 * Fraction(each['part']))} %",
            str(each["proved"]),
            str(each["failing"]),
            str(each["plants"] - each["proved"] - each["failing"]),
            str(each["plants"]),
        )
        for each in tolerances(documents, questions)
    )
    return (Table("plants within parts of their entries", columns, rows),) if rows else ()


def tolerances(documents: Sequence[Document], questions: Sequence[str]) -> list[dict[str, Any]]:
    """For each question and each part of `tolerance_variants`, the numbers of plants."""
    rows, members = [], [*_members(documents)]
    for question in filter(PROPERTIES.__contains__, questions):
        for part in sorted({at for _, at, _ in members}):
            known = [_verdict(document, question) for _, at, document in members if at == part]
            of: dict[str, Any] = {"question": question, "part": written(part)}
            numbers = {"proved": known.count(True), "failing": known.count(False)}
            rows.append(of | {"plants": len(known)} | numbers)
    return rows


def pictures(documents: Sequence[Document], questions: Sequence[str]) -> list[Picture]:
    """Draw the share of the plants for which each property is proved, against the part."""
    drawn, members = [], [*_members(documents)]
    for question in filter(PROPERTIES.__contains__, questions if members else ()):
        known = list(_known(members, question).values())
        proved = sum(each.lower > 0 for each in known)
        failing = sum(each.upper is not None for each in known)
        words = (
            f"Of {len(known)} plants the property is proved within some part of the entries for "
            f"{proved}, and for {failing} a plant is known that fails. The table has the numbers "
            "for every part."
        )
        title = f"Plants by uncertainty: {PROPERTIES[question]}"
        drawn.append(Picture(uncertainty_shares(known), title, words))
    return drawn


def _known(members: Sequence[tuple[str, Fraction, Document]], question: str) -> dict[str, Known]:
    """The tolerances that are known for each plant, by its name."""
    by_plant: dict[str, Known] = {}
    for name, part, document in members:
        lower, upper = Fraction(0), None
        if name in by_plant:
            lower, upper = by_plant[name].lower, by_plant[name].upper
        verdict = _verdict(document, question)
        if verdict is True:
            lower = max(lower, part)
        if verdict is False:
            upper = part if upper is None else min(upper, part)
        by_plant[name] = Known(PROPERTIES[question], lower, upper)
    return by_plant


def _members(documents: Sequence[Document]) -> Iterator[tuple[str, Fraction, Document]]:
    """Yield the records about boxes that are parts of the entries: the plant, and the part."""
    for document in documents:
        name, _, member = document["name"].rpartition(": ")
        within = _WITHIN.fullmatch(member)
        if within:
            yield name, Fraction(within[1]), document


def _verdict(document: Document, question: str) -> bool | None:
    """Whether a property is proved, or fails for a member; None if it is left open."""
    answer = document.get("answers", {}).get(question)
    return None if answer is None else "member" not in answer


# The display of a sweep: one row for each system, and counts.

_MOST_ROWS, _MOST_ON_A_PAGE = 60, 5000
_MOST_SKIPPED = 20
_NOT_STABILIZABLE = "not stabilizable: by no linear time-invariant decentralized controller"


def sweep_view(
    documents: Sequence[Document],
    questions: Sequence[str],
    skipped: Sequence[tuple[str, str]] = (),
) -> dict[str, Any]:
    """Return counts, all records, and the skipped files with reasons, as plain data.

    If the sweep was over tolerances, ``tolerances`` has the numbers of plants by question and part.
    """
    return {
        "counts": counts(documents),
        "tolerances": tolerances(documents, questions),
        "records": list(documents),
        "skipped": [{"name": name, "reason": reason} for name, reason in skipped],
    }


def nearby_tables(documents: Sequence[Document], most: int = _MOST_ROWS) -> tuple[Table, ...]:
    """The table of systems of which the data allow another answer; empty if there is none."""
    short = _short_names(documents)
    told = [
        (f"{short[document['name']]} *", each["text"])
        for document in documents
        for each in document.get("nearby", ())
    ]
    more = len(told) - most
    note = f"and {more} more, which the JSON document lists" if more > 0 else ""
    title = "* the data allow another answer as well"
    return (Table(title, ("system", "what"), tuple(told[:most]), note),) if told else ()


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
    numbers = {"systems": len(documents), "decided": len(decided)}
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
            numbers[key] = sum(map(_COUNTED[key], claims))
    return numbers


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
    tables += nearby_tables(documents, _MOST_ON_A_PAGE)
    uncertain = sum(bool(document.get("nearby")) for document in documents)
    if uncertain:
        words.append(f"warning: of {count(uncertain, 'system')} the data allow another answer")
    tables += [skipped_table(skipped)] if skipped else []
    return AnswerPage(
        title=f"A sweep over {count(len(documents), 'system')}",
        heading=f"Asked about every system: {asked}. The independent checker verified the "
        "certificate of every answer.",
        good=None,
        answer=(*words, *([summed.note.capitalize()] if summed.note else [])),
        pictures=tuple(each.embedded() for each in pictures(documents, questions)),
        tables=tuple(
            replace(table, title=(table.title or "every system").capitalize()) for table in tables
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
    totals = tuple((key.replace("_", " "), str(number)) for key, number in named.items())
    stays = _NOT_STABILIZABLE if named.get("not_stabilizable") else ""
    return (Table("", columns, rows, note), Table("of all systems", (), totals, stays))


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
    # The text after a colon names a member of a family, possibly with quotients.
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
    claims = [_said(each, answers[each]) if each in answers else "open" for each in questions]
    if document.get("nearby"):
        name = f"{name} *"
    seconds = f"{document['seconds']:.3g}"
    return (name, str(system["n"]), str(system["m"]), *claims, seconds)


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
