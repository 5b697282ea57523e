"""Formulas are set as MathML, and everything else is escaped."""

from __future__ import annotations

import pytest

from mcexact.report.formulas import matrix, typeset

SET = [
    ("no formula & none", "no formula &amp; none"),
    ("`a_b` < `c`", "<code>a_b</code> &lt; <code>c</code>"),
    ("n_i", "<math><msub><mi>n</mi><mi>i</mi></msub></math>"),
    (
        "n_i, and m.",
        '<span class="kept"><math><msub><mi>n</mi><mi>i</mi></msub></math>,</span> and '
        '<span class="kept"><math><mi>m</mi></math>.</span>',
    ),
    ("C_{N_s}", "<math><msub><mi>C</mi><msub><mi>N</mi><mi>s</mi></msub></msub></math>"),
    (
        "B_jF_j",
        "<math><msub><mi>B</mi><mi>j</mi></msub><msub><mi>F</mi><mi>j</mi></msub></math>",
    ),
    (
        "Ĥ_i",
        '<math><msub><mover accent="true"><mi>H</mi><mo>^</mo></mover><mi>i</mi></msub></math>',
    ),
    (
        "B_{m−s}",
        "<math><msub><mi>B</mi><mrow><mi>m</mi><mo>−</mo><mi>s</mi></mrow></msub></math>",
    ),
    (
        "[x; 0]",
        "<math><mo>[</mo><mtable><mtr><mtd><mi>x</mi></mtd></mtr><mtr><mtd><mn>0</mn></mtd></mtr>"
        "</mtable><mo>]</mo></math>",
    ),
    (
        "(A, B)⁻¹",
        "<math><msup><mrow><mo stretchy='false'>(</mo><mi>A</mi><mo>,</mo><mi>B</mi>"
        "<mo stretchy='false'>)</mo></mrow><mrow><mo>−</mo><mn>1</mn></mrow></msup></math>",
    ),
    ("A_32", "<math><msub><mi>A</mi><mn>32</mn></msub></math>"),
]


@pytest.mark.parametrize(("text", "made"), SET, ids=[text for text, _ in SET])
def test_formulas_are_set(text: str, made: str) -> None:
    assert typeset(text) == made


def test_a_matrix_is_set_with_its_name_and_escaped() -> None:
    made = matrix("B_1", [["1", "<"], ["0", "-1/2"]])
    assert made.startswith("<math><msub><mi>B</mi><mn>1</mn></msub><mo>=</mo>")
    assert made.count("<mtr>") == 2 and "&lt;" in made
    assert made.__html__() is made
