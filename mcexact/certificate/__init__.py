"""Kinds of certificates whose answers are declared elsewhere still: frozen dataclasses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.model.canonical import Document


@dataclass(frozen=True)
class Certificate:
    """A statement about a system, with the evidence for it."""

    kind: ClassVar[str] = ""

    system: Document
    subject: tuple[Document, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        raise NotImplementedError

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        raise NotImplementedError
