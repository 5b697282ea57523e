"""Text and matrices as LaTeX."""

from __future__ import annotations

from mcexact.exact.matrix import Matrix

_ESCAPES = {
    "\\": r"\textbackslash{}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


def escaped(text: str) -> str:
    r"""Text that LaTeX sets as it is.

    Examples
    --------
    >>> escaped("50% of x_1")
    '50\\% of x\\_1'
    """
    return "".join(_ESCAPES.get(character, character) for character in text)


def matrix(M: Matrix) -> str:
    r"""A matrix of exact entries.

    Examples
    --------
    >>> print(matrix(Matrix.from_rows([["1/2", 0]])))
    \begin{bmatrix} \tfrac{1}{2} & 0 \end{bmatrix}
    """

    def entry(x: object) -> str:
        text = str(x)
        sign = "-" if text.startswith("-") else ""
        top, bar, bottom = text.lstrip("-").partition("/")
        return f"{sign}\\tfrac{{{top}}}{{{bottom}}}" if bar else text

    rows = r" \\ ".join(" & ".join(entry(x) for x in row) for row in M.rows())
    return rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}"
