"""What ARCHITECTURE.md names is there."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
# Names in capitals stand for others.
FILES = sorted(set(re.findall(r"`((?:mcexact|tests|proofs)/[a-z\d_/.]+)`", PAGE)))
FORMULAS = re.findall(r"^\| (.+) \| `(mcexact/[\w/]+\.py)` \| `(\w+)` \|$", PAGE, re.MULTILINE)


def test_the_formulas_are_read_from_the_page() -> None:
    lines = PAGE.partition("## Where the formulas are")[2].partition("\n## ")[0].splitlines()
    assert len(FORMULAS) == sum(line.startswith("| ") for line in lines) - 1 > 0


@pytest.mark.parametrize("formula, path, function", FORMULAS)
def test_a_formula_leads_to_a_documented_function(formula: str, path: str, function: str) -> None:
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    *overloads, found = [
        node for node in tree.body if isinstance(node, ast.FunctionDef) and node.name == function
    ]
    assert all(node.decorator_list for node in overloads)
    assert ast.get_docstring(found), formula


@pytest.mark.parametrize("path", FILES)
def test_every_file_named_is_there(path: str) -> None:
    assert (ROOT / path).exists()


def test_the_tree_has_every_folder() -> None:
    """At the top those that are tracked, which have no dot, and in the package every stage."""
    tree = PAGE.partition("## Folders")[2].partition("\n\n`tests/architecture/`")[0]
    stages = {path.parent.name for path in (ROOT / "mcexact").glob("*/__init__.py")}
    assert set(re.findall(r"^      (\w+)/ +\w", tree, re.MULTILINE)) == stages
    for folder in re.findall(r"^    (\w+)/ *", tree, re.MULTILINE):
        assert (ROOT / folder).is_dir(), folder
