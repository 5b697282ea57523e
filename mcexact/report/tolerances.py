"""What a sweep over tolerances found: of how many plants each is proved, and where plants fail."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from mcexact.exact.rational import decimal_or_quotient, written
from mcexact.model.properties import PROPERTIES
from mcexact.plot.uncertainty import uncertainty_shares
from mcexact.report.picture import Picture
from mcexact.report.text import Table

_WITHIN = re.compile(r"within ([0-9]+(?:/[0-9]+)?)")

Document = Mapping[str, Any]


@dataclass(frozen=True)
class Known:
    """Up to which part of its entries a property of a plant is proved, and within which it fails.

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
    found, members = [], [*_members(documents)]
    for question in filter(PROPERTIES.__contains__, questions):
        for part in sorted({at for _, at, _ in members}):
            known = [_verdict(document, question) for _, at, document in members if at == part]
            of: dict[str, Any] = {"question": question, "part": written(part)}
            numbers = {"proved": known.count(True), "failing": known.count(False)}
            found.append(of | {"plants": len(known)} | numbers)
    return found


def pictures(documents: Sequence[Document], questions: Sequence[str]) -> list[Picture]:
    """Draw of which share of the plants each property is proved, against the part."""
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
    """What is known of each plant, by its name."""
    found: dict[str, Known] = {}
    for name, part, document in members:
        lower, upper = Fraction(0), None
        if name in found:
            lower, upper = found[name].lower, found[name].upper
        verdict = _verdict(document, question)
        if verdict is True:
            lower = max(lower, part)
        if verdict is False:
            upper = part if upper is None else min(upper, part)
        found[name] = Known(PROPERTIES[question], lower, upper)
    return found


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
