"""Plain text with its formulas, and matrices, in MathML."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from html import escape

from mcexact.report.formulas import Node, formulas

_ACCENTS = {"\u0302": "^", "\u0303": "~", "\u0304": "¯", "\u0307": "˙"}


class Markup(str):
    """A text in which everything is escaped that has to be."""

    __slots__ = ()

    def __html__(self) -> str:
        """The text itself, which templates insert as it is."""
        return self


def typeset(text: str) -> Markup:
    """Set the formulas in a text as MathML and names in backticks as code, and escape the rest.

    Parameters
    ----------
    text : str

    Examples
    --------
    >>> typeset("if n_i < m")
    'if <math><msub><mi>n</mi><mi>i</mi></msub><mo>&lt;</mo><mi>m</mi></math>'
    """
    pieces = text.split("`")
    made = [
        f"<code>{escape(piece, quote=False)}</code>" if k % 2 else _with_formulas(piece)
        for k, piece in enumerate(pieces)
    ]
    return Markup("".join(made))


def _with_formulas(text: str) -> str:
    """A text without code; a sign after a formula stays on its line."""
    made: list[str] = []
    for each in formulas(text):
        if isinstance(each, Node):
            made.append(f"<math>{_set(each)}</math>")
            continue
        said = escape(each, quote=False)
        if made and said[0] in ",.;:)":
            made[-1] = f'<span class="kept">{made[-1]}{said[0]}</span>'
            said = said[1:]
        made.append(said)
    return "".join(made)


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
    (left,) = (_set(each) for each in formulas(name) if isinstance(each, Node))
    cells = [[f"<mn>{escape(entry)}</mn>" for entry in row] for row in rows]
    return Markup(f"<math>{left}<mo>=</mo>{_table(cells)}</math>")


def _table(cells: Sequence[Sequence[str]]) -> str:
    """A matrix in square brackets."""
    rows = "".join(f"<mtr>{''.join(f'<mtd>{cell}</mtd>' for cell in row)}</mtr>" for row in cells)
    return f"<mo>[</mo><mtable>{rows}</mtable><mo>]</mo>"


def _set(node: Node) -> str:
    """A formula in MathML."""
    match node.kind:
        case "letter":
            return _letter(node.text)
        case "number":
            return f"<mn>{node.text}</mn>"
        case "name":
            return f"<mi>{node.text}</mi><mspace width='0.2em'></mspace>"
        case "sum":
            return "<mo>∑</mo>"
        case "operator":
            return f"<mo>{escape(node.text)}</mo>"
        case "power" if set(node.parts[1].text) == {"′"}:
            # The sign is raised already.
            return f"{_one(node.parts[0])}<mo>{node.parts[1].text}</mo>"
        case "index" | "power":
            base, mark = (_one(part) for part in node.parts)
            name = "msub" if node.kind == "index" else "msup"
            return f"<{name}>{base}{mark}</{name}>"
        case "fenced":
            inside = "<mo>,</mo>".join(map(_set, node.parts))
            fence = "<mo stretchy='false'>"
            return f"{fence}{node.text[0]}</mo>{inside}{fence}{node.text[1]}</mo>"
        case "matrix" if len(node.parts) == 1:
            inside = "<mspace width='0.5em'></mspace>".join(map(_set, node.parts[0].parts))
            return f"<mo>[</mo>{inside}<mo>]</mo>"
        case "matrix":
            return _table([[_set(cell) for cell in row.parts] for row in node.parts])
        case _:
            return "".join(map(_set, node.parts))


def _one(node: Node) -> str:
    """A formula as one element."""
    made = _set(node)
    single = node.kind in ("letter", "number", "operator", "index", "power", "sum")
    return made if single and made.count("<mo>′") == 0 else f"<mrow>{made}</mrow>"


def _letter(text: str) -> str:
    """A letter, perhaps with an accent."""
    base = f"<mi>{unicodedata.normalize('NFC', text[0])}</mi>"
    if text[1:]:
        return f'<mover accent="true">{base}<mo>{_ACCENTS[text[1]]}</mo></mover>'
    return base
