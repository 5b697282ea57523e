"""The report of a reproduction: a page for a browser, plain data, and a table in LaTeX."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import groupby
from typing import Any

from mcexact.answer.templates import count
from mcexact.report.formulas import matrix, typeset, typeset_latex
from mcexact.report.html import page
from mcexact.reproduce.reproduction import SECTIONS, Reproduction, Row
from mcexact.reproduce.statements import STATUSES, Statement, counted

_LARGEST_SAMPLE = 6000
_OF_EXAMINATION = ("key", "title", "section", "proofs", "erratum")
_OF_FINDING = ("holds", "instances", "in_common", "failure")
_OF_STATEMENT = ("number", "section", "equation", "says", "status", "examined", "proofs", "note")
COMMON_BOUND = (
    "The paper asks whether its bound on the common dimension of shared sub-states is tight. It is "
    "not: a plant with four agents has the bound 2 where outputs and sub-states are shared, and "
    "n_i = 1 for all suffices, as does (0, 1, 1, 0). Exactly those dimensions suffice whose sum "
    "over N_s∖s is at least n − rank P_s(λ) for every subset s and every eigenvalue λ."
)
"""The answer to the paper's open question, proved by the examination `tight`."""


def reproduction_page(found: Reproduction) -> str:
    """The whole report as one page."""
    shown = {row.examination.key: _shown(row) for row in found.rows}
    sections = [
        {"name": name, "rows": [shown[key] for key in keys if key in shown]}
        for name, keys in SECTIONS
    ]
    return page(
        "reproduction",
        dated=False,
        title="The paper, reproduced",
        holds=found.holds,
        answer=[typeset(sentence) for sentence in answer(found)],
        rows=list(shown.values()),
        counts=[(name, str(size)) for name, size in counts(found).items()],
        statements=[_listed(each, found) for each in found.statements],
        sections=[section for section in sections if section["rows"]],
    )


def counts(found: Reproduction) -> dict[str, int]:
    """How many statements have each status, by what the report calls it."""
    return {STATUSES[key]: size for key, size in counted(found.statements).items()}


def answer(found: Reproduction) -> list[str]:
    """The results in plain words."""
    rows = found.rows
    certificates = [made for row in rows for made in row.finding.certificates]
    valid = sum(made.verdict == "VALID" for made in certificates)
    false = sum(len(row.examination.nearest_false) for row in rows)
    sentences = []
    if any(row.examination.key == "tight" and row.finding.holds for row in rows):
        sentences.append(COMMON_BOUND)
    if not found.holds:
        named = ", ".join(row.examination.title for row in found.failures)
        failed = "fails" if len(found.failures) == 1 else "fail"
        sentences.append(
            f"{len(found.failures)} of {count(len(rows), 'examination')} {failed}: {named}."
        )
    elif len(rows) == 1:
        sentences.append("The examination succeeds: all its checks hold.")
    else:
        sentences.append(f"All {len(rows)} examinations succeed: all their checks hold.")
    told = [f"{size} {name}" for name, size in counts(found).items() if size]
    sentences.append(
        f"Of {count(len(found.statements), 'statement')} of the paper: {'; '.join(told)}."
    )
    corrected = [row.examination.title for row in rows if row.examination.erratum]
    if corrected:
        sentences.append(f"Corrections concern {'; '.join(corrected)}.")
    if false and found.holds:
        sentences.append(
            f"{count(false, 'false statement')} next to those of the paper "
            + ("was refuted, by" if false == 1 else "were refuted, each by")
            + " an instance that is named."
        )
    sentences.append(
        f"{valid} of {count(len(certificates), 'certificate')} were found VALID by the independent "
        "checker."
    )
    return sentences


def _listed(statement: Statement, found: Reproduction) -> dict[str, Any]:
    """The data of a statement that the page shows."""
    titles = {row.examination.key: row.examination.title for row in found.rows}
    return {
        **{name: getattr(statement, name) for name in _OF_STATEMENT},
        "says": typeset(statement.says),
        "note": typeset(statement.note),
        "status": "an examination fails" if found.fails(statement) else STATUSES[statement.status],
        "fails": found.fails(statement),
        "links": [(key, typeset(titles[key])) for key in statement.examined if key in titles],
    }


def _shown(row: Row) -> dict[str, Any]:
    """The data of a row that the page shows."""
    said, finding = row.examination, row.finding
    sample = next((made for made in finding.certificates if len(made.text) < _LARGEST_SAMPLE), None)
    return {
        **{name: getattr(said, name) for name in (*_OF_EXAMINATION, "says", "part", "code")},
        **{name: getattr(finding, name) for name in ("holds", "failure", "pictures")},
        "name": said.title,
        "title": typeset(said.title),
        "printed": ", ".join(f"({each})" for each in said.equations if said.kind == "numbered"),
        "says": typeset(said.says),
        "erratum": typeset(said.erratum),
        "part": typeset(said.part),
        "status": typeset(row.status),
        "instances": typeset(finding.in_common),
        "matrices": [
            (typeset(instance), [matrix(name, rows) for _, name, rows in group])
            for instance, group in groupby(finding.matrices, key=lambda each: each[0])
        ],
        "checks": _with_formulas(finding.grouped_checks()),
        "refutations": _with_formulas(finding.grouped_refutations()),
        "certificates": [
            (typeset(made.instance), made.name, made.verdict) for made in finding.certificates
        ],
        "sample": sample,
    }


def _with_formulas(rows: Iterable[tuple[str, str, bool]]) -> list[tuple[str, str, str]]:
    """Rows of a table from texts, their instances, and whether they hold there."""
    return [
        (typeset(text), "yes" if holds else "NO", typeset(instances))
        for text, instances, holds in rows
    ]


def reproduction_view(found: Reproduction) -> dict[str, Any]:
    """The rows as plain data."""
    return {
        "holds": found.holds,
        "counts": counts(found),
        "statements": [
            {
                **{name: getattr(each, name) for name in _OF_STATEMENT},
                "status": STATUSES[each.status],
                "holds": not found.fails(each),
            }
            for each in found.statements
        ],
        "examinations": [
            {
                **{name: getattr(row.examination, name) for name in _OF_EXAMINATION},
                **{
                    name: getattr(row.finding, name)
                    for name in ("holds", "instances", "in_common", "failure")
                },
                "status": row.status,
                "checks": len(row.finding.checks),
                "refutations": [
                    {"name": each.name, "statement": each.statement, "instance": each.instance}
                    for each in row.finding.refutations
                    if each.refuted
                ],
                "certificates": [made.name for made in row.finding.certificates],
            }
            for row in found.rows
        ],
    }


def reproduction_latex(found: Reproduction) -> str:
    """The statements with their status as a table in LaTeX."""
    lines = [
        r"\begin{tabular}{rlp{8cm}l}",
        r" & equation & statement & what is known \\ \hline",
    ]
    for each in found.statements:
        cells = (str(each.number), each.equation, each.says, STATUSES[each.status])
        lines.append(" & ".join(typeset_latex(cell) for cell in cells) + r" \\")
    return "\n".join([*lines, r"\end{tabular}"]) + "\n"
