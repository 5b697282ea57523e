"""The checker's rules about all members of a box."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from mcexact.analysis.boxes.loops import box_stability
from mcexact.analysis.boxes.margins import box_disk_margin
from mcexact.answer.protocol import document, encode
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.system import read_matrix
from mcexact.checker.discs import pairs_of, radii_in_words
from mcexact.checker.sentences_loops import least
from mcexact.model.box import Box
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from tests.checker.box_maker import stable
from tests.checker.box_plants import LOOP_STABLE, PART_CERTAIN, PART_STABLE, WAYS, proportional
from tests.checker.handmade import checked, plant
from tests.checker.parameter_plants import LOOP_DAMPED, LOOP_SAMPLED, TIED, TURNED
from tests.checker.recorded import compare, keys
from tests.checker.test_sentences_design import judged
from tests.wording import says


def test_how_far_the_radii_of_a_loop_reach_is_read_off_its_certificate(tmp_path: Path) -> None:
    for loop, reach in (
        (PART_STABLE, ["1/10", "1/100"]),
        (PART_CERTAIN, ["1/10"]),
        (LOOP_STABLE, ["0", "0"]),
    ):
        name, _, claim = checked(loop).statement.partition(" (")
        claim = claim.partition("): ")[2]
        said = judged(tmp_path, "members-in-region", [loop]).statement
        assert said == f"{name}: {claim} from premise_0.json"
        said = judged(tmp_path, "members-in-region-part", [loop]).statement
        assert said.startswith(f"{name}: {claim}; ")
        told = said.removeprefix(f"{name}: {claim}; ").removesuffix(" from premise_0.json")
        assert re.findall(r"by more than (\S+) of", told) == reach


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
    assert says(said, "more none")


def test_set_points_are_in_no_loop_and_need_no_radii(tmp_path: Path) -> None:
    values, radii = proportional(-1), proportional("1/100")
    values["agents"][0]["input"]["reference"] = [[1]]
    step = {"construction": "closed_loop", "controller": values}
    loop = stable(plant([[-1]], ([[2]], [["1/2"]])), WAYS, step, growth=[1], gain_radii=radii)
    said = judged(tmp_path, "members-in-region-part", [loop]).statement
    assert says(said, "more none")


def test_a_plant_of_zeros_has_no_entry_that_changes() -> None:
    assert least(pairs_of([Matrix([[0]], 1)], [Matrix([[0]], 1)])) == 0


OF_IT = "of the absolute value"
NEAR = [
    ("no radius", [[2, 0]], [[0, 0]], "by at most ITS (no entry has one)"),
    (
        "one part",
        [[2, -4]],
        [["1/5", "2/5"]],
        "by at most 1/10 of the absolute values of the latter",
    ),
    (
        "0 is certain",
        [[2, 0]],
        [["1/5", 0]],
        "by at most 1/10 of the absolute values of the latter",
    ),
    (
        "an entry is certain",
        [[2, 4]],
        [["1/5", 0]],
        "by at most ITS (1 entry has one, none above 1/5 and none above 1/10 of the absolute value "
        "of its entry)",
    ),
    (
        "the largest radius is another one than the largest part",
        [[1, -100]],
        [["1/2", 1]],
        "by at most ITS (2 entries have one, none above 1 and none above 1/2 of the absolute value "
        "of its entry)",
    ),
    ("0 is uncertain", [[2, 0]], [["1/5", 3]], "by at most ITS (2 entries have one, none above 3)"),
]


@pytest.mark.parametrize(("values", "radii", "said"), [row[1:] for row in NEAR])
def test_words_say_how_large_radii_are(values: Any, radii: Any, said: str) -> None:
    M, D = (read_matrix(each, "", None, None) for each in (values, radii))
    assert radii_in_words(pairs_of([M], [D]), "ITS") == said


def test_the_statement_of_a_box_names_the_plant_without_radii_and_the_part() -> None:
    wide = Box.relative(MultiChannelSystem([[-1]], [[[1]]], [[[1]]]), "1/10").system
    loop = box_stability(wide, local_controllers(wide, [[["-1/2"]]]), gains="1/100")
    said = checked(document(loop)).statement
    own, whole = wide.digest_of_values(), wide.digest()
    assert own != whole and says(said, "state controlled") and whole in said
    assert says(said, "plants differ") and own in said
    assert says(said, "controllers differ")
    assert says(said, "most being")


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


def test_a_margin_in_a_box_is_said_of_the_ports_of_its_certificate(tmp_path: Path) -> None:
    wide = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), "1/10").system
    gain = local_controllers(wide, [[[-3]]])
    found = {
        at: json.loads(encode(box_disk_margin(wide, gain, at=at, margin="1/2")))  # type: ignore[arg-type]
        for at in ("inputs", "outputs")
    }
    for at, other in (("inputs", "outputs"), ("outputs", "inputs")):
        key = f"members-{at.removesuffix('s')}-margin"
        verdict = judged(tmp_path, key, [found[at]])
        assert verdict.verdict == "IMPLIED"
        assert f"any one {at.removesuffix('s')} is multiplied" in verdict.statement
        part = judged(tmp_path, f"{key}-part", [found[at]])
        assert says(part.statement, "more modulus")
        assert judged(tmp_path, key, [found[other]]).verdict == "INVALID"
        assert judged(tmp_path, key, [LOOP_STABLE]).verdict == "INVALID"
