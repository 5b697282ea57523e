"""Certificates whose evidence are two polynomials, as it is where the blocks leave more."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any
from unittest import mock

from mcexact.answer.protocol import Answer, document
from tests.checker.handmade import Document


def by_polynomials(decide: Callable[..., Answer], *arguments: Any, **keywords: Any) -> Document:
    """The certificate of a decision about what agents share."""
    with mock.patch("mcexact.analysis.sharing.free_blocks", return_value=None):
        return document(decide(*arguments, **keywords))
