"""`reproduce` carries out the examinations of the paper; pages and tables of their findings.

`chosen` finds examinations by key, title, equation, label or section; `examine` carries out those
of one section, which may run in another process, and `assembled` joins the findings in the order of
the ledger.  The display is a page (`reproduction_page`), tables for a terminal, plain data, or a
table in LaTeX.  It says of each statement what is proved in general and what was checked on
instances.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from mcexact.answer.templates import count
from mcexact.errors import UsageError
from mcexact.report.formulas import matrix, typeset, typeset_latex
from mcexact.report.html import page
from mcexact.report.text import Table
from mcexact.reproduce import decentralized, delays, lemmas, nearest, observer, setpoint, sharing
from mcexact.reproduce.notebook import (
    STATUSES,
    Examination,
    Notebook,
    Procedure,
    Statement,
    counted,
    examinations,
    examined,
    statements,
)

SECTIONS: tuple[tuple[str, dict[str, Procedure]], ...] = (
    ("I, the problem", decentralized.PROBLEM),
    ("II-A, certainty equivalence", lemmas.CANCELLATION),
    ("II-B and II-C, the distributed observer", observer.PROCEDURES),
    ("II-D, its analysis", lemmas.LEMMAS),
    ("II-B, II-D and IV-E, almost all gains", lemmas.ALMOST_ANY),
    ("III, set-points", {**setpoint.SETPOINT, **setpoint.TRACKING}),
    ("IV-A, decentralized control", decentralized.DECENTRALIZED),
    ("IV-B, sharing outputs", decentralized.EXAMPLE),
    ("IV-C, extended systems", {**sharing.EXTENDED, **sharing.RESTATED}),
    ("IV-D, shared dimensions", sharing.BOUNDS),
    ("IV-E and VI, free assignment", sharing.FREEDOM),
    ("V-A, delays", delays.DELAYS),
    ("V-B, holding", delays.HOLDING),
    ("IV-D, IV-E and V, near to what is true", nearest.NEAREST),
)


@dataclass(frozen=True)
class Row:
    """An examination with its finding."""

    examination: Examination
    finding: Notebook

    @property
    def status(self) -> str:
        """What is known, in words."""
        if not self.finding.holds:
            return "fails"
        return self.examination.status(len(self.finding.instances), self.finding.with_content)


@dataclass(frozen=True)
class Reproduction:
    """The findings of examinations, in the order of the ledger.

    Attributes
    ----------
    rows : tuple of Row
    """

    rows: tuple[Row, ...]

    @property
    def holds(self) -> bool:
        """Whether no examination fails."""
        return all(row.finding.holds for row in self.rows)

    @property
    def failures(self) -> tuple[Row, ...]:
        """The rows of examinations that fail."""
        return tuple(row for row in self.rows if not row.finding.holds)

    @property
    def is_whole(self) -> bool:
        """Whether these are all examinations of the ledger."""
        return len(self.rows) == len(examinations())

    @property
    def statements(self) -> tuple[Statement, ...]:
        """The statements of the paper that these examinations are about: all, if these are all."""
        keys = {row.examination.key for row in self.rows}
        return tuple(
            each for each in statements() if self.is_whole or keys.intersection(each.examined)
        )

    def fails(self, statement: Statement) -> bool:
        """Whether an examination of the statement fails."""
        return any(row.examination.key in statement.examined for row in self.failures)

    def certificates(self) -> dict[str, str]:
        """The texts of all certificates, keyed by file names."""
        return {
            certificate.name: certificate.text
            for row in self.rows
            for certificate in row.finding.certificates
        }


def procedures() -> dict[str, Procedure]:
    """The procedures of all examinations, by their keys."""
    return {key: procedure for _, section in SECTIONS for key, procedure in section.items()}


def chosen(wanted: Iterable[str]) -> tuple[str, ...]:
    """Return the keys of the examinations with some names; all keys if none is given.

    A name is a key or title of the ledger, a printed number of an equation, a label of the paper's
    LaTeX source, ``statement 89`` for a number of the list of statements, or ``section II-D``.

    Raises
    ------
    UsageError
        If there is nothing of this name, or if nothing examines it.

    Examples
    --------
    >>> chosen(["Theorem 2", "(26)", "26", "eqn:n_i", "statement 89", "Equation (21)"])
    ('theorem-2', 'bound-by-ranks', 'equation-21')
    """
    by_name: dict[str, tuple[str, ...]] = {
        name.lower(): (each.key,) for each in examinations() for name in each.names
    }
    for each in statements():
        by_name[f"statement {each.number}"] = each.examined
        for section in {each.section, each.section.partition("-")[0]}:
            name = f"section {section}".lower()
            by_name[name] = (*by_name.get(name, ()), *each.examined)
    keys: list[str] = []
    for name in wanted:
        number = re.fullmatch(r"(?:(?:equation|eq\.) )?\(?(\d+)\)?", name.lower())
        asked = f"({number[1]})" if number else name.lower()
        if asked not in by_name:
            near = difflib.get_close_matches(asked, by_name, n=1)
            hint = f"; did you mean {near[0]!r}?" if near else ""
            raise UsageError(f"the paper has no statement {name!r}{hint}")
        if not by_name[asked]:
            why = statements()[int(asked.removeprefix("statement ")) - 1].note
            raise UsageError(f"nothing examines {asked}: {why}")
        keys += by_name[asked]
    return tuple(dict.fromkeys(keys)) or tuple(each.key for each in examinations())


def examine(section: int, keys: tuple[str, ...]) -> tuple[Notebook, ...]:
    """Carry out the examinations of one section that have these keys."""
    return tuple(
        examined(key, procedure) for key, procedure in SECTIONS[section][1].items() if key in keys
    )


def assembled(findings: Iterable[Notebook]) -> Reproduction:
    """Join findings with their examinations, in the order of the ledger."""
    by_key = {finding.key: finding for finding in findings}
    return Reproduction(
        tuple(Row(each, by_key[each.key]) for each in examinations() if each.key in by_key)
    )


def reproduce(keys: Iterable[str] = ()) -> Reproduction:
    """Examine statements of the paper in this process.

    Parameters
    ----------
    keys : iterable of str
        Names as for `chosen`; all examinations if none is named.

    Examples
    --------
    >>> reproduce(["every-subset"]).holds
    True
    """
    wanted = chosen(keys)
    return assembled(finding for k in range(len(SECTIONS)) for finding in examine(k, wanted))


# The report of a reproduction: a page for a browser, plain data, and a table in LaTeX.

_LARGEST_SAMPLE = 6000
_OF_EXAMINATION = ("key", "title", "section", "content", "proofs", "erratum")
_OF_FINDING = ("holds", "instances", "with_content", "in_common", "failure")
_OF_STATEMENT = ("number", "section", "equation", "says", "status", "examined", "proofs", "note")
COMMON_BOUND = (
    "The paper asks whether its bound on the common dimension of shared sub-states is tight. The "
    "answer depends on the neighbor graph N: the bound is at most β(N) times the least common "
    "dimension, and some plant attains this on every graph; so it is tight for all plants on N if "
    "and only if β(N) ≤ 1, as on directed rings of up to five agents. A plant with four agents has "
    "the bound 2, and n_i = 1 for all suffices, as does (0, 1, 1, 0). Exactly those dimensions "
    "suffice whose sum over N_s∖s is at least n − rank P_s(λ) for every subset s and every "
    "eigenvalue λ."
)
"""The answer to the paper's open question: statement 92, and the examination `tight`."""


def reproduction_page(reproduction: Reproduction) -> str:
    """The whole report as one page."""
    shown = {row.examination.key: _shown(row) for row in reproduction.rows}
    sections = [
        {"name": name, "rows": [shown[key] for key in keys if key in shown]}
        for name, keys in SECTIONS
    ]
    return page(
        "reproduction",
        dated=False,
        title="The paper, reproduced",
        holds=reproduction.holds,
        answer=[typeset(sentence) for sentence in answer(reproduction)],
        rows=list(shown.values()),
        counts=[(name, str(size)) for name, size in counts(reproduction).items()],
        statements=[_listed(each, reproduction) for each in reproduction.statements],
        sections=[section for section in sections if section["rows"]],
    )


def counts(reproduction: Reproduction) -> dict[str, int]:
    """How many statements have each status, by what the report calls it."""
    return {STATUSES[key]: size for key, size in counted(reproduction.statements).items()}


def answer(reproduction: Reproduction) -> list[str]:
    """The results in plain words."""
    rows = reproduction.rows
    certificates = [certificate for row in rows for certificate in row.finding.certificates]
    valid = sum(certificate.verdict == "VALID" for certificate in certificates)
    false = sum(len(row.examination.nearest_false) for row in rows)
    sentences = []
    if any(row.examination.key == "tight" and row.finding.holds for row in rows):
        sentences.append(COMMON_BOUND)
    if not reproduction.holds:
        named = ", ".join(row.examination.title for row in reproduction.failures)
        failed = "fails" if len(reproduction.failures) == 1 else "fail"
        sentences.append(
            f"{len(reproduction.failures)} of {count(len(rows), 'examination')} {failed}: {named}."
        )
    elif len(rows) == 1:
        sentences.append("The examination succeeds: all its checks hold.")
    else:
        sentences.append(f"All {len(rows)} examinations succeed: all their checks hold.")
    statuses = [f"{size} {name}" for name, size in counts(reproduction).items() if size]
    total = count(len(reproduction.statements), "statement")
    sentences.append(f"Of {total} of the paper: {'; '.join(statuses)}.")
    corrected = [row.examination.title for row in rows if row.examination.erratum]
    if corrected:
        sentences.append(f"Corrections concern {'; '.join(corrected)}.")
    if false and reproduction.holds:
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


def _listed(statement: Statement, reproduction: Reproduction) -> dict[str, Any]:
    """The data of a statement that the page shows."""
    titles = {row.examination.key: row.examination.title for row in reproduction.rows}
    return {
        **{name: getattr(statement, name) for name in _OF_STATEMENT},
        "says": typeset(statement.says),
        "note": typeset(statement.note),
        "status": "an examination fails"
        if reproduction.fails(statement)
        else STATUSES[statement.status],
        "fails": reproduction.fails(statement),
        "links": [(key, typeset(titles[key])) for key in statement.examined if key in titles],
    }


def _shown(row: Row) -> dict[str, Any]:
    """The data of a row that the page shows."""
    examination, finding = row.examination, row.finding
    sample = next(
        (
            certificate
            for certificate in finding.certificates
            if len(certificate.text) < _LARGEST_SAMPLE
        ),
        None,
    )
    return {
        **{name: getattr(examination, name) for name in (*_OF_EXAMINATION, "says", "code")},
        **{name: getattr(finding, name) for name in ("holds", "failure", "pictures")},
        "name": examination.title,
        "title": typeset(examination.title),
        "printed": ", ".join(
            f"({each})" for each in examination.equations if examination.kind == "numbered"
        ),
        "says": typeset(examination.says),
        "erratum": typeset(examination.erratum),
        "status": typeset(row.status),
        "instances": typeset(finding.in_common),
        "content": typeset(_content(row)),
        "matrices": [
            (typeset(instance), [matrix(name, rows) for _, name, rows in group])
            for instance, group in groupby(finding.matrices, key=lambda each: each[0])
        ],
        "checks": _with_formulas(finding.grouped_checks()),
        "refutations": _with_formulas(finding.grouped_refutations()),
        "certificates": [
            (typeset(certificate.instance), certificate.name, certificate.verdict)
            for certificate in finding.certificates
        ],
        "sample": sample,
    }


def _content(row: Row) -> str:
    """On how many instances the statement says something, and where it does."""
    size, of = row.finding.with_content, len(row.finding.instances)
    return f"With content {size} of {of}: {row.examination.content}."


def _with_formulas(rows: Iterable[tuple[str, str, bool]]) -> list[tuple[str, str, str]]:
    """Rows of a table from texts, their instances, and whether they hold there."""
    return [
        (typeset(text), "yes" if holds else "NO", typeset(instances))
        for text, instances, holds in rows
    ]


def reproduction_view(reproduction: Reproduction) -> dict[str, Any]:
    """The rows as plain data."""
    return {
        "holds": reproduction.holds,
        "counts": counts(reproduction),
        "statements": [
            {
                **{name: getattr(each, name) for name in _OF_STATEMENT},
                "status": STATUSES[each.status],
                "holds": not reproduction.fails(each),
            }
            for each in reproduction.statements
        ],
        "examinations": [
            {
                **{name: getattr(row.examination, name) for name in _OF_EXAMINATION},
                **{name: getattr(row.finding, name) for name in _OF_FINDING},
                "status": row.status,
                "checks": len(row.finding.checks),
                "refutations": [
                    {"name": each.name, "statement": each.statement, "instance": each.instance}
                    for each in row.finding.refutations
                    if each.refuted
                ],
                "certificates": [certificate.name for certificate in row.finding.certificates],
            }
            for row in reproduction.rows
        ],
    }


def reproduction_latex(reproduction: Reproduction) -> str:
    """The statements with their status as a table in LaTeX."""
    lines = [
        r"\begin{tabular}{rlp{8cm}l}",
        r" & equation & statement & what is known \\ \hline",
    ]
    for each in reproduction.statements:
        cells = (str(each.number), each.equation, each.says, STATUSES[each.status])
        lines.append(" & ".join(typeset_latex(cell) for cell in cells) + r" \\")
    return "\n".join([*lines, r"\end{tabular}"]) + "\n"


# The report of a reproduction for a terminal: the whole paper, or a few statements in full.

_FEW = 5


def reproduction_tables(reproduction: Reproduction) -> list[Table]:
    """The answer and the count of statements by status; then all examinations, or a few in full."""
    statuses = tuple((name, str(size)) for name, size in counts(reproduction).items() if size)
    first = Table(" ".join(answer(reproduction)), ("status", "statements"), statuses)
    if len(reproduction.rows) <= _FEW:
        return [
            first,
            _statements(reproduction),
            *(each for row in reproduction.rows for each in _in_full(row)),
        ]
    rows = tuple(
        (
            row.examination.title,
            row.examination.section,
            "yes" if row.finding.holds else "NO",
            row.status + (" (corrected)" if row.examination.erratum else ""),
            str(len(row.finding.certificates)),
        )
        for row in reproduction.rows
    )
    columns = ("examined", "section", "holds", "what is known", "certificates")
    return [first, Table("The examinations.", columns, rows)]


def _statements(reproduction: Reproduction) -> Table:
    """The statements that a few examinations are about."""
    rows = tuple(
        (
            str(each.number),
            f"{each.section} {each.equation}".strip(),
            each.says,
            STATUSES[each.status] + (f". {each.note}" if each.note else ""),
        )
        for each in reproduction.statements
    )
    return Table("The statements.", ("", "section", "statement", "what is known"), rows)


def _in_full(row: Row) -> Iterator[Table]:
    """All checks and refutations of an examination."""
    examination, finding = row.examination, row.finding
    title = f"{examination.title}: {examination.says} Examined on {finding.in_common}."
    title += f" {_content(row)}"
    if examination.proofs:
        title += f" Machine-checked: {', '.join(examination.proofs)}."
    if examination.erratum:
        title += f" Correction: {examination.erratum}"
    for name, entries in (
        (title, finding.grouped_checks()),
        (f"False statements next to {examination.title}.", finding.grouped_refutations()),
    ):
        what = ("what was checked", "holds") if name == title else ("false statement", "refuted")
        rows = tuple((text, "yes" if holds else "NO", on) for text, on, holds in entries)
        yield Table(name, (*what, "instances"), rows)
