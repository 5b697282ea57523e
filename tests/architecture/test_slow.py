"""The list of slow tests names tests, and is updated by what was measured."""

from __future__ import annotations

import re
from pathlib import Path

from tests.durations import LIST, ROOT, measurements, slow_tests, updated


def test_every_slow_test_is_there_and_the_list_is_sorted() -> None:
    listed = LIST.read_text(encoding="utf-8").splitlines()
    assert listed == sorted(set(listed))
    for name in slow_tests():
        path, _, test = name.partition("::")
        text = (ROOT / path).read_text(encoding="utf-8")
        if path.startswith("tests/"):
            function = test.partition("[")[0].rpartition("::")[2]
            assert re.search(rf"^ *(async )?def {function}\(", text, re.MULTILINE), name


def test_what_was_measured_replaces_what_the_list_says_of_these_files_alone() -> None:
    measured = measurements("0.10\ta.py::one\n2.00\ta.py::two[x\ty]\n0.00\tb.py::three\n")
    assert measured == {"a.py::one": 0.1, "a.py::two[x\ty]": 2.0, "b.py::three": 0.0}
    listed = ["a.py::gone", "b.py::three", "c.py::other"]
    assert updated(listed, measured) == ["a.py::two[x\ty]", "c.py::other"]


def test_both_targets_together_run_all_tests() -> None:
    makefile = (Path(ROOT) / "Makefile").read_text(encoding="utf-8")
    assert re.findall(r"--dist worksteal -m (.*)$", makefile, re.MULTILINE) == [
        "'not slow'",
        "slow",
    ]
