"""Failures, against enumeration: all are tried, by the rank of every pencil."""

from __future__ import annotations

import pickle
import random
import re
from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.analyze import analyze
from mcexact.analysis.failures import failures, fewest_failures
from mcexact.analysis.modulo import modulo
from mcexact.answer.failures import Failures, every, failure_of
from mcexact.answer.protocol import document
from mcexact.answer.templates import failures_in_words
from mcexact.errors import InputError, UsageError
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle.certificates.systems import read_plant
from tests.oracle.draws import exact, sparse_system
from tests.oracle.sentences.analysis import stable
from tests.oracle.sentences.cases import Case, plain, same_roots
from tests.oracle.sentences.failures import after_several, fewest, fixed_after, more_fixed
from tests.wording import says

SEEDS = 600
"""The number of drawn systems that are compared with enumeration, half of them with messages."""


def drawn(seed: int) -> tuple[MultiChannelSystem, str]:
    """A plant, and what its agents feed back."""
    rng = random.Random(seed)
    plant = exact(sparse_system(rng), rng.choice(["continuous", "discrete"]))
    if seed % 2:
        return plant, "own"
    sets = [[j for j in range(plant.m) if rng.random() < 0.5] for _ in range(plant.m)]
    heard = plant.with_neighbors(NeighborGraph(plant.names, sets))
    measuring = rng.randrange(plant.m) if rng.random() < 0.5 else None
    if measuring is None:
        return heard, "outputs"
    # one agent alone measures, so that links matter
    C = [C_i if i == measuring else 0 * C_i for i, C_i in enumerate(heard.C)]
    return MultiChannelSystem(
        heard.A, heard.B, C, time=heard.time, names=heard.names, neighbors=heard.neighbors
    ), "outputs"


@pytest.mark.parametrize("first", range(0, SEEDS, 50))
def test_every_single_failure_is_decided_as_by_enumeration(first: int) -> None:
    seen: Counter[str] = Counter()
    for seed in range(first, first + 50):
        plant, information = drawn(seed)
        several = failures(plant, information)
        known = {tuple(failure_of(each.about.subject)): each.polynomial for each in several}
        read = read_plant(document(several[0])["system"])
        case = Case(read, {"information": information})
        after = fixed_after(case)
        assert {*known} <= {*after}, seed
        for failure, facts in after.items():
            if failure in known:
                assert same_roots(plain(known[failure]), facts.fixed), (seed, failure)
            else:
                assert [*map(str, facts.fixed)] == [*map(str, case.subject.fixed)], (seed, failure)
            seen[failure[0]] += len(facts.fixed) > len(case.subject.fixed)
    assert {"agents", "actuators", "sensors"} <= {part for part, k in seen.items() if k}


@pytest.mark.parametrize("first", range(0, SEEDS, 50))
def test_the_fewest_failures_are_those_of_enumeration(first: int) -> None:
    seen: Counter[int | None] = Counter()
    for seed in range(first, first + 50):
        plant, information = drawn(seed)
        parts = ["agents", "actuators", "sensors", *["links"] * (information == "outputs")]
        found = fewest_failures(plant, information, parts=parts)
        case = Case(read_plant(document(found.before)["system"]), {"information": information})
        assert {*found.fixing()} == {part for part in parts if every(part, plant)}
        questions = [(found.fixing(), more_fixed(case))]
        if stable(case.subject):
            questions += [(found.destabilizing(), lambda facts: not stable(facts))]
        else:
            assert found.destabilizing() == {}
        for by_part, matters in questions:
            for part, answer in by_part.items():
                assert answer.number == fewest(case, part, matters), (seed, part)
                if answer.failures is not None:
                    assert matters(after_several(case, answer.failures)), (seed, part)
                else:
                    assert answer.spared == len(every(part, plant))
                seen[answer.number] += 1
    assert {None, 1, 2} <= {*seen}


def published() -> list[list[str]]:
    """The rows of the page about the fewest agents of published plants."""
    page = Path(__file__).parents[3] / "docs" / "how-to" / "failures.md"
    rows_of = r"^\| `([\w-]+)`.* \| (\d+) \| (\d+|no failure) \| (\d+|no failure) \|$"
    return [[*row] for row in re.findall(rows_of, page.read_text("utf-8"), re.M)]


def test_the_fewest_agents_of_published_plants_are_computed() -> None:
    assert len(published()) == 8
    for name, m, fixed, unstable in published():
        plant = gallery.load(name)
        found = fewest_failures(plant, parts=["agents"])
        numbers = (found.fixing()["agents"].number, found.destabilizing()["agents"].number)
        assert (int(m), fixed, unstable) == (plant.m, *(str(k or "no failure") for k in numbers))


SPARE = MultiChannelSystem([[1]], [[[1]]] * 5, [[[1]]] * 5)
"""Each of five agents moves the mode 1."""


def test_a_limit_leaves_bounds_that_are_proved() -> None:
    [full, bounded] = [fewest_failures(SPARE, node_limit=k).fixing()["agents"] for k in (500, 3)]
    assert full.number == 5 and full.spared == 4
    assert bounded.number is None and bounded.failures is not None
    assert bounded.spared < 4 and len(bounded.failures) == 5
    with pytest.raises(UsageError, match="node_limit"):
        fewest_failures(SPARE, node_limit=0)
    with pytest.raises(UsageError, match="parts"):
        fewest_failures(SPARE, parts=["links"])


def test_what_is_said_of_the_fewest_failures() -> None:
    def said(name: str) -> list[tuple[str, Any, Any]]:
        account = analyze(gallery.load(name), ["fixed_spectrum", "fewest_failures"]).account
        sentences = [each for each in account.sentences if "failures" in each.template.key]
        values = [each.values for each in sentences]
        return [
            (
                each.template.key.removeprefix("failures-"),
                len(v.get("failures", ())),
                v.get("spared"),
            )
            for each, v in zip(sentences, values, strict=True)
        ]

    assert said("compleib-nn10") == [("fewest-unstable", 3, ("agents", 2))] * 1 + [
        ("fewest-unstable", 3, ("sensors", 2))
    ] * (len(said("compleib-nn10")) - 1)
    assert said("farina-three-rooms") == [
        ("all-stabilizable", 0, None),
        ("fewest-fixed", 2, ("agents", 1)),
    ]
    assert said("relative-positions-4") == [("all-none", 0, None)]
    assert said("compleib-tf1")[0] == ("fewest-unstable", 1, ("agents", 0))


def test_the_fewest_failures_are_printed_and_kept_by_a_copy() -> None:
    found = fewest_failures(SPARE)
    assert str(found).splitlines()[0] == (
        "further fixed: agent 1, agent 2, agent 3, agent 4 and agent 5; by any 4 agents: no"
    )
    assert pickle.loads(pickle.dumps(found)).fixing() == found.fixing()
    assert repr(found).startswith("FewestFailures(")


def test_a_link_matters_where_one_agent_measures_and_another_one_acts() -> None:
    plant = MultiChannelSystem(
        [[1]], [[[0]], [[1]]], [[[1]], [[0]]], names=["a", "b"], neighbors={"a": ["b"], "b": ["a"]}
    )
    lost = [*failures(plant, "outputs").leaving()]
    assert ("links", "a", "b") in lost and ("links", "b", "a") not in lost
    said = analyze(plant, also=["failures"], information="outputs").account
    assert says(said.at("answer"), "failures stabilize")
    assert rows(plant, information="outputs")[1][1] == lost


def rows(plant: MultiChannelSystem, **options: Any) -> list[tuple[str, list[Any] | None]]:
    """The keys of the sentences about failures, each with the failures that it names."""
    said = analyze(plant, also=["failures"], **options).account.sentences
    about = [each for each in said if each.template.key.startswith("failures-")]
    return [(each.template.key, each.values.get("failures")) for each in about]


def test_what_is_said_of_published_plants() -> None:
    string = gallery.load("farina-string-of-vehicles-4")
    keys = ["failures-unstable", "failures-unstable-row", *["failures-fixed"] * 2]
    assert [key for key, _ in rows(string)] == [*keys, "failures-fixed-others"]
    [_, unstable, actuators, sensors, _] = [named for _, named in rows(string)]
    assert actuators and sensors and unstable == [*actuators, *sensors]
    assert actuators == [
        *(("agents", name, None) for name in string.names),
        *(("actuators", name, 1) for name in string.names),
    ]
    assert sensors == [("sensors", name, 1) for name in string.names]
    assert [key for key, _ in rows(gallery.load("compleib-he3"))] == [
        "failures-stabilizable",
        "failures-fixed-none",
    ]
    # every single failure leaves a stable mode, so that there are no others
    tanks = rows(gallery.load("quadruple-tank-pminus"))
    assert [key for key, _ in tanks] == ["failures-stabilizable", *["failures-fixed"] * 2]
    # what cannot be stabilized anyway is not said to be lost
    periodic = rows(gallery.load("movable-by-periodic-gains"))
    assert [key for key, _ in periodic] == ["failures-fixed"]


def test_the_table_of_five_published_plants_is_computed() -> None:
    page = Path(__file__).parents[3] / "docs" / "how-to" / "failures.md"
    rows_of = re.findall(
        r"^\| `([\w-]+)`, [^|]* \| (\d+) \| ([^|]*) \|$", page.read_text("utf-8"), re.M
    )
    assert len(rows_of) == 5
    for name, number, lost in rows_of:
        plant = gallery.load(name)
        p, q = (sum(each) for each in zip(*plant.sizes, strict=True))
        fatal = failures(plant).leaving()
        assert int(number) == plant.m + p + q
        assert lost == (failures_in_words(fatal) if fatal else "none of them")


def test_a_plant_without_a_part_of_its_state_fails_like_the_plant() -> None:
    plant = gallery.load("relative-positions-4")
    whole, rest = failures(plant), failures(modulo(plant))
    assert all(each.about.subject[1]["construction"] == "modulo" for each in rest)
    assert {str(each.polynomial) for each in whole} == {"x"}
    keys = [key for key, _ in rows(modulo(plant))]
    assert {str(each.polynomial) for each in rest} <= {"1", "x"}
    assert keys[0] in {"failures-unstable", "failures-stabilizable"}


def test_a_plant_with_feedthrough_is_asked_as_any_other() -> None:
    plant = MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]], D=[[1, 0], [0, 1]])
    assert all(each.empty for each in failures(plant))
    assert [key for key, _ in rows(plant)] == ["failures-stabilizable", "failures-fixed-none"]
    alone = MultiChannelSystem([[1]], [[[1]]], [[[1]]], D=[[1]])
    keys = ["failures-unstable", "failures-unstable-row", "failures-fixed"]
    assert [key for key, _ in rows(alone)] == keys


def test_modes_that_are_slower_than_a_rate_are_listed() -> None:
    tanks = failures(gallery.load("quadruple-tank-pminus"))
    assert tanks.leaving() == {} == tanks.leaving(rate="1/1000")
    slow = tanks.leaving(rate="1/50")
    assert [str(failure) for failure in slow] == [
        *("agent 1", "agent 2"),
        *("actuator 1 of agent 1", "actuator 1 of agent 2"),
        *("sensor 1 of agent 1", "sensor 1 of agent 2"),
    ]
    assert repr(tanks) == "Failures(6 certificates; print them, or ask for .leaving())"
    assert isinstance(
        tanks, Failures
    ) and "sensor 1 of agent 1: x + 1/62, x + 1/30, x + 1/23" in str(tanks)


def test_links_need_a_graph_and_plants_numbers() -> None:
    with pytest.raises(UsageError, match="neighbor graph"):
        failures(gallery.load("compleib-he3"), "outputs")
    with pytest.raises(UsageError, match="information"):
        failures(gallery.load("compleib-he3"), "links")
    plant: Any = gallery.load_parametric("platoon-parametric")
    with pytest.raises(InputError, match="MultiChannelSystem"):
        failures(plant)


def test_the_failure_of_a_certificate_stands_in_json() -> None:
    account = analyze(gallery.load("compleib-ac1"), ["fixed_spectrum", "failures"]).account
    views = [view for name, view in account.as_json().items() if name.startswith("failures_")]
    assert [view["failed"] for view in views] == [
        *({"agents": [name]} for name in "123"),
        {"actuators": [["1", 1]]},
        {"sensors": [["1", 1]]},
    ]
