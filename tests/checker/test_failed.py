"""The construction ``failed``, and what is said of single failures."""

from __future__ import annotations

import random
from itertools import combinations
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, fixed_spectrum
from mcexact.analysis.failures import failures
from mcexact.answer.failures import hitting_set
from mcexact.answer.protocol import document
from mcexact.checker.sentences import hit
from mcexact.derived.constructions import augmented_outputs, failed
from mcexact.derived.feedthrough import input_filters
from tests.checker.handmade import Document, checked
from tests.checker.manifests import manifest, said, sentence, write
from tests.checker.tables import accepts, rejects

DOUBLE = MultiChannelSystem(
    [[1]], [[[1]], [[1]]], [[[1]], [[1], [2]]], names=["a", "b"], neighbors={"b": ["a"]}
)
"""An unstable state that two agents move and measure; b receives messages of a."""


def after(plant: MultiChannelSystem = DOUBLE, heard: bool = False, **lost: Any) -> Document:
    """The fixed modes after failures."""
    made = failed(plant, **lost)
    return document(fixed_spectrum(augmented_outputs(made) if heard else made))


NOTHING: Document = {
    "construction": "failed",
    "agents": [],
    "actuators": [],
    "sensors": [],
    "links": [],
}
ONE = after(agents=["a"])
SENSORS = after(sensors=[("a", 1), ("b", 1), ("b", 2)])
IDLE = after(actuators=[("a", 1), ("b", 1)])
BOTH = after(agents=["a", "b"])
LINK = after(heard=True, actuators=[("a", 1)], sensors=[("b", 1), ("b", 2)], links=[("a", "b")])
"""b alone acts and a alone measures: the mode is fixed once the link between them fails."""
DIRECT = document(
    fixed_spectrum(
        input_filters(
            failed(
                MultiChannelSystem([[1]], [[[1, 0]]], [[[0]]], D=[[1, 1]], names=["a"]),
                actuators=[("a", 1)],
            )
        )
    )
)

ACCEPTED = [
    ("nothing is fixed without the agent a", ONE),
    ("the mode is fixed where nobody measures", SENSORS),
    ("the mode is fixed where nobody acts", IDLE),
    ("the mode is fixed without agents", BOTH),
    ("the mode is fixed without the link", LINK),
    ("a plant with feedthrough fails before its inputs become states", DIRECT),
    ("an agent that has failed, and its actuator", after(agents=["a"], actuators=[("a", 1)])),
    ("a link of an agent that has failed", after(agents=["a"], links=[("a", "b")])),
]
STEP = "subject.0"
REJECTED = [
    ("nothing fails", SENSORS, (STEP, NOTHING), "INVALID"),
    ("the other agent still measures", SENSORS, (f"{STEP}.sensors", [["a", 1]]), "INVALID"),
    (
        "another sensor of it still measures",
        SENSORS,
        (f"{STEP}.sensors", [["a", 1], ["b", 2]]),
        "INVALID",
    ),
    ("the other agent still acts", IDLE, (f"{STEP}.actuators", [["b", 1]]), "INVALID"),
    ("only one agent has failed", BOTH, (f"{STEP}.agents", ["b"]), "INVALID"),
    ("the link works", LINK, (f"{STEP}.links", []), "INVALID"),
    ("a link the other way", LINK, (f"{STEP}.links", [["b", "a"]]), "INVALID"),
    ("a link of an agent to itself", LINK, (f"{STEP}.links", [["a", "a"]]), "INVALID"),
    ("a link of a plant without a graph", DIRECT, (f"{STEP}.links", [["a", "a"]]), "INVALID"),
    ("sensors in another order", SENSORS, (f"{STEP}.sensors", [["b", 1], ["a", 1]]), "MALFORMED"),
    ("a sensor twice", SENSORS, (f"{STEP}.sensors", [["a", 1], ["a", 1]]), "MALFORMED"),
    ("a sensor that does not exist", SENSORS, (f"{STEP}.sensors", [["a", 2]]), "MALFORMED"),
    ("a sensor 0", SENSORS, (f"{STEP}.sensors", [["a", 0]]), "MALFORMED"),
    ("a truth value for a sensor", SENSORS, (f"{STEP}.sensors", [["a", True]]), "MALFORMED"),
    ("a sensor without a number", SENSORS, (f"{STEP}.sensors", [["a"]]), "MALFORMED"),
    ("a sensor of nobody", SENSORS, (f"{STEP}.sensors", [["c", 1]]), "MALFORMED"),
    ("an agent that does not exist", BOTH, (f"{STEP}.agents", ["c"]), "MALFORMED"),
    ("an agent twice", BOTH, (f"{STEP}.agents", ["a", "a"]), "MALFORMED"),
    ("agents in another order", BOTH, (f"{STEP}.agents", ["b", "a"]), "MALFORMED"),
    ("a link twice", LINK, (f"{STEP}.links", [["a", "b"], ["a", "b"]]), "MALFORMED"),
    ("a link with one end", LINK, (f"{STEP}.links", [["a"]]), "MALFORMED"),
    ("no list of links", LINK, (f"{STEP}.links", {}), "MALFORMED"),
    (
        "a part that is not known",
        BOTH,
        (STEP, {**NOTHING, "agents": ["a"], "pumps": []}),
        "MALFORMED",
    ),
    (
        "a part that is left out",
        BOTH,
        (STEP, {"construction": "failed", "agents": ["a"]}),
        "MALFORMED",
    ),
]

test_a_true_claim_after_failures_is_accepted = accepts(ACCEPTED)
test_anything_else_is_rejected = rejects(REJECTED)


def test_a_statement_names_what_failed() -> None:
    words = 'after the failures {"agents":["a"],"links":[["a","b"]]}'
    assert words in checked(after(agents=["a"], links=[("a", "b")])).statement


# Sentences: what follows from certificates about single failures, and what does not.

PARTED = MultiChannelSystem(
    [[1, 0], [0, -2]],
    [[[1], [0]], [[1], [1]]],
    [[[1, 0]], [[0, 1]]],
    names=["a", "b"],
    neighbors={"a": ["b"], "b": ["a"]},
)
"""a moves and measures the mode 1, which b moves too; b alone moves and measures -2."""


def evidence_of(plant: MultiChannelSystem, information: str = "own") -> dict[str, Document]:
    """The plant's fixed modes, and those after single failures."""
    whole = augmented_outputs(plant) if information == "outputs" else plant
    several = failures(plant, information)
    found = {f"failures_{k}": document(each) for k, each in enumerate(several, 1)}
    return {"fixed_spectrum": document(fixed_spectrum(whole)), **found}


OWN, HEARD = evidence_of(PARTED), evidence_of(PARTED, "outputs")
SPARED = evidence_of(DOUBLE)
LINKED = evidence_of(
    MultiChannelSystem(
        [[1]], [[[0]], [[1]]], [[[1]], [[0]]], names=["a", "b"], neighbors={"a": ["b"], "b": ["a"]}
    ),
    "outputs",
)
"""a alone measures and b alone acts, so that of two links the one from a to b matters."""
AFTER = [name for name in OWN if name != "fixed_spectrum"]


def verdict(folder: Path, key: str, evidence: dict[str, Document], cited: list[str]) -> str:
    listed = [sentence(key, *cited, evidence=evidence)]
    [found] = said(write(folder, evidence, manifest(evidence, listed)))
    return found.verdict


def fatal(evidence: dict[str, Document]) -> list[str]:
    """The certificates about failures after which the plant cannot be stabilized."""
    return [name for name, each in evidence.items() if not each["claim"]["stabilizable"]]


def test_the_plants_are_as_they_are_meant() -> None:
    assert len(OWN) == 7 and len(HEARD) == 9
    assert all(name.startswith("failures") for name in fatal(OWN))
    assert [OWN[name]["subject"][0]["agents"] for name in fatal(OWN)] == [["a"], [], []]
    assert not fatal(SPARED) and len(SPARED) == 3


@pytest.mark.parametrize(
    ("key", "evidence", "cited", "expected"),
    [
        ("failures-unstable-row", OWN, AFTER, "IMPLIED"),
        ("failures-unstable-row", OWN, fatal(OWN), "IMPLIED"),
        ("failures-unstable-row", OWN, [n for n in AFTER if n not in fatal(OWN)], "INVALID"),
        ("failures-unstable-row", SPARED, [*SPARED][1:], "INVALID"),
        ("failures-unstable-row", OWN, ["fixed_spectrum"], "INVALID"),
        ("failures-unstable", OWN, AFTER, "IMPLIED"),
        # without b only -2 is fixed, so that nothing more has to be known of its parts
        ("failures-unstable", OWN, AFTER[:-1], "IMPLIED"),
        ("failures-unstable", OWN, [n for n in AFTER if n != "failures_3"], "INVALID"),
        ("failures-unstable", OWN, fatal(OWN), "INVALID"),
        ("failures-unstable", SPARED, [*SPARED][1:], "INVALID"),
        ("failures-stabilizable", OWN, AFTER, "INVALID"),
        ("failures-unstable", LINKED, [*LINKED][1:], "IMPLIED"),
        ("failures-unstable", LINKED, [*LINKED][1:-1], "INVALID"),
        ("failures-fixed-others", LINKED, [*LINKED], "IMPLIED"),
        ("failures-fixed-others", LINKED, [*LINKED][:-1], "INVALID"),
        ("failures-stabilizable", SPARED, [*SPARED][1:], "IMPLIED"),
        ("failures-stabilizable", SPARED, ["failures_1"], "INVALID"),
        ("failures-unstable", HEARD, [*HEARD][1:], "IMPLIED"),
        ("failures-unstable", HEARD, [*HEARD][2:], "INVALID"),
        ("failures-fixed", OWN, ["fixed_spectrum", *fatal(OWN)], "IMPLIED"),
        ("failures-fixed", OWN, fatal(OWN), "INVALID"),
        ("failures-fixed", SPARED, [*SPARED], "INVALID"),
        ("failures-fixed-none", SPARED, [*SPARED], "IMPLIED"),
        ("failures-fixed-none", SPARED, ["fixed_spectrum", "failures_2"], "INVALID"),
        ("failures-fixed-others", OWN, [*OWN], "IMPLIED"),
        ("failures-fixed-others", OWN, [*OWN][:-1], "INVALID"),
    ],
)  # fmt: skip
def test_what_follows_from_single_failures(
    tmp_path: Path, key: str, evidence: dict[str, Document], cited: list[str], expected: str
) -> None:
    assert verdict(tmp_path, key, evidence, cited) == expected


def test_of_two_failures_at_once_nothing_is_said(tmp_path: Path) -> None:
    evidence = {"fixed_spectrum": SPARED["fixed_spectrum"], "failures_1": BOTH}
    for key in ("failures-unstable-row", "failures-fixed"):
        assert verdict(tmp_path, key, evidence, [*evidence]) == "INVALID"


PAIRED = MultiChannelSystem([[1]], [[[1]]] * 3, [[[1]]] * 3, names=["a", "b", "c"])
"""Each of three agents moves the mode 1."""
WHOLE = {"fixed_spectrum": document(fixed_spectrum(PAIRED))}
EACH = {
    "".join(lost): after(PAIRED, agents=lost)
    for lost in (*map(list, ("a", "b", "c", "ab", "ac", "bc", "abc")),)
}
PORTS = {
    "actuators": after(PAIRED, actuators=[("a", 1), ("b", 1), ("c", 1)]),
    "both": after(PAIRED, agents=["a"], actuators=[("b", 1)]),
}
PAIRS = ["ab", "ac", "bc"]


@pytest.mark.parametrize(
    ("key", "cited", "follows"),
    [
        ("unstable", [*PAIRS, "abc"], "and stabilizable after that of any 2 of the agents"),
        ("unstable", ["ab", "ac", "abc"], "and stabilizable after that of any 1 of the agents"),
        ("unstable", ["ab", "c", "abc"], "and stabilizable after that of any 1 of the agents"),
        ("unstable", ["ab", "abc"], 'after the failure of agents "a", "b", "c"'),
        ("unstable", ["abc"], 'after the failure of agents "a", "b", "c"'),
        ("unstable", PAIRS, ""),
        ("unstable", [*PAIRS, "actuators"], ""),
        ("unstable", [*PAIRS, "both"], ""),
        ("fixed", ["fixed_spectrum", *PAIRS, "abc"], "any 2 of the agents"),
        ("fixed", ["fixed_spectrum", "actuators"], 'actuators ["a", 1], ["b", 1], ["c", 1]'),
        ("fixed", [*PAIRS, "abc"], ""),
        ("fixed", ["fixed_spectrum", *PAIRS], ""),
    ],
)
def test_fewer_failures_than_are_covered_prove_less(
    tmp_path: Path, key: str, cited: list[str], follows: str
) -> None:
    evidence = WHOLE | EACH | PORTS
    listed = [sentence(f"failures-fewest-{key}", *cited, evidence=evidence)]
    [found] = said(write(tmp_path, evidence, manifest(evidence, listed)))
    assert found.verdict == ("IMPLIED" if follows else "INVALID"), found.line()
    assert not follows or f"{follows} [" in found.statement, found.statement


@pytest.mark.parametrize("size", [1, 2, 3, 4])
def test_the_search_of_the_checker_is_enumeration(size: int) -> None:
    """Sets of about so many of seven elements: with two they are the edges of a graph."""
    rng = random.Random(size)
    elements = [1 << k for k in range(7)]
    for _ in range(40):
        sets = [
            sum(rng.sample(elements, rng.choice([size, size, size + 1, size - 1])))
            for _ in range(rng.randrange(8 * size))
        ]
        for most in range(5):
            some = (sum(few) for few in combinations(elements, most))
            right = any(all(each & few for each in sets) for few in some)
            assert hit(sets, most) == right, sets
            found = hitting_set(sets, most, lambda: None)
            assert (found is not None) == right, sets
            if found is not None:
                assert found.bit_count() <= most and all(each & found for each in sets)


def test_two_elements_of_the_smallest_set_may_be_needed() -> None:
    others = [120 - (1 << k) for k in range(3, 7)]
    sets = [0b111, *(one | each for one in (2, 4) for each in others)]
    assert not hit(sets, 1) and hit(sets, 2)
    assert hitting_set(sets, 2, lambda: None) == 0b110


def test_failures_of_all_parts(tmp_path: Path) -> None:
    still = MultiChannelSystem([[-1]], [[[1]], [[1]]], [[[1]], [[1]]])
    moved = MultiChannelSystem([[1]], [[[0]], [[0]]], [[[1]], [[1]]])
    for k, (plant, key) in enumerate([(still, "all-stabilizable"), (moved, "all-none")]):
        evidence = {
            "fixed_spectrum": document(fixed_spectrum(plant)),
            "one": after(plant, agents=["1"]),
            "two": after(plant, agents=["1", "2"]),
        }
        for cited, expected in ((["one", "two"], "IMPLIED"), (["one"], "INVALID")):
            for rule in ("all-stabilizable", "all-none"):
                cited_ = ["fixed_spectrum"] * (rule == "all-none") + cited
                listed = [sentence(f"failures-{rule}", *cited_, evidence=evidence)]
                folder = tmp_path / f"{k}{rule}{len(cited)}"
                folder.mkdir()
                [found] = said(write(folder, evidence, manifest(evidence, listed)))
                assert found.verdict == (expected if rule == key else "INVALID"), found.line()


def test_failures_with_messages_prove_nothing_without_them(tmp_path: Path) -> None:
    mixed = {**OWN, **{name: HEARD[name] for name in AFTER}}
    assert verdict(tmp_path, "failures-fixed-others", mixed, [*mixed]) == "INVALID"


def test_a_plant_with_feedthrough_fails_before_its_inputs_become_states(tmp_path: Path) -> None:
    plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]], D=[[1, 0], [0, 1]])
    filtered = input_filters(plant)
    several = failures(filtered)
    assert all(
        [s["construction"] for s in each.about.subject] == ["failed", "input_filters"]
        for each in several
    )
    evidence = {f"failures_{k}": document(each) for k, each in enumerate(several, 1)}
    listed = [sentence("failures-stabilizable", *evidence, evidence=evidence)]
    document_ = manifest(evidence, listed)
    document_["subject"] = [{"construction": "input_filters"}]
    [found] = said(write(tmp_path, evidence, document_))
    assert found.verdict == "IMPLIED", found.line()


def test_failures_of_a_system_that_is_made_in_another_way_prove_nothing(tmp_path: Path) -> None:
    several = failures(input_filters(DOUBLE))
    evidence = {f"failures_{k}": document(each) for k, each in enumerate(several, 1)}
    for base, expected in (("input_filters", "IMPLIED"), ("integrators", "INVALID")):
        listed = manifest(
            evidence, [sentence("failures-stabilizable", *evidence, evidence=evidence)]
        )
        listed["subject"] = [{"construction": base}]
        (tmp_path / base).mkdir()
        [found] = said(write(tmp_path / base, evidence, listed))
        assert found.verdict == expected, base
