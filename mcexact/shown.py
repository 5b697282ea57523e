"""How results are shown in notebooks: HTML for light and dark backgrounds, and LaTeX."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import Any

LINE = 200
"""The largest number of characters of a ``repr``."""

MOST_ROWS = 60
"""The most rows of a table in a notebook."""

_STYLE = """\
.mcexact { --good: #2a9a4f; --bad: #d8502f; --line: rgba(128, 128, 128, 0.45);
  --panel: rgba(128, 128, 128, 0.12); --accent: #3f86d2; color: inherit; overflow-x: auto;
  padding-top: 0.35em; }
.mcexact table { border-collapse: collapse; margin: 0.3em 0; color: inherit; }
.mcexact caption { caption-side: top; text-align: left; font-weight: 600; color: inherit;
  padding: 0.2em 0; }
.mcexact tbody tr { background: transparent !important; }
.mcexact th, .mcexact td { text-align: left !important; vertical-align: top; color: inherit;
  padding: 0.25em 0.6em; border: 0; border-bottom: 1px solid var(--line); white-space: normal; }
.mcexact th { background: var(--panel); white-space: nowrap; font-weight: 600; max-width: 24em;
  overflow: hidden; text-overflow: ellipsis; }
.mcexact .yes { color: var(--good); font-weight: 600; }
.mcexact .no { color: var(--bad); font-weight: 600; }
.mcexact .said { border-left: 0.3em solid var(--accent); background: var(--panel);
  padding: 0.4em 0.8em; margin: 0.4em 0; list-style: none; }
.mcexact .said li { margin: 0.2em 0; }
.mcexact table.matrix { border-left: 2px solid currentColor; border-right: 2px solid currentColor;
  border-radius: 0.5em; display: inline-table; margin: 0.15em 0; }
.mcexact table.matrix td { border: 0; padding: 0.1em 0.5em; text-align: right !important; }
.mcexact sup { line-height: 0; }
"""


_ESCAPES = {
    "\\": r"\textbackslash{}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


_SIGNS = {
    "\\": r"{\backslash}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "~": r"{\sim}",
    "^": r"{\wedge}",
}
_PIECES = re.compile(r"([^\\&%$#_{}~^]+)|\^([0-9]+)|([\\&%$#_{}~^])")


class Shown:
    """A result that is shown as a table of labels and values."""

    def _labeled(self) -> Iterable[tuple[str, Any]]:
        """Return the labels and the values that are shown."""
        raise NotImplementedError

    def explain(self) -> str:
        """Say the result in plain words, one label with its value a line."""
        return "\n".join(f"{label}: {_said(value)}" for label, value in self._labeled())

    def _html(self) -> str:
        """Return the table in HTML, to be shown inside of another one."""
        return table(type(self).__name__, self._labeled())

    def _latex(self) -> str:
        """Return the table in LaTeX, to be shown inside of another one."""
        return array(self._labeled())

    def _repr_html_(self) -> str:
        return framed(self._html())

    def _repr_latex_(self) -> str:
        return rf"$\displaystyle {self._latex()}$"


def fitting(text: str, room: int = LINE) -> str:
    """Return a text, cut at its end if it is longer than a line.

    Examples
    --------
    >>> fitting("a long story", 8)
    'a long …'
    """
    return text if len(text) <= room else f"{text[: room - 1]}…"


def _said(value: Any) -> str:
    """Return a value in words, on one line."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "; ".join(value.explain().splitlines()) if isinstance(value, Shown) else str(value)


def framed(body: str) -> str:
    """Return a piece of HTML with the style of this package, which changes nothing around it."""
    return f'<div class="mcexact"><style>{_STYLE}</style>{body}</div>'


def cell(value: Any) -> str:
    """Return a value as a piece of HTML, by its own method if it has one, otherwise as text."""
    if hasattr(value, "_html"):
        return str(value._html())
    if isinstance(value, bool):
        return f'<span class="{"yes" if value else "no"}">{"yes" if value else "no"}</span>'
    return escape(value if isinstance(value, str) else repr(value))


def table(caption: str, rows: Iterable[tuple[str, Any]]) -> str:
    """Return labels and values as a piece of HTML; only the first ones if there are very many."""
    body = "".join(
        f"<tr><th>{escape(name)}</th><td>{cell(value)}</td></tr>" for name, value in first(rows)
    )
    return f"<table><caption>{escape(caption)}</caption><tbody>{body}</tbody></table>"


def grid(head: Sequence[str], rows: Iterable[Sequence[Any]], caption: str = "") -> str:
    """Return rows below the names of their columns as a piece of HTML."""
    names = "".join(f"<th>{escape(name)}</th>" for name in head)
    body = "".join(
        "<tr>" + "".join(f"<td>{cell(value)}</td>" for value in row) + "</tr>" for row in rows
    )
    over = f"<caption>{escape(caption)}</caption>" if caption else ""
    return f"<table>{over}<thead><tr>{names}</tr></thead><tbody>{body}</tbody></table>"


def array(rows: Iterable[tuple[str, Any]]) -> str:
    """Return labels and values as LaTeX; only the first ones if there are very many."""
    body = r" \\ ".join(rf"{words(name)} & {latex(value)}" for name, value in first(rows))
    return rf"\begin{{array}}{{ll}} {body} \end{{array}}"


def first(rows: Iterable[tuple[str, Any]]) -> Iterator[tuple[str, Any]]:
    """Yield the rows to show; if some are left out, the last row says so."""
    for k, row in enumerate(rows):
        if k == MOST_ROWS:
            yield "…", "more, which `to_dict` or `explain` gives"
            return
        yield row


def latex(value: Any) -> str:
    """Return a value as LaTeX, by its own method if it has one, otherwise as text."""
    if hasattr(value, "_latex"):
        return str(value._latex())
    text = ("yes" if value else "no") if isinstance(value, bool) else value
    return words(text if isinstance(text, str) else repr(text))


def words(text: str) -> str:
    r"""Return a text for a formula, with special characters escaped and powers raised.

    LaTeX, MathJax and KaTeX set these alike; inside of ``\text`` MathJax knows no escapes.

    Examples
    --------
    >>> words("best_rate")
    '\\text{best}\\_\\text{rate}'
    >>> words("x^12 + 1")
    '\\text{x}^{12}\\text{ + 1}'
    """
    set_apart = (
        rf"\text{{{plain}}}" if plain else rf"^{{{power}}}" if power else _SIGNS[sign]
        for plain, power, sign in _PIECES.findall(text)
    )
    return "".join(set_apart) or r"\text{}"


def escaped(text: str) -> str:
    r"""Escape a text for LaTeX.

    Examples
    --------
    >>> escaped("50% of x_1")
    '50\\% of x\\_1'
    """
    return "".join(_ESCAPES.get(character, character) for character in text)


def kept(size: int, most: int) -> list[int | None]:
    """Return the positions to show; of more than ``most``, None stands for those left out.

    Examples
    --------
    >>> kept(3, 5), kept(30, 5)
    ([0, 1, 2], [0, 1, None, 28, 29])
    """
    if size <= most:
        return list(range(size))
    half = most // 2
    return [*range(half), None, *range(size - half, size)]
