"""The form of what persons read: a page for each version, and lines that fit on a screen."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import mcexact

ROOT = Path(__file__).parents[2]
PAGE = 60  # lines
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
# What a line about a fault says, which users of released versions never met.
HISTORY = re.compile(r"\bno longer\b|\bin place of an error\b|\bbefore\)|: it (?:was|said|took)\b")


def test_the_changelog_has_one_page_for_each_version() -> None:
    versions = re.split(r"^## ", CHANGELOG, flags=re.MULTILINE)[1:]
    assert versions[0].startswith(mcexact.__version__)
    assert all(version.count("\n") <= PAGE for version in versions)


def test_the_changelog_has_no_history_of_faults() -> None:
    first = CHANGELOG.rpartition("\n## ")[2]
    assert not HISTORY.findall(first)


WIDTH = 120  # characters of a line in a source
MADE = re.compile(r"^<!-- the ledger: .*?^<!-- end of the ledger -->", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^( *)(`{3,}|\$\$).*?^\1\2", re.MULTILINE | re.DOTALL)
SPAN = re.compile(r"`[^`]{60,}`")  # of code, which no line may divide
INDENTED = re.compile(r"(?<=\n)\n(?: {4}.*\n)+")
# Made by programs from data, or lists of code.
LISTS = {
    *("DESIGNS.md", "SPEED.md", "SENTENCES.md", "THEOREMS.md"),
    *("SURVIVORS.md", "WEAKENED.md"),
}
PAGES = sorted(
    path
    for folder in (".", "docs", "proofs", "benchmarks", "examples", "verified", "mcexact")
    for path in (ROOT / folder).glob("*.md" if folder == "." else "**/*.md")
    if path.name not in LISTS and "generated" not in path.parts
)


def long_lines(text: str) -> list[str]:
    """The lines of prose that are too long; tables, code and formulas may be."""
    prose = INDENTED.sub("", CODE.sub("", MADE.sub("", text)))
    return [
        line
        for line in prose.splitlines()
        if len(SPAN.sub("``", line)) > WIDTH and not line.startswith("|")
    ]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_lines_of_pages_can_be_read_in_their_source(path: Path) -> None:
    assert not long_lines(path.read_text(encoding="utf-8"))


def test_a_long_line_is_found_where_it_is_prose() -> None:
    words = "word " * 30
    assert long_lines(f"a\n\n{words}\n") == [words]
    assert not long_lines(f"| {words} |\n\n```text\n{words}\n```\n\n$$\n{words}\n$$\n")


LEADING = [path for path in PAGES if path.parts[len(ROOT.parts)] in {"README.md", "docs"}]
HEADINGS = {
    re.sub(r"[^\w -]", "", title).lower().replace(" ", "-")
    for title in re.findall(
        r"^## (.*)$", (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8"), re.MULTILINE
    )
}


def test_what_pages_link_in_the_glossary_is_there() -> None:
    texts = [path.read_text(encoding="utf-8") for path in LEADING]
    linked = {place for text in texts for place in re.findall(r"glossary\.md#([\w-]+)", text)}
    assert linked and linked <= HEADINGS, linked - HEADINGS


@pytest.mark.parametrize("page", ["README.md", "docs/index.md", "CITATION.cff"])
def test_the_paper_and_what_reproduces_it_are_named_where_one_begins(page: str) -> None:
    text = " ".join((ROOT / page).read_text(encoding="utf-8").split())
    assert "Distributed Feedback Control of Multi-Channel Linear Systems" in text
    assert "`mcexact reproduce" in text


@pytest.mark.parametrize("path", LEADING, ids=lambda path: str(path.relative_to(ROOT)))
def test_commands_and_what_they_print_fit_into_80_columns(path: Path) -> None:
    text = path.read_text(encoding="utf-8")
    consoles = re.findall(r"^`{3}(?:\{code-block\} )?console\n(.*?)^`{3}", text, re.M | re.S)
    assert all(len(line) <= 80 for each in consoles for line in each.splitlines())
