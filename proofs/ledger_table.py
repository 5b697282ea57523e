"""Write what is known of the paper's statements into the pages of this folder.

All of it is made from `mcexact/reproduce/statements.toml` and `ledger.toml`: the verdicts on the
numbered results in README.md, all statements in STATEMENTS.md, those that are not proved in
OPEN.md, the corrections in ERRATA.md, and in THEOREMS.md every theorem that a statement cites, with
its text.  Names of theorems are links to their lines.

Run as ``python proofs/ledger_table.py`` with the package installed, or by ``make ledger``.
"""

from __future__ import annotations

import re
import textwrap
from functools import cache
from pathlib import Path

from mcexact.reproduce.notebook import (
    STATUSES,
    anchor,
    errata,
    front_table,
    open_table,
    statement_table,
    statements,
)

FOLDER = Path(__file__).parent
BEGIN, END = "<!-- the ledger: made by make ledger -->\n", "<!-- end of the ledger -->\n"
WIDTH = 110  # characters of a line of prose
THEOREM = re.compile(
    r"^(?:Theorem|Corollary|Proposition|Lemma|Remark) (\w+)\b.*?(?=\nProof)",
    re.MULTILINE | re.DOTALL,
)


@cache
def texts(stem: str) -> dict[str, tuple[int, str]]:
    """The theorems of a file, each with its line and its statement."""
    source = (FOLDER / f"{stem}.v").read_text(encoding="utf-8")
    return {
        match[1]: (source.count("\n", 0, match.start()) + 1, match[0])
        for match in THEOREM.finditer(source)
    }


def linked(made: str) -> str:
    """A text in which names of theorems are links to their lines."""

    def link(match: re.Match[str]) -> str:
        stem, name = match[1], match[2]
        if not (FOLDER / f"{stem}.v").is_file() or name not in texts(stem):
            return match[0]
        return f"[`{stem}.{name}`]({stem}.v#L{texts(stem)[name][0]})"

    return re.sub(r"`(\w+)\.(\w+)`", link, made)


def theorem_pages() -> str:
    """Every theorem that a statement cites: the statements that it proves, and its text in Coq."""
    proves: dict[str, list[str]] = {}
    for each in statements():
        number = f"[statement {each.number}](STATEMENTS.md#{each.number})"
        where = ", ".join(filter(None, (each.equation, f"section {each.section}")))
        for name in each.proofs:
            row = f"{where}, {number}, {STATUSES[each.status]}: {each.says}"
            proves.setdefault(name, []).append(row)
    order = sorted(
        proves,
        key=lambda name: (name.partition(".")[0] != "paper", name.partition(".")[0], place(name)),
    )
    parts = []
    for name in order:
        stem, _, theorem = name.partition(".")
        rows = "\n".join(f"- {row}" for row in proves[name])
        text = texts(stem)[theorem][1]
        code = "\n".join([*abbreviations(stem, text), text])
        place_of = f'<a id="{anchor(name)}"></a>'
        parts.append(f"### {place_of}`{name}`\n\n{rows}\n\n```coq\n{code}\n```\n")
    return "\n".join(parts)


ABBREVIATION = re.compile(
    r"^(?:Local |Let )?(?:Notation|Definition|Let) \"?(\w+)\b.*?\.$(?=\n)", re.MULTILINE | re.DOTALL
)


def abbreviations(stem: str, text: str) -> list[str]:
    """The definitions and notations of the file of a theorem that its text uses, as they stand."""
    source = (FOLDER / f"{stem}.v").read_text(encoding="utf-8")
    return [
        match[0]
        for match in ABBREVIATION.finditer(source)
        if len(match[1]) > 2 and re.search(rf"(?<![\w.]){match[1]}\b", text)
    ]


def place(name: str) -> int:
    """The line of a theorem."""
    stem, _, theorem = name.partition(".")
    return texts(stem)[theorem][0]


TABLES = {
    "README.md": front_table,
    "STATEMENTS.md": statement_table,
    "OPEN.md": open_table,
    "ERRATA.md": errata,
    "THEOREMS.md": theorem_pages,
}
"""The pages with a part that is made, and what makes it."""


def wrapped(made: str) -> str:
    """A text whose paragraphs and items have lines that fit on a screen; tables and code stay."""
    lines, code = [], False
    for line in made.split("\n"):
        code ^= line.startswith("```")
        if code or len(line) <= WIDTH or line.startswith(("|", "#")):
            lines.append(line)
        else:
            rest = "  " if line.startswith("- ") else ""
            lines += textwrap.wrap(
                line, WIDTH, subsequent_indent=rest, break_long_words=False, break_on_hyphens=False
            )
    return "\n".join(lines)


def renewed(text: str, made: str) -> str:
    """The text with the part as the package makes it now."""
    before, found, rest = text.partition(BEGIN)
    _, closed, after = rest.partition(END)
    if not found or not closed:
        raise SystemExit("the marks around the table are missing")
    return before + BEGIN + wrapped(linked(made)) + END + after


if __name__ == "__main__":
    for name, made in TABLES.items():
        page = FOLDER / name
        page.write_text(renewed(page.read_text(encoding="utf-8"), made()), encoding="utf-8")
