"""Plants with a parameter: the checker's grammar, canonical form and digest."""

from __future__ import annotations

import json
from typing import Any

import pytest

from mcexact import MultiChannelSystem, ParametricSystem
from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.kinds import Expectation
from mcexact.errors import InputError
from mcexact.model.system_file import read_parametric_system, system_text
from tests.checker.handmade import changed, checked
from tests.checker.parametric_plants import ALL, PAPER, RANGED

SYSTEM = RANGED["system"]
OTHERS: dict[str, tuple[Any, str]] = {
    "no parameters": (changed(SYSTEM, ("parameters", {})), "MALFORMED"),
    "a list of parameters": (changed(SYSTEM, ("parameters", ["t"])), "MALFORMED"),
    "two parameters": (changed(SYSTEM, ("parameters", {"t": {}, "u": {}})), "INCOMPLETE"),
    "the parameter x": (changed(SYSTEM, ("parameters", {"x": {}})), "MALFORMED"),
    "a parameter of 65 letters": (changed(SYSTEM, ("parameters", {"t" * 65: {}})), "MALFORMED"),
    "no name of a parameter": (changed(SYSTEM, ("parameters", {"2u": {}})), "MALFORMED"),
    "a range of one end": (changed(SYSTEM, ("parameters.t.range", [0])), "MALFORMED"),
    "a range upside down": (changed(SYSTEM, ("parameters.t.range", [1, 0])), "MALFORMED"),
    "a range that says nothing": (
        changed(SYSTEM, ("parameters.t.range", [None, None])),
        "MALFORMED",
    ),
    "an unknown key": (changed(SYSTEM, ("parameters.t.unit", "m")), "MALFORMED"),
    "a neighbor graph": (changed(SYSTEM, ("neighbors", {})), "MALFORMED"),
    "an entry that is not canonical": (changed(SYSTEM, ("A.2.0", "1*t")), "MALFORMED"),
    "a number as a text": (changed(SYSTEM, ("A.0.0", "2")), "MALFORMED"),
    "A is not square": (changed(SYSTEM, ("A", [[1, 2]])), "MALFORMED"),
    "rows of two lengths": (changed(SYSTEM, ("A", [[1, 2], [3]])), "MALFORMED"),
    "B has a row less": (changed(SYSTEM, ("channels.0.B", [[1]])), "MALFORMED"),
    "C has a column less": (changed(SYSTEM, ("channels.0.C", [[1]])), "MALFORMED"),
    "no channels": (changed(SYSTEM, ("channels", [])), "MALFORMED"),
    "entries listed": (
        changed(SYSTEM, ("A", {"shape": [3, 3], "entries": [[2, 0, "t"]]})),
        "MALFORMED",
    ),
    "another time": (changed(SYSTEM, ("time", "sampled")), "MALFORMED"),
    "a name": (changed(SYSTEM, ("name", "a")), "MALFORMED"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_the_system_of_a_certificate_is_canonical(name: str) -> None:
    system, verdict = OTHERS[name]
    found = checked({**RANGED, "system": system})
    assert found.verdict == verdict, found.line()


@pytest.mark.parametrize("name", ALL)
def test_the_digest_is_that_of_the_package(name: str) -> None:
    text = json.dumps({"format": "mcexact-system/1", **ALL[name]["system"]})
    assert checked(ALL[name]).system_digest == read_parametric_system(text).digest()


FILE = {
    "format": "mcexact-system/1",
    "name": "a name",
    "source": "a source",
    "time": "continuous",
    "parameters": {"t": {"range": ["0", 1.0]}},
    "A": {"shape": [3, 3], "entries": [[0, 0, 2], [0, 2, -1], [1, 2, "-4/2"], [2, 0, "t + 0"]]},
    "channels": [
        {"name": "1", "B": [[0], ["t*t - 2"], ["t^3-2"]], "C": [[0, 0, 0], [0, 0, 1]]},
        {"B": [[], [], []], "C": []},
    ],
}
BROKEN: list[tuple[str, Any]] = [
    ("A.entries.0.0", 3),
    ("A.entries.0.1", 3),
    ("A.entries.1", [0, 0, 1]),
    ("A.shape", [3]),
    ("A.entries.0.2", None),
    ("name", 3),
    ("parameters.t.range", ["t", 1]),
    ("format", "mcexact-controller/1"),
    ("sample_time", 1),
]
NO_SYSTEMS = ([], {"format": "mcexact-system/2", "parameters": {"t": {}}})


def test_a_range_may_be_one_value() -> None:
    document = changed(FILE, ("parameters.t.range", ["1/2", 0.5]))
    assert about(document).plant["parameters"] == {"t": {"range": ["1/2", "1/2"]}}


def about(document: Any) -> Expectation:
    """What a system file asks of a certificate."""
    return Expectation().about(json.dumps(document).encode(), Limits())


def test_a_system_file_is_compared_with_the_certificate() -> None:
    system = changed(RANGED["system"], ("channels.1.C", {"shape": [0, 3], "entries": []}))
    wanted = about(FILE)
    assert wanted.plant == system
    assert wanted.system == read_parametric_system(json.dumps(FILE)).digest()
    assert checked(PAPER, expected=wanted).code == "system"
    plain = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    assert about(json.loads(system_text(plain))).system == plain.digest()


@pytest.mark.parametrize(("place", "value"), BROKEN)
def test_a_broken_system_file_is_refused_by_both_readers(place: str, value: Any) -> None:
    document = changed(FILE, (place, value))
    with pytest.raises(Refused):
        about(document)
    with pytest.raises(InputError):
        read_parametric_system(json.dumps(document))


@pytest.mark.parametrize("document", NO_SYSTEMS)
def test_what_is_no_system_file_is_refused(document: Any) -> None:
    with pytest.raises(Refused):
        about(document)


def test_a_plant_may_be_named_by_its_digest() -> None:
    plant = ParametricSystem([["t"]], [[[1]]], [[[1]]], parameters=["t"])
    assert len(plant.digest()) == 64
    named = {**PAPER, "system": checked(PAPER).system_digest}
    assert checked(named).verdict == "INCOMPLETE"
    file = {"format": "mcexact-system/1", **PAPER["system"]}
    assert checked(named, expected=about(file)).verdict == "VALID"
