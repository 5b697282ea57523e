"""A function of the checker fits on a screen, its core stands alone, and it depends on nothing."""

from __future__ import annotations

import ast
import io
import re
import sys
import tokenize
from collections.abc import Iterable
from pathlib import Path

import pytest

from mcexact import checker
from mcexact.checker.kinds import KINDS

FOLDER = Path(checker.__file__).parent
FILES = sorted(FOLDER.rglob("*.py"))
RULES = {rule.check.__module__.rpartition(".")[2] for rule in KINDS.values()}
"""The modules with the rules about certificates."""
SENTENCES = {path.stem for path in FILES if path.stem.startswith("sentences")}
"""The rules of sentences, no rule about a certificate rests on which."""
SKIPPED = {
    tokenize.COMMENT,
    tokenize.DEDENT,
    tokenize.ENDMARKER,
    tokenize.INDENT,
    tokenize.NEWLINE,
    tokenize.NL,
}


LONGEST = 50
"""The lines of code of a function: one screen."""


def code_lines(source: str) -> set[int]:
    """The lines that hold code: no blank lines, comments or docstrings."""
    lines = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in SKIPPED:
            lines.update(range(token.start[0], token.end[0] + 1))
    tree = ast.parse(source)
    for node in ast.walk(tree):
        # A string that stands alone documents what it follows.
        alone = node.value if isinstance(node, ast.Expr) else None
        if isinstance(alone, ast.Constant) and isinstance(alone.value, str):
            lines -= set(range(alone.lineno, (alone.end_lineno or alone.lineno) + 1))
    return lines


def lengths(source: str) -> dict[str, int]:
    """How many lines of each function hold code."""
    lines = code_lines(source)
    functions = [each for each in ast.walk(ast.parse(source)) if isinstance(each, ast.FunctionDef)]
    return {
        f"{each.name} in line {each.lineno}": len(
            lines & set(range(each.lineno, (each.end_lineno or each.lineno) + 1))
        )
        for each in functions
    }


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_a_function_takes_at_most_50_lines(path: Path) -> None:
    found = lengths(path.read_text(encoding="utf-8"))
    assert {name: lines for name, lines in found.items() if lines > LONGEST} == {}


def test_lines_of_code_are_counted_without_comments_and_docstrings() -> None:
    source = '''
def outer(x):
    """Say
    something."""

    # Nothing.
    def inner():
        return (
            x
        )
    return inner
'''
    assert lengths(source) == {"outer in line 2": 6, "inner in line 7": 4}


def size(paths: Iterable[Path]) -> int:
    """The lines of code of some files."""
    return sum(len(code_lines(path.read_text(encoding="utf-8"))) for path in paths)


@pytest.mark.parametrize("page", ["README.md", "SECURITY.md"])
def test_pages_give_the_sizes_of_the_core_and_of_the_whole(page: str) -> None:
    """They say what a VALID rests on: the figures are those of the code, to a hundred lines."""
    text = " ".join((FOLDER.parents[1] / page).read_text(encoding="utf-8").split())
    core = [path for path in FILES if path.parent.name == "core"]
    for words, files in (("core, `mcexact/checker/core/`,", core), ("whole checker", FILES)):
        figure = re.search(rf"{words} has ([0-9,]+) lines", text)
        assert figure and abs(int(figure[1].replace(",", "")) - size(files)) <= 100, words


def test_the_core_imports_nothing_of_the_rest() -> None:
    for path in (path for path in FILES if path.parent.name == "core"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            assert not isinstance(node, ast.ImportFrom) or node.level <= 1, path
            assert not isinstance(node, ast.Import) or "mcexact" not in ast.unparse(node), path


def imported(stem: str) -> set[str]:
    """The modules of the checker that one of them imports."""
    paths = {path.stem: path for path in reversed(FILES)}
    nodes = ast.walk(ast.parse(paths[stem].read_text(encoding="utf-8")))
    found = [node for node in nodes if isinstance(node, ast.ImportFrom) and node.level == 1]
    modules = {str(node.module).rpartition(".")[2] for node in found}
    return paths.keys() & {*modules, *(each.name for node in found for each in node.names)}


def test_no_rule_about_a_certificate_rests_on_the_sentences() -> None:
    used, new = set[str](), set(RULES)
    while new:
        used |= new
        new = {each for stem in new for each in imported(stem)} - used
    assert not used & {*SENTENCES, "kinds", "command"}


def test_every_kind_has_a_check_and_a_statement_of_its_name() -> None:
    for kind, rule in KINDS.items():
        assert rule.check.__name__ == f"check_{kind}"
        assert rule.statement.__name__ == f"{kind}_statement"
        assert rule.check.__module__ == rule.statement.__module__


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_only_the_standard_library_and_the_folder_itself_are_imported(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            assert all(alias.name in sys.stdlib_module_names for alias in node.names)
        if isinstance(node, ast.ImportFrom):
            assert node.level == 1 or (node.level == 0 and node.module is not None)
            if node.level == 0:
                assert str(node.module).partition(".")[0] in sys.stdlib_module_names


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_no_step_can_vanish_under_optimization(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    assert not any(isinstance(node, ast.Assert) for node in ast.walk(tree))


@pytest.mark.parametrize("word", ["VALID", "IMPLIED", "REMARK"])
def test_the_good_verdicts_are_said_in_one_place_each(word: str) -> None:
    made = [
        node
        for path in FILES
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
        and any(isinstance(arg, ast.Constant) and arg.value == word for arg in node.args)
    ]
    assert len(made) == 1


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_messages_are_ascii(path: Path) -> None:
    tree = ast.parse(path.read_text(encoding="utf-8"))
    strings = {
        id(node.value)
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            assert id(node) in strings or node.value.isascii() or node.value == "\ufeff", node.value
