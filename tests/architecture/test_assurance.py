"""The programs that run for long use the oracles of the tests, and no oracle uses them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parents[1]


def modules_imported(path: Path) -> Iterator[str]:
    """The modules that a file imports, by their full names."""
    package = ".".join(path.relative_to(TESTS.parent).parts[:-1]).split(".")
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            upper = package[: len(package) + 1 - node.level] if node.level else []
            home = ".".join([*upper, *filter(None, [node.module])])
            yield from (f"{home}.{alias.name}" for alias in node.names)


@pytest.mark.parametrize(
    "path", sorted((TESTS / "oracle").rglob("*.py")), ids=lambda path: str(path.relative_to(TESTS))
)
def test_no_oracle_uses_a_program_of_assurance(path: Path) -> None:
    assert not [name for name in modules_imported(path) if name.startswith("tests.assurance")]


def test_an_import_is_seen_however_it_is_written() -> None:
    source = TESTS / "assurance" / "attack" / "campaign.py"
    assert "tests.assurance.attack.report.Report" in {*modules_imported(source)}


def test_no_test_stands_where_pytest_looks_for_none() -> None:
    assert not [*(TESTS / "assurance").rglob("test_*.py")]
