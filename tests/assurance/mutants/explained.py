"""The changes that ``tests/checker/SURVIVORS.md`` explains: no test can notice them, or has to."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

EXPLAINED = Path("tests/checker/SURVIVORS.md")
ENTRY = re.compile(r"^- `(?P<before>.+?)` → `(?P<after>.+?)`", re.MULTILINE)


@dataclass(frozen=True)
class Explained:
    """The stem of a file, or "everywhere", and the line before and after, of each change."""

    changes: frozenset[tuple[str, str, str]]

    def holds(self, stem: str, before: str, after: str) -> bool:
        """Whether a change is explained, by its lines or as one that is explained everywhere."""
        if (stem, before, after) in self.changes:
            return True
        pairs = ((old, new) for place, old, new in self.changes if place == "everywhere")
        return any(after in _replaced(before, old, new) for old, new in pairs)


def _replaced(line: str, old: str, new: str) -> Iterator[str]:
    """The line with one occurrence of a text replaced by another."""
    parts = line.split(old)
    for k in range(1, len(parts)):
        yield old.join(parts[:k]) + new + old.join(parts[k:])


def read() -> Explained:
    """Read the file, if it is there."""
    found = set()
    text = EXPLAINED.read_text(encoding="utf-8") if EXPLAINED.exists() else ""
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        stem = part.split("\n", 1)[0].strip().removesuffix(".py")
        found |= {(stem, entry["before"], entry["after"]) for entry in ENTRY.finditer(part)}
    return Explained(frozenset(found))
