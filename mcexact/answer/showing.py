"""Display of answers: one line, HTML, LaTeX and plain data; items that do not fit are left out."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from fractions import Fraction
from html import escape
from typing import TYPE_CHECKING, Any

from mcexact.answer.latex import escaped
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import rational_text
from mcexact.exact.shortened import polynomial
from mcexact.model.canonical import plain
from mcexact.shown import LINE

if TYPE_CHECKING:
    from mcexact.answer.protocol import Answer

_CELL = 300


def line(answer: Answer) -> str:
    """Return the claims on one line, in which no number and no name is cut.

    Notes
    -----
    Each claim first gets the space of its shortest form; the remaining space goes to the claims
    with the shortest complete forms.
    """
    values = answer.claim()
    if answer.subject:
        values["of"] = tuple(each["construction"] for each in answer.subject)
    texts = {key: fitted(value, 0) for key, value in values.items()}
    head = type(answer).__name__
    room = LINE - len(_call(head, texts))
    for _, key in sorted((len(fitted(value, LINE)), key) for key, value in values.items()):
        longer = fitted(values[key], len(texts[key]) + room)
        room += len(texts[key]) - len(longer)
        texts[key] = longer
    return _call(head, texts)


def _call(head: str, texts: dict[str, str]) -> str:
    return f"{head}({', '.join(f'{key}={text}' for key, text in texts.items())})"


def fitted(value: Any, room: int) -> str:
    """Return a value in a number of characters, or in its shortest form if it needs more.

    Examples
    --------
    >>> fitted(("1", "2", "3", "4"), 18), fitted(("1", "2"), 0)
    ("('1', … 3 more)", '(… 2 more)')
    >>> fitted(Polynomial.of(7, 0, -3, 1), 30), fitted(Polynomial.of(7, 0, -3, 1), 12)
    ('x^3 - 3*x^2 + 7', '… (degree 3)')
    """
    if isinstance(value, (tuple, list)):
        return _sequence(value, room)
    if isinstance(value, Polynomial):
        text = polynomial(value, room)
        return text if len(text) <= room else f"… (degree {value.degree})"
    if isinstance(value, Matrix):
        return f"{value.nrows}×{value.ncols} matrix"
    if dataclasses.is_dataclass(value):
        names = getattr(value, "brief", ()) or (dataclasses.fields(value)[0].name,)
        told = tuple(getattr(value, name) for name in names)
        return fitted(told[0] if len(told) == 1 else told, room)
    text = rational_text(value) if isinstance(value, Fraction) else repr(value)
    short = value is None or isinstance(value, bool)
    return text if short or len(text) <= room else "…"


def _sequence(values: Sequence[Any], room: int) -> str:
    """Return the first few items, each complete, and the number of the others."""
    kept: list[str] = []
    used = len("(,)")
    for place, value in enumerate(values):
        left = len(values) - place - 1
        more = len(f", … {left} more") if left else 0
        text = fitted(value, LINE)
        if used + len(text) + more > room:
            break
        kept.append(text)
        used += len(text) + len(", ")
    left = len(values) - len(kept)
    if left:
        kept.append(f"… {left} more")
    return f"({', '.join(kept)}{',' if len(kept) == 1 and not left else ''})"


def plain_view(value: Any) -> Any:
    """Return plain data, with polynomials and matrices as lists of exact strings."""
    if isinstance(value, Polynomial):
        return [rational_text(c) for c in value.coefficients]
    if isinstance(value, Matrix):
        return [[rational_text(entry) for entry in row] for row in value.rows()]
    if hasattr(value, "document"):
        return {key: plain_view(item) for key, item in value.document().items()}
    if isinstance(value, (tuple, list)):
        return [plain_view(item) for item in value]
    return plain(value)


def html(answer: Answer) -> str:
    """Return everything displayed as an HTML table."""
    rows = "".join(
        f"<tr><th>{escape(label)}</th><td>{escape(fitted(value, _CELL))}</td></tr>"
        for _, label, value in answer.entries()
    )
    return f"<table><caption>{type(answer).__name__}</caption>{rows}</table>"


def latex(answer: Answer) -> str:
    """Return everything displayed as a LaTeX array."""
    rows = r" \\ ".join(
        rf"\text{{{escaped(label)}}} & {_latex(value)}" for _, label, value in answer.entries()
    )
    return rf"$\begin{{array}}{{ll}} {rows} \end{{array}}$"


def _latex(value: Any) -> str:
    if isinstance(value, Polynomial):
        return value.latex()
    return rf"\text{{{escaped(fitted(value, _CELL))}}}"
