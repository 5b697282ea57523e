"""A strict reader of our pages: what a browser would forgive is an error here."""

from __future__ import annotations

import re
from html.parser import HTMLParser

VOID = {"meta", "img", "br", "wbr", "hr", "link", "input"}
KNOWN = VOID | {"html", "head", "title", "style", "body", "header", "main", "section", "p", "div"}
KNOWN |= {"h1", "h2", "h3", "table", "thead", "tbody", "tr", "th", "td", "ul", "li", "pre", "code"}
KNOWN |= {"details", "summary", "figure", "footer", "figcaption", "cite", "span", "a", "b"}
KNOWN |= {
    "math",
    "mrow",
    "mi",
    "mo",
    "mn",
    "msub",
    "msup",
    "mspace",
    "mover",
    "mtable",
    "mtr",
    "mtd",
}
BOXED = {"table", "pre", "img"}
ONCE = {"html", "head", "title", "body", "h1"}


class Page(HTMLParser):
    """Parses a page and raises `ValueError` at the first thing that is not as it should be."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=False)
        self.open: list[tuple[str, str]] = []
        self.tags: list[tuple[str, dict[str, str]]] = []
        self.text = ""
        self.feed(text)
        self.close()
        if self.open:
            raise ValueError(f"not closed: {self.open}")
        for name in ONCE:
            if sum(tag == name for tag, _ in self.tags) != 1:
                raise ValueError(f"expected one {name}")
        ids = [given["id"] for _, given in self.tags if "id" in given]
        if len(ids) != len(set(ids)):
            raise ValueError("an id is used twice")
        for _, given in self.tags:
            target = given.get("href", "")
            if target.startswith("#") and target[1:] not in ids:
                raise ValueError(f"nothing at {target}")

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        raw = self.get_starttag_text() or ""
        if tag not in KNOWN:
            raise ValueError(f"unknown element {raw}")
        names = [name for name, _ in attrs]
        if len(names) != len(set(names)):
            raise ValueError(f"an attribute is given twice: {raw}")
        if "<" in raw[1:]:
            raise ValueError(f"a bare < in {raw}")
        given = {name: value or "" for name, value in attrs}
        for name in names:
            if name.startswith("on"):
                raise ValueError(f"a handler of events: {raw}")
        if tag in BOXED and not any("box" in kind.split() for _, kind in self.open):
            raise ValueError(f"outside of a scroll box: {raw[:80]}")
        if tag == "img" and not given.get("alt"):
            raise ValueError("a picture without a text alternative")
        self.tags.append((tag, given))
        if tag not in VOID:
            self.open.append((tag, given.get("class", "")))

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        raise ValueError(f"<{tag}/> is not HTML")

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open[-1][0] != tag:
            raise ValueError(f"</{tag}> closes {self.open[-1:]}")
        self.open.pop()

    def handle_data(self, data: str) -> None:
        inside = self.open[-1][0] if self.open else ""
        if inside != "style" and re.search(r"[<&]", data):
            raise ValueError(f"a bare < or & in {data[:80]!r}")
        self.text += data

    def handle_comment(self, data: str) -> None:
        raise ValueError("a comment")

    def handle_entityref(self, name: str) -> None:
        self.text += f"&{name};"

    def handle_charref(self, name: str) -> None:
        self.text += f"&#{name};"


def external_addresses(text: str) -> list[str]:
    """Everything in a page that would make a browser ask another host, or another file."""
    page = Page(text)
    found = []
    for tag, given in page.tags:
        for name, value in given.items():
            if name in ("src", "srcset", "href", "action", "data", "poster") and not re.match(
                r"#|data:image/", value
            ):
                found.append(f"{tag} {name}={value}")
    found += re.findall(r"url\([^)]*\)|@import[^;]*", text)
    return found + re.findall(r"https?://[^\s\"'<]*", text)
