"""The answers to the documents that are kept stay what they are."""

from __future__ import annotations

import json

import pytest

from tests.checker.kept import answer, by_group

KEPT = by_group()


@pytest.mark.parametrize("group", sorted(KEPT))
def test_a_kept_document_has_its_answer(group: str) -> None:
    for case in KEPT[group]:
        assert answer(case) == case["answer"], json.dumps(case)
