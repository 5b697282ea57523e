"""Loops at all values of parameters within ranges: what is proved holds, and what fails does."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mcexact import (
    Controller,
    MultiChannelSystem,
    NeighborGraph,
    ParametricSystem,
    certify_controller,
    check,
    load_certificate,
    save_certificate,
)
from mcexact.analysis.boxes.cells import members_of_cell, whole_cell
from mcexact.analysis.boxes.largest import LargestRanges
from mcexact.analysis.boxes.loops import LoopSearch
from mcexact.answer.boxes import ParametricBoxStability
from mcexact.boxes import Box, box_stability, largest_loop_ranges
from mcexact.designs import local_controllers
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.roots import StabilityRegion
from mcexact.model.controller import AgentProgram, LinearMap
from mcexact.model.radii import moduli
from tests.wording import refusal, says, worded

PORTS = ([[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])


def joined(time: str = "continuous", **ranges: tuple[Any, Any]) -> ParametricSystem:
    """Two states joined by a damper k, each with a channel of its own."""
    A = [["1 - k", "k"], ["k", "1 - k"]]
    if time == "discrete":
        A = [["1 - k", "1/2*k"], ["1/2*k", "1 - k"]]
    return ParametricSystem(A, *PORTS, parameters=[*ranges], assume=ranges, time=time)


def gains(plant: ParametricSystem, *values: Any) -> Controller:
    """A static gain for each channel."""
    ends = zip(plant.parameters, whole_cell(plant), strict=True)
    middle = plant.at({name: (low + high) / 2 for name, (low, high) in ends})
    return local_controllers(middle, [[[value]] for value in values])


def drawn_values(plant: ParametricSystem, rng: random.Random) -> dict[str, Fraction]:
    """Values within the ranges, often at their ends."""
    shares = [Fraction(rng.choice((0, 8, rng.randint(0, 8))), 8) for _ in plant.parameters]
    ends = zip(plant.parameters, whole_cell(plant), shares, strict=True)
    return {name: low + s * (high - low) for name, (low, high), s in ends}


@pytest.mark.parametrize(
    ("time", "value", "region"),
    [("continuous", -3, {"rate": "1/2"}), ("discrete", "-3/4", {"radius": "9/10"})],
)
def test_a_loop_is_proved_for_every_value_and_drawn_values_agree(
    time: str, value: Any, region: dict[str, Any]
) -> None:
    plant = joined(time, k=("1/4", "3/4"))
    controller = gains(plant, value, value)
    proof = box_stability(plant, controller, gains="1/1000", **region)
    assert check(proof).verdict == "VALID" and len(proof.parts) >= 1
    rng = random.Random(1)
    for _ in range(4):
        values = drawn_values(plant, rng)
        assert certify_controller(plant.at(values), controller, **region).stable
        assert certify_controller(proof.about.at(values).plant, controller, **region).stable


def test_what_is_saved_is_read_back_with_its_loop(tmp_path: Any) -> None:
    plant = joined(k=("1/4", "3/4"))
    proof = box_stability(plant, gains(plant, -3, -3), gains="1/100")
    save_certificate(proof, tmp_path / "loop.json")
    found = load_certificate(tmp_path / "loop.json", plant)
    assert found == proof and isinstance(found, ParametricBoxStability)
    assert found.about.subject == proof.about.subject and str(found.region) == "Re λ < 0"
    values = {"k": "1/2"}
    assert found.about.at(values).A == proof.about.at(values).A


def test_agents_may_use_what_they_receive_over_links() -> None:
    plant = joined(k=("1/4", "3/4"))
    graph = NeighborGraph.from_names(plant.names, {"1": ["2"], "2": []})
    own = gains(plant, -3, -3)
    agents = list(own.agents)
    used = {**agents[0].input.outputs, 1: -agents[0].input.outputs[0] / 6}
    agents[0] = AgentProgram("1", 0, 0, input=LinearMap(used))
    controller = Controller("continuous", "", tuple(agents))
    proof = box_stability(plant, controller, graph)
    assert [each["construction"] for each in proof.subject] == ["arcs", "closed_loop"]
    verdict = check(proof)
    assert verdict.verdict == "VALID" and 'with the links {"2" -> "1"} added' in verdict.statement
    with pytest.raises(InputError):
        box_stability(plant, controller)


def test_what_depends_on_one_parameter_is_moved_together() -> None:
    """The eigenvalues −1 ± it; within independent radii one could be 1."""
    plant = ParametricSystem(
        [[-1, "t"], ["-t", -1]], [[[1], [0]]], [[[1, 0]]], parameters=["t"], assume={"t": (-2, 2)}
    )
    controller = local_controllers(plant.at({"t": 0}), [[[0]]])
    proof = box_stability(plant, controller)
    assert check(proof).verdict == "VALID" and len(proof.parts) > 1
    box = members_of_cell(plant, whole_cell(plant))
    free = Box.absolute(box.system, A=box.radii.A + moduli(box.generators[0].A)).system
    with pytest.raises(LimitReached):
        box_stability(free, controller)


def test_values_at_which_the_loop_fails_are_named() -> None:
    plant = joined(k=(-3, 1))
    with refusal(LimitReached, part=True):
        box_stability(plant, gains(plant, -3, -3))


def test_what_cannot_be_asked_is_refused() -> None:
    plant = joined(k=("1/4", "3/4"))
    controller = gains(plant, -3, -3)
    with pytest.raises(InputError, match="at least 0"):
        box_stability(plant, controller, gains="-1/100")
    with refusal(UsageError):
        box_stability(plant.along({}, ["k"], {}), controller)
    with pytest.raises(InputError, match="controller"):
        box_stability(plant, [[1]])  # type: ignore[call-overload]
    with pytest.raises(UsageError):
        box_stability(plant, controller, radius="1/2")
    with pytest.raises(InputError, match="system"):
        largest_loop_ranges(plant.at({"k": 0}), controller)  # type: ignore[arg-type]


def both_ends(found: LargestRanges, plant: ParametricSystem, controller: Controller) -> None:
    """The smaller ranges are proved, and the loop fails at values outside of them."""
    assert found.proof is not None and check(found.proof).verdict == "VALID"
    assert found.failing is not None and found.upper is not None and found.refutation is not None
    assert 0 < found.lower < found.upper <= 1
    assert not certify_controller(plant.at(found.failing), controller).stable
    inside = zip(found.proof.about.plant.ranges, found.failing.values(), strict=True)
    assert any(not low <= x <= high for (low, high), x in inside)  # type: ignore[operator]
    ends = zip(whole_cell(plant), found.failing.values(), strict=True)
    assert all(low <= x <= high for (low, high), x in ends)
    assert check(found.refutation).verdict == "VALID"


def test_the_largest_part_of_a_range_is_told_beside_a_value_at_which_the_loop_fails() -> None:
    """The loop has the eigenvalues −2 and −2 − 2k: it fails from k = −1 on."""
    plant = joined(k=(-2, 4))
    controller = gains(plant, -3, -3)
    found = largest_loop_ranges(plant, controller, effort=1)
    both_ends(found, plant, controller)
    assert found.upper is not None and Fraction(2, 3) <= found.upper < Fraction(3, 4)
    assert found.lower > Fraction(1, 2)
    told = dict(found.rows())
    assert told["fails"].startswith("at k = -1") and "of the ranges" in told["fails"]
    assert says(found.explain(), "satisfies proved")
    view = found.to_dict()
    assert view["ranges"] and Fraction(view["lower"]) == found.lower and view["failing"]["k"]
    assert "LargestRanges(" in repr(found) and "fails" in found._repr_html_()


def test_of_several_parameters_the_nearest_values_are_looked_for_in_every_direction() -> None:
    """x' = (a·b − 2)x: of a, b in [0, 2] the corner at which both are large fails."""
    plant = ParametricSystem(
        [["a*b"]], [[[1]]], [[[1]]], parameters=["a", "b"], assume={"a": (0, 2), "b": (0, 2)}
    )
    controller = local_controllers(plant.at({"a": 1, "b": 1}), [[[-2]]])
    found = largest_loop_ranges(plant, controller, effort=2)
    both_ends(found, plant, controller)
    assert found.upper is not None and found.upper < Fraction(1, 2)


def test_ranges_that_are_proved_whole_or_not_at_all_are_told_so() -> None:
    plant = joined(k=("1/4", "3/4"))
    whole = largest_loop_ranges(plant, gains(plant, -3, -3), effort=1)
    assert whole.lower == 1 and whole.upper is None and whole.failing is None
    assert worded(dict(whole.rows())["fails"])
    none = largest_loop_ranges(plant, gains(plant, 3, 3), effort=1)
    assert none.lower == 0 and none.upper == 0 and none.proof is None
    assert none.to_dict()["ranges"] is None
    assert worded(dict(none.rows())["proved for all values"])
    assert worded(dict(none.rows())["fails"])


def test_values_at_which_an_entry_is_undefined_fail_nothing() -> None:
    plant = ParametricSystem([["-1/k"]], [[[1]]], [[[1]]], parameters=["k"], assume={"k": (0, 2)})
    controller = local_controllers(plant.at({"k": 1}), [[[0]]])
    found = largest_loop_ranges(plant, controller, effort=1)
    assert found.upper is None and Fraction(1, 2) < found.lower < 1


@settings(max_examples=8, deadline=None)
@given(
    st.lists(st.sampled_from(["-k", "k", "1/4*k", "k^2", "0"]), min_size=4, max_size=4),
    st.sampled_from(["continuous", "discrete"]),
    st.integers(0, 5),
)
def test_what_is_proved_holds_for_drawn_values(slopes: list[str], time: str, seed: int) -> None:
    shift = ["-2", "0", "0", "-3/2"] if time == "continuous" else ["1/4", "0", "0", "-1/8"]
    entries = [f"{c} + 1/4*({slope})" for c, slope in zip(shift, slopes, strict=True)]
    plant = ParametricSystem(
        [entries[:2], entries[2:]], *PORTS, parameters=["k"], assume={"k": (-1, 2)}, time=time
    )
    controller = local_controllers(plant.at({"k": 0}), [[["-1/8"]], [["1/16"]]])
    try:
        proof = box_stability(plant, controller)
    except LimitReached:
        return
    assert check(proof).verdict == "VALID"
    rng = random.Random(seed)
    for _ in range(3):
        assert certify_controller(plant.at(drawn_values(plant, rng)), controller).stable


def test_a_box_and_ranges_of_independent_entries_are_proved_alike() -> None:
    """With a parameter of its own for each uncertain entry nothing is tied."""
    plant = ParametricSystem(
        [["a", 0], [0, "b"]],
        *PORTS,
        parameters=["a", "b"],
        assume={"a": ("-3/2", "-1/2"), "b": ("-3/2", "-1/2")},
    )
    middle = plant.at({"a": -1, "b": -1})
    controller = local_controllers(middle, [[[0]], [[0]]])
    near = Box.absolute(middle, A=[["1/2", 0], [0, "1/2"]]).system
    assert isinstance(near, MultiChannelSystem)
    assert check(box_stability(near, controller)).verdict == "VALID"
    proof = box_stability(plant, controller)
    assert check(proof).verdict == "VALID" and proof.cuts == (None,)


def test_work_is_counted_and_ends_at_its_limit() -> None:
    plant = joined(k=("1/4", "3/4"))
    region = StabilityRegion("continuous")
    search = LoopSearch(plant, gains(plant, -3, -3), None, region)
    assert search.proof(plant).parts and search.tested >= 1
    search.limit = 0
    with refusal(LimitReached, part=True):
        search.proof(plant)
