"""Sentences, accounts and tables as text, or of pandas."""

from __future__ import annotations

import os
import shutil
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, TextIO

from mcexact.answer.account import LABELS, MODES, PROOFS, PROVED, Account
from mcexact.answer.analysis import FIXED_MODE
from mcexact.answer.sentence import Sentences
from mcexact.answer.templates import Sentence
from mcexact.errors import InputError, MissingExtra
from mcexact.exact import matrix
from mcexact.exact.matrix import Matrix
from mcexact.shown import array, escaped

# Sentences and tables as text, with lines no longer than the width of the terminal.

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


# The account of a system as text: sentences and tables.

_COLUMNS = {
    "fixed-modes": FIXED_MODE.columns,
    "pencil": ("factor of det(xI-A)", "rank", "below n"),
    "why": ("these agents", "can receive from", "need", "because of"),
}
_COLUMNS_OF_ROWS = {"allocate-row": ("agent", "least"), "allocate-link": ("from", "to", "cost")}
_BOUNDS = {"outputs+states": "Theorem 2's bound", "states": "Remark 2's bound"}
_CONTINUOUS = "numerical abscissa", "no eigenvalue: the rate at which a norm can grow at first"
_DISCRETE = (
    "numerical radius",
    "no eigenvalue: in t steps a norm grows to at most twice its power t",
)
_MORE = "Further fixed modes are listed below."
_SHOWN = "the first {}; the JSON document and the HTML page list all. "


def answer(sentences: Sentences) -> list[str]:
    """The most important sentences, in order."""
    return [*sentences.at("answer", "answer.mode")]


def in_lines(sentences: Sentences, most: int, width: int = WIDTH) -> str:
    """Return the answer in a number of lines; sentences that the table repeats may be left out.

    Parameters
    ----------
    sentences : Sentences
    most : int
        The largest number of lines.  Fixed modes are left out first, last ones first; then whole
        sentences from the end.  No sentence is cut.
    width : int
        The largest number of characters in a line.
    """
    first, modes = sentences.at("answer"), sentences.at("answer.mode")
    for shown in range(len(modes), -1, -1):
        more = [_MORE] if 0 < shown < len(modes) else []
        lines = [line for each in (*first, *modes[:shown], *more) for line in wrapped(each, width)]
        if len(lines) <= most:
            return "\n".join(lines) + "\n"
    lines = []
    for each in first:
        if len(lines) + len(wrapped(each, width)) > most:
            break
        lines += wrapped(each, width)
    return "\n".join(lines) + "\n"


def tables(
    sentences: Sentences, *, most_modes: int | None = None, note: str = ""
) -> tuple[Table, ...]:
    """Return the table of all answers, then the tables about further questions.

    Parameters
    ----------
    sentences : Sentences
    most_modes : int, optional
        The largest number of fixed modes in the table, by default all.
    note : str
        What stands below the table of all answers.
    """
    rows = sentences.at("table")
    columns = _columns(rows[0]) if rows else ()
    first = _table(sentences, "table", columns, "".join(sentences.at("title")))
    all_tables = [replace(first, note="; ".join(filter(None, (first.note, note))))]
    for place in ("fixed-modes", "pencil", "subsystem", "channel", "bound and least", "why"):
        if sentences.at(place):
            all_tables.append(_table(sentences, place, _COLUMNS.get(place, ()), most=most_modes))
    return tuple(all_tables)


def _columns(row: Sentence) -> tuple[str, ...]:
    """Return the names of a table's columns; a bound is named after its theorem."""
    if row.template.key == "allocate-row-bound":
        read = {pointer: value for _, pointer, value in row.because}
        return ("agent", "least", _BOUNDS[read["/claim/share"]])
    return _COLUMNS_OF_ROWS.get(row.template.key, ())


def _table(
    sentences: Sentences,
    place: str,
    columns: Sequence[str],
    title: str = "",
    most: int | None = None,
) -> Table:
    """Return the table of the sentences of a place, with its title and notes."""
    rows = [sentence.cells for sentence in sentences.at(place)]
    note = "".join(sentences.at(f"{place}.note"))
    if place == "fixed-modes" and most is not None and len(rows) > most:
        rows, note = rows[:most], _SHOWN.format(most) + note
    title = title or "".join(sentences.at(f"{place}.title")) or place
    return Table(title, tuple(columns), tuple(rows), note)


def parameter_tables(account: Account, *, whole: bool = False) -> tuple[Table, ...]:
    """Return the table of all answers, then tables with the details of some questions.

    Parameters
    ----------
    account : Account
    whole : bool
        Whether all questions have a table, and not only those about modes: on a page.
    """
    sentences = account.sentences
    rows = tuple(each.cells for each in sentences.at("table"))
    title = "All answers" if whole else "".join(sentences.at("title"))
    first = (Table(title, (), rows),) if rows else ()
    shown = account.detailed(LABELS) if whole else account.detailed(MODES)
    proofs = account.proofs(LABELS if whole else MODES)
    proved = (Table(PROVED, PROOFS, proofs),) if proofs else ()
    return (*first, *(Table(LABELS[name], *account.table(name)) for name in shown), *proved)


def measured(
    figures: Mapping[str, float | None],
    assessed: Sequence[tuple[str, str]],
    sentences: Sentences,
    discrete: bool,
) -> Table:
    """Return the figures of a loop that are not proved; a dash if numbers exceed floats.

    Parameters
    ----------
    figures : mapping
        The robustness measures of the loop.
    assessed : sequence of pairs
        Labels and texts of further figures, which come first.
    sentences : Sentences
    discrete : bool
    """
    labels = {
        "numerical": _DISCRETE if discrete else _CONTINUOUS,
        "distance_to_instability": (
            "distance to instability, at most",
            "the 2-norm of a change of the loop's matrix that makes it unstable",
        ),
    }
    rows = [
        (label, "–" if (value := figures.get(name)) is None else f"{value:.3g} ({meaning})")
        for name, (label, meaning) in labels.items()
    ]
    return Table("".join(sentences.at("measured.title")), (), (*assessed, *rows))


def _matrix(M: Matrix) -> str:
    return matrix.latex(M, whole=True)


def latex(account: Account) -> str:
    """Return the system and its fixed modes in LaTeX."""
    system = account.given.system
    lines = [f"% {escaped(system.name or 'system')}", r"\begin{align*}"]
    lines.append(rf"A &= {_matrix(system.A)} \\")
    for k, channel in enumerate(system.channels, start=1):
        last = r" \\" if k < system.m else ""
        lines.append(
            rf"B_{{{k}}} &= {_matrix(channel.B)}, & C_{{{k}}} &= {_matrix(channel.C)}{last}"
        )
    lines.append(r"\end{align*}")
    formulas: list[str] = [*account.sentences.at("latex")]
    if any(sentence.template.key == "latex-fixed-mode" for sentence in account.sentences):
        head = r"mode & in $A$ & $\operatorname{rank} P_{\mathbf s}$ & $\mathbf s$ \\ \hline"
        formulas = [r"\begin{tabular}{lrrl}", head, *formulas, r"\end{tabular}"]
    return "\n".join([*lines, *formulas]) + "\n"


# Results as tables of pandas.


def parameter_latex(account: Account) -> str:
    """Return the system and the answers in LaTeX."""
    lines = [
        f"% {escaped(account.given.system.name or 'system')}",
        rf"\[ {account.given.system._latex()} \]",
    ]
    lines += [escaped(sentence) for sentence in account.at("answer")]
    lines += [escaped(each.line) for each in account.sentences.at("table")]
    for name in account.detailed():
        rows = ((where, "; ".join(filter(None, rest))) for where, *rest in account.rows(name))
        lines.append(rf"\[ {array(rows)} \]")
    if proofs := account.proofs(MODES):
        rows = ((about, "; ".join(rest)) for about, *rest in proofs)
        lines += [escaped(PROVED), rf"\[ {array(rows)} \]"]
    return "\n".join(lines) + "\n"


def to_pandas(results: Any) -> Any:
    """Return results as a table of pandas, which the extra ``pandas`` installs.

    Parameters
    ----------
    results : Analysis, Trajectory, or iterable of answers or of the records of a sweep
        One row for each answer, time or system.  Exact numbers stay exact; the times of a
        trajectory are floats.

    Returns
    -------
    pandas.DataFrame

    Raises
    ------
    InputError
        If the results are of another kind.
    MissingExtra
        If pandas is not installed.

    Examples
    --------
    >>> from mcexact import analyze
    >>> from mcexact.model import gallery
    >>> analysis = analyze(gallery.load("hidden-triple-mode"), ["fixed_spectrum", "completeness"])
    >>> to_pandas(analysis)[["question", "polynomial", "complete"]]
             question polynomial complete
    0  fixed_spectrum      x - 1      NaN
    1    completeness        NaN    False
    """
    with MissingExtra.named("pandas"):
        import pandas

    if hasattr(results, "snapshots"):
        return pandas.DataFrame(results.to_rows()).astype({"t": float})
    if hasattr(results, "to_rows"):
        return pandas.DataFrame(results.to_rows())
    several = isinstance(results, Iterable) and not isinstance(results, str)
    members = list(results) if several and not hasattr(results, "to_row") else [results]
    for each in members:
        if not hasattr(each, "to_row"):
            raise InputError(
                "expected an analysis, a trajectory, answers, or records of a sweep, "
                f"found {type(each).__name__}",
                where="results",
            )
    return pandas.DataFrame([each.to_row() for each in members])
