"""Symbols with indices in plain text, such as ``B_i`` and ``C_{N_s}``, and matrices, in MathML."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from html import escape

_ACCENTS = {"\u0302": "^", "\u0303": "~", "\u0304": "¯"}
_LETTER = r"[A-Za-zΑ-Ωα-ω][\u0302\u0303\u0304]?"
_INDEX = r"\{[^{}]*(?:_[^{}])?[^{}]*\}|[A-Z]|[a-z0-9]+"
_SYMBOL = re.compile(rf"(?<![a-z][a-z])({_LETTER})_({_INDEX})")


class Markup(str):
    """A text in which everything is escaped that has to be."""

    __slots__ = ()

    def __html__(self) -> str:
        """The text itself, which templates insert as it is."""
        return self


def typeset(text: str) -> Markup:
    """Set the symbols with indices in a text as MathML, and escape the rest.

    Parameters
    ----------
    text : str

    Examples
    --------
    >>> typeset("n_i < m")
    '<math><msub><mi>n</mi><mi>i</mi></msub></math> &lt; m'
    """
    plain = unicodedata.normalize("NFD", text)
    parts, end = [], 0
    for found in _SYMBOL.finditer(plain):
        parts += [_plain(plain[end : found.start()]), f"<math>{_symbol(*found.groups())}</math>"]
        end = found.end()
    return Markup("".join([*parts, _plain(plain[end:])]))


def matrix(name: str, rows: Sequence[Sequence[str]]) -> Markup:
    """Set an equation of a symbol and a matrix.

    Parameters
    ----------
    name : str
        Such as ``B_1``.
    rows : sequence of sequences of str

    Examples
    --------
    >>> matrix("A", [["1"]])
    '<math><mi>A</mi><mo>=</mo><mo>[</mo><mtable><mtr><mtd><mn>1</mn></mtd></mtr></mtable><mo>]\
</mo></math>'
    """
    found = _SYMBOL.fullmatch(name)
    left = _symbol(*found.groups()) if found else f"<mi>{escape(name)}</mi>"
    cells = "".join(
        f"<mtr>{''.join(f'<mtd><mn>{escape(entry)}</mn></mtd>' for entry in row)}</mtr>"
        for row in rows
    )
    inside = f"<mtable>{cells}</mtable>"
    return Markup(f"<math>{left}<mo>=</mo><mo>[</mo>{inside}<mo>]</mo></math>")


def _plain(text: str) -> str:
    return escape(unicodedata.normalize("NFC", text), quote=False)


def _symbol(letter: str, index: str) -> str:
    """A letter, perhaps with an accent, and its index."""
    base = f"<mi>{letter[0]}</mi>"
    if letter[1:]:
        base = f'<mover accent="true">{base}<mo>{_ACCENTS[letter[1]]}</mo></mover>'
    return f"<msub>{base}{_index(index.strip('{}'))}</msub>"


def _index(text: str) -> str:
    """An index: a symbol with an index of its own, letters, numbers and signs."""
    found = _SYMBOL.fullmatch(text)
    if found:
        return _symbol(*found.groups())
    tokens = re.findall(r"[A-Za-zα-ω]|[0-9]+|[^\sA-Za-zα-ω0-9]", text)
    names = [
        f"<mn>{each}</mn>"
        if each.isdigit()
        else f"<mi>{each}</mi>"
        if each.isalpha()
        else f"<mo>{escape(each)}</mo>"
        for each in tokens
    ]
    return names[0] if len(names) == 1 else f"<mrow>{''.join(names)}</mrow>"
