"""The versions that are tested as the oldest are those that are declared as the oldest."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]


def pairs(lines: list[str], relation: str) -> dict[str, str]:
    """The libraries with the versions that stand in this relation to them."""
    found = (re.fullmatch(rf"([\w-]+)(?:\[.*\])?{relation}([\d.]+)", line) for line in lines)
    return {match[1]: match[2] for match in found if match}


def test_every_library_that_runs_in_the_tests_is_pinned_at_its_declared_minimum() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    optional = [
        each
        for name in ("plot", "control", "cluster", "pandas", "yaml", "test")
        for each in extras[name]
    ]
    declared = pairs(project["dependencies"] + optional, ">=")
    pinned = pairs((ROOT / "tests/oldest.txt").read_text(encoding="utf-8").splitlines(), "==")
    assert "click" in declared
    assert declared.items() <= pinned.items()
    assert pinned.keys() - declared.keys() == {"pyparsing"}
