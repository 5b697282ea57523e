"""Results as LaTeX, for papers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mcexact.answer.wording import details as say
from mcexact.exact.matrix import Matrix

if TYPE_CHECKING:
    from mcexact.report.assessment import Assessment

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


def assessment_latex(assessment: Assessment) -> str:
    """The system and its fixed modes."""
    system, spectrum = assessment.system, assessment.fixed_spectrum
    lines = [f"% {escaped(system.name or 'system')}", r"\begin{align*}"]
    lines.append(rf"A &= {matrix(system.A)} \\")
    for k, channel in enumerate(system.channels, start=1):
        last = r" \\" if k < system.m else ""
        lines.append(rf"B_{{{k}}} &= {matrix(channel.B)}, & C_{{{k}}} &= {matrix(channel.C)}{last}")
    lines.append(r"\end{align*}")
    if spectrum.empty:
        return "\n".join([*lines, say.LATEX_NOTHING_FIXED()]) + "\n"
    lines += [
        r"\begin{tabular}{lrrl}",
        r"mode & in $A$ & $\operatorname{rank} P_{\mathbf s}$ & $\mathbf s$ \\ \hline",
    ]
    lines += [
        say.LATEX_FIXED_MODE(
            p=factor.polynomial,
            in_A=factor.multiplicity_in_A,
            rank=factor.rank,
            s=", ".join(map(escaped, factor.channels)),
        )
        for factor in spectrum.factors
    ]
    return "\n".join([*lines, r"\end{tabular}"]) + "\n"
