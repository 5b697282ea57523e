"""Each rule names the theorems that justify it, or says that it is open; each theorem its rule."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path

import pytest

from mcexact import checker
from mcexact.checker.kinds import KINDS
from mcexact.checker.sentences import RULES as RULES_OF_SENTENCES
from tests.assurance.mutants.topics import sources

FOLDER = Path(checker.__file__).parent
PROOFS = FOLDER.parent.parent / "proofs"
SOURCES = sources(FOLDER)
STEMS = sorted(SOURCES)
NO_RULE = {
    "__init__",
    "__main__",
    "budget",
    "command",
    "kinds",
    "reading",
    "summaries",
    "controllers",
    "page",
    "wording",
}
NO_RULE |= {stem for stem in STEMS if stem.startswith("sentences")}
"""What reads, starts, speaks and counts.

Every other module holds rules, or evidence of several."""
SENTENCE = re.compile(r"Theorems? ((?:``\w+\.\w+``(?:,\s+)?)+)\.")
OPEN = "Open: see ``proofs/OPEN.md``."
ELSEWHERE = ("paper, ", "supporting: ")
"""How a line of theorems.txt begins if it justifies no rule by itself."""


@cache
def tree(stem: str) -> ast.Module:
    """The parsed module of the checker."""
    return ast.parse(SOURCES[stem].read_text(encoding="utf-8"))


def documented(node: ast.AST) -> list[str]:
    """What the functions and classes of a part of a module say of themselves, the part included."""
    nodes = [n for n in ast.walk(node) if isinstance(n, ast.FunctionDef | ast.ClassDef)]
    return [ast.get_docstring(each) or "" for each in nodes]


def theorems_in(texts: Iterable[str]) -> set[str]:
    """The theorems that docstrings name."""
    found = (listed for text in texts for listed in SENTENCE.findall(text))
    return {name for listed in found for name in re.findall(r"[\w.]+", listed)}


@cache
def definitions() -> dict[str, ast.AST]:
    """What the modules define: functions, classes and tables, by module and name."""
    found: dict[str, ast.AST] = {}
    for stem in STEMS:
        for node in tree(stem).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                found[f"{stem}.{node.name}"] = node
            elif isinstance(node, ast.Assign):
                names = [t.id for t in node.targets if isinstance(t, ast.Name)]
                found |= {f"{stem}.{name}": node for name in names}
    return found


@cache
def imported(stem: str) -> dict[str, str]:
    """Names in a module for what other modules of the checker define, or for these modules."""
    found: dict[str, str] = {}
    for node in ast.walk(tree(stem)):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            module = (node.module or "").removeprefix("core").removeprefix(".")
            start = f"{module}." if module else ""
            found |= {alias.asname or alias.name: f"{start}{alias.name}" for alias in node.names}
    return found


@cache
def uses(name: str) -> frozenset[str]:
    """The definitions that one of them names."""
    stem, known = name.partition(".")[0], imported(name.partition(".")[0])
    found: set[str] = set()
    for node in ast.walk(definitions()[name]):
        if isinstance(node, ast.Name):
            found |= {f"{stem}.{node.id}", known.get(node.id, "")}
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            found.add(f"{known.get(node.value.id, '')}.{node.attr}")
    return frozenset(found & definitions().keys())


@cache
def rests_on(name: str) -> frozenset[str]:
    """A definition, and all that it uses, directly or not."""
    found, new = set[str](), {name}
    while new:
        found |= new
        new = {each for part in new for each in uses(part)} - found
    return frozenset(found)


def theorems() -> dict[str, str]:
    """The lines of theorems.txt: a theorem, and the rule that it justifies."""
    lines = (PROOFS / "theorems.txt").read_text(encoding="utf-8").splitlines()
    pairs = (line.split(maxsplit=1) for line in lines if line.strip() and line[0] != "#")
    return {name: rule.strip() for name, rule in pairs}


def kinds_of(rule: str) -> set[str]:
    """The kinds at the beginning of a line's second half, "kind k: …" or "kinds k, l: …"."""
    if rule.startswith("kind "):
        return {rule.split()[1].strip(",:;")}
    if not rule.startswith("kinds "):
        return set()
    head = rule.removeprefix("kinds ").partition(":")[0]
    return set(re.split(", | and ", head)) - {"others"}


LISTED = theorems()
RULES = {name: rule for name, rule in LISTED.items() if not rule.startswith(ELSEWHERE)}


@pytest.mark.parametrize("stem", STEMS)
def test_what_a_module_names_is_listed(stem: str) -> None:
    assert theorems_in(documented(tree(stem))) <= set(LISTED)


@pytest.mark.parametrize("stem", STEMS)
def test_every_mention_of_a_theorem_has_the_one_form(stem: str) -> None:
    proved = {path.stem for path in PROOFS.glob("*.v")}
    for text in documented(tree(stem)):
        mentioned = set(re.findall(r"``(\w+\.\w+)``", text))
        formed = {n for found in SENTENCE.findall(text) for n in re.findall(r"[\w.]+", found)}
        assert {name for name in mentioned if name.partition(".")[0] in proved} <= formed
        assert len(re.findall(r"\b[Tt]heorems? ``", text)) == len(SENTENCE.findall(text))
        assert text.count("OPEN.md") == text.count(OPEN)


@pytest.mark.parametrize("stem", sorted(set(STEMS) - NO_RULE))
def test_every_module_of_rules_names_a_theorem_or_is_open(stem: str) -> None:
    said = documented(tree(stem))
    assert theorems_in(said) or any(OPEN in text for text in said)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_the_rule_of_a_kind_names_a_theorem_or_is_open(kind: str) -> None:
    text = KINDS[kind].check.__doc__ or ""
    assert SENTENCE.search(text) or OPEN in text


@pytest.mark.parametrize("name", sorted(RULES))
def test_every_theorem_of_a_rule_is_named_by_a_function_that_the_rule_uses(name: str) -> None:
    kinds = kinds_of(RULES[name])
    assert kinds <= set(KINDS)
    for kind in kinds:
        check = KINDS[kind].check
        used = rests_on(f"{check.__module__.rpartition('.')[2]}.{check.__name__}")
        assert name in theorems_in(
            text for each in used for text in documented(definitions()[each])
        )
    assert kinds or name in theorems_in(text for stem in STEMS for text in documented(tree(stem)))


@pytest.mark.parametrize("name", sorted(LISTED))
def test_what_is_listed_is_a_theorem(name: str) -> None:
    stem, _, theorem = name.partition(".")
    text = (PROOFS / f"{stem}.v").read_text(encoding="utf-8")
    assert re.search(rf"^(?:Theorem|Corollary|Proposition) {theorem}\b", text, re.MULTILINE)


def test_every_theorem_of_a_sentence_is_proved_by_machine_or_has_an_author() -> None:
    for key, rule in RULES_OF_SENTENCES.items():
        for name in re.split(r"[,;] ", rule.theorem) if rule.theorem else ():
            author = re.fullmatch(r"[A-Z][\w. ]+ (and [A-Z][\w. ]+ )?\d{4}", name)
            assert name in LISTED or author, (key, name)


def test_what_says_that_it_is_open_is_what_the_page_lists() -> None:
    page = (PROOFS / "OPEN.md").read_text(encoding="utf-8").partition("## Statements")[0]
    rows = [line.split("|")[1] for line in page.splitlines() if line.startswith("| `")]
    listed = {name for row in rows for name in re.findall(r"`(\w+\.\w+)`", row)}
    said = {
        f"{stem}.{node.name}"
        for stem in STEMS
        for node in ast.walk(tree(stem))
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
        and OPEN in (ast.get_docstring(node) or "")
    }
    assert said == listed


def test_what_is_weakened_is_there_and_every_file_of_rules_has_such_a_line() -> None:
    lines = (PROOFS / "weakened.txt").read_text(encoding="utf-8").splitlines()
    entries = [line.split(" ;; ") for line in lines if line.strip() and line[0] != "#"]
    for stem, _, _, text, _ in entries:
        source = (PROOFS / f"{stem.strip()}.v").read_text(encoding="utf-8")
        assert text.strip().replace("⏎", "\n") in source, (stem, text)
    assert {name.partition(".")[0] for name in RULES} <= {entry[0].strip() for entry in entries}
