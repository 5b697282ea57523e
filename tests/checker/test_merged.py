"""The construction ``merged``: a partition of the channels, written in one way only."""

from __future__ import annotations

from typing import Any

import pytest

from mcexact.checker.constructions import read_subject
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, read_plant
from tests.checker.handmade import (
    FIXED,
    FREE,
    INTEGRATOR,
    PAPER,
    RANK,
    RING,
    Document,
    certificate,
    changed,
    checked,
    matrix,
    without,
)
from tests.checker.tables import accepts, rejects
from tests.wording import says


def taken(*parts: Any) -> Document:
    """The construction with these parts."""
    return {"construction": "merged", "parts": list(parts)}


FIRST_TWO = without(
    certificate(
        "fixed_spectrum",
        PAPER,
        FREE["claim"],
        {**FREE["witness"], "gains": [matrix([1, 0, 0], [0, 1, 1]), matrix([0])]},
        taken(["1", "2"], ["3"]),
    ),
    "system.neighbors",
)
"""x_1' = 2x_1; x_2' = 2x_2 + x_3, x_3' = x_2 + x_3: channel 2 uses what channel 1 measures."""
LAST_TWO = changed(
    FIXED,
    ("subject", [taken(["1"], ["2", "3"])]),
    ("claim.factors.0.channels", ["2+3"]),
    ("witness.gains", [matrix([1, 0]), matrix([2, 0], [0, 0])]),
)
OUTER_TWO = changed(RANK, ("subject", [taken(["1", "3"], ["2"])]))
APART = changed(FIXED, ("subject", [taken(["1"], ["2"], ["3"])]))

ACCEPTED = [
    ("nothing is fixed once 1 and 2 are one", FIRST_TWO),
    ("the mode of {2, 3} is one of 2+3", LAST_TWO),
    ("the pencil of {2} is the same beside 1+3", OUTER_TWO),
    ("channels by themselves are those of the plant", APART),
    ("one channel by itself", changed(FREE, ("subject", [taken(["1"])]))),
    (
        "the new names are those of later constructions",
        changed(OUTER_TWO, ("subject", [*OUTER_TWO["subject"], taken(["1+3"], ["2"])])),
    ),
]

PARTS = "subject.0.parts"
SUBJECT = FIRST_TWO["subject"]
REJECTED = [
    ("other channels taken as one", FIRST_TWO, (PARTS, [["1"], ["2", "3"]])),
    ("nothing taken as one", FIRST_TWO, ("subject", [])),
    ("a channel that is in no part", FIRST_TWO, (PARTS, [["1", "2"]]), "INVALID"),
    ("no parts", FIRST_TWO, (PARTS, []), "INVALID"),
    ("a channel in two parts", FIRST_TWO, (PARTS, [["1", "2"], ["2", "3"]]), "INVALID"),
    ("a part twice", FIRST_TWO, (PARTS, [["1", "2"], ["3"], ["3"]]), "INVALID"),
    ("a channel twice in a part", FIRST_TWO, (PARTS, [["1", "2", "2"], ["3"]]), "MALFORMED"),
    ("parts in another order", FIRST_TWO, (PARTS, [["3"], ["1", "2"]]), "MALFORMED"),
    ("members in another order", FIRST_TWO, (PARTS, [["2", "1"], ["3"]]), "MALFORMED"),
    ("an empty part", FIRST_TWO, (PARTS, [[], ["1", "2"], ["3"]]), "MALFORMED"),
    ("an unknown channel", FIRST_TWO, (PARTS, [["1", "2"], ["3"], ["4"]]), "MALFORMED"),
    ("positions for names", FIRST_TWO, (PARTS, [[0, 1], [2]]), "MALFORMED"),
    ("truth values for names", FIRST_TWO, (PARTS, [[True, "2"], ["3"]]), "MALFORMED"),
    ("lists for names", FIRST_TWO, (PARTS, [[["1"], "2"], ["3"]]), "MALFORMED"),
    ("a name for a part", FIRST_TWO, (PARTS, [["1", "2"], "3"]), "MALFORMED"),
    ("null for a part", FIRST_TWO, (PARTS, [["1", "2"], ["3"], None]), "MALFORMED"),
    ("an object of parts", FIRST_TWO, (PARTS, {"1": ["1", "2"], "3": ["3"]}), "MALFORMED"),
    ("no word about parts", FIRST_TWO, ("subject", [{"construction": "merged"}]), "MALFORMED"),
    ("names given besides", FIRST_TWO, ("subject.0.names", ["a", "b"]), "MALFORMED"),
    (
        "two channels of one name",
        FIRST_TWO,
        (("system.channels.2.name", "1+2"), (PARTS, [["1", "2"], ["1+2"]])),
        "INVALID",
    ),
    ("the plant's names behind it", FIRST_TWO, ("subject", SUBJECT * 2), "MALFORMED"),
    ("a claim about a member", LAST_TWO, ("claim.factors.0.channels", ["2"]), "MALFORMED"),
    ("a graph that the plant has", RING, ("subject", SUBJECT), "INVALID"),
    (
        "neighbors' outputs behind it",
        APART,
        ("subject", [*APART["subject"], {"construction": "augmented_outputs"}]),
        "INVALID",
    ),
]

test_a_true_claim_about_a_merged_plant_is_accepted = accepts(ACCEPTED)
test_anything_else_is_rejected = rejects(REJECTED)


def test_the_theorem_names_the_channels_that_are_taken_as_one() -> None:
    sets = 'with its channels merged into {"1", "2"}, {"3"} (2 states, channels {"1+2", "3"}'
    assert sets.partition(" (")[0] in checked(FIRST_TWO).statement
    assert says(checked(APART).statement, "merged into")


def test_a_name_cannot_pass_for_words() -> None:
    ports = [{**INTEGRATOR["channels"][0], "name": name} for name in ('a" and "b', "ü", "c")]
    document = certificate(
        "fixed_spectrum",
        {**INTEGRATOR, "channels": ports},
        FREE["claim"],
        {**FREE["witness"], "gains": [matrix([1, 0, 0], [0, 0, 0], [0, 0, 0])]},
        taken([port["name"] for port in ports]),
    )
    said = r'with its channels merged into {"a\" and \"b", "\u00fc", "c"} ('
    assert said in checked(document).statement


@pytest.mark.parametrize(
    ("reason", "parts", "verdict"),
    [
        ("the first channel left out", [["2"], ["3"]], "INVALID"),
        ("the last channel left out", [["1"], ["2"]], "INVALID"),
        ("the first channel twice", [["1"], ["1", "2", "3"]], "INVALID"),
        ("the last channel twice", [["1", "2", "3"], ["3"]], "INVALID"),
        ("no parts", [], "INVALID"),
        ("the last part first", [["3"], ["1", "2"]], "MALFORMED"),
        ("the first part last", [["2"], ["3"], ["1"]], "MALFORMED"),
        ("an empty part, the first", [[], ["1", "2", "3"]], "MALFORMED"),
        ("an empty part, the last", [["1", "2", "3"], []], "MALFORMED"),
    ],
)
def test_only_partitions_in_order_are_taken(reason: str, parts: Any, verdict: str) -> None:
    with pytest.raises(Refused) as found:
        read_subject([taken(*parts)], read_plant(PAPER))
    assert found.value.verdict == verdict


def test_the_channels_of_a_loop_are_not_merged_since_it_has_none() -> None:
    loop = System("continuous", [], Matrix([[-1]], 1), [], [])
    with pytest.raises(Refused, match="and a part"):
        read_subject([taken()], loop)
