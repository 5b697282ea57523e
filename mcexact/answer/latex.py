"""Text and matrices as LaTeX."""

from __future__ import annotations

from mcexact.exact.matrix import Matrix
from mcexact.exact.rational import rational_latex

_ESCAPES = {
    "\\": r"\textbackslash{}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


def escaped(text: str) -> str:
    r"""Escape a text for LaTeX.

    Examples
    --------
    >>> escaped("50% of x_1")
    '50\\% of x\\_1'
    """
    return "".join(_ESCAPES.get(character, character) for character in text)


def matrix(M: Matrix) -> str:
    r"""Format a matrix of exact entries.

    Examples
    --------
    >>> print(matrix(Matrix.from_rows([["1/2", 0]])))
    \begin{bmatrix} \tfrac{1}{2} & 0 \end{bmatrix}
    """

    rows = r" \\ ".join(
        " & ".join(rational_latex(entry, "tfrac") for entry in row) for row in M.rows()
    )
    return rf"\begin{{bmatrix}} {rows} \end{{bmatrix}}"
