"""Formulas in plain text, and their LaTeX and MathML.

Sentences are written once, as plain text with formulas such as ``A + Σ B_i F_i`` and ``[λI − A,
B_i; C_s, 0]``.  `formulas` finds these formulas by a small grammar and reads them into trees of
`Node`; `typeset_latex` and `typeset` write the trees as LaTeX and as MathML, and escape the rest of
the text.  Text that the grammar does not read as a formula stays text.
"""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape

from mcexact.shown import escaped

# Reading formulas in plain text into trees.

RELATIONS = ["=", "≠", "≥", "≤", "<", ">", "∈", "⊂", "→"]
OPERATORS = ["+", "−", "∖", "∪", "∩", "·", "×", "⊗", "/"]
BRACKETS = {"(": ")", "[": "]", "{": "}"}
NAMES = ("rank", "det", "column", "diag", "exp", "min")
PRODUCTS = ("BF", "KC", "Fx", "Fe", "BFe", "Ax", "Mt", "ct", "mn", "nm", "mr", "gA", "sI", "λI")
"""Products of letters without a space, which have the form of words."""

_LETTER = "[A-Za-zΑ-ΩΣα-ω][\u0302\u0303\u0304\u0307]?"
_TOKEN = re.compile(
    rf"(?P<product>(?:{'|'.join(PRODUCTS)})(?![A-Za-z]))"
    rf"|(?P<name>(?:{'|'.join(NAMES)})(?![A-Za-z]))"
    r"|(?P<sum>Σ)"
    rf"|(?P<letter>{_LETTER})(?![A-Za-zα-ω])(?!['’][a-z])"
    r"|(?P<number>[0-9]+(?:\.[0-9]+)?)"
    r"|(?P<symbol>[∅…ℝℂℚ])"
)
_INDEX = re.compile(r"_(\{[^{}]*\}|[A-Z]|[a-z0-9]+)")
_IN_INDEX = re.compile(r"([0-9]+|\S)(?:_([A-Za-z0-9]))?")
_POWER = re.compile(r"⁻?[⁰¹²³⁴⁵⁶⁷⁸⁹]+|'+(?![A-Za-z])")
_DIGITS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻'", "0123456789−′")


@dataclass(frozen=True)
class Node:
    """A part of a formula.

    Attributes
    ----------
    kind : str
        ``letter``, ``number``, ``name``, ``operator``, or a construction from parts: ``row``,
        ``index``, ``power``, ``product``, ``fenced``, ``matrix`` with rows as parts.
    text : str
        The sign, letter or word; for ``fenced`` the opening and the closing bracket.
    parts : tuple of Node
    """

    kind: str
    text: str = ""
    parts: tuple[Node, ...] = ()

    def any(self, *kinds: str) -> bool:
        """Whether it or a part of it is of some kind."""
        return self.kind in kinds or any(part.any(*kinds) for part in self.parts)


class _NoFormula(Exception):
    """There is no formula at this place."""


class _Reader:
    """Read one formula from a place of a text.

    A relation is between sums, a sum is of products, and a product is of factors, with a space
    between them only where neither could be a word.
    """

    def __init__(self, text: str, at: int, end: int) -> None:
        self.text, self.at, self.end = text, at, end

    def relation(self) -> Node:
        return self._chain(self._sum, RELATIONS)

    def _sum(self) -> Node:
        if self._sign(["−"]):
            return Node("row", parts=(Node("operator", "−"), self._sum()))
        return self._chain(self._product, OPERATORS)

    def _chain(self, inner: Callable[[], Node], signs: list[str]) -> Node:
        """Parts with signs between them; a sign without a part after it is left in the text."""
        parts = [inner()]
        while True:
            before = self.at
            sign = self._sign(signs)
            if sign is None:
                break
            try:
                parts += [Node("operator", sign), inner()]
            except _NoFormula:
                self.at = before
                break
        return parts[0] if len(parts) == 1 else Node("row", parts=tuple(parts))

    def _sign(self, signs: list[str]) -> str | None:
        """Step over one of these signs, with spaces around it."""
        at = self._past_spaces(self.at)
        first = next((sign for sign in signs if self.text.startswith(sign, at, self.end)), None)
        if first is None:
            return None
        self.at = self._past_spaces(at + len(first))
        return first

    def _past_spaces(self, at: int) -> int:
        while at < self.end and self.text[at] == " ":
            at += 1
        return at

    def _product(self) -> Node:
        parts = [self._factor()]
        while self.at < self.end:
            before = self.at
            self.at = self._past_spaces(before)
            try:
                following = self._factor()
            except _NoFormula:
                self.at = before
                break
            # A word may follow after a space; letters with indices and brackets are no words.
            if self.at > before and self.text[before] == " " and not _joins(parts[-1], following):
                self.at = before
                break
            parts.append(following)
        return parts[0] if len(parts) == 1 else Node("row", parts=tuple(parts))

    def _factor(self) -> Node:
        factor = self._primary()
        if self.at < self.end and (index := _INDEX.match(self.text, self.at, self.end)):
            inside = index[1].strip("{}")
            self.at = index.end()
            factor = Node("index", parts=(factor, _index(inside)))
        if power := _POWER.match(self.text, self.at, self.end):
            self.at = power.end()
            raised = power[0].translate(_DIGITS)
            factor = Node("power", parts=(factor, _index(raised)))
        return factor

    def _primary(self) -> Node:
        if self.at >= self.end:
            raise _NoFormula
        if self.text[self.at] in BRACKETS:
            return self._bracket()
        token = _TOKEN.match(self.text, self.at, self.end)
        if token is None or _within_a_word(self.text, self.at):
            raise _NoFormula
        self.at = token.end()
        kind, text = str(token.lastgroup), token[0]
        if kind == "product":
            return Node("row", parts=tuple(Node("letter", each) for each in text))
        kinds = {"symbol": "letter", "sum": "sum"}
        return Node(kinds.get(kind, kind), text)

    def _bracket(self) -> Node:
        opening = self.text[self.at]
        close = _closing(self.text, self.at, self.end)
        inside = (self.at + 1, close)
        if opening == "[":
            node = _matrix(self.text, *inside)
        else:
            node = Node("fenced", opening + BRACKETS[opening], _listed(self.text, *inside))
        self.at = close + 1
        return node


def _within_a_word(text: str, at: int) -> bool:
    """Whether the letter before this place belongs to the same word."""
    before = text[at - 1 : at]
    return before.isalpha() and before.isascii() and text[at - 2 : at - 1].isalpha()


def _joins(left: Node, right: Node) -> bool:
    """Whether two factors with a space between them are a product."""
    sure = ("index", "power", "sum", "fenced", "matrix")
    if left.kind in ("sum", "name"):
        return True
    if right.kind == "fenced" and len(right.parts) == 1 and right.parts[0].kind == "number":
        return False
    if right.text == "a":
        return False
    return "power" in (left.kind, right.kind) or (left.any(*sure) and right.any(*sure))


def _closing(text: str, at: int, end: int) -> int:
    """The place of the bracket that closes the one at a place."""
    depth = 0
    for place in range(at, end):
        depth += (text[place] in "([{") - (text[place] in ")]}")
        if depth == 0:
            if text[place] != BRACKETS[text[at]]:
                break
            return place
    raise _NoFormula


def _split(text: str, start: int, end: int, sign: str) -> list[tuple[int, int]]:
    """The places between signs outside of brackets."""
    places, depth, first = [], 0, start
    for place in range(start, end):
        depth += (text[place] in "([{") - (text[place] in ")]}")
        if depth == 0 and text[place] == sign:
            places.append((first, place))
            first = place + 1
    return [*places, (first, end)]


def _whole(text: str, start: int, end: int) -> Node:
    """The formula that a part of the text is, without spaces at its ends."""
    while start < end and text[start] == " ":
        start += 1
    while start < end and text[end - 1] == " ":
        end -= 1
    reader = _Reader(text, start, end)
    node = reader.relation()
    if reader.at != end:
        raise _NoFormula
    return node


def _listed(text: str, start: int, end: int) -> tuple[Node, ...]:
    """Formulas with commas between them."""
    return tuple(_whole(text, *each) for each in _split(text, start, end, ","))


def _matrix(text: str, start: int, end: int) -> Node:
    """Rows with semicolons between them; entries with commas, or else with spaces."""
    rows = []
    for row in _split(text, start, end, ";"):
        commas = _split(text, *row, ",")
        try:
            entries = commas if len(commas) > 1 else [row]
            cells = [_whole(text, *each) for each in entries]
        except _NoFormula:
            spaced = [each for each in _split(text, *row, " ") if each[0] < each[1]]
            cells = [_whole(text, *each) for each in spaced]
        rows.append(Node("row", parts=tuple(cells)))
    return Node("matrix", parts=tuple(rows))


def _index(text: str) -> Node:
    """An index or a power: a formula, or letters and digits side by side."""
    try:
        return _whole(text, 0, len(text))
    except _NoFormula:
        parts = [_sign_of_index(*each) for each in _IN_INDEX.findall(text)]
        return parts[0] if len(parts) == 1 else Node("row", parts=tuple(parts))


def _sign_of_index(sign: str, index: str) -> Node:
    """A letter of an index, which may have one of its own, a number, or a sign."""
    kind = "number" if sign.isdigit() else "letter" if sign.isalpha() else "operator"
    node = Node(kind, sign)
    return Node("index", parts=(node, _index(index))) if index else node


def _is_worth_setting(node: Node, text: str, start: int, end: int) -> bool:
    """Whether a node is a formula, and not a word, a number or a reference to an equation."""
    if node.any("index", "power", "operator", "sum", "matrix", "name"):
        return node.kind != "name"
    if node.kind == "fenced":
        numbers = all(part.kind == "number" for part in node.parts)
        return not (numbers and len(node.parts) == 1 and node.text == "()")
    if node.kind == "row":
        return True
    if node.kind != "letter" or node.text in ("a", "I", "V", "…"):
        return False
    article = node.text == "A" and re.match(r" (?!(?:and|is|has) )[a-z]{2}", text[end:])
    begins = start == 0 or text[:start].rstrip().endswith((".", ":"))
    hyphened = text[end : end + 1] == "-" or text[start - 1 : start] == "-"
    return not (article and begins) and not hyphened


def formulas(text: str) -> Iterator[str | Node]:
    """Split a text into words, as they are, and formulas.

    Parameters
    ----------
    text : str

    Yields
    ------
    str or Node

    Examples
    --------
    >>> [each if isinstance(each, str) else each.kind for each in formulas("All n_i > 0 do.")]
    ['All ', 'row', ' do.']
    """
    plain = unicodedata.normalize("NFD", text).replace("=\u0338", "≠")
    words, at = 0, 0
    while at < len(plain):
        reader = _Reader(plain, at, len(plain))
        try:
            if at and (plain[at - 1].isalnum() or plain[at - 1] in "`_.'’"):
                raise _NoFormula
            node = reader.relation()
            if not _is_worth_setting(node, plain, at, reader.at):
                raise _NoFormula
        except _NoFormula:
            at += 1
            continue
        if words < at:
            yield unicodedata.normalize("NFC", plain[words:at])
        yield node
        at = words = reader.at
    if words < len(plain):
        yield unicodedata.normalize("NFC", plain[words:])


# Writing in LaTeX.

_ACCENTS = {"\u0302": "hat", "\u0303": "tilde", "\u0304": "bar", "\u0307": "dot"}
_NAMES = {
    "≠": r"\ne",
    "≥": r"\ge",
    "≤": r"\le",
    "∈": r"\in",
    "⊂": r"\subset",
    "→": r"\to",
    "−": "-",
    "∖": r"\setminus",
    "∪": r"\cup",
    "∩": r"\cap",
    "·": r"\cdot",
    "×": r"\times",
    "⊗": r"\otimes",
    "∅": r"\emptyset",
    "…": r"\dots",
    "λ": r"\lambda",
    "φ": r"\varphi",
    "ε": r"\epsilon",
    "σ": r"\sigma",
    "Λ": r"\Lambda",
    "′": r"\prime",
}
_BRACES = {"{": r"\{", "}": r"\}"}


def typeset_latex(text: str) -> str:
    r"""Set the formulas in a text in LaTeX and names in backticks as code, and escape the rest.

    Parameters
    ----------
    text : str

    Examples
    --------
    >>> print(typeset_latex("if n_i ≥ 1"))
    if $n_{i} \ge 1$
    """
    pieces = [
        rf"\texttt{{{escaped(piece)}}}" if k % 2 else _with_formulas(piece)
        for k, piece in enumerate(text.split("`"))
    ]
    return "".join(pieces)


def _with_formulas(text: str) -> str:
    """A text without code."""
    return "".join(
        escaped(each).replace("…", r"\dots{}") if isinstance(each, str) else f"${_set(each)}$"
        for each in formulas(text)
    )


def _set(node: Node) -> str:
    """A formula in LaTeX."""
    match node.kind:
        case "letter" | "operator":
            return _letter(node.text)
        case "number":
            return node.text
        case "name":
            return rf"\operatorname{{{node.text}}}"
        case "sum":
            return r"\textstyle\sum"
        case "index":
            return f"{_set(node.parts[0])}_{{{_set(node.parts[1])}}}"
        case "power":
            return f"{{{_set(node.parts[0])}}}^{{{_set(node.parts[1])}}}"
        case "fenced":
            opening, closing = (_BRACES.get(each, each) for each in (node.text[0], node.text[1]))
            return f"{opening}{', '.join(map(_set, node.parts))}{closing}"
        case "matrix":
            rows = r" \\ ".join(" & ".join(map(_set, row.parts)) for row in node.parts)
            return rf"\left[\begin{{smallmatrix}} {rows} \end{{smallmatrix}}\right]"
        case _:
            return " ".join(map(_set, node.parts))


def _letter(text: str) -> str:
    """A letter, perhaps with an accent, or a sign."""
    base = _NAMES.get(text[0], escaped(text[0]))
    return rf"\{_ACCENTS[text[1]]}{{{base}}}" if text[1:] else base


# Writing in MathML.

_MATHML_ACCENTS = {"\u0302": "^", "\u0303": "~", "\u0304": "¯", "\u0307": "˙"}


class Markup(str):
    """A text in which all special characters are escaped."""

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
    written = [
        f"<code>{escape(piece, quote=False)}</code>" if k % 2 else _with_mathml(piece)
        for k, piece in enumerate(pieces)
    ]
    return Markup("".join(written))


def _with_mathml(text: str) -> str:
    """A text without code; a sign after a formula stays on its line."""
    written: list[str] = []
    for each in formulas(text):
        if isinstance(each, Node):
            written.append(f"<math>{_mathml_set(each)}</math>")
            continue
        word = escape(each, quote=False)
        if written and word[0] in ",.;:)":
            written[-1] = f'<span class="kept">{written[-1]}{word[0]}</span>'
            word = word[1:]
        written.append(word)
    return "".join(written)


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
    (left,) = (_mathml_set(each) for each in formulas(name) if isinstance(each, Node))
    cells = [[f"<mn>{escape(entry)}</mn>" for entry in row] for row in rows]
    return Markup(f"<math>{left}<mo>=</mo>{_table(cells)}</math>")


def _table(cells: Sequence[Sequence[str]]) -> str:
    """A matrix in square brackets."""
    rows = "".join(f"<mtr>{''.join(f'<mtd>{cell}</mtd>' for cell in row)}</mtr>" for row in cells)
    return f"<mo>[</mo><mtable>{rows}</mtable><mo>]</mo>"


def _mathml_set(node: Node) -> str:
    """A formula in MathML."""
    match node.kind:
        case "letter":
            return _mathml_letter(node.text)
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
            inside = "<mo>,</mo>".join(map(_mathml_set, node.parts))
            fence = "<mo stretchy='false'>"
            return f"{fence}{node.text[0]}</mo>{inside}{fence}{node.text[1]}</mo>"
        case "matrix" if len(node.parts) == 1:
            inside = "<mspace width='0.5em'></mspace>".join(map(_mathml_set, node.parts[0].parts))
            return f"<mo>[</mo>{inside}<mo>]</mo>"
        case "matrix":
            return _table([[_mathml_set(cell) for cell in row.parts] for row in node.parts])
        case _:
            return "".join(map(_mathml_set, node.parts))


def _one(node: Node) -> str:
    """A formula as one element."""
    element = _mathml_set(node)
    single = node.kind in ("letter", "number", "operator", "index", "power", "sum")
    return element if single and element.count("<mo>′") == 0 else f"<mrow>{element}</mrow>"


def _mathml_letter(text: str) -> str:
    """A letter, perhaps with an accent."""
    base = f"<mi>{unicodedata.normalize('NFC', text[0])}</mi>"
    if text[1:]:
        return f'<mover accent="true">{base}<mo>{_MATHML_ACCENTS[text[1]]}</mo></mover>'
    return base
