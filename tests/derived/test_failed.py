"""Plants after failures: the matrices, the graph, the fixed modes, and what is refused."""

from __future__ import annotations

import itertools
import random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import mcexact
from mcexact import fixed_spectrum, testing
from mcexact.constructions import failed
from mcexact.errors import InputError, UsageError
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle import enumeration

PLANT = MultiChannelSystem(
    [[0, 1], [2, 3]],
    [[[1, 2], [3, 4]], [[5], [6]], [[], []]],
    [[[7, 8]], [[9, 1], [2, 3]], [[4, 5]]],
    D=[[1, 2, 3], [4, 5, 6], [7, 8, 9], [1, 1, 1]],
    names=["a", "b", "c"],
).with_neighbors(NeighborGraph(("a", "b", "c"), [[1, 2], [2], [0]], [(0, 1, 2), (2, 0, 1)]))
PARTS = ("agents", "actuators", "sensors", "links")


def drawn_failures(rng: random.Random, plant: MultiChannelSystem) -> dict[str, list[Any]]:
    """Some failures, at least one."""
    sizes = {"actuators": plant.p, "sensors": plant.q}
    known: dict[str, list[Any]] = {"agents": [*plant.names]}
    for what, size in sizes.items():
        known[what] = [(name, k + 1) for i, name in enumerate(plant.names) for k in range(size(i))]
    edges = () if plant.neighbors is None else plant.neighbors.edges()
    known["links"] = [(plant.names[j], plant.names[i]) for j, i in edges]
    lost = {part: [one for one in each if rng.random() < 0.3] for part, each in known.items()}
    return lost if any(lost.values()) else {"agents": [rng.choice(plant.names)]}


def test_what_failed_is_zero_and_all_else_is_as_before() -> None:
    made = failed(PLANT, agents=["c"], actuators=[("a", 2)], sensors=[("b", 1)], links=[("b", "a")])
    assert made.A == PLANT.A
    assert [B.tolist() for B in made.B] == [[[1, 0], [3, 0]], [[5], [6]], [[], []]]
    assert [C.tolist() for C in made.C] == [[[7, 8]], [[0, 0], [2, 3]], [[0, 0]]]
    zeros = [0, 0, 0]
    assert made.feedthrough_matrix().tolist() == [[1, 0, 3], zeros, [7, 0, 9], zeros]
    assert made.neighbors == NeighborGraph(PLANT.names, [[], [], []])
    assert failed(PLANT, agents=["b"]).neighbors == NeighborGraph(
        PLANT.names, [[2], [], [0]], [(2, 0, 1)]
    )


def test_the_order_of_failures_does_not_matter() -> None:
    made = failed(PLANT, sensors=[("b", 2), ("b", 1), ("b", 2)], links=[("c", "b"), ("b", "a")])
    [step] = made.subject
    assert step == {
        "construction": "failed",
        "agents": [],
        "actuators": [],
        "sensors": [["b", 1], ["b", 2]],
        "links": [["b", "a"], ["c", "b"]],
    }
    with pytest.raises(UsageError, match="made by 'failed'"):
        made.with_neighbors({})


@given(testing.systems(max_states=3, max_channels=3), st.integers(0, 10**6))
def test_what_is_fixed_stays_fixed_and_is_after_more_failures(drawn: Any, seed: int) -> None:
    rng, system = random.Random(seed), drawn.system
    more = drawn_failures(rng, system)
    part = rng.choice([part for part in PARTS if more.get(part)])
    fewer = {part: more[part][:1]}
    polynomials = [
        fixed_spectrum(each).polynomial
        for each in (system, failed(system, **fewer), failed(system, **more))
    ]
    for before, after in itertools.pairwise(polynomials):
        assert before.divides(after)
    numbers = enumeration.plain(failed(system, **more))
    for i, name in enumerate(system.names):
        for k in range(system.p(i)):
            gone = name in more.get("agents", ()) or (name, k + 1) in more.get("actuators", ())
            column = [row[k] for row in enumeration.plain(system).B[i]]
            assert [row[k] for row in numbers.B[i]] == [0 if gone else x for x in column]
        for k, row in enumerate(enumeration.plain(system).C[i]):
            gone = name in more.get("agents", ()) or (name, k + 1) in more.get("sensors", ())
            assert numbers.C[i][k] == [0 if gone else x for x in row]


@pytest.mark.parametrize(
    ("lost", "message"),
    [
        ({}, "at least one failure, found none"),
        ({"agents": ["d"]}, "'d'"),
        ({"actuators": [("b", 2)]}, "from 1 to 1, found 2"),
        ({"actuators": [("c", 1)]}, "from 1 to 0, found 1"),
        ({"sensors": [("b", 0)]}, "from 1 to 2, found 0"),
        ({"sensors": [("b", True)]}, "found True"),
        ({"links": [("a", "b")]}, "no link from 'a' to 'b'"),
        ({"links": [("a", "a")]}, "no link from 'a' to 'a'"),
    ],
)
def test_what_cannot_fail_is_refused(lost: dict[str, list[Any]], message: str) -> None:
    with pytest.raises(UsageError, match=message):
        failed(PLANT, **lost)


def test_a_text_is_no_list_of_agents_and_parameters_are_refused() -> None:
    with pytest.raises(InputError, match="write"):
        failed(PLANT, agents="a")
    plant: Any = mcexact.ParametricSystem([["t"]], [[[1]]], [[[1]]], parameters=["t"])
    with pytest.raises(InputError, match="parameters"):
        failed(plant, agents=["1"])
