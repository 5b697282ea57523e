"""The checker's rules about all members of a box."""

from __future__ import annotations

from pathlib import Path

import pytest

from mcexact.checker.sentences_boxes import least, of_plant
from mcexact.checker.system import read_plant
from tests.checker.box_maker import stable
from tests.checker.box_plants import LOOP_STABLE, PART_CERTAIN, PART_STABLE, WAYS, proportional
from tests.checker.handmade import checked, plant
from tests.checker.parameter_plants import LOOP_DAMPED, LOOP_SAMPLED, TIED, TURNED
from tests.checker.recorded import compare, keys
from tests.checker.test_sentences_design import judged


def test_how_far_the_radii_of_a_loop_reach_is_read_off_its_certificate(tmp_path: Path) -> None:
    for loop, reach in (
        (
            PART_STABLE,
            "in the plant by more than 1/10 and none in the controller by more than 1/100",
        ),
        (PART_CERTAIN, "in the plant by more than 1/10"),
        (LOOP_STABLE, "in the plant by more than 0 and none in the controller by more than 0"),
    ):
        name, _, claim = checked(loop).statement.partition(" (")
        claim = claim.partition("): ")[2]
        said = judged(tmp_path, "members-in-region", [loop]).statement
        assert said == f"{name}: {claim} from premise_0.json"
        said = judged(tmp_path, "members-in-region-part", [loop]).statement
        told = f"it holds if no entry changes {reach} of its modulus"
        assert said == f"{name}: {claim}; {told} from premise_0.json"


def test_gains_that_are_0_stay_so(tmp_path: Path) -> None:
    """A radius of a gain that is 0 is no part of it."""
    wide = plant([[-1]], ([[2]], [["1/2"], [0]]))
    told = {}
    for name, gain in (("values", -1), ("radii", "1/100")):
        told[name] = proportional(gain)
        told[name]["agents"][0]["input"]["outputs"]["1"] = [[gain, "1/8" if name == "radii" else 0]]
    step = {"construction": "closed_loop", "controller": told["values"]}
    loop = stable(wide, WAYS, step, growth=[1], gain_radii=told["radii"])
    said = judged(tmp_path, "members-in-region-part", [loop]).statement
    assert "in the plant by more than 0 and none in the controller by more than 1/100" in said


def test_set_points_are_in_no_loop_and_need_no_radii(tmp_path: Path) -> None:
    values, radii = proportional(-1), proportional("1/100")
    values["agents"][0]["input"]["reference"] = [[1]]
    step = {"construction": "closed_loop", "controller": values}
    loop = stable(plant([[-1]], ([[2]], [["1/2"]])), WAYS, step, growth=[1], gain_radii=radii)
    said = judged(tmp_path, "members-in-region-part", [loop]).statement
    assert "in the plant by more than 0 and none in the controller by more than 1/100" in said


def test_a_plant_of_zeros_has_no_entry_that_changes() -> None:
    assert least(of_plant(read_plant(plant([[0]], ([[0]], [[0]]))))) == 0


def test_a_loop_is_in_its_region_at_all_values(tmp_path: Path) -> None:
    rule = "parametric-ranges-in-region"
    said = judged(tmp_path, rule, [LOOP_DAMPED])
    name, _, claim = checked(LOOP_DAMPED).statement.partition(" (")
    assert said.verdict == "IMPLIED"
    assert said.statement == f"{name}: {claim.partition('): ')[2]} from premise_0.json"
    for other in (TURNED, TIED, LOOP_STABLE, LOOP_SAMPLED):
        assert judged(tmp_path, rule, [other]).verdict == "INVALID"
    assert judged(tmp_path, "members-in-region", [LOOP_DAMPED]).verdict == "INVALID"


@pytest.mark.parametrize("key", keys("boxes"))
def test_a_rule_answers_as_it_did(key: str) -> None:
    compare(key)
