"""What is said first of a plant with radii, in Python and in notebooks."""

from __future__ import annotations

from mcexact import MultiChannelSystem, analyze, certify_controller, fixed_spectrum
from mcexact.answer.account import leading
from mcexact.boxes import (
    Box,
    box_controllability,
    box_fixed_modes,
    box_stability,
    box_stabilizability,
)
from mcexact.derived.constructions import augmented_outputs
from mcexact.designs import local_controllers
from tests.wording import says, worded

PLANT = MultiChannelSystem([[1, 0], [0, 2]], [[[1], [1]]], [[[1, 1]]])
NEAR, FAR = (Box.relative(PLANT, part).system for part in ("1/100", "9/10"))
OPEN = Box.relative(PLANT, "33/100").system
"""No plant fails, as all do from 1/3 on; but these radii are too large for a proof."""
FIRST = (
    "radii: 6 entries are uncertain, by at most 1 %",
    "within the radii: no plant has a fixed mode",
    "within the radii: every plant is controllable by all channels together",
    "within the radii: every plant is observable by all channels together",
    "within the radii: for every plant some decentralized linear time-invariant controller of its "
    "own holds all outputs at any constant set-points",
    "At the nominal values:",
)


def test_what_holds_for_every_plant_comes_first() -> None:
    found = analyze(NEAR)
    assert found.account.leading == FIRST
    assert found.explain().startswith("\n".join(FIRST) + "\n")
    shown = found._repr_html_()
    assert shown.index(FIRST[1]) < shown.index(FIRST[-1]) < shown.index("No mode")
    assert analyze(PLANT).account.leading == ()
    agents = NEAR.with_neighbors({"1": []})
    assert analyze(agents, information="outputs").account.leading == FIRST


def test_questions_without_a_proof_are_open_if_they_were_asked() -> None:
    asked = analyze(OPEN, ["fixed_spectrum", "box_fixed_modes"]).account.leading
    assert worded(asked[1])
    assert says(analyze(OPEN).account.leading[-2], "open modes")
    assert leading(FAR, {}, ()) == ()
    gain = local_controllers(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), [[[-3]]])
    box = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), "1/10").system
    assert "open" not in certify_controller(box, gain).explain()


def test_a_plant_within_the_radii_that_fails_is_told_in_place_of_an_open_question() -> None:
    found = analyze(FAR)
    failing = found.failing()
    assert all(Box(FAR).contains(each.about.plant) for each in failing.values())
    assert not fixed_spectrum(failing["box_fixed_modes"].about.plant).empty
    told = found.account.leading[1:]
    assert told[0] == "within the radii: some plant has a fixed mode"
    assert worded(told[3])
    assert worded(told[4])
    assert {*found.to_dict()["failing_within_radii"]} == {*failing}
    one = analyze(FAR, ["box_observability"])
    assert [*one.failing()] == ["box_observability"]
    assert not analyze(NEAR).failing() and "failing_within_radii" not in analyze(NEAR).to_dict()
    whole = augmented_outputs(FAR.with_neighbors({"1": []}))
    assert not analyze(whole).failing()


def test_answers_about_boxes_say_in_notebooks_what_is_proved() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    box = Box.relative(plant, "1/10").system
    gain = local_controllers(plant, [[[-3]]])
    for found, told in (
        (box_fixed_modes(NEAR), "<th>fixed modes of every member</th><td>none</td>"),
        (box_stabilizability(NEAR), "<td>only with Re λ &lt; 0</td>"),
        (box_controllability(NEAR), "that these do not control</th><td>none</td>"),
        (box_stability(box, gain), "<td>Re λ &lt; 0</td></tr><tr><th>gains</th><td>certain</td>"),
        (box_stability(box, gain, gains="1/100"), "<td>within radii of their own</td>"),
        (Box(box), "3 entries are uncertain, by at most 10 %"),
    ):
        assert told in found._repr_html_()
