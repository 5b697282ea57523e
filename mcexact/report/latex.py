"""Results as LaTeX, for papers."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mcexact.answer.latex import escaped, matrix
from mcexact.answer.wording import details as say

if TYPE_CHECKING:
    from mcexact.report.assessment import Assessment


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
