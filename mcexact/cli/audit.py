"""The page of an audit: what was checked, what is proved, and how anybody repeats it."""

from __future__ import annotations

import platform
import shlex
from collections.abc import Mapping, Sequence

from mcexact import __version__
from mcexact.checker.kinds import Found
from mcexact.report.html import AnswerPage
from mcexact.report.text import Table

ARCHIVE = "mcexact-checker.pyz"


def _certificates(found: Sequence[Found], second: Mapping[int, str]) -> Table:
    """Each certificate with its verdict, and what it proves or why it does not."""
    rows = []
    for k, (about, verdict) in enumerate(found):
        if "text" in about or verdict.verdict == "COUNTED":
            continue
        by = "both" if second.get(k, "").startswith("CONFIRMED") else "the first"
        said = verdict.summary or f"{verdict.code} {verdict.place}: {verdict.message}"
        checked = by if verdict.verdict == "VALID" else ""
        rows.append((about.get("number", ""), about["file"], verdict.verdict, checked, said))
    note = "The first checker is that of mcexact; the second one, mcexact-verified, is the program "
    note += "extracted from the proof of its own soundness. Whole statements stand under Evidence."
    columns = ("number", "certificate", "verdict", "by which checker", "what is proved")
    return Table("Certificates", columns, tuple(rows), note)


def _sentences(found: Sequence[Found]) -> Table:
    """Each sentence of the report, quoted, and from which certificates it follows."""
    rows = tuple(
        (
            about["text"],
            verdict.verdict,
            about["premises"],
            verdict.summary if not verdict.status else f"{verdict.code}: {verdict.message}",
        )
        for about, verdict in found
        if "text" in about
    )
    note = "Sentences are quoted from the manifest, in which anything may be written. What is "
    note += "proved is what the certificates of these numbers state, or the words beside them. "
    note += "A REMARK claims nothing."
    columns = ("sentence of the report", "verdict", "certificates", "what follows")
    return Table("Sentences of the report", columns, rows, note)


def audit_page(
    found: Sequence[Found],
    second: Mapping[int, str],
    arguments: Sequence[str],
    archive: str,
    *,
    asked: Mapping[str, str],
) -> AnswerPage:
    """Return the page of one run of the checker.

    Parameters
    ----------
    found : sequence of Found
        The verdicts, each behind what it is about.
    second : mapping
        What mcexact-verified says of certificates, by their places among the verdicts.
    arguments : sequence of str
        What the command was called with.
    archive : str
        The SHA-256 of the checker as one file.
    asked : mapping
        The files of the plant and the controller that were asked for, by these words.
    """
    verdicts = [verdict for _, verdict in found]
    good = not any(verdict.status for verdict in verdicts)
    proved = sum(verdict.verdict == "VALID" for verdict in verdicts)
    implied = sum(verdict.verdict == "IMPLIED" for verdict in verdicts)
    refused = sum(bool(verdict.status) for verdict in verdicts)
    answer = [f"{proved} certificates are VALID, and {implied} sentences follow from them."]
    if refused:
        answer.append(f"warning: {refused} certificates or sentences are not proved; see below.")
    plants = dict.fromkeys(each.system_digest for each in verdicts if each.verdict == "VALID")
    loops = dict.fromkeys(each.controller_digest for each in verdicts if each.controller_digest)
    for words, digests in (("plant", plants), ("controller", loops)):
        if digests and words not in asked:
            answer.append(f"warning: no {words} was given to compare with: compare the digest.")
    facts = [(f"the {words} asked for", path) for words, path in asked.items()]
    facts += [("SHA-256 of the plant", digest) for digest in plants]
    facts += [("SHA-256 of the controller", digest) for digest in loops]
    facts += [("version", f"mcexact {__version__}, Python {platform.python_version()}")]
    again = [
        ("with mcexact", shlex.join(["mcexact", "check", *arguments])),
        ("make the checker as one file", f"mcexact check --export {ARCHIVE}"),
        ("with Python alone", shlex.join(["python", "-I", ARCHIVE, *arguments])),
        (f"SHA-256 of {ARCHIVE}", archive),
    ]
    signed = [("name", ""), ("date", ""), ("signature", "")]
    tables = (
        Table("What was checked", (), tuple(facts)),
        _certificates(found, second),
        _sentences(found),
        Table("How to repeat it", (), tuple(again)),
        Table("Signed", (), tuple(signed)),
    )
    return AnswerPage(
        "Audit of certificates",
        "What an independent checker verified, and how anybody can repeat it.",
        good,
        tuple(answer),
        (),
        tuple(table for table in tables if table.rows),
    )
