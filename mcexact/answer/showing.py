"""Display of answers: one line, HTML, LaTeX and plain data; items that do not fit are left out."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from mcexact import shown
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import polynomial, rational_text, written
from mcexact.model.text import plain
from mcexact.shown import LINE, Shown

if TYPE_CHECKING:
    from mcexact.answer.protocol import Answer

_CELL = 300
_MOST = 20


def line(answer: Answer) -> str:
    """Return the claims on one line, in which no number and no name is cut."""
    values = answer.claim()
    if answer.subject:
        values["of"] = tuple(each["construction"] for each in answer.subject)
    return call(type(answer).__name__, values)


def call(head: str, values: Mapping[str, Any]) -> str:
    """Return values by their names on one line, in which no number and no name is cut.

    Notes
    -----
    Each value first gets the space of its shortest form; the remaining space goes to the values
    with the shortest complete forms.
    """
    texts = {key: fitted(value, 0) for key, value in values.items()}
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
    """Return plain data, with polynomials and matrices as lists of exact numbers."""
    if isinstance(value, Polynomial):
        return [written(c) for c in value.coefficients]
    if isinstance(value, Matrix):
        return [[written(entry) for entry in row] for row in value.rows()]
    if hasattr(value, "document"):
        return {key: plain_view(item) for key, item in value.document().items()}
    if isinstance(value, (tuple, list)):
        return [plain_view(item) for item in value]
    return plain(value)


def flat(value: Any) -> Any:
    """Return a value for one cell of a table: texts and numbers, or the number of items."""
    if value is None or isinstance(value, (bool, int, str, Fraction)):
        return value
    if isinstance(value, Polynomial):
        return str(value)
    if isinstance(value, Matrix):
        return f"{value.nrows} × {value.ncols}"
    return len(value) if isinstance(value, (tuple, list)) else fitted(value, _CELL)


def displayed(value: Any) -> Any:
    """Return a value as notebooks show it: parts as a table, and what is long shortened."""
    if isinstance(value, tuple) and value and len(value) <= _MOST and _is_part(value[0]):
        return Parts(value)
    if isinstance(value, (bool, Matrix, Polynomial)) or _is_part(value):
        return value
    if isinstance(value, tuple) and value and all(isinstance(each, str) for each in value):
        told = ", ".join(value)
        return told if len(told) <= _CELL else fitted(value, _CELL)
    if isinstance(value, str) and len(value) <= _CELL:
        return value
    return "none" if value is None or value == () else fitted(value, _CELL)


def _is_part(value: Any) -> bool:
    return hasattr(value, "document") and hasattr(value, "_labeled")


class Parts(Shown):
    """Several parts of one kind, one row for each."""

    def __init__(self, parts: Sequence[Any]) -> None:
        self._parts = parts

    def _labeled(self) -> Iterator[tuple[str, Any]]:
        """Yield each part with its number."""
        yield from ((str(k), each) for k, each in enumerate(self._parts, start=1))

    def _rows(self) -> list[list[Any]]:
        return [[value for _, value in each._labeled()] for each in self._parts]

    def _html(self) -> str:
        """Return a table in HTML."""
        return shown.grid([label for label, _ in self._parts[0]._labeled()], self._rows())

    def _latex(self) -> str:
        """Return an array in LaTeX."""
        return r" \quad ".join(each._latex() for each in self._parts)
