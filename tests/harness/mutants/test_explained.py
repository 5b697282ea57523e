"""What is explained of changes of the checker is about lines that are there."""

from __future__ import annotations

from pathlib import Path

import mcexact.checker
from tests.assurance.mutants.explained import Explained, read
from tests.assurance.mutants.topics import sources

FOLDER = Path(mcexact.checker.__path__[0])


def gone(explained: Explained) -> list[tuple[str, str]]:
    """The lines that are explained and that their file does not have, each with its stem."""
    found = set()
    for stem, before, _ in explained.changes:
        if stem != "everywhere":
            text = sources(FOLDER)[stem].read_text(encoding="utf-8")
            if before not in map(str.strip, text.splitlines()):
                found.add((stem, before))
    return sorted(found)


def test_explained_lines_are_in_their_files() -> None:
    assert gone(read()) == []


def test_a_line_that_is_elsewhere_is_noticed() -> None:
    line = "power = product(system.A, power)"
    changes = {("bivariate", line, "pass"), ("structure", line, "pass")}
    assert gone(Explained(frozenset(changes))) == [("structure", line)]
