"""Channels control every plant in a box: what is proved holds for drawn members."""

from __future__ import annotations

import random

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mcexact import (
    MultiChannelSystem,
    check,
    gallery,
    joint_controllability,
    joint_observability,
    testing,
)
from mcexact.analysis.boxes.members import box_controllability, box_observability
from mcexact.boxes import Box
from mcexact.errors import LimitReached
from tests.wording import refusal


@pytest.mark.parametrize("name", ["quadruple-tank-pminus", "compleib-ac1", "compleib-dis5"])
def test_published_plants_stay_controllable_and_observable(name: str) -> None:
    box = Box.relative(gallery(name), "1/20")
    for answer in (box_controllability(box.system), box_observability(box.system)):
        assert check(answer, box.system).verdict == "VALID"


@given(testing.systems(max_states=3), st.sampled_from(["1/1000", "1/10", "1/2"]))
@settings(max_examples=20)
def test_members_of_certified_boxes_are_controllable(drawn: testing.Drawn, part: str) -> None:
    box = Box.relative(drawn.system, part)
    assume(box.system.uncertainty is not None)
    for decide, exact in (
        (box_controllability, joint_controllability),
        (box_observability, joint_observability),
    ):
        try:
            answer = decide(box.system)
        except LimitReached:
            continue
        assert check(answer, box.system).verdict == "VALID"
        for k in range(2):
            assert exact(box.member(random.Random(k), vertex=bool(k))).controllable


@given(testing.uncontrollable_systems(max_states=4))
@settings(max_examples=20)
def test_a_box_with_an_uncontrollable_member_is_never_certified(drawn: testing.Drawn) -> None:
    inner = Box.relative(drawn.system, "1/50")
    outer = Box(inner.member(random.Random(1)), inner.radii)
    with refusal(LimitReached, "proof plant"):
        box_controllability(outer.system)


def test_some_channels_control_the_modes_outside_of_a_region() -> None:
    plant = MultiChannelSystem([[1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 1]]] * 2)
    box = Box.relative(plant, "1/10").system
    answer = box_controllability(box, ["1"], bound=0)
    assert answer.channels == ("1",) and check(answer, box).verdict == "VALID"
    with pytest.raises(LimitReached):
        box_controllability(box, ["1"])
    assert box_observability(box, ["2"]).channels == ("2",)
