"""Plain text with its formulas in LaTeX."""

from __future__ import annotations

from mcexact.report.formulas import Node, formulas
from mcexact.shown import escaped

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
    made = [
        rf"\texttt{{{escaped(piece)}}}" if k % 2 else _with_formulas(piece)
        for k, piece in enumerate(text.split("`"))
    ]
    return "".join(made)


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
