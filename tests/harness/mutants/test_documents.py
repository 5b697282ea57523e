"""The checker with and without a change, on the documents that its tests keep."""

from __future__ import annotations

from pathlib import Path

import mcexact.checker
from tests.assurance.mutants.documents import NONE, UNLOADABLE, telling
from tests.checker.kept import by_group

CASES = by_group()["fixed_spectrum"]
RANK = "require(lost >= deficiency >= 1"


def told(before: str, after: str) -> int:
    """What the documents tell of a change."""
    source = Path(mcexact.checker.__path__[0], "core", "evidence.py").read_text(encoding="utf-8")
    assert before in source
    return telling("evidence", compile(source.replace(before, after), "", "exec"), CASES)


def test_without_a_change_every_answer_is_the_same() -> None:
    assert told(RANK, RANK) == NONE


def test_a_condition_that_is_left_out_is_noticed() -> None:
    assert told(RANK, "require(lost >= 1") >= 0


def test_what_cannot_be_loaded_is_noticed() -> None:
    assert told("from .system import System", "from .system import Nothing") == UNLOADABLE
