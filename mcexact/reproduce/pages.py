"""The report of a reproduction: a page for a browser, lines for a terminal, a table in LaTeX."""

from __future__ import annotations

from typing import Any

from mcexact.answer.formats import count
from mcexact.answer.latex import escaped
from mcexact.report.page import page
from mcexact.report.text import Table
from mcexact.reproduce.reproduction import SECTIONS, Reproduction, Row

_LARGEST_SAMPLE = 6000
_OF_STATEMENT = ("key", "title", "section", "proofs", "erratum")


def reproduction_page(found: Reproduction) -> str:
    """The whole report as one page."""
    shown = {row.statement.key: _shown(row) for row in found.rows}
    sections = [
        {"name": name, "rows": [shown[key] for key in keys if key in shown]}
        for name, keys in SECTIONS
    ]
    return page(
        "reproduction",
        title="The paper, reproduced",
        holds=found.holds,
        answer=answer(found),
        rows=list(shown.values()),
        sections=[section for section in sections if section["rows"]],
    )


def answer(found: Reproduction) -> list[str]:
    """The results in plain words."""
    rows = found.rows
    certificates = [made for row in rows for made in row.finding.certificates]
    valid = sum(made.verdict == "VALID" for made in certificates)
    if found.holds and len(rows) == 1:
        sentences = ["The statement examined holds."]
    elif found.holds:
        sentences = [f"All {len(rows)} statements examined hold."]
    else:
        named = ", ".join(row.statement.title for row in found.failures)
        sentences = [f"{len(found.failures)} of {len(rows)} statements do not hold: {named}."]
    numbered = [row for row in rows if row.statement.kind == "numbered"]
    proved = [row for row in rows if row.statement.proved]
    if len(rows) > 1 and numbered:
        sentences.append(
            f"{len(numbered)} of them are numbered theorems, propositions, lemmas, corollaries and "
            "remarks of the paper."
        )
    if len(rows) > 1:
        sentences.append(
            f"{len(proved)} are proved in general by machine-checked proofs; the others are "
            "checked on instances, as it says beside each."
        )
    corrected = [row.statement.title for row in rows if row.statement.erratum]
    if corrected:
        sentences.append(
            f"{count(len(corrected), 'statement')} had to be corrected: {'; '.join(corrected)}."
        )
    sentences.append(
        f"{valid} of {count(len(certificates), 'certificate')} were found VALID by the independent "
        "checker."
    )
    return sentences


def _shown(row: Row) -> dict[str, Any]:
    """The data of a row that the page shows."""
    said, finding = row.statement, row.finding
    sample = next((made for made in finding.certificates if len(made.text) < _LARGEST_SAMPLE), None)
    return {
        "anchor": said.key.replace(":", "-"),
        **{name: getattr(said, name) for name in (*_OF_STATEMENT, "says", "part", "code")},
        **{name: getattr(finding, name) for name in ("holds", "failure", "pictures")},
        "status": row.status,
        "checks": [
            (check.instance, check.text, "yes" if check.holds else "NO") for check in finding.checks
        ],
        "certificates": [(made.instance, made.name, made.verdict) for made in finding.certificates],
        "sample": sample,
    }


def reproduction_table(found: Reproduction) -> Table:
    """The rows, for a terminal."""
    return Table(
        " ".join(answer(found)[:1]),
        ("statement", "section", "holds", "what is known", "certificates"),
        tuple(
            (
                row.statement.title,
                row.statement.section,
                "yes" if row.finding.holds else "NO",
                row.status + (" (corrected)" if row.statement.erratum else ""),
                str(len(row.finding.certificates)),
            )
            for row in found.rows
        ),
    )


def reproduction_view(found: Reproduction) -> dict[str, Any]:
    """The rows as plain data."""
    return {
        "holds": found.holds,
        "statements": [
            {
                **{name: getattr(row.statement, name) for name in _OF_STATEMENT},
                **{name: getattr(row.finding, name) for name in ("holds", "instances", "failure")},
                "status": row.status,
                "checks": len(row.finding.checks),
                "certificates": [made.name for made in row.finding.certificates],
            }
            for row in found.rows
        ],
    }


def reproduction_latex(found: Reproduction) -> str:
    """The rows as a table in LaTeX."""
    lines = [r"\begin{tabular}{lll}", r"statement & section & what is known \\ \hline"]
    for row in found.rows:
        cells = (row.statement.title, row.statement.section, row.status)
        lines.append(" & ".join(_typeset(cell) for cell in cells) + r" \\")
    return "\n".join([*lines, r"\end{tabular}"]) + "\n"


_SYMBOLS = {
    "Σ": r"$\Sigma$",
    "∈": r"$\in$",
    "̄": "",
    "∖": r"$\setminus$",
    "φ": r"$\varphi$",
    "≥": r"$\ge$",
}


def _typeset(text: str) -> str:
    """Escape a text for LaTeX; the mathematical symbols in titles become formulas."""
    return "".join(_SYMBOLS.get(character, escaped(character)) for character in text)
