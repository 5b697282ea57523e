"""Plants with feedthrough: what the checker reads, builds, refuses, and concludes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, analyze, certify_controller, setpoint_solvability
from mcexact.answer.protocol import document
from mcexact.checker.kinds import KINDS
from mcexact.constructions import input_filters, regulated_outputs
from mcexact.designs import local_controllers
from mcexact.errors import UsageError
from mcexact.model.loop import closed_loop
from mcexact.performance import disk_margin
from mcexact.questions import open_loop_spectrum
from tests.checker.handmade import Document, changed, checked
from tests.checker.manifests import manifest, said, sentence, write
from tests.checker.tables import accepts, rejects
from tests.wording import says, worded

FILTERS = {"construction": "input_filters"}
A, B, C = [[-1, -1], [-1, -1]], [[[-1], [-1]], [[1], [0]]], [[[1, 0]], [[1, 1]]]


def signed(sign: int, time: str = "continuous") -> MultiChannelSystem:
    """Of the sign 1 the mode 0 is fixed, and of the sign -1 nothing is."""
    return MultiChannelSystem(A, B, C, D=[[0, 0], [sign, 0]], time=time)


def answers(plant: MultiChannelSystem) -> dict[str, Document]:
    """The certificates of an analysis, all about the plant with its inputs as states."""
    return {name: document(answer) for name, answer in analyze(plant).decided().items()}


FIXED, NOTHING, LATE = answers(signed(1)), answers(signed(-1)), answers(signed(-1, "discrete"))
CONTROLLED = changed(
    FIXED["joint_controllability"],
    ("subject", []),
    ("claim.dimension", 2),
    ("witness.annihilator", {"denominator": 1, "entries": []}),
)
STAYS, MOVES = FIXED["fixed_spectrum"], NOTHING["fixed_spectrum"]

ACCEPTED = [
    ("0 is fixed, as the outputs of 2 see the inputs of 1", STAYS),
    ("with the other sign nothing is", MOVES),
    ("in discrete time", LATE["fixed_spectrum"]),
    ("no input of D moves the state: controllability is about A and B", CONTROLLED),
    ("set-points of the outputs alone", NOTHING["setpoint"]),
]
D = "system.D"
REJECTED = [
    ("the other sign of D", MOVES, (D, [[0, 0], [1, 0]]), "INVALID"),
    ("the other sign of D, where a mode was fixed", STAYS, (D, [[0, 0], [-1, 0]]), "INVALID"),
    ("D at another place", STAYS, (D, [[0, 1], [0, 0]]), "INVALID"),
    ("the plant itself in place of its inputs as states", MOVES, ("subject", []), "INCOMPLETE"),
    ("D of zeros", MOVES, (D, [[0, 0], [0, 0]]), "MALFORMED"),
    ("D of another shape", MOVES, (D, [[0, 0]]), "MALFORMED"),
    ("D that is null", MOVES, (D, None), "MALFORMED"),
    ("D of a channel", MOVES, ("system.channels.0.D", [[1]]), "MALFORMED"),
    (
        "D beside radii",
        MOVES,
        ("system.uncertainty", {"absolute": {"A": {"shape": [2, 2], "entries": [[0, 0, "1/9"]]}}}),
        "MALFORMED",
    ),
    ("an argument of the construction", MOVES, ("subject.0.pole", -1), "MALFORMED"),
    ("integrators beside D", MOVES, ("subject", [{"construction": "integrators"}]), "INCOMPLETE"),
]


test_plants_with_feedthrough_are_accepted = accepts(ACCEPTED)
test_forgeries_about_feedthrough_are_rejected = rejects(REJECTED)


def test_the_reason_is_told() -> None:
    verdict = checked(changed(MOVES, ("subject", [])))
    assert (verdict.code, verdict.place) == ("feedthrough", "system")
    assert worded(verdict.message)


def test_only_kinds_whose_claims_do_not_depend_on_it_take_feedthrough() -> None:
    taking = {name for name, rule in KINDS.items() if rule.feedthrough}
    assert taking == {"controllability", "controllability_indices"}


def test_the_digest_depends_on_the_feedthrough() -> None:
    digests = {checked(each).system_digest for each in (STAYS, MOVES)}
    assert digests == {signed(1).digest(), signed(-1).digest()} and len(digests) == 2


# Loops.

GAINS = local_controllers(signed(-1), [[["1/2"]], [[3]]])
LOOP = document(certify_controller(signed(-1), GAINS, method="polynomial"))
SPECTRUM = document(open_loop_spectrum(closed_loop(signed(-1), GAINS).system))
GAIN = "subject.0.controller.agents.1.input.outputs.2"


def test_loops_of_plants_with_feedthrough_are_accepted() -> None:
    for each in (LOOP, SPECTRUM):
        assert checked(each).verdict == "VALID"
        for wrong in ([[0, 0], [1, 0]], [[0, -1], [0, 0]]):
            assert checked(changed(each, (D, wrong))).verdict == "INVALID"


def test_a_loop_has_to_be_well_posed() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], D=[[1]])
    found = document(certify_controller(plant, local_controllers(plant, [[[3]]])))
    place = "subject.0.controller.agents.0.input.outputs.1"
    verdict = checked(changed(found, (place, [[1]])))
    assert (verdict.verdict, verdict.code) == ("INVALID", "subject")
    assert worded(verdict.message)
    with pytest.raises(UsageError, match="not well posed"):
        certify_controller(plant, local_controllers(plant, [[[1]]]))


def test_other_kinds_about_such_loops_are_not_known() -> None:
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    loop = closed_loop(plant, local_controllers(plant, [[[0]]]))
    found = document(disk_margin(plant, loop.controller, at="inputs"))
    assert checked(found).verdict == "VALID"
    verdict = checked(changed(found, (D, [[1]])))
    assert (verdict.verdict, verdict.code, verdict.place) == ("INCOMPLETE", "feedthrough", "system")


# Sentences.


def about(folder: Path, evidence: dict[str, Document], *keys: str, subject: Any = None) -> Any:
    """The verdicts on sentences about the plant with its inputs as states."""
    listed = [sentence(key, *evidence, evidence=evidence) for key in keys]
    made = {**manifest(evidence, listed), "subject": subject or [FILTERS]}
    return said(write(folder, evidence, made))


def test_the_fixed_modes_are_those_of_the_plant(tmp_path: Path) -> None:
    (found,) = about(tmp_path, {"fixed": STAYS}, "feedthrough")
    assert found.verdict == "IMPLIED"
    assert says(found.statement, "plant modes") and signed(1).digest() in found.statement


def test_of_a_plant_without_filters_nothing_is_said(tmp_path: Path) -> None:
    dual = changed(STAYS, ("subject", [FILTERS, {"construction": "dual"}]))
    bare = document(analyze(MultiChannelSystem(A, B, C)).fixed_spectrum)
    assert checked(dual).verdict != "VALID"
    made = manifest({"fixed": bare}, [sentence("feedthrough", "fixed", evidence={"fixed": bare})])
    (found,) = said(write(tmp_path, {"fixed": bare}, made))
    assert (found.verdict, found.code) == ("INVALID", "claim")


def test_what_is_held_are_the_outputs_and_not_the_inputs(tmp_path: Path) -> None:
    names = ("setpoint", "joint_controllability", "joint_observability")
    evidence = {name: NOTHING[name] for name in names}
    (found,) = about(tmp_path, evidence, "setpoint")
    assert found.verdict == "IMPLIED"
    inputs = [{"denominator": 1, "entries": [[0, 1]]}] * 2
    held = setpoint_solvability(regulated_outputs(input_filters(signed(-1)), [[[0, 1]]] * 2))
    assert document(held)["subject"][1]["gains"] == inputs
    (found,) = about(tmp_path, {**evidence, "setpoint": document(held)}, "setpoint")
    assert (found.verdict, found.code) == ("INVALID", "claim")
    lost = {"setpoint": FIXED["setpoint"]}
    assert [each.verdict for each in about(tmp_path, lost, "setpoint-zero")] == ["IMPLIED"]
