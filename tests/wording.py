"""Whether messages and sentences are worded as recorded: words stand once, in ``wording.txt``.

    with refusal(InputError, where="A[0][0]"):
        MultiChannelSystem([[0.1]], [[[1]]], [[[1]]])
    assert worded(rows["set-points"])
    assert status == 0 and says(out, "fixed for all")

What such a text is about stays in the test as data: the type of the error and its attributes, an
exit status, the key of a rule, a number.  The words alone are compared with what ``wording.txt``
holds for the test and the label.  Without a label, the first text of a test is called 1, the second
2, and so on.  Words that a test no longer compares make it fail, too.

    python -m tests.wording [PATH…]

Runs the tests in these files and folders, by default in all files that compare words, and records
the words anew.  The whole text is recorded for `worded` and `refusal`.  For `says` the recorded
piece stays while the text still has it; otherwise the line or the part of a sentence that is most
like it takes its place, so the difference has to be read before it is kept.  The piece of a long
text that a new test looks for is written into ``wording.txt`` by hand.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Generator, Iterable, Iterator, Mapping
from contextlib import contextmanager
from difflib import SequenceMatcher, ndiff
from itertools import pairwise
from pathlib import Path
from textwrap import wrap
from typing import Any, TypeVar

import pytest

Refused = TypeVar("Refused", bound=BaseException)
Text = str | BaseException | Iterable[object]
Wording = dict[str, dict[str, str]]
"""The words for each label of each test."""

ROOT = Path(__file__).parents[1]
SNAPSHOT = Path(__file__).with_name("wording.txt")
HEADER = """\
The words that tests compare, each above the labels and the tests that expect them; see
tests/wording.py. `make wording` records them. An ellipsis stands for folders, and # for what varies
or is compared by the tests themselves: decimal fractions, seconds, bytes, digests, temporary files.
"""
INDENT = "    "
LONGEST = 400
"""So many characters of a text are recorded without a piece of it that was chosen by hand."""
ALIKE = 0.4
"""The similarity from which words may take the place of others."""

VARIABLE = (
    (
        re.compile(
            r"(?<![^\s'\"`:;,(=])/[^\s'\"`:;,(]*/pytest-\d+/(?:popen-gw\d+/)?[^\s/'\"`:;,)]+"
        ),
        "#",
    ),
    (re.compile(r"(?<![\w.…/<])/(?:[^\s/'\"`<>]+/)+"), "…/"),
    (re.compile(r"\b[0-9a-f]{32,}\b|\b(?=[a-f]*\d)(?=\d*[a-f])[0-9a-f]{12,}\b"), "#"),
    (re.compile(r"(?<!\d)\d+(?:(?:\.\d+)+(?:e[-+]?\d+)?|e[-+]?\d+)"), "#"),
    (re.compile(r"\b\d+(?= (?:s|seconds|kB|MB|GB|KiB|MiB|GiB)\b)"), "#"),
    (re.compile(r"\s+"), " "),
)
"""What varies between machines and runs, or between versions, and what stands for it."""


def normalized(text: Text) -> str:
    """The text in one line, without what varies."""
    if not isinstance(text, (str, BaseException)):
        text = " | ".join(map(str, text))
    shown = str(text)
    for pattern, short in VARIABLE:
        shown = pattern.sub(short, shown)
    return shown.strip()


def read(text: str) -> Wording:
    """The words for each label of each test, from the text of a snapshot."""
    found: Wording = {}
    for block in text.strip().split("\n\n")[1:]:
        lines = block.splitlines()
        words = " ".join(line for line in lines if not line.startswith(INDENT))
        for line in lines:
            if line.startswith(INDENT):
                label, test = line.strip().split(": ", 1)
                found.setdefault(test, {})[label] = words
    return found


def written(wording: Wording) -> str:
    """The text of a snapshot: each wording once, above its tests, in the order of their names."""
    users: dict[str, list[str]] = {}
    for test, labels in sorted(wording.items()):
        for label, words in sorted(labels.items()):
            users.setdefault(words, []).append(f"{INDENT}{label}: {test}")
    blocks = (
        "\n".join([*wrap(words, 100, break_long_words=False, break_on_hyphens=False), *lines])
        for words, lines in users.items()
    )
    return "\n\n".join([HEADER.rstrip(), *blocks]) + "\n"


def nearest(words: str, text: Text) -> str:
    """The line, or the part of a sentence, that is most like some words, or nothing."""
    lines = [normalized(each) for each in (text.splitlines() if isinstance(text, str) else [text])]
    parts = (part for line in lines for part in re.split(r"(?<=[;:.?!]) | \| ", line))
    two = (" ".join(pair) for pair in pairwise(lines))
    similar = {each: SequenceMatcher(None, words, each).ratio() for each in (*parts, *lines, *two)}
    best = max(similar, key=lambda each: similar[each], default="")
    return best if best and similar[best] >= ALIKE else ""


class Comparison:
    """The words of all tests, and what the test that runs now has compared.

    Parameters
    ----------
    wording : dict
        What is expected.
    recording : bool
        Whether the words of tests replace what is expected of them.
    """

    def __init__(self, wording: Wording, recording: bool = False) -> None:
        self.wording, self.recording = wording, recording
        self.test = ""
        self.said: dict[str, str] = {}

    @contextmanager
    def during(self, test: str) -> Iterator[None]:
        """Compare what one test says, and refuse words that it no longer compares."""
        self.test, self.said = test, {}
        try:
            yield
        except BaseException:
            if self.recording and self.said:
                self.wording[test] = {**self.wording.get(test, {}), **self.said}
            raise
        finally:
            self.test = ""
        if self.recording:
            self.wording.pop(test, None)
            if self.said:
                self.wording[test] = self.said
        elif left := self.wording.get(test, {}).keys() - self.said.keys():
            _fail(f"the test no longer compares the words of {', '.join(sorted(left))}", test)

    def compare(self, text: Text, label: str, whole: bool) -> None:
        """Fail if a text has other words than the expected ones.

        Parameters
        ----------
        text : str, exception or iterable of str
        label : str
            May be empty.
        whole : bool
            Whether the text has to be the words; otherwise it has to contain them.
        """
        if not self.test:
            raise AssertionError("words are compared by tests, and not by what prepares them")
        if not isinstance(text, (str, BaseException)):
            text = [*text]
        label = label or str(1 + sum(each.isdecimal() for each in self.said))
        expected = self.said if label in self.said else self.wording.get(self.test, {})
        shown, words = normalized(text), expected.get(label, "")
        if self.recording and label not in self.said:
            words = shown if whole else self._piece(words, label, text)
        self.said[label] = words
        if not words:
            _fail(f"{label}: no words are recorded for this text:\n{shown}", self.test)
        if whole and shown != words:
            lines = "\n".join(ndiff([words], [shown]))
            _fail(f"{label}: other words than the recorded ones\n{lines}", self.test)
        if not whole and words not in shown:
            near = nearest(words, text) or shown[:LONGEST]
            lines = "\n".join(ndiff([words], [near]))
            _fail(f"{label}: the text does not say it; nearest is\n{lines}", self.test)

    def _piece(self, words: str, label: str, text: Text) -> str:
        shown = normalized(text)
        if words:
            piece = words if words in shown else nearest(words, text)
        else:
            piece = shown if len(shown) <= LONGEST else ""
        if not piece:
            _fail(f"{label}: write the piece of the text to look for by hand:\n{shown}", self.test)
        return piece


def _fail(message: str, test: str) -> None:
    path = test.partition("::")[0]
    again = f"`make wording PATHS={path}` records the words of {path}"
    raise AssertionError(f"{message}\n({again}; see tests/wording.py)")


_COMPARISON = Comparison(read(SNAPSHOT.read_text(encoding="utf-8")))


def worded(text: Text, label: str = "") -> bool:
    """Whether the words of a text are the recorded ones."""
    _COMPARISON.compare(text, label, whole=True)
    return True


def says(text: Text, label: str = "") -> bool:
    """Whether a text contains the recorded words."""
    _COMPARISON.compare(text, label, whole=False)
    return True


def lacks(text: Text, test: str, label: str) -> bool:
    """Whether a text does not contain the words that another test, named with its file, compares.

    As that test compares them, they are what is said where something is said.
    """
    return _COMPARISON.wording[f"tests/{test}"][label] not in normalized(text)


@contextmanager
def refusal(
    kind: type[Refused] | tuple[type[Refused], ...],
    label: str = "",
    part: bool = False,
    quantity: str = "",
    **attributes: Any,
) -> Iterator[pytest.ExceptionInfo[Refused]]:
    """Expect an error of a type, with these attributes and the recorded words.

    Parameters
    ----------
    kind : type, or tuple of types
    label : str, optional
    part : bool
        Whether the recorded words are a part of the message, as where it has computed numbers.
    quantity : str
        A number with its unit that the message names.
    **attributes
        What the error says besides its words, such as ``where``.
    """
    with pytest.raises(kind) as refused:
        yield refused
    assert attributes == {name: getattr(refused.value, name) for name in attributes}
    assert quantity in str(refused.value)
    _COMPARISON.compare(refused.value, label, whole=not part)


# Hooks of pytest, which tests/conftest.py imports.


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare the option that records."""
    said = "record the words of messages that tests compare"
    parser.addoption("--record-wording", action="store_true", help=said)


def pytest_sessionstart(session: pytest.Session) -> None:
    """Record only in one process: each of several would write what it has seen alone."""
    _COMPARISON.recording = session.config.getoption("--record-wording")
    if _COMPARISON.recording and session.config.getoption("numprocesses", None):
        raise pytest.UsageError("--record-wording records in one process: --numprocesses=0")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, Any, Any]:
    """Know the test that compares words."""
    with _COMPARISON.during(item.nodeid):
        return (yield)


def pytest_sessionfinish() -> None:
    """Write what was recorded, without tests that are gone."""
    if _COMPARISON.recording:
        kept = {test: _COMPARISON.wording[test] for test in existing(_COMPARISON.wording)}
        SNAPSHOT.write_text(written(kept), encoding="utf-8")


def existing(tests: Iterable[str]) -> list[str]:
    """Those among some tests whose functions still are in their files."""
    texts: dict[str, str] = {}
    kept = []
    for test in tests:
        path, _, name = test.partition("::")
        if path not in texts:
            file = ROOT / path
            texts[path] = file.read_text(encoding="utf-8") if file.exists() else ""
        function = name.partition("[")[0].rpartition("::")[2]
        if re.search(rf"^ *def {re.escape(function)}\(", texts[path], re.MULTILINE):
            kept.append(test)
    return kept


def main(paths: list[str]) -> int:
    """Record the words of the tests in some files and folders, by default of all that have any.

    Returns
    -------
    int
        The status of pytest.
    """
    files = sorted((ROOT / "tests").rglob("test_*.py"))
    users = [str(path) for path in files if "from tests.wording" in path.read_text("utf-8")]
    command = [sys.executable, "-m", "pytest", "--quiet", "--numprocesses=0", "--record-wording"]
    environment: Mapping[str, str] = {**os.environ, "HYPOTHESIS_PROFILE": "ci"}
    return subprocess.run([*command, *(paths or users)], cwd=ROOT, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
