"""The verdicts on documents of the campaign stay what they are."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact.checker import check_document
from tests.checker.kept import by_kind, said

KEPT = by_kind()


def data_of(document: Any) -> Any:
    """What the checker is given: the bytes of a text, or the document itself."""
    return document.encode("utf-8", "surrogatepass") if isinstance(document, str) else document


@pytest.mark.parametrize("kind", sorted(KEPT))
def test_a_kept_document_has_its_verdict(kind: str) -> None:
    for expected, document in KEPT[kind]:
        found = said(check_document(data_of(document)))
        assert found == expected, json.dumps(document)
