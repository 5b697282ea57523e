"""Formulas are found in plain text, whole, and words are left as they are."""

from __future__ import annotations

import re

import pytest

from mcexact.report.formulas import Node, formulas, typeset, typeset_latex
from mcexact.reproduce.notebook import examinations, statements

FOUND = [
    ("A + Σ B_i F_i C_i is the loop", ["A + Σ B_i F_i C_i"]),
    ("A distributed controller in place of A", ["A"]),
    ("A and B_i are the plant's", ["A", "B_i"]),
    ("(A, B) has index m if m r = n, by (16)", ["(A, B)", "m", "m", "r = n"]),
    ("rank [λI − A, B_{m−s}; C_s, 0] < n", ["rank [λI − A, B_{m−s}; C_s, 0] < n"]),
    ("iff [A B; C 0] has full row rank", ["[A B; C 0]"]),
    ("C_i(sI − A)⁻¹B_j, and det C A⁻¹ B ≠ 0", ["C_i(sI − A)⁻¹B_j", "det C A⁻¹ B ≠ 0"]),
    ("it has ñ = n + Σ (n_i + d_i n_i) states", ["ñ = n + Σ (n_i + d_i n_i)"]),
    ("x_{j_2} is late by d_{ij_2}; x_i(t − d_i)", ["x_{j_2}", "d_{ij_2}", "x_i(t − d_i)"]),
    ("e_i' and e' = (A + KC)e", ["e_i'", "e' = (A + KC)e"]),
    ("N_s∖s = {i}, or N_s∖s ≠ ∅", ["N_s∖s = {i}", "N_s∖s ≠ ∅"]),
    ("agent 1's; sections V-A and I; the numbers 1 and 2", []),
    ("`a_b.c_d` is code", []),
    ("a bracket (that is words) and [x", ["x"]),
    ("a wrong one (x] ends", ["x"]),
    ("an open sum: x + for", ["x"]),
]


def told(node: Node) -> str:
    """A formula in letters and signs alone."""
    brackets = node.text if node.kind == "fenced" else "[]" if node.kind == "matrix" else ""
    if not node.parts:
        return node.text
    return brackets[:1] + "".join(map(told, node.parts)) + brackets[1:]


@pytest.mark.parametrize(("text", "wanted"), FOUND, ids=[text for text, _ in FOUND])
def test_formulas_are_found_whole(text: str, wanted: list[str]) -> None:
    def bare(formula: str) -> str:
        return re.sub(r"[ _,;{}()]", "", formula).replace("'", "′").replace("⁻¹", "−1")

    pieces = [piece for k, piece in enumerate(text.split("`")) if not k % 2]
    found = [each for piece in pieces for each in formulas(piece) if isinstance(each, Node)]
    assert [bare(told(each)) for each in found] == [
        bare(each.replace("ñ", "n\u0303")) for each in wanted
    ]


def test_no_sign_of_the_report_stays_outside_of_a_formula() -> None:
    texts = [text for each in statements() for text in (each.says, each.note, each.closes)]
    for row in examinations():
        texts += [row.title, row.says, row.verdicts, row.erratum, *row.nearest_false.values()]
    for text in texts:
        outside = re.sub(r"<(math|code)>.*?</\1>|</?span[^>]*>|&lt;|&gt;", "", typeset(text))
        assert not re.search(r"[=≠≥≤<>∈∖Σ⊗_−λφ∅]", outside), (text, outside)
        latex = re.sub(r"\$[^$]*\$|\\texttt\{[^}]*\}", "", typeset_latex(text))
        assert not re.search(r"[=_^]", latex) and latex.isascii(), (text, latex)


def test_formulas_are_set_in_latex() -> None:
    text = "if [M_k; e_i'] ≠ 0, x̂ = (A + gA)² or `a_b`, 50 %"
    assert typeset_latex(text) == (
        r"if $\left[\begin{smallmatrix} M_{k} \\ {e_{i}}^{\prime} \end{smallmatrix}\right] \ne 0$, "
        r"$\hat{x} = {(A + g A)}^{2}$ or \texttt{a\_b}, 50 \%"
    )
