"""Links that may be added: their form, and what they carry."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, read_plant
from mcexact.checker.sharing import candidates, carried, link
from tests.checker.handmade import plant

PORTS = [([[1], [0]], [[1, 2]]), ([[0], [1]], [[0, 3], [4, 0]]), ([[1], [1]], [[0, 5]])]


def system(neighbors: Any) -> System:
    """Three agents, the second with two outputs."""
    graph = {} if neighbors is None else {"neighbors": neighbors}
    return read_plant(plant([[1, 0], [0, 1]], *PORTS, **graph))


ALONE = system({"1": [], "2": [], "3": []})
LINKED = system({"1": [], "2": ["1"], "3": []})


def test_a_link_goes_from_the_first_to_the_second() -> None:
    assert link(["3", "1"], "claim", ALONE) == (2, 0)


def test_candidates_are_positions_with_costs() -> None:
    given = [["1", "2", 1], ["1", "3", "1/2"], ["2", "1", 3]]
    expected = [(0, 1, 1), (0, 2, Fraction(1, 2)), (1, 0, 3)]
    assert candidates(given, ALONE) == expected
    assert candidates([["2", "1", 3]], LINKED) == [(1, 0, 3)]
    assert candidates([], LINKED) == []


@pytest.mark.parametrize(
    ("reason", "about", "given", "verdict"),
    [
        ("out of order", ALONE, [["2", "1", 1], ["1", "2", 1]], "MALFORMED"),
        ("twice", ALONE, [["1", "2", 1], ["1", "2", 1]], "MALFORMED"),
        (
            "twice, before another",
            ALONE,
            [["1", "2", 1], ["1", "2", 2], ["2", "1", 1]],
            "MALFORMED",
        ),
        ("in the graph", LINKED, [["1", "2", 1]], "MALFORMED"),
        ("in the graph, the second", LINKED, [["1", "2", 1], ["1", "3", 1]], "MALFORMED"),
        ("from an agent to itself", ALONE, [["1", "1", 1]], "MALFORMED"),
        ("to nobody", ALONE, [["1", "4", 1]], "MALFORMED"),
        ("without a cost", ALONE, [["1", "2"]], "MALFORMED"),
        ("by position", ALONE, [[0, 1, 1]], "MALFORMED"),
        ("free of charge", ALONE, [["1", "2", 0]], "INVALID"),
        ("for less than nothing", ALONE, [["1", "2", 1], ["2", "1", -1]], "INVALID"),
        ("without a graph", system(None), [], "INVALID"),
    ],
)
def test_candidates_have_one_form(reason: str, about: System, given: Any, verdict: str) -> None:
    with pytest.raises(Refused) as found:
        candidates(given, about)
    assert found.value.verdict == verdict


def test_a_link_carries_outputs_and_sub_states_of_its_sender() -> None:
    outputs = ALONE.C[1]
    assert carried(ALONE, "outputs", None, 1) == outputs
    both = carried(ALONE, "outputs+states", [1, 2, 3], 1)
    assert (both.nrows, both.ncols) == (4, 8)
    assert both.equals(
        Matrix(
            [
                [0, 3, 0, 0, 0, 0, 0, 0],
                [4, 0, 0, 0, 0, 0, 0, 0],
                [0, 0, 0, 1, 0, 0, 0, 0],
                [0, 0, 0, 0, 1, 0, 0, 0],
            ],
            8,
        )
    )
    states = carried(ALONE, "states", [1, 2, 3], 2)
    rows = [[int(j == 5 + i) for j in range(8)] for i in range(3)]
    assert (states.nrows, states.ncols) == (3, 8)
    assert states.equals(Matrix(rows, 8))
