"""What a module of the checker is about: the kinds that it checks, and the tests of it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from functools import cache
from pathlib import Path

CHECKER = Path("mcexact/checker")
TESTS = Path("tests/checker")
DOCUMENTS = ("tests/checker/test_kept.py", "tests/checker/test_recorded.py")
"""The tests that look at many documents in little time."""


def sources(folder: Path = CHECKER) -> dict[str, Path]:
    """The files of the checker, those of its core included, by their stems.

    Both folders have an ``__init__``: that of the core defines nothing, and is left out.
    """
    paths = sorted(folder.rglob("*.py"), key=lambda path: -len(path.parts))
    return {path.stem: path for path in paths}


@cache
def kinds(stem: str) -> frozenset[str]:
    """The kinds that a module checks: each has a function of its name there."""
    source = sources()[stem].read_text(encoding="utf-8")
    return frozenset(re.findall(r"^def check_(\w+)\(claim\b", source, re.MULTILINE))


@cache
def tests(stem: str) -> frozenset[str]:
    """The files of tests named as a module or one of its kinds, or that import most from it."""
    named = {f"test_{name}.py" for name in (stem, *kinds(stem))}
    return frozenset(
        path.name
        for path in TESTS.glob("test_*.py")
        if path.name in named or stem in _most_imported(path)
    )


@cache
def _most_imported(path: Path) -> frozenset[str]:
    """The modules of the checker from which a file imports the most names."""
    counted: Counter[str] = Counter()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            if node.module == "mcexact.checker":
                counted.update(each.name for each in node.names)
            elif node.module.startswith("mcexact.checker."):
                counted[node.module.rpartition(".")[2]] += len(node.names)
    return frozenset(name for name, count in counted.items() if count == max(counted.values()))
