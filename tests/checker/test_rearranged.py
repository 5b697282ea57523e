"""Constructions that only place entries, applied to plants with a parameter."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest

from mcexact import (
    MultiChannelSystem,
    NeighborGraph,
    ParametricSystem,
    check,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    setpoint_solvability,
)
from mcexact.analysis.parameters.modes import parametric_fixed_spectrum
from mcexact.answer.check import constructed
from mcexact.answer.protocol import document
from mcexact.checker.cells import REARRANGING, subject_of
from mcexact.checker.core.budget import Budget, Refused, limited
from mcexact.checker.parametric_system import ParametricSystem as Read
from mcexact.checker.parametric_system import read_parametric
from mcexact.constructions import dual, extended_system, restricted
from mcexact.derived import constructions
from mcexact.derived.constructions import along_line, feedback
from mcexact.errors import InputError, UsageError
from tests.checker.handmade import changed, checked
from tests.checker.parametric_plants import PAPER, POLES
from tests.oracle.certificates.constructions import subject_of as obvious
from tests.oracle.drawn.parametric import drawn_moves, drawn_on_a_line, drawn_parametric_plant
from tests.wording import refusal, says

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
    assert {step["construction"] for steps in SEVERAL.values() for step in steps} == set(
        REARRANGING
    )
    assert constructions.REARRANGING == set(REARRANGING)


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


# Lines: what is claimed along them is about the user's plant.

TWO = ParametricSystem(
    [["a*b", 1], [0, "b"]],
    [[["a + b"], [1]], [[0], ["1/(a - 1)"]]],
    [[[1, "a/b"]], [[0, 1]]],
    parameters=["a", "b"],
    assume={"a": (0, 1)},
)
LINE = along_line(TWO, {"a": 1, "b": 0}, {"a": "1/2", "b": -1})
ALONG: dict[str, Any] = {
    "modes": parametric_fixed_spectrum(LINE),
    "controllability": joint_controllability(LINE),
    "observability": joint_observability(LINE, ["1"]),
    "rank": setpoint_solvability(LINE),
    "a line beside a parameter": fixed_spectrum(
        along_line(TWO, {"a": 2, "b": 0}, {"a": 0, "b": 1})
    ),
    "one parameter": fixed_spectrum(
        along_line(
            ParametricSystem([["1/t"]], [[[1]]], [[[0]]], parameters=["t"]), {"t": 1}, {"t": 2}
        )
    ),
}


@pytest.mark.parametrize("name", ALONG)
def test_a_certificate_along_a_line_names_the_plant_of_the_user(name: str) -> None:
    answer = ALONG[name]
    found = document(answer)
    assert found["system"] == answer.about.plant.document()
    assert checked(found).verdict == check(answer, answer.about.plant).verdict == "VALID"
    assert "parameters" not in found["subject"][0] and found["subject"][0]["parameter"] == "s"


def test_the_line_is_told_by_the_values_of_the_parameters() -> None:
    statement = checked(document(ALONG["modes"])).statement
    assert " along the line a = 1/2*s + 1, b = -s (2 states" in statement
    assert says(statement, "complex entries")


def test_poles_of_the_plant_stay_where_they_cancel_on_a_line() -> None:
    plant = ParametricSystem([["a/b"]], [[[1]]], [[["b"]]], parameters=["a", "b"])
    line = along_line(plant, {"a": 0, "b": 0}, {"a": 1, "b": 1})
    assert str(line.A[0, 0]) == "1" and [str(q) for q in line.poles] == ["x"]
    found = document(joint_observability(line))
    assert found["claim"]["exceptional"] == [] and found["witness"]["undefined"] == [[0, 1]]
    assert checked(found).verdict == "VALID"
    told = {"value": [0, 1], "roots": [{"re": "0", "im": "0", "radius": "0"}], "modes": []}
    forged = changed(found, ("claim.exceptional", [told]))
    assert checked(changed(forged, ("witness.exceptional", [{"modes": [], "divisors": []}]))).code


STEP = "subject.0"
REFUSED: dict[str, tuple[Any, tuple[str, str]]] = {
    "a direction of 0": ((f"{STEP}.direction", {"a": 0, "b": 0}), ("INVALID", "subject")),
    "inside of a pole": ((STEP, {"construction": "line", "parameter": "s",
        "point": {"a": 1, "b": 0}, "direction": {"a": 0, "b": 1}}), ("INVALID", "subject")),
    "a letter of the plant": ((f"{STEP}.parameter", "a"), ("MALFORMED", "form")),
    "the letter of modes": ((f"{STEP}.parameter", "x"), ("MALFORMED", "form")),
    "no letter": ((f"{STEP}.parameter", ""), ("MALFORMED", "form")),
    "a number for a letter": ((f"{STEP}.parameter", 1), ("MALFORMED", "form")),
    "a parameter is missing": ((f"{STEP}.point", {"a": 1}), ("MALFORMED", "form")),
    "a parameter too many": ((f"{STEP}.point", {"a": 1, "b": 0, "c": 0}), ("MALFORMED", "form")),
    "no rational": ((f"{STEP}.point.a", "1.0"), ("MALFORMED", "form")),
    "no numbers": ((f"{STEP}.direction", [1, 1]), ("MALFORMED", "form")),
    "another key": ((f"{STEP}.more", 1), ("MALFORMED", "form")),
    "no line": (("subject", []), ("INCOMPLETE", "parameters")),
    "two lines": (
        ("subject", [document(ALONG["modes"])["subject"][0]] * 2), ("INVALID", "subject"),
    ),
    "behind the dual": (
        ("subject", [{"construction": "dual"}, document(ALONG["modes"])["subject"][0]]),
        ("INVALID", "subject"),
    ),
}  # fmt: skip


def test_what_is_proved_along_one_line_is_not_about_another() -> None:
    found = document(ALONG["rank"])
    assert found["claim"]["exceptional"]
    assert checked(changed(found, (f"{STEP}.point.a", 5))).verdict == "INVALID"


@pytest.mark.parametrize("name", REFUSED)
def test_other_lines_are_refused(name: str) -> None:
    change, (verdict, code) = REFUSED[name]
    found = checked(changed(document(ALONG["modes"]), change))
    assert (found.verdict, found.code) == (verdict, code), found.line()


@pytest.mark.parametrize(
    ("point", "direction", "parameter", "error"),
    [
        ({"a": 1}, {"a": 1, "b": 1}, "s", InputError),
        ({"a": 1, "b": 1}, {"a": 0, "b": 0}, "s", InputError),
        ({"a": 1, "b": 0}, {"a": 0, "b": 1}, "s", InputError),
        ({"a": 1, "b": 1, "c": 1}, {"a": 1, "b": 1}, "s", InputError),
        ({"a": 0.5, "b": 1}, {"a": 1, "b": 1}, "s", InputError),
        ([1, 2], {"a": 1, "b": 1}, "s", InputError),
        ({"a": 1, "b": 1}, {"a": 1, "b": 1}, "x", InputError),
        ({"a": 1, "b": 1}, {"a": 1, "b": 1}, "a", UsageError),
    ],
)
def test_the_package_refuses_them_as_well(
    point: Any, direction: Any, parameter: str, error: type[Exception]
) -> None:
    with pytest.raises(error):
        along_line(TWO, point, direction, parameter)


def test_there_is_one_line_before_all_other_constructions() -> None:
    with pytest.raises(UsageError, match="on a line already"):
        along_line(LINE, {"s": 1}, {"s": 1}, "r")
    turned = constructions.rearranged(TWO, dual)
    line = along_line(turned, {"a": 1, "b": 0}, {"a": "1/2", "b": -1})
    assert [step["construction"] for step in line.subject] == ["line", "dual"]
    assert line.A == constructions.rearranged(LINE, dual).A
    alone = constructions.rearranged(TWO, lambda plain: restricted(plain, ["1"]))
    with pytest.raises(InputError, match="undefined there"):
        along_line(alone, {"a": 1, "b": 0}, {"a": 0, "b": 1})


@pytest.mark.parametrize("seed", range(8))
def test_oracle_and_checker_make_the_same_lines(seed: int) -> None:
    plant, steps = drawn_on_a_line(random.Random(seed))
    theirs, ours = obvious({"system": plant, "subject": steps}), made(steps, plant)
    assert ours.parameter == theirs.parameter == steps[0]["parameter"]
    for table, (other, _, _) in zip(ours.tables, theirs.tables, strict=True):
        expected = [[Fraction(str(over(-5) / under(-5))) for over, under in row] for row in other]
        assert values(table, Fraction(-5)) == expected


def test_the_powers_of_a_line_are_charged_before_they_are_made() -> None:
    plant = ParametricSystem([["a^999"]], [[[1]]], [[["b^900*a^99"]]], parameters=["a", "b"])
    step = {"construction": "line", "parameter": "s", "point": {"a": 1, "b": 2},
            "direction": {"a": 1, "b": 3}}  # fmt: skip
    with pytest.raises(Refused) as found, limited(Budget(10**6)):
        made([step], plant.document())
    assert found.value.args[:2] == ("INCOMPLETE", "work")


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
    with refusal(UsageError):
        constructions.rearranged(plant, lambda bare: feedback(bare, [[[1, 1]], [[1]], [[1]]]))


def test_a_construction_that_adds_entries_is_told_from_one_that_places_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rows = [[1, 0]], [[1]], [[1]]
    gains = [{"denominator": 1, "entries": entries} for entries in rows]
    fed = {"construction": "feedback", "gains": gains}
    monkeypatch.setattr("mcexact.checker.cells.REARRANGING", (*REARRANGING, "feedback"))
    with pytest.raises(Refused) as refused:
        made([fed])
    assert refused.value.place == "subject"
    assert refused.value.code == "construction"
