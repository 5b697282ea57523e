"""The checker's table of rules beside the sentences that are said of systems."""

from __future__ import annotations

import pytest

from mcexact.answer.listing import everything
from mcexact.answer.template import Template
from mcexact.checker.manifest import RULES

TEMPLATES = tuple(everything())


@pytest.mark.parametrize("template", TEMPLATES, ids=lambda template: template.key)
def test_the_checker_knows_every_sentence_by_its_theorem(template: Template) -> None:
    assert RULES[template.key].theorem == template.theorem
    assert bool(RULES[template.key].roles) == bool(template.premises)


def test_the_checker_knows_no_sentence_that_is_never_said() -> None:
    assert set(RULES) == {template.key for template in TEMPLATES}
