"""The folders are the stages, in order, and the imports keep to it."""

import ast
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "mcexact"

STAGE = {
    "exact": 0,
    "plot": 1,
    "model": 2,
    "derived": 3,
    "answer": 4,
    "analysis": 5,
    "floating": 5,
    "synthesis": 6,
    "export": 7,
    "simulation": 8,
    "report": 9,
    "crosschecks": 10,
    "sweeps": 10,
    "reproduce": 11,
}
DOORS = {"constructions", "questions", "parameters", "boxes", "performance", "sharing", "designs"}
"""The public modules, which give names of all stages a place and do nothing."""
BESIDE = {"checker", "testing", "cli", "errors", "shown", "processes"}
EXACT_STAGES = {"exact", "model", "derived", "answer", "analysis", "checker"}
SHOWN = {"answer", "model", "exact", "plot", "simulation", "errors", "shown"}
"""What a report may import: it shows answers, accounts and trajectories, and decides nothing."""
MODULES = sorted(PACKAGE.rglob("*.py"))


def part_of(path: Path) -> str:
    """The folder or file directly under the package that a module belongs to."""
    return path.relative_to(PACKAGE).parts[0].removesuffix(".py")


@cache
def tree_of(path: Path) -> ast.Module:
    """A parsed module: many tests look at all of them."""
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes_of(path: Path) -> tuple[ast.AST, ...]:
    """All nodes of a module."""
    return tuple(ast.walk(tree_of(path)))


def imports_of(path: Path) -> Iterator[tuple[str, int, int]]:
    """Every module that a file imports, absolutely: name, level of the import, line."""
    package = ("mcexact", *path.relative_to(PACKAGE).parts[:-1])
    for node in nodes_of(path):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, 0, node.lineno
        elif isinstance(node, ast.ImportFrom):
            if node.level == 0:
                origin = node.module or ""
            else:
                upper = package[: len(package) - node.level + 1]
                origin = ".".join((*upper, node.module) if node.module else upper)
            yield origin, node.level, node.lineno
            for alias in node.names:
                yield f"{origin}.{alias.name}", node.level, node.lineno


def imported_parts(path: Path) -> Iterator[tuple[str, int]]:
    """The parts of this package that a file imports, with the line."""
    for name, _, line in imports_of(path):
        parts = name.split(".")
        if parts[0] == "mcexact" and len(parts) > 1:
            yield parts[1], line


def may_import(importer: str, imported: str) -> bool:
    """Whether one part of the package may import another."""
    if importer == imported or importer in {"cli", "__main__"}:
        return True
    if importer == "__init__" or importer in DOORS:  # only names
        return True
    if imported in {"errors", "shown", "processes"}:
        return importer != "checker"
    if imported == "checker":
        # The independent checker is called, never built upon.
        return importer == "answer"
    if imported not in STAGE or (importer == "report" and imported not in SHOWN):
        return False
    if importer == "testing":
        return STAGE[imported] <= STAGE["answer"]
    return importer in STAGE and STAGE[imported] < STAGE[importer]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_stage_imports_only_lower_stages(path: Path) -> None:
    known = STAGE.keys() | BESIDE
    wrong = [
        f"{path}:{line}: {part_of(path)} imports {imported}"
        for imported, line in imported_parts(path)
        if imported in known and not may_import(part_of(path), imported)
    ]
    assert not wrong


def test_every_folder_is_a_stage_or_beside_them() -> None:
    folders = {
        path.name for path in PACKAGE.iterdir() if path.is_dir() and path.name[0] not in "._"
    }
    assert folders <= STAGE.keys() | BESIDE


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(ROOT)))
def test_only_exact_imports_flint(path: Path) -> None:
    if part_of(path) != "exact":
        assert not [line for name, _, line in imports_of(path) if name.split(".")[0] == "flint"]


def test_the_checker_imports_the_standard_library_and_itself_relatively() -> None:
    for path in sorted((PACKAGE / "checker").rglob("*.py")):
        depth = len(path.relative_to(PACKAGE / "checker").parts)
        for name, level, line in imports_of(path):
            top = name.split(".")[0]
            place = f"{path}:{line}: {name}"
            if level == 0:
                assert top in sys.stdlib_module_names, place
            else:
                assert level <= depth, place


def test_nothing_exact_imports_floating() -> None:
    for path in MODULES:
        if part_of(path) in EXACT_STAGES:
            assert "floating" not in {imported for imported, _ in imported_parts(path)}, path


def test_no_module_is_named_for_having_no_topic() -> None:
    for path in MODULES:
        *words, noun = path.stem.split("_")
        assert noun not in {"common", "base", "misc"}, path  # but a common dimension is a topic
        assert not {*words, noun} & {"utils", "util", "helpers", "helper"}, path


def test_no_stage_walks_through_the_subsets_of_the_channels() -> None:
    """Powersets and bit masks over channels belong to the slow oracle in the tests."""
    for path in MODULES:
        for node in nodes_of(path):
            if not isinstance(node, ast.Call):
                continue
            place = f"{path}:{node.lineno}"
            called = ast.unparse(node.func).rpartition(".")[2]
            assert called not in {"powerset", "subsets"}, place
            if called == "combinations":  # of a fixed size, such as pairs
                assert isinstance(node.args[1], ast.Constant), place
            if called == "range" and node.args:
                assert not ast.unparse(node.args[-1]).startswith(("2 **", "1 <<")), place


def test_nothing_is_validated_by_a_statement_that_an_option_deletes() -> None:
    for path in MODULES:
        assert not [n.lineno for n in nodes_of(path) if isinstance(n, ast.Assert)], path
