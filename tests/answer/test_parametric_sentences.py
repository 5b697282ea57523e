"""Sentences about all values of a parameter, held against what is decided at single values."""

from __future__ import annotations

import random
import re
from dataclasses import replace
from fractions import Fraction
from typing import Any

import pytest

from mcexact import ParametricSystem, analyze
from mcexact.errors import InputError
from tests.assurance.campaigns.parametric_words import examined
from tests.oracle.parametric_words import disagreements
from tests.wording import worded

CONDITION = re.compile(r"t = (-?\d+(?:/\d+)?)(?! =)")
ENTRIES = [0, 0, 0, 1, 1, -1, 2, "t", "t - 1", "t + 2", "t^2 - 1", "1/(t - 3)"]


def drawn(rng: random.Random) -> ParametricSystem:
    """A plant of two or three states and two channels, with few entries that are not 0."""
    n = rng.choice([2, 3])

    def table(r: int, c: int) -> list[list[Any]]:
        return [[rng.choice(ENTRIES) for _ in range(c)] for _ in range(r)]

    B, C = [table(n, 1) for _ in range(2)], [table(1, n) for _ in range(2)]
    return ParametricSystem(
        table(n, n), B, C, parameters=["t"], time=rng.choice(["continuous", "discrete"])
    )


@pytest.mark.parametrize("seed", range(4))
def test_what_is_said_of_all_values_holds_at_each(seed: int) -> None:
    rng = random.Random(seed)
    for _ in range(3):
        plant = drawn(rng)
        said = {each.template.label: str(each) for each in analyze(plant).sentences}
        conditions = {Fraction(v) for text in said.values() for v in CONDITION.findall(text)}
        for t in sorted({*conditions, Fraction(0), Fraction(1), Fraction(rng.randint(5, 99), 7)}):
            try:
                point = plant.at(t)
            except InputError:  # an entry is undefined there
                continue
            require_agreement(said, t, analyze(point))


def require_agreement(said: dict[str, str], t: Fraction, found: Any) -> None:
    """At one value each sentence says what is decided there."""

    def elsewhere(label: str) -> bool:
        """Whether the value is not one at which something else holds."""
        return t not in map(Fraction, CONDITION.findall(said[label]))

    complete = said["complete"].startswith("yes") and elsewhere("complete")
    assert found.completeness.complete == complete, (said, t)
    steady = said["set-points"].startswith("every") and elsewhere("set-points")
    assert found.setpoint.solvable == steady, (said, t)
    free = said["fixed modes"].startswith("none") and elsewhere("fixed modes")
    assert found.fixed_spectrum.empty == free, (said, t)
    for label, answer in (
        ("jointly controllable", found.joint_controllability),
        ("jointly observable", found.joint_observability),
    ):
        whole = said[label].startswith("every") and elsewhere(label)
        assert answer.controllable == whole, (said, t)
    for label, answer in (
        ("controllability indices", found.controllability_indices),
        ("observability indices", found.observability_indices),
    ):
        told = re.match(r"(?:\d+(?:, )?)*|none", said[label])
        listed = [int(k) for k in re.findall(r"\d+", told[0])] if told else []
        assert (list(answer.indices) == listed) == elsewhere(label), (said, t)
    edges = {(j, i) for j, i in re.findall(r"(\w+) -> (\w+)", said["transfer graph"])}
    lost = re.findall(r"(\w+) -> (\w+) vanishes where ([^;]*)", said["transfer graph"])
    gone = {(j, i) for j, i, at in lost if t in map(Fraction, CONDITION.findall(at))}
    assert set(found.transfer_graph.arcs) == edges - gone, (said, t)


@pytest.mark.parametrize("number", [1, 6, 19, 300])
def test_words_about_small_plants_hold_at_points_on_and_off_what_they_name(number: int) -> None:
    """In 6 denominators divide the modes, in 19 a line meets two hypersurfaces
    at one point, in 300 one of them and a pole."""
    wrong, seen = examined(number)
    assert wrong == [] and seen["points"] >= 3


TWO = ParametricSystem(
    [[-1, "c"], [0, -2]],
    [[[1], [0]], [[0], [1]]],
    [[["k", 0]], [["k", 0]]],
    parameters=["c", "k"],
)


def test_no_channel_is_said_to_control_what_all_channels_control() -> None:
    account = analyze(TWO).account
    causes = {name: {why for *_, why in account.rows(name)} for name in account.answers}
    assert causes["joint_observability"] == {""}
    (cause,) = causes["fixed_spectrum"]
    assert worded(cause)
    at = {"c": Fraction(0), "k": Fraction(5)}
    assert disagreements(TWO, account, at) == []
    answer = account.answers["joint_observability"]
    blamed = [replace(each, channels=((),)) for each in answer.hypersurfaces]
    wrong = {**account.answers, "joint_observability": replace(answer, hypersurfaces=(*blamed,))}
    assert disagreements(TWO, replace(account, answers=wrong), at) != []


def test_a_line_of_proof_is_not_listed_among_conditions() -> None:
    account = analyze(TWO).account
    lines = {line for name in account.answers for _, line in account.along(name)}
    where = {at for name in account.answers for at, *_ in account.rows(name)}
    assert len(lines) > 2 and not lines & where
    files = [file for name in account.answers for file, _ in account.along(name)]
    assert sorted(files) == sorted(account.certificates)


def test_values_out_of_the_range_and_poles_have_one_row_each() -> None:
    plant = ParametricSystem(
        [["1/(t - 9)", "t - 7"], ["t - 8", 2]],
        [[[1], [0]], [[0], ["t - 6"]]],
        [[[1, 0]], [[0, 1]]],
        parameters=["t"],
        assume={"t": (0, 1)},
    )
    account = analyze(plant).account
    for name in account.answers:
        what = [what for _, what, _ in account.rows(name)]
        assert what.count("undefined") == 1 and what.count("not decided") <= 1, name
    assert any("not decided" in each for each in account.rows("transfer_graph"))
