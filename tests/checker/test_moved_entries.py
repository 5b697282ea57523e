"""Constructions that move entries, applied to plants with a parameter."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from mcexact import MultiChannelSystem, NeighborGraph, ParametricSystem, extended_system
from mcexact.analysis.engine.parametric_modes import parametric_fixed_spectrum
from mcexact.answer.codec import document
from mcexact.answer.reading import constructed
from mcexact.checker.moved_entries import MOVING, subject_of
from mcexact.checker.parametric_system import ParametricSystem as Read
from mcexact.checker.parametric_system import read_parametric
from mcexact.derived import moved_entries
from mcexact.derived.feedback import feedback
from mcexact.errors import UsageError
from tests.attack.draws.parametric import drawn_moves, drawn_parametric_plant
from tests.attack.oracle.constructions import subject_of as obvious
from tests.checker.handmade import changed, checked
from tests.checker.parametric_plants import PAPER, POLES

KIND = "parametric_fixed_spectrum"
SEVERAL: dict[str, list[Any]] = {
    "arcs": [
        {"construction": "arcs", "added": [["1", "2"]]},
        {"construction": "augmented_outputs"},
    ],
    "dual": [{"construction": "dual"}],
    "extended": [{"construction": "extended", "share": "states", "dimensions": [1, 0, 2]}],
    "full_output": [{"construction": "full_output", "channel": "2"}],
    "integrators": [{"construction": "integrators"}],
    "merged": [{"construction": "merged", "parts": [["1", "3"], ["2"]]}],
    "restricted": [
        {"construction": "restricted", "channels": ["2", "3"]},
        {"construction": "dual"},
    ],
}


def made(steps: list[Any], plant: Any = PAPER["system"]) -> Read:
    found = subject_of(steps, read_parametric(plant), KIND)
    assert isinstance(found, Read)
    return found


def values(table: Any, t: Fraction) -> list[list[Fraction]]:
    """A table of functions at a value."""

    def at(p: Any) -> Fraction:
        return sum((c * t**k for k, c in enumerate(p)), Fraction(0))

    return [[at(top) / at(bottom) for top, bottom in row] for row in table[0]]


@pytest.mark.parametrize("name", SEVERAL)
def test_the_result_at_a_value_is_made_from_the_plant_there(name: str) -> None:
    plant = ParametricSystem(
        [[1, "t", 0], ["t", 1, 0], [0, "1/(t + 3)", 1]],
        [[[1], ["t"], [0]], [[0, 0], [1, "t^2"], [0, 0]], [[1], [0], [0]]],
        [[[1, 0, 0], [0, 0, "t/(t + 2)"]], [[0, 1, 0]], [[0, "t", 0]]],
        parameters=["t"],
    )
    steps, t = SEVERAL[name], Fraction(5, 2)
    found = made(steps, plant.document())
    at = plant.at({"t": t}).with_neighbors(NeighborGraph.empty(plant.names))
    there: MultiChannelSystem = constructed(at, steps)
    ports = [M for c in there.channels for M in (c.B, c.C)]
    assert [values(table, t) for table in found.tables] == [
        [list(row) for row in M.rows()] for M in (there.A, *ports)
    ]
    assert (tuple(found.names), found.n, found.time) == (there.names, there.n, "continuous")
    ours = constructed(plant, steps)
    assert ours.at({"t": t}).A == there.A and ours.subject == there.subject
    assert ours.plant is plant


@pytest.mark.parametrize("number", range(12))
def test_checker_package_and_oracle_make_the_same(number: int) -> None:
    rng = random.Random(number)
    plant = drawn_parametric_plant(rng)
    steps = drawn_moves(rng, plant)
    theirs = obvious({"system": plant, "subject": steps})
    ours = made(steps, plant)
    assert [(len(rows), width) for rows, width in ours.tables] == [
        (nrows, ncols) for _, nrows, ncols in theirs.tables
    ]
    for table, (other, _, _) in zip(ours.tables, theirs.tables, strict=True):
        expected = [[Fraction(str(over(-5) / under(-5))) for over, under in row] for row in other]
        assert values(table, Fraction(-5)) == expected


def test_every_construction_that_moves_entries_is_examined() -> None:
    assert {step["construction"] for steps in SEVERAL.values() for step in steps} == set(MOVING)
    assert moved_entries.MOVING == set(MOVING)


OTHERS: dict[str, Any] = {
    "feedback": {"construction": "feedback", "gains": []},
    "error": {"construction": "error", "gains": []},
    "lifted": {"construction": "lifted", "share": "states", "dimensions": [1, 1, 1]},
    "held": {"construction": "held", "dimensions": [1, 1, 1]},
    "closed_loop": {"construction": "closed_loop", "controller": {}},
    "unknown": {"construction": "unknown"},
}


@pytest.mark.parametrize("name", OTHERS)
def test_constructions_that_compute_are_incomplete(name: str) -> None:
    found = checked(changed(PAPER, ("subject", [OTHERS[name]])))
    place = "subject[0]"
    assert (found.verdict, found.code, found.place) == ("INCOMPLETE", "construction", place)


@pytest.mark.parametrize("step", [None, 7, {}, {"construction": 7}, {"construction": ["dual"]}])
def test_what_is_no_construction_is_malformed(step: Any) -> None:
    found = checked(changed(PAPER, ("subject", [step])))
    assert (found.verdict, found.place) == ("MALFORMED", "subject[0]")


def test_entries_that_are_left_out_keep_their_poles() -> None:
    found = made([{"construction": "restricted", "channels": ["2"]}], POLES["system"])
    assert found.poles == made([], POLES["system"]).poles and len(found.poles[1]) == 2


def about(build: Callable[[Any], Any], plant: ParametricSystem) -> Any:
    return document(parametric_fixed_spectrum(build(plant)))


def test_a_certificate_is_about_what_was_constructed() -> None:
    plant = ParametricSystem(
        [[1, 0, 0], ["t", 1, 0], [0, 1, 1]],
        [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
        [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
        parameters=["t"],
    )
    ring = NeighborGraph.ring(plant.names)
    found = about(lambda p: extended_system(p, (0, 0, 1), graph=ring), plant)
    assert found["system"] == PAPER["system"]
    assert found["claim"]["generic"] == found["claim"]["exceptional"] == []
    verdict = checked(found)
    assert verdict.verdict == "VALID"
    assert 'of dimensions {"1":0,"2":0,"3":1} of: the plant ' in verdict.statement
    for steps in (found["subject"][:1], [], found["subject"][::-1]):
        assert checked({**found, "subject": steps}).verdict in ("INVALID", "MALFORMED")
    with pytest.raises(UsageError, match="feedback does not apply"):
        moved_entries.moved(plant, lambda bare: feedback(bare, [[[1, 1]], [[1]], [[1]]]))
