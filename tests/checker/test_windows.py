"""Certificates about plants in windows of several steps (construction ``slow``)."""

from __future__ import annotations

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.answer.protocol import document
from mcexact.derived.constructions import held_system, slow_system
from mcexact.model.system import MultiChannelSystem
from tests.checker.handmade import Document, changed, checked, without
from tests.wording import says

PLANT = MultiChannelSystem(
    [[1, 0], [0, -1]],
    [[[1], [1]], [[0], [0]]],
    [[[0, 0]], [[1, 1]]],
    time="discrete",
    neighbors={"1": ["2"], "2": ["1"]},
)
SLOW = slow_system(PLANT, 4)
BOUND = document(shared_dimension_bound(SLOW, share="states"))
FREE = document(fixed_spectrum(held_system(SLOW, [2, 2])))
LONGER = document(shared_dimension_bound(slow_system(PLANT, 6), share="states"))

ACCEPTED = [
    ("the bound of a plant in windows", BOUND),
    ("nothing is fixed with this bound, held", FREE),
    ("a longer window", LONGER),
    ("another window with the same powers", changed(BOUND, ("subject.0.window", 6))),
    ("a long window with the same powers", changed(BOUND, ("subject.0.window", 10**30))),
]

REJECTED = [
    ("a window in which nobody can measure and act", BOUND, ("subject.0.window", 3)),
    ("an odd window, after which the modes differ", BOUND, ("subject.0.window", 5)),
    ("a window of no steps", BOUND, ("subject.0.window", 0)),
    ("a window that is no integer", BOUND, ("subject.0.window", "4")),
    ("continuous time", BOUND, ("system.time", "continuous")),
    ("the plant itself, without windows", BOUND, ("subject", [])),
    ("less than the bound", FREE, ("subject.1.dimensions", [1, 1])),
    ("the plant itself, with less than the bound", FREE, (
        "subject", [{"construction": "held", "dimensions": [0, 0]}]
    )),
]  # fmt: skip


@pytest.mark.parametrize(("reason", "found"), ACCEPTED)
def test_a_true_answer_is_accepted(reason: str, found: Document) -> None:
    verdict = checked(found)
    assert verdict.verdict == "VALID", verdict.line()


@pytest.mark.parametrize(("reason", "found", "change"), REJECTED)
def test_anything_else_is_rejected(
    reason: str, found: Document, change: tuple[str, object]
) -> None:
    verdict = checked(changed(found, change))
    assert verdict.verdict in ("INVALID", "MALFORMED"), verdict.line()


def test_a_graph_is_needed() -> None:
    verdict = checked(without(BOUND, "system.neighbors"))
    assert (verdict.verdict, verdict.code) == ("INVALID", "subject")


def test_the_statement_names_the_window() -> None:
    assert says(checked(BOUND).statement, "windows steps")
