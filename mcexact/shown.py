"""How results appear in notebooks: HTML that is readable on light and dark paper, and LaTeX."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import Any

LINE = 200
"""The largest number of characters of a ``repr``."""

_STYLE = """\
.mcexact { --good: #2a9a4f; --bad: #d8502f; --line: rgba(128, 128, 128, 0.45);
  --panel: rgba(128, 128, 128, 0.12); --accent: #3f86d2; color: inherit; overflow-x: auto; }
.mcexact table { border-collapse: collapse; margin: 0.3em 0; color: inherit; }
.mcexact caption { caption-side: top; text-align: left; font-weight: 600; color: inherit;
  padding: 0.2em 0; }
.mcexact tbody tr, .mcexact tbody tr:nth-child(odd) { background: transparent; }
.mcexact th, .mcexact td { text-align: left !important; vertical-align: top; color: inherit;
  padding: 0.25em 0.6em; border: 0; border-bottom: 1px solid var(--line); white-space: normal; }
.mcexact th { background: var(--panel); white-space: nowrap; font-weight: 600; }
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


def framed(body: str) -> str:
    """Return a piece of HTML with the style of this package, which changes nothing around it."""
    return f'<div class="mcexact"><style>{_STYLE}</style>{body}</div>'


def cell(value: Any) -> str:
    """Return a value as a piece of HTML: what shows itself does, and other values are text."""
    if hasattr(value, "piece_of_html"):
        return str(value.piece_of_html())
    if isinstance(value, bool):
        return f'<span class="{"yes" if value else "no"}">{"yes" if value else "no"}</span>'
    return escape(value if isinstance(value, str) else repr(value))


def table(caption: str, rows: Iterable[tuple[str, Any]]) -> str:
    """Return labels and values as a piece of HTML."""
    body = "".join(
        f"<tr><th>{escape(name)}</th><td>{cell(value)}</td></tr>" for name, value in rows
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


def kept(size: int, most: int) -> list[int | None]:
    """Return the positions to show of so many; of more than ``most`` None stands for a gap.

    Examples
    --------
    >>> kept(3, 5), kept(30, 5)
    ([0, 1, 2], [0, 1, None, 28, 29])
    """
    if size <= most:
        return list(range(size))
    edge = most // 2
    return [*range(edge), None, *range(size - edge, size)]
