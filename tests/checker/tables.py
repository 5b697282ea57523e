"""The two tests that every table of certificates is made of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import pytest

from tests.checker.handmade import Document, changed, checked


def accepts(rows: Sequence[tuple[str, Document]]) -> Callable[..., None]:
    """A test of rows (reason, document): the checker says VALID."""

    @pytest.mark.parametrize(("reason", "document"), rows)
    def test(reason: str, document: Document) -> None:
        verdict = checked(document)
        assert verdict.verdict == "VALID", verdict.line()

    return test


def rejects(rows: Sequence[tuple[Any, ...]]) -> Callable[..., None]:
    """A test of rows (reason, document, edits): a valid document is not valid once it is changed.

    Edits are one (place, value) or several.  A fourth entry names the verdict, INVALID or
    MALFORMED, where it matters which.
    """

    @pytest.mark.parametrize("row", rows, ids=[row[0] for row in rows])
    def test(row: tuple[Any, ...]) -> None:
        _, document, edits, *expected = row
        assert checked(document).verdict == "VALID"
        verdict = checked(changed(document, *((edits,) if isinstance(edits[0], str) else edits)))
        assert verdict.verdict in (expected or ("INVALID", "MALFORMED")), verdict.line()

    return test
