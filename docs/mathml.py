"""Formulas as MathML, which browsers set by themselves: no script, and none from another place."""

from __future__ import annotations

import re

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.writers.html5 import HTML5Translator


def mathml(formula: str, **options: str) -> str:
    """Set a formula: names of operators without room in front, and a slash that every font has."""
    found: str = convert(formula.strip("$"), **options)
    named = re.sub(r"<mo>(\w{2,})</mo>(?=<m[is])", r"<mi>\1</mi><mspace width='0.17em'/>", found)
    return re.sub(r"<mo>(\w{2,})</mo>", r"<mi>\1</mi>", named).replace(
        "<mi>&#x029F5;</mi>", "<mo>\\</mo>"
    )


def visit_inline(self: HTML5Translator, node: nodes.math) -> None:
    """Set a formula in a line."""
    self.body.append(mathml(node.astext()))
    raise nodes.SkipNode


def visit_block(self: HTML5Translator, node: nodes.math_block) -> None:
    """Set a formula on lines of its own."""
    formula = mathml(node.astext(), display="block")
    self.body.append(f'<div class="math">{formula}</div>\n')
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    """Make this the way in which formulas are set."""
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
