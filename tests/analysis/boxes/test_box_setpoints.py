"""Set-points of every plant in a box."""

from __future__ import annotations

import random

import pytest

from mcexact.analysis.boxes.members import box_fixed_modes, box_setpoints
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.structure import setpoint_solvability
from mcexact.answer.check import check
from mcexact.derived.constructions import setpoint_system
from mcexact.errors import LimitReached
from mcexact.model.box import Box
from mcexact.model.system import MultiChannelSystem
from tests.wording import refusal, says

PORTS = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
PLANT = MultiChannelSystem([[1, 0], [1, -2]], *PORTS)
SAMPLED = MultiChannelSystem([[2, 1], [0, "1/2"]], *PORTS, time="discrete")


@pytest.mark.parametrize("plant", [PLANT, SAMPLED])
def test_every_member_holds_set_points_by_a_controller_of_its_own(
    plant: MultiChannelSystem,
) -> None:
    box = Box.relative(plant, "1/20")
    proof = box_setpoints(box.system)
    assert check(proof, box.system).verdict == "VALID"
    assert says(proof.explain(), "holds constant")
    rng = random.Random(1)
    for vertex in (True, False) * 5:
        member = box.member(rng, vertex=vertex)
        assert fixed_spectrum(setpoint_system(member)).stabilizable
        assert setpoint_solvability(member).solvable


def test_a_member_with_a_zero_at_rest_holds_no_set_point() -> None:
    """x' = -x + u, y = (1 - c) u at rest: 0 where c = 1, and no mode is fixed or unstable."""
    plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [1]]], [[["1.1", -2]]])
    assert setpoint_solvability(plant).solvable
    box = Box.absolute(plant, C=[[["1/5", 0]]])
    assert box_fixed_modes(box.system, bound=0).bound == 0
    with refusal(LimitReached):
        box_setpoints(box.system)
    assert box_setpoints(Box.absolute(plant, C=[[["1/50", 0]]]).system).bound == 0


def test_no_proof_is_searched_where_the_plant_itself_fails() -> None:
    twice = Box.relative(MultiChannelSystem([[-1]], [[[1]]], [[[1], [2]]]), "1/20").system
    with refusal(LimitReached):
        box_setpoints(twice, solvability=setpoint_solvability(twice))
