"""The report of a reproduction for a terminal: the whole paper, or a few statements in full."""

from __future__ import annotations

from collections.abc import Iterator

from mcexact.report.text import Table
from mcexact.reproduce.pages import answer, counts
from mcexact.reproduce.reproduction import Reproduction, Row
from mcexact.reproduce.statements import STATUSES

_FEW = 5


def reproduction_tables(found: Reproduction) -> list[Table]:
    """The answer and the count of statements by status; then all examinations, or a few in full."""
    told = tuple((name, str(size)) for name, size in counts(found).items() if size)
    first = Table(" ".join(answer(found)), ("status", "statements"), told)
    if len(found.rows) <= _FEW:
        return [first, _statements(found), *(each for row in found.rows for each in _in_full(row))]
    rows = tuple(
        (
            row.examination.title,
            row.examination.section,
            "yes" if row.finding.holds else "NO",
            row.status + (" (corrected)" if row.examination.erratum else ""),
            str(len(row.finding.certificates)),
        )
        for row in found.rows
    )
    columns = ("examined", "section", "holds", "what is known", "certificates")
    return [first, Table("The examinations.", columns, rows)]


def _statements(found: Reproduction) -> Table:
    """The statements that a few examinations are about."""
    rows = tuple(
        (
            str(each.number),
            f"{each.section} {each.equation}".strip(),
            each.says,
            STATUSES[each.status] + (f". {each.note}" if each.note else ""),
        )
        for each in found.statements
    )
    return Table("The statements.", ("", "section", "statement", "what is known"), rows)


def _in_full(row: Row) -> Iterator[Table]:
    """All checks and refutations of an examination."""
    said, finding = row.examination, row.finding
    title = f"{said.title}: {said.says} Examined on {finding.in_common}."
    if said.proofs:
        title += f" Machine-checked: {', '.join(said.proofs)}{f' ({said.part})' * bool(said.part)}."
    if said.erratum:
        title += f" Correction: {said.erratum}"
    for name, entries in (
        (title, finding.grouped_checks()),
        (f"False statements next to {said.title}.", finding.grouped_refutations()),
    ):
        what = ("what was checked", "holds") if name == title else ("false statement", "refuted")
        rows = tuple((text, "yes" if holds else "NO", on) for text, on, holds in entries)
        yield Table(name, (*what, "instances"), rows)
