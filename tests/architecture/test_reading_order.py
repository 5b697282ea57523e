"""The page of the proofs' files is as they are: every file after those that it rests on."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

PROOFS = Path(__file__).parents[2] / "proofs"
SPEC = importlib.util.spec_from_file_location("reading_order", PROOFS / "reading_order.py")
assert SPEC is not None and SPEC.loader is not None
ORDER = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(ORDER)


def test_the_page_is_made_from_the_files() -> None:
    page = (PROOFS / "READING.md").read_text(encoding="utf-8")
    assert page == ORDER.PAGE + ORDER.reading_table(), "run make ledger"


def test_every_file_comes_once_and_after_all_that_it_rests_on() -> None:
    graph = ORDER.required()
    listed = re.findall(r"^\| \[`(\w+)`\]", ORDER.reading_table(), re.MULTILINE)
    assert sorted(listed) == sorted(graph)
    for name, others in graph.items():
        assert all(listed.index(other) < listed.index(name) for other in others), name


def test_every_file_says_at_its_head_what_it_is_about() -> None:
    for name in ORDER.required():
        assert (PROOFS / f"{name}.v").read_text().startswith("(*")
        assert ORDER.subject(name), name


def test_an_arc_that_others_imply_is_left_out() -> None:
    graph = {"a": set(), "b": {"a"}, "c": {"a", "b"}}
    assert ORDER.direct(graph) == {"a": [], "b": ["a"], "c": ["b"]}
    assert ORDER.below(graph)["c"] == {"a", "b"}
