"""The form of what persons read: the changelog of a version is one page."""

from __future__ import annotations

import re
from pathlib import Path

import mcexact

ROOT = Path(__file__).parents[2]
PAGE = 60  # lines
CHANGELOG = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
# What a line about a fault says, which users of released versions never met.
HISTORY = re.compile(r"\bno longer\b|\bin place of an error\b|\bbefore\)|: it (?:was|said|took)\b")


def test_the_changelog_has_one_page_for_each_version() -> None:
    versions = re.split(r"^## ", CHANGELOG, flags=re.MULTILINE)[1:]
    assert versions[0].startswith(mcexact.__version__)
    assert all(version.count("\n") <= PAGE for version in versions)


def test_the_changelog_has_no_history_of_faults() -> None:
    first = CHANGELOG.rpartition("\n## ")[2]
    assert not HISTORY.findall(first)
