"""Controllability, observability and shared dimensions for all values of a parameter."""

from __future__ import annotations

import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact import (
    NeighborGraph,
    ParametricSystem,
    check,
    fixed_spectrum,
    joint_controllability,
    joint_observability,
    load_certificate,
    save_certificate,
)
from mcexact.constructions import extended_system
from mcexact.errors import InputError, UsageError
from mcexact.model.system_file import read_parametric_system
from tests.answer.test_golden import PORTS, with_a_parameter
from tests.assurance.campaigns.parametric import companions
from tests.oracle.parametric_draws import drawn_parametric
from tests.wording import refusal, says

EXAMPLE = with_a_parameter([[1, 0, 0], ["t", 1, 0], [0, 1, 1]], PORTS)


def lost_at(found: Any, value: Fraction) -> bool | None:
    """Whether an answer says that a mode is fixed at a value; None if it says nothing."""
    if any(each.value(value) == 0 for each in found.outside):
        return None
    return bool(found.generic) or any(each.value(value) == 0 for each in found.exceptional)


@pytest.mark.parametrize("number", range(3))
def test_what_is_lost_at_a_value_is_lost_by_the_plant_there(number: int) -> None:
    rng = random.Random(number)
    plant = drawn_parametric(rng)
    chosen = rng.sample(plant.names, rng.randint(1, plant.m))
    answers = [
        (ask, names, ask(plant, names))
        for ask in (joint_controllability, joint_observability)
        for names in (chosen, None)
    ]
    exact = [e.exact for _, _, found in answers for e in found.exceptional if e.exact is not None]
    for value in {Fraction(0), Fraction(1), Fraction(rng.randint(-9, 9), 4), *exact}:
        try:
            there = plant.at({"t": value})
        except InputError:
            continue
        for ask, names, found in answers:
            if lost_at(found, value) is not None:
                assert (ask(there, names).dimension < there.n) is lost_at(found, value)


@pytest.mark.parametrize("number", (4, 7))
def test_elimination_at_points_finds_the_same(number: int) -> None:
    assert companions(number, 3)[0] == []


def test_the_certificate_is_about_the_plant_that_was_asked(tmp_path: Path) -> None:
    found = joint_controllability(EXAMPLE, ["1", "3"])
    assert [each.exact for each in found.exceptional] == [0]
    verdict = check(found, EXAMPLE)
    assert verdict.verdict == "VALID"
    assert says(verdict.statement, "merged into")
    save_certificate(found, tmp_path / "found.json")
    read = load_certificate(tmp_path / "found.json", EXAMPLE)
    assert (read, read.about, read.about.plant) == (found, found.about, EXAMPLE)
    assert hash(read.about) == hash(found.about)


def test_a_system_of_one_channel_is_measured_as_it_is() -> None:
    alone = ParametricSystem([[1, "t"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["t"])
    (step,) = joint_controllability(alone).about.subject
    assert step == {"construction": "full_output", "channel": "1"}
    assert [e.exact for e in joint_controllability(alone).exceptional] == [0]
    assert [e.exact for e in joint_observability(alone, ["1"]).exceptional] == [0]
    with refusal(UsageError):
        joint_controllability(EXAMPLE, [])


@pytest.mark.parametrize(
    ("dimensions", "share", "enough"),
    [
        ((0, 0, 1), "outputs+states", True),
        ((0, 0, 0), "outputs+states", False),
        ((1, 0, 0), "outputs+states", False),
        ((0, 0, 1), "states", False),
        ((1, 0, 1), "states", True),
    ],
)
def test_what_the_agents_of_the_example_share_is_enough_for_every_complex_value(
    dimensions: tuple[int, int, int], share: Any, enough: bool
) -> None:
    ring = NeighborGraph.ring(EXAMPLE.names)
    found = fixed_spectrum(extended_system(EXAMPLE, dimensions, share, ring))
    assert not found.generic and bool(found.exceptional) is not enough
    assert check(found, EXAMPLE).verdict == "VALID"
    bare = fixed_spectrum(EXAMPLE.at({"t": 0}).with_neighbors(ring))
    assert bare.factors


def test_constructions_keep_ranges_and_several_parameters() -> None:
    text = (
        '{"format": "mcexact-system/1", "time": "discrete", "A": [["a", "b"], [0, 1]],'
        ' "parameters": {"a": {"range": [0, 1]}, "b": {}},'
        ' "channels": [{"B": [[1], [0]], "C": [["a*b", 1]]}]}'
    )
    made = extended_system(read_parametric_system(text), (1,))
    assert (made.n, made.ranges, made.time) == (3, ((0, 1), (None, None)), "discrete")
    assert str(made.channels[0].C[0, 0]) == "a*b"
    assert len(fixed_spectrum(made.along({"a": "s", "b": 1})).generic) == 1
