"""The account of a system as text: sentences and tables."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from mcexact.answer.account import Account
from mcexact.answer.sentence import Sentences
from mcexact.answer.template import Sentence
from mcexact.exact import matrix
from mcexact.exact.matrix import Matrix
from mcexact.report.text import WIDTH, Table, wrapped
from mcexact.shown import escaped

_COLUMNS = {
    "fixed-modes": ("factor", "roots, about", "stable", "in A", "fixed", "s", "rank"),
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
    said, modes = sentences.at("answer"), sentences.at("answer.mode")
    for shown in range(len(modes), -1, -1):
        more = [_MORE] if 0 < shown < len(modes) else []
        lines = [line for each in (*said, *modes[:shown], *more) for line in wrapped(each, width)]
        if len(lines) <= most:
            return "\n".join(lines) + "\n"
    lines = []
    for each in said:
        if len(lines) + len(wrapped(each, width)) > most:
            break
        lines += wrapped(each, width)
    return "\n".join(lines) + "\n"


def tables(sentences: Sentences, *, most_modes: int | None = None) -> tuple[Table, ...]:
    """Return the table of all answers, then the tables about further questions.

    Parameters
    ----------
    sentences : Sentences
    most_modes : int, optional
        The largest number of fixed modes in the table, by default all.
    """
    rows = sentences.at("table")
    columns = _columns(rows[0]) if rows else ()
    made = [_table(sentences, "table", columns, "".join(sentences.at("title")))]
    for place in ("fixed-modes", "pencil", "subsystem", "channel", "why"):
        if sentences.at(place):
            made.append(_table(sentences, place, _COLUMNS.get(place, ()), most=most_modes))
    return tuple(made)


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


def measured(
    figures: Mapping[str, float | None],
    assessed: Sequence[tuple[str, str]],
    said: Sentences,
    discrete: bool,
) -> Table:
    """Return the figures of a loop that are not proved; a dash if numbers exceed floats.

    Parameters
    ----------
    figures : mapping
        The robustness measures of the loop.
    assessed : sequence of pairs
        Labels and texts of further figures, which come first.
    said : Sentences
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
        (label, "–" if (value := figures.get(name)) is None else f"{value:.3g} ({told})")
        for name, (label, told) in labels.items()
    ]
    return Table("".join(said.at("measured.title")), (), (*assessed, *rows))


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
    said: list[str] = [*account.sentences.at("latex")]
    if any(sentence.template.key == "latex-fixed-mode" for sentence in account.sentences):
        head = r"mode & in $A$ & $\operatorname{rank} P_{\mathbf s}$ & $\mathbf s$ \\ \hline"
        said = [r"\begin{tabular}{lrrl}", head, *said, r"\end{tabular}"]
    return "\n".join([*lines, *said]) + "\n"
