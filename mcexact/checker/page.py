"""The page of an audit: what was checked, what is proved, and how anybody repeats it.

An auditor makes the page himself, with Python and the checker alone, and signs that one.
"""

from __future__ import annotations

import hashlib
import os
import platform
import shlex
from collections import defaultdict
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from html import escape
from typing import Any

from .kinds import Found
from .summaries import RADII

ARCHIVE = "mcexact-checker.pyz"
GOOD = ("VALID", "IMPLIED")
ATTESTED = (
    "I ran the checker as it says above, on the files of the table 'What was checked'. It wrote "
    "this page. In each sentence I compared the marked words with what follows beside it, or with "
    "the whole statements below."
)
"""What the signature says."""
SENTENCES = (
    "What follows is what the checker proved from the certificates of these numbers: [3] stands "
    "for the whole statement of the certificate 3, below. The sentence is quoted from the "
    "manifest. The checker compared its words with those of its rule, and its costs, weights, "
    "margins, distances, rates and steps with the certificates. It did not compare the marked "
    "words: choices, modes, names, some whole numbers. Compare them yourself. Rounded numbers are "
    "rounded to the side on which the sentence stays true. A sentence that was left out of the "
    "manifest is not missed. A REMARK claims nothing. What else a report says, such as 'worth "
    "installing' or what it calls computed and not certified, is not covered by this page."
)
STYLE = """
:root { color-scheme: light dark }
body { font: 16px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 70rem }
body { padding: 0 1rem }
table { border-collapse: collapse; width: 100%; margin: .5rem 0 }
th, td { border-bottom: 1px solid #8886; padding: .3rem .6rem; text-align: left }
td { vertical-align: top }
td { overflow-wrap: anywhere }
td:first-child { overflow-wrap: normal }
.warning { border-left: 4px solid #c60; padding-left: .6rem }
.note, .lead { opacity: .8 }
.signed td:first-child { width: 8rem }
.signed td { height: 2rem }
mark { color: inherit; background: #fc08; border-radius: 3px }
"""


class Marked(str):
    """A text with places that are marked."""

    __slots__ = ("places",)
    places: Sequence[tuple[int, int]]

    def __new__(cls, text: str, places: Sequence[tuple[int, int]]) -> Marked:
        """The text itself, with the places beside it."""
        marked = super().__new__(cls, text)
        marked.places = places
        return marked

    def __html__(self) -> str:
        parts, end = list[str](), 0
        for start, stop in self.places:
            parts += [written(self[end:start]), f"<mark>{written(self[start:stop])}</mark>"]
            end = stop
        return "".join([*parts, written(self[end:])])


@dataclass(frozen=True)
class Table:
    """A table with its heading, the columns if they have heads, and what is said below it."""

    title: str
    columns: tuple[str, ...]
    rows: Sequence[tuple[str, ...]]
    note: str = ""
    style: str = ""


@dataclass(frozen=True)
class Audit:
    """One run of the checker.

    Attributes
    ----------
    found : sequence of Found
        The verdicts, each behind what it is about.
    arguments : sequence of str
        What the command was called with, without what verdicts do not depend on.
    asked : mapping
        The files of the plant and the controller that were asked for, by these words.
    status : int
        The exit status of the run.
    last : str
        The last line that it printed.
    archive : str
        The SHA-256 of the checker as one file, if it is known.
    program : str
        What made the page.
    worded : collection of tuple, optional
        The rules and the texts of sentences that mcexact made again of the same certificates.
    second : mapping
        What mcexact-verified says of certificates, by their places among the verdicts.
    """

    found: Sequence[Found]
    arguments: Sequence[str]
    asked: Mapping[str, str]
    status: int
    last: str
    archive: str = ""
    program: str = ""
    worded: Collection[tuple[str, str]] | None = None
    second: Mapping[int, str] = field(default_factory=dict)

    @classmethod
    def of(
        cls,
        found: Sequence[Found],
        files: Sequence[str],
        manifest: str | None,
        asking: Sequence[str | None],
        **more: Any,
    ) -> Audit:
        """The run of the checker with some files and what was asked of them."""
        names = ("system", "controller", "expect")
        given = {**dict(zip(names, asking, strict=True)), "manifest": manifest}
        options = [(f"--{name}", path) for name, path in given.items() if path is not None]
        words = zip(("plant", "controller"), asking, strict=False)
        asked = {name: path for name, path in words if path is not None}
        arguments = [*files, *(each for pair in options for each in pair)]
        return cls(found, arguments, asked, **more)

    def page(self) -> str:
        """The page, as HTML without scripts."""
        names = " and ".join(map(os.path.basename, self.asked.values()))
        title = f"Audit of certificates{': ' if names else ''}{names}"
        lead = (
            "What a checker verified that shares no code with the program that found it, and how "
            "anybody can repeat it. Do not sign a page that somebody sends: make your own."
        )
        tables = (
            Table("What was checked", (), [*self._facts()]),
            self._certificates(),
            self._sentences(),
            Table("How to repeat it", (), [*self._again()]),
            Table(
                "Signed", (), [(x, "") for x in ("name", "date", "signature")], ATTESTED, "signed"
            ),
            Table("Whole statements", (), [*self._statements()]),
        )
        body = [f"<h1>{escape(title)}</h1>", f'<p class="lead">{escape(lead)}</p>']
        for each in self._answer():
            opened = '<p class="warning">' if each.startswith("warning: ") else "<p>"
            body.append(f"{opened}{escape(each)}</p>")
        body += [rendered(table) for table in tables if table.rows]
        head = f'<meta charset="utf-8"><title>{escape(title)}</title><style>{STYLE}</style>'
        return f'<!doctype html>\n<html lang="en">\n<head>{head}</head>\n<body>\n' + "\n".join(
            [*body, "</body>", "</html>", ""]
        )

    def _answer(self) -> Iterator[str]:
        """The sentences at the top, warnings last."""
        valid, implied = (
            sum(verdict.verdict == kind for _, verdict in self.found) for kind in GOOD
        )
        yield f"{valid} certificates are VALID."
        if implied:
            yield (
                f"From them follows what stands beside {implied} sentences of the report. What the "
                f"checker did not compare in these is marked."
            )
        if self.worded is not None and implied:
            own = sum(
                verdict.verdict == "IMPLIED" and (about["rule"], about["text"]) in self.worded
                for about, verdict in self.found
            )
            number = "all" if own == implied else f"{own} of {implied}"
            yield (
                f"When this page was made, mcexact also computed {number} of these sentences again "
                f"from the certificates, word for word."
            )
        refused = sum(bool(each.status) and each.verdict != "COUNTED" for _, each in self.found)
        if refused:
            yield f"warning: {refused} certificates or sentences are not proved; see below."
        for words, digests in (("plant", self._plants()), ("controller", self._controllers())):
            if digests and words not in self.asked:
                yield f"warning: no {words} was given to compare with: compare the digest."

    def _numbered(self, digest: Callable[[Found], str]) -> dict[str, list[Found]]:
        """The VALID certificates by a digest."""
        groups = defaultdict[str, list[Found]](list)
        for each in self.found:
            if each[1].verdict == "VALID" and digest(each):
                groups[digest(each)].append(each)
        return groups

    def _plants(self) -> dict[str, list[Found]]:
        return self._numbered(lambda each: each[1].system_digest)

    def _controllers(self) -> dict[str, list[Found]]:
        return self._numbered(lambda each: each[1].controller_digest)

    def _facts(self) -> Iterator[tuple[str, ...]]:
        """Files and digests."""
        for words, path in self.asked.items():
            yield f"the {words} asked for", path
            yield from bytes_of(path)
        manifests = (about["manifest"] for about, _ in self.found if "manifest" in about)
        for manifest in dict.fromkeys(manifests):
            yield "the manifest", manifest
            yield from bytes_of(manifest)
        for words, groups in (("plant", self._plants()), ("controller", self._controllers())):
            for k, (digest, each) in enumerate(groups.items()):
                numbers = ", ".join(about.get("number", about["file"]) for about, _ in each)
                which = _which(words, each) if k else f"the {words}"
                yield f"SHA-256 of the numbers of {which}: certificates {numbers}", digest
        if self.archive:
            note = "compare it with that of a copy that you trust, not the sender's"
            yield f"SHA-256 of {ARCHIVE}", f"{self.archive} ({note})"
        yield "made by", f"{self.program}, Python {platform.python_version()}"

    def _certificates(self) -> Table:
        """Each certificate with its verdict, and what it proves or why it does not."""
        rows, note = list[tuple[str, ...]](), "Whole statements stand at the end."
        for k, (about, verdict) in enumerate(self.found):
            if "text" in about or verdict.verdict == "COUNTED":
                continue
            said = verdict.summary or f"{verdict.code} {verdict.place}: {verdict.message}"
            twice = self.second.get(k, "").startswith("CONFIRMED") and verdict.verdict == "VALID"
            row = (about.get("number", ""), about["file"], verdict.verdict, said)
            rows.append((*row, "confirmed" if twice else "") if self.second else row)
        columns: tuple[str, ...] = ("number", "certificate", "verdict", "what is proved")
        if self.second:
            columns += ("mcexact-verified",)
            note += (
                " mcexact-verified is the program extracted from the proof of its own soundness."
            )
        return Table("Certificates", columns, rows, note)

    def _sentences(self) -> Table:
        """Each sentence of the report, quoted, and from which certificates it follows."""
        rows = list[tuple[str, ...]]()
        for about, verdict in self.found:
            if "text" in about:
                follows = verdict.summary
                if verdict.status:
                    follows = f"{verdict.code}: {verdict.message}"
                text = Marked(about["text"], verdict.left_open)
                row = (verdict.verdict, about["premises"], follows, text)
                again = self.worded is not None and (about["rule"], about["text"]) in self.worded
                rows.append(row if self.worded is None else (*row, "yes" if again else ""))
        columns: tuple[str, ...] = ("verdict", "certificates", "what follows from them", "sentence")
        if self.worded is not None:
            columns += ("computed again",)
        return Table("Sentences of the report", columns, rows, SENTENCES)

    def _again(self) -> Iterator[tuple[str, ...]]:
        """Commands, and how they end."""
        yield "this page, with Python alone", self._command("python", "-I", ARCHIVE)
        yield "this page, with mcexact", self._command("mcexact", "check")
        yield "the checker as one file, with mcexact", f"mcexact check --export {ARCHIVE}"
        yield "it ends with, letter by letter", f"status {self.status}, and the line {self.last}"
        yield "SHA-256 of a file", "sha256sum FILE, or on Windows certutil -hashfile FILE SHA256"

    def _command(self, *program: str) -> str:
        return shlex.join([*program, *self.arguments, "--html", "FILE"])

    def _statements(self) -> Iterator[tuple[str, ...]]:
        """What each certificate proves, whole, and its SHA-256."""
        for about, verdict in self.found:
            if "text" not in about and verdict.statement and verdict.verdict != "COUNTED":
                number, digest = about.get("number", about["file"]), verdict.statement_digest
                yield number, f"{verdict.statement} (its SHA-256: {digest})"


def _which(words: str, found: Sequence[Found]) -> str:
    """What a plant or a controller is that is not the one asked about."""
    verdict = found[0][1]
    if words == "controller":
        return "the controller at samples" if " sampled " in verdict.statement else "another one"
    if verdict.summary.startswith("of a plant nearby"):
        return "a plant nearby, for which something fails"
    box = "the plant with radii, which make a box around it"
    return box if RADII in verdict.summary else "another one"


def bytes_of(path: str) -> Iterator[tuple[str, ...]]:
    """The digest of the bytes of a file, as `sha256sum` prints it; nothing of standard input."""
    with suppress(OSError), open(path, "rb") as file:
        yield "its SHA-256, as a file", hashlib.sha256(file.read()).hexdigest()


def rendered(table: Table) -> str:
    """A table as HTML."""
    head = "".join(f"<th>{escape(name)}</th>" for name in table.columns)
    rows = ["".join(f"<td>{_cell(each)}</td>" for each in row) for row in table.rows]
    lines = [f"<tr>{cells}</tr>" for cells in ([head] if head else []) + rows]
    note = f'<p class="note">{escape(table.note)}</p>' if table.note else ""
    opened = f'<table class="{table.style}">' if table.style else "<table>"
    return "\n".join([f"<h2>{escape(table.title)}</h2>", note, opened, *lines, "</table>"])


def _cell(text: str) -> str:
    return text.__html__() if isinstance(text, Marked) else written(text)


def written(text: str) -> str:
    """A text as HTML, with the codes of characters that have no picture or turn others around."""
    return escape("".join(c if c.isprintable() else ascii(c)[1:-1] for c in text))
