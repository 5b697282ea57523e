"""Sentences and tables as text, with lines no longer than the width of the terminal."""

from __future__ import annotations

import os
import shutil
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TextIO

WIDTH = 80
"""The default width of text."""
WIDE = 200
"""The width of tables with many columns when they are written to a pipe."""
_NARROWEST = 8


@dataclass(frozen=True)
class Table:
    """A table with a title; without column names it lists names and values."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def shorten(text: str, limit: int = 60) -> str:
    """Shorten a long name or message in the middle; numbers must not be shortened like this.

    Examples
    --------
    >>> shorten("0123456789" * 20, 21)
    '0123456789…0123456789'
    """
    if len(text) <= limit:
        return text
    half = (limit - 1) // 2
    return f"{text[:half]}…{text[-half:]}"


def wrapped(text: str, width: int) -> list[str]:
    """Break a text into lines at blanks, and also words longer than a line.

    Examples
    --------
    >>> wrapped("one two three", 8), wrapped("", 8)
    (['one two', 'three'], [''])
    """
    return textwrap.wrap(text, max(width, 8), break_on_hyphens=False) or [""]


def plain(tables: Sequence[Table], width: int = WIDTH) -> str:
    """Format tables as aligned lines, with blank lines between them."""
    return "\n\n".join("\n".join(_lines(table, width)) for table in tables) + "\n"


def _lines(table: Table, width: int) -> Iterator[str]:
    """Format title, rows and note; cells that are too long continue in the lines below."""
    if table.title:
        yield from wrapped(table.title, width)
    rows = [table.columns, *table.rows] if table.columns else list(table.rows)
    widths = _widths(rows, width - 2)
    for row in rows:
        cells = [wrapped(cell, room) for cell, room in zip(row, widths, strict=True)]
        for k in range(max(map(len, cells))):
            parts = (
                (cell[k] if k < len(cell) else "").ljust(room)
                for cell, room in zip(cells, widths, strict=True)
            )
            yield ("  " + "  ".join(parts)).rstrip()
    if table.note:
        yield from ("  " + line for line in wrapped(f"({table.note})", width - 2))


def _widths(rows: Sequence[Sequence[str]], room: int) -> list[int]:
    """The width of each column: that of its longest cell, the widest ones narrowed to fit."""
    widths = [max(len(cell) for cell in column) for column in zip(*rows, strict=True)]
    room -= 2 * (len(widths) - 1)
    fitting = (
        cap
        for cap in range(max(widths, default=0), _NARROWEST, -1)
        if sum(min(width, cap) for width in widths) <= room
    )
    cap = next(fitting, _NARROWEST)
    return [min(width, cap) for width in widths]


def show(tables: Sequence[Table], stream: TextIO) -> None:
    """Draw tables on a terminal, with highlighted titles and column names."""
    import click

    width = shutil.get_terminal_size((WIDTH, 24)).columns
    plain_terminal = "NO_COLOR" in os.environ or os.environ.get("TERM") == "dumb"
    for number, table in enumerate(tables):
        titles = len(wrapped(table.title, width)) if table.title else 0
        if number:
            click.echo(file=stream)
        for k, line in enumerate(_lines(table, width)):
            if k < titles and not plain_terminal:
                line = click.style(line, bold=True)
            elif table.columns and k == titles and not plain_terminal:
                line = click.style(line, underline=True)
            click.echo(line, file=stream)
