"""Words of messages stand once, in ``tests/wording.txt``, and tests compare them by it alone."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.wording import HEADER, ROOT, SNAPSHOT, Comparison, existing, normalized, read, written

LISTED = Path(__file__).with_name("quoting.txt")
QUOTED = re.compile(r"(?:[A-Za-z][a-z']+ ){3,}[A-Za-z][a-z']+")
"""Four or more words in a row."""
FORMER = "no mode is fixed here"
LATER = "some mode is fixed here"
TEST = "tests/architecture/test_wording.py::test"


def quotes(*nodes: ast.AST) -> bool:
    """Whether some text in an expression has so many words."""
    constants = (
        each for node in nodes for each in ast.walk(node) if isinstance(each, ast.Constant)
    )
    return any(isinstance(each.value, str) and QUOTED.search(each.value) for each in constants)


def quotations(path: Path) -> int:
    """How many assertions and expected errors of a file quote words."""
    count = 0
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Assert):
            count += quotes(node.test)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
            count += node.func.attr == "raises" and quotes(*node.keywords)
    return count


def test_no_test_quotes_words_but_those_that_are_listed_with_their_number() -> None:
    files = {path: quotations(path) for path in sorted((ROOT / "tests").rglob("*.py"))}
    found = [f"{number} {path.relative_to(ROOT)}" for path, number in files.items() if number]
    listed = LISTED.read_text(encoding="utf-8").splitlines()
    advice = "compare words by tests/wording.py; lower a number in quoting.txt, never raise one"
    assert Counter(found) - Counter(listed) == Counter(), advice
    assert found == listed, advice


def test_the_snapshot_is_as_it_is_written_and_is_about_tests_that_exist() -> None:
    text = SNAPSHOT.read_text(encoding="utf-8")
    wording = read(text)
    assert written(wording) == text
    assert existing(wording) == [*wording]


def test_each_wording_is_written_once_above_all_its_tests() -> None:
    wording = {f"{TEST}_b[x: y]": {"1": FORMER, "refused": LATER}, f"{TEST}_a": {"1": LATER}}
    assert read(written(wording)) == wording
    assert written(wording).count(FORMER) == written(wording).count(LATER) == 1
    assert read(written({})) == {} and written({}) == HEADER


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("a margin of 0.25\n  and 1e-9", "a margin of # and #"),
        ("1/3 of 12 channels", "1/3 of 12 channels"),
        ("limit of 8 s, 500 MiB", "limit of # s, # MiB"),
        ("'/tmp/pytest-of-a/pytest-0/popen-gw1/test_b0/c.json' is", "'#/c.json' is"),
        ("/usr/share/d.json: x", "…/d.json: x"),
        (f"the plant {'0123456789abcdef' * 4} (", "the plant # ("),
        (["first", "second"], "first | second"),
    ],
)
def test_what_varies_is_not_compared(text: str | list[str], shown: str) -> None:
    assert normalized(text) == shown


def outcome(comparison: Comparison, test: Callable[[Comparison], None]) -> str:
    """What is wrong with what a test compares, or nothing."""
    try:
        with comparison.during(TEST):
            test(comparison)
    except AssertionError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("whole", [True, False])
def test_other_words_fail_with_both_until_they_are_recorded(whole: bool) -> None:
    def says(said: str) -> Callable[[Comparison], None]:
        return lambda comparison: comparison.compare(said, "", whole)

    expected = {TEST: {"1": FORMER}}
    assert outcome(Comparison(expected), says(FORMER)) == ""
    wrong = outcome(Comparison(expected), says(LATER))
    assert f"- {FORMER}" in wrong and f"+ {LATER}" in wrong and "make wording" in wrong
    assert outcome(Comparison(expected, recording=True), says(LATER)) == ""
    assert expected == {TEST: {"1": LATER}}


def test_a_piece_stays_while_the_text_has_it_and_the_line_most_like_it_replaces_it() -> None:
    expected = {TEST: {"1": FORMER}}
    recording = Comparison(expected, recording=True)
    text = f"first line\nsecond, {FORMER}, and more\nthird"
    assert outcome(recording, lambda it: it.compare(text, "", False)) == ""
    assert expected == {TEST: {"1": FORMER}}
    text = text.replace("second", "").replace(f", {FORMER}, and more", LATER)
    assert outcome(recording, lambda it: it.compare(text, "", False)) == ""
    assert expected == {TEST: {"1": LATER}}
    assert "by hand" in outcome(recording, lambda it: it.compare("x", "", False))


def test_words_that_are_no_longer_compared_fail_until_they_are_gone() -> None:
    expected = {TEST: {"1": FORMER, "other": LATER}}

    def says_one(comparison: Comparison) -> None:
        comparison.compare(FORMER, "", True)

    assert "other" in outcome(Comparison(expected), says_one)
    assert outcome(Comparison(expected, recording=True), says_one) == ""
    assert expected == {TEST: {"1": FORMER}}


def test_a_text_of_which_nothing_is_recorded_fails() -> None:
    assert FORMER in outcome(Comparison({}), lambda it: it.compare(FORMER, "", False))
