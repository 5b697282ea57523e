"""Each rule names the theorems that justify it, or says that it is open; each theorem its rule."""

from __future__ import annotations

import ast
import re
from functools import cache
from pathlib import Path

import pytest

from mcexact import checker
from mcexact.checker.kinds import KINDS
from mcexact.checker.sentences import RULES as RULES_OF_SENTENCES

FOLDER = Path(checker.__file__).parent
PROOFS = FOLDER.parent.parent / "proofs"
STEMS = sorted(path.stem for path in FOLDER.glob("*.py"))
SENTENCES = {stem for stem in STEMS if stem.startswith("sentence")} | {"manifest"}
SPOKEN = {"__init__", "__main__", "command", "controller", "expectation", "kinds", "reading"}
SPOKEN |= {
    "allowance",
    "expressions",
    "parametric_system",
    "several_parameters",
    "statement",
    "system",
}
SPOKEN |= {"system_matrices", "uncertainty"}
NO_RULE = {
    *SPOKEN,
    "budget",
    "complex_matrices",
    "packed_rows",
    "sparse",
    "sparse_step",
} | SENTENCES
"""What reads, starts, speaks, counts and packs numbers.

Every other file holds a rule, or evidence of several."""
SENTENCE = re.compile(r"Theorems? ((?:``\w+\.\w+``(?:,\s+)?)+)\.")
OPEN = "Open: see ``proofs/OPEN.md``."
ELSEWHERE = ("paper, ", "supporting: ")
"""How a line of theorems.txt begins if it justifies no rule by itself."""


@cache
def tree(stem: str) -> ast.Module:
    """The parsed file of the checker."""
    return ast.parse((FOLDER / f"{stem}.py").read_text(encoding="utf-8"))


@cache
def docstrings(stem: str) -> tuple[str, ...]:
    """What the functions and classes of a file say of themselves."""
    nodes = [n for n in ast.walk(tree(stem)) if isinstance(n, ast.FunctionDef | ast.ClassDef)]
    return tuple(ast.get_docstring(node) or "" for node in nodes)


@cache
def named(stem: str) -> frozenset[str]:
    """The theorems that a file of the checker names."""
    found = (listed for text in docstrings(stem) for listed in SENTENCE.findall(text))
    return frozenset(name for listed in found for name in re.findall(r"[\w.]+", listed))


def is_open(stem: str) -> bool:
    """Whether a function of this file says that a part of it is open."""
    return any(OPEN in text for text in docstrings(stem))


@cache
def imported(stem: str) -> frozenset[str]:
    """The files of the checker that one of them imports itself."""
    found: set[str] = set()
    for node in ast.walk(tree(stem)):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            found |= {node.module} if node.module else {alias.name for alias in node.names}
    return frozenset(found & set(STEMS))


@cache
def rests_on(stem: str) -> frozenset[str]:
    """The files of the checker that one of them imports, itself and what they import included."""
    found, new = set[str](), {stem}
    while new:
        found |= new
        new = {each for part in new for each in imported(part)} - found
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
def test_what_a_file_names_is_listed(stem: str) -> None:
    assert named(stem) <= set(LISTED)


@pytest.mark.parametrize("stem", STEMS)
def test_every_mention_of_a_theorem_has_the_one_form(stem: str) -> None:
    proved = {path.stem for path in PROOFS.glob("*.v")}
    for text in docstrings(stem):
        mentioned = set(re.findall(r"``(\w+\.\w+)``", text))
        formed = {n for found in SENTENCE.findall(text) for n in re.findall(r"[\w.]+", found)}
        assert {name for name in mentioned if name.partition(".")[0] in proved} <= formed
        assert len(re.findall(r"\b[Tt]heorems? ``", text)) == len(SENTENCE.findall(text))
        assert text.count("OPEN.md") == text.count(OPEN)


@pytest.mark.parametrize("stem", sorted(set(STEMS) - NO_RULE))
def test_every_rule_names_a_theorem_or_is_open(stem: str) -> None:
    assert named(stem) or is_open(stem)


@pytest.mark.parametrize("kind", sorted(KINDS))
def test_the_rule_of_a_kind_names_a_theorem_or_is_open(kind: str) -> None:
    (check,) = [node for node in tree(kind).body if getattr(node, "name", "") == "check"]
    text = ast.get_docstring(check) or ""  # type: ignore[arg-type]
    assert SENTENCE.search(text) or OPEN in text


@pytest.mark.parametrize("name", sorted(RULES))
def test_every_theorem_of_a_rule_is_named_by_a_file_that_the_rule_rests_on(name: str) -> None:
    kinds = kinds_of(RULES[name])
    assert kinds <= set(KINDS)
    for places in [rests_on(kind) for kind in kinds] or [frozenset(STEMS)]:
        assert any(name in named(stem) for stem in places)


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
    said = {stem for row in rows for stem in re.findall(r"`(\w+)(?:\.\w+)?`", row)}
    assert said & set(STEMS) == {stem for stem in STEMS if is_open(stem)}


def test_what_is_weakened_is_there_and_every_file_of_rules_has_such_a_line() -> None:
    lines = (PROOFS / "weakened.txt").read_text(encoding="utf-8").splitlines()
    entries = [line.split(" ;; ") for line in lines if line.strip() and line[0] != "#"]
    for stem, _, _, text, _ in entries:
        source = (PROOFS / f"{stem.strip()}.v").read_text(encoding="utf-8")
        assert text.strip().replace("⏎", "\n") in source, (stem, text)
    assert {name.partition(".")[0] for name in RULES} <= {entry[0].strip() for entry in entries}
