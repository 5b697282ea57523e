"""Every text in what a command shows, whatever the form, without the help of what made it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from html.parser import HTMLParser
from typing import Any

BETWEEN_CELLS = re.compile(r" {2,}")


def texts_of_plain(text: str) -> Iterator[str]:
    """Titles, rows with their cells joined by bars, and notes of unbroken lines."""
    for line in text.splitlines():
        body = line.strip()
        if body.startswith("(") and body.endswith(")") and line.startswith("  "):
            body = body[1:-1]
        if body:
            yield BETWEEN_CELLS.sub(" | ", body)


class _Blocks(HTMLParser):
    """The texts of paragraphs, headings, captions and rows.

    What the user gave and when it was written is left out, as is evidence in <pre>.
    """

    ALONE = frozenset({"p", "h1", "h2", "h3", "summary", "figcaption", "title"})

    def __init__(self) -> None:
        super().__init__()
        self.texts: list[str] = []
        self.cells: list[str] | None = None
        self.parts: list[str] | None = None
        self.given = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "footer" or ("class", "given") in attrs:
            self.given = True
        elif tag == "tr":
            self.cells = []
        elif tag in self.ALONE | {"td", "th"}:
            self.parts = []

    def handle_endtag(self, tag: str) -> None:
        if tag in {"td", "th"} and self.cells is not None and self.parts is not None:
            self.cells.append("".join(self.parts))
        elif tag in self.ALONE and self.parts is not None and not self.given:
            self.texts.append("".join(self.parts))
        elif tag == "tr" and self.cells is not None:
            if not self.given:
                self.texts.append(" | ".join(self.cells))
            self.cells = None
        if tag in self.ALONE | {"td", "th"}:
            self.parts = None
        if tag in {"section", "footer"}:
            self.given = False

    def handle_data(self, data: str) -> None:
        if self.parts is not None:
            self.parts.append(data)
        elif data.strip() and not self.given and self.lasttag not in {"style", "pre"}:
            self.texts.append(data.strip())


def texts_of_html(page: str) -> list[str]:
    """Every text of a page that is no certificate."""
    reader = _Blocks()
    reader.feed(page)
    return reader.texts


def texts_of_latex(text: str) -> Iterator[str]:
    """The lines that are not the matrices of the system, which the user gave."""
    for line in text.splitlines():
        if not re.match(r"%|\\begin|\\end|[AB](_\{\d+\})? &=|mode & in", line):
            yield line


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """The leaves of a JSON document with the keys that lead there; lists have no numbers."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from leaves(item, f"{path}.{key}" if path else key)
    elif isinstance(value, list):
        for item in value:
            yield from leaves(item, path)
    else:
        yield path, value
