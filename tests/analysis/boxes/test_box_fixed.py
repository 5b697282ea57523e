"""No plant in a box has a fixed mode: what is proved holds for drawn members."""

from __future__ import annotations

import random
from collections.abc import Callable, Sequence
from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mcexact import MultiChannelSystem, check, fixed_spectrum, gallery, testing
from mcexact.analysis.boxes.members import (
    box_controllability,
    box_fixed_modes,
    box_setpoints,
    box_stabilizability,
)
from mcexact.analysis.boxes.pencils import radii_of
from mcexact.answer.boxes import BoxFixedModes
from mcexact.boxes import Box
from mcexact.constructions import dual
from mcexact.derived.constructions import (
    augmented_outputs,
    error_system,
    extended_system,
    feedback,
    full_output,
    merged,
    restricted,
    setpoint_system,
)
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.loop import closed_loop
from mcexact.model.radii import Radii
from mcexact.model.statespace import local_controllers
from tests.wording import refusal


def found(system: MultiChannelSystem, stable: bool = False) -> BoxFixedModes | None:
    """The proof, if there is one."""
    try:
        return box_stabilizability(system) if stable else box_fixed_modes(system)
    except LimitReached:
        return None


BOXES = [
    ("compleib-ac1", "2/5"),
    ("compleib-dis5", "1/10"),
    ("quadruple-tank-pminus", "1/1000"),
    ("liu2020-3ch-extended-n1", "1/1000"),
]
"""Published plants, with parts of their entries within which no mode is fixed."""


@pytest.mark.parametrize(("name", "part"), [*BOXES, ("farina-three-rooms", "1/1000")])
def test_no_member_of_a_box_around_a_published_plant_has_a_fixed_mode(name: str, part: str) -> None:
    box = Box.relative(gallery(name), part)
    proof = box_fixed_modes(box.system)
    assert check(proof, box.system).verdict == "VALID"
    rng = random.Random(1)
    for k in range(10):
        assert fixed_spectrum(box.member(rng, vertex=k % 2 == 0)).empty


def test_each_member_is_stabilized_where_what_is_fixed_is_stable() -> None:
    box = Box.relative(gallery("siljak-two-subsystems-farina"), "1/1000")
    assert found(box.system) is None
    proof = box_stabilizability(box.system)
    assert proof.bound == 0 and check(proof, box.system).verdict == "VALID"
    assert fixed_spectrum(box.member(random.Random(2))).stabilizable


@pytest.mark.parametrize(("name", "part"), BOXES)
def test_a_part_of_the_proof_that_nothing_is_fixed_proves_that_members_are_stabilized(
    name: str, part: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    box = Box.relative(gallery(name), part)
    whole, smaller = box_fixed_modes(box.system), box.scaled("1/2").system
    with monkeypatch.context() as patch:
        patch.setattr("mcexact.analysis.boxes.members.proofs", None)
        proof = box_stabilizability(box.system, nothing_fixed=whole)
        with pytest.raises(TypeError):  # the radii are others
            box_stabilizability(smaller, nothing_fixed=whole)
    assert proof.bound is not None and check(proof, box.system).verdict == "VALID"
    assert len(proof.frames) <= len(whole.frames)
    again = box_stabilizability(box.system, nothing_fixed=proof)
    assert again == box_stabilizability(box.system)


def test_a_radius_is_the_region_in_discrete_time() -> None:
    plant = MultiChannelSystem([["1/2", 0], [0, 2]], [[[0], [1]]], [[[0, 1]]], time="discrete")
    proof = box_stabilizability(Box.relative(plant, "1/100").system)
    assert proof.bound == 1 and check(proof).verdict == "VALID"
    closer = box_fixed_modes(Box.relative(plant, "1/100").system, bound="3/5")
    assert closer.bound == Fraction(3, 5) and check(closer).verdict == "VALID"
    with refusal(LimitReached):
        box_fixed_modes(Box.relative(plant, "1/100").system, bound="2/5")


@given(testing.systems(max_states=3, max_channels=2), st.sampled_from(["1/1000", "1/20", "1/2"]))
@settings(max_examples=12)
def test_members_of_certified_boxes_have_no_fixed_mode(drawn: testing.Drawn, part: str) -> None:
    box = Box.relative(drawn.system, part)
    if box.system.uncertainty is None:  # every entry is 0
        return
    proof, stable = found(box.system), found(box.system, stable=True)
    for answer in (proof, stable):
        assert answer is None or check(answer, box.system).verdict == "VALID"
    members = [box.nominal, *(box.member(random.Random(k), vertex=bool(k)) for k in range(2))]
    for member in members if proof is not None or stable is not None else []:
        spectrum = fixed_spectrum(member)
        assert proof is None or spectrum.empty
        assert stable is None or spectrum.stabilizable


@given(testing.systems_with_fixed_mode(max_states=4), st.integers(0, 10**6))
@settings(max_examples=12)
def test_a_box_with_a_planted_fixed_mode_is_never_certified(
    drawn: testing.Drawn, seed: int
) -> None:
    """The center is moved, so that the member with the fixed mode is anywhere in the box."""
    planted = drawn.system
    inner = Box.relative(planted, "1/50")
    center = inner.member(random.Random(seed))
    outer = Box(center, inner.radii)
    assert outer.contains(planted)
    assert found(outer.system) is None


def test_a_plant_without_radii_is_refused_with_how_to_give_it_some() -> None:
    for plant in (MultiChannelSystem([], [[]], [[]]), gallery("quadruple-tank-pminus")):
        for question in (box_fixed_modes, box_stabilizability, box_controllability, box_setpoints):
            with refusal(UsageError):
                question(plant)
    single = MultiChannelSystem([[0, 1], [0, 0]], [[[0], [1]]], [[[1, 0]]])
    assert check(box_fixed_modes(Box.relative(single, "1/2").system)).verdict == "VALID"


def test_the_answer_is_about_derived_systems_as_well() -> None:
    plant = Box.relative(gallery("liu2020-3ch-no-communication"), "1/1000").system
    assert found(plant) is None
    ring = {"1": ["2"], "2": ["3"], "3": ["1"]}
    extended = extended_system(plant.with_neighbors(ring), (1, 1, 1))
    assert check(box_fixed_modes(extended)).verdict == "VALID"


def test_constructions_that_copy_entries_copy_their_radii() -> None:
    plant = MultiChannelSystem([[1, 2], [0, 3]], [[[4], [5]]], [[[6, 0]]])
    box = Box.relative(plant, "1/2")
    assert radii_of(box.system) == box.radii
    turned = radii_of(dual(box.system))
    assert turned == Radii(box.radii.A.T, [box.radii.C[0].T], [box.radii.B[0].T])
    twice = extended_system(box.system.with_neighbors({}), (1,), share="states")
    assert radii_of(twice).A.take([0, 1], [0, 1]) == box.radii.A
    assert radii_of(twice).A[2, 2] == 0
    assert radii_of(plant).is_zero()


def matrices_of(system: MultiChannelSystem) -> list[Matrix]:
    """A, all B_i and all C_i."""
    return [system.A, *(c.B for c in system.channels), *(c.C for c in system.channels)]


def fed_back(plant: MultiChannelSystem) -> MultiChannelSystem:
    """With gains of both signs."""
    gains = [
        [[Fraction((-1) ** (i + j) * (i + 2 * j + 1), 2) for j in range(q)] for i in range(p)]
        for p, q in ((plant.p(k), plant.q(k)) for k in range(plant.m))
    ]
    return feedback(plant, gains)


CONSTRUCTIONS: dict[str, Callable[[MultiChannelSystem], MultiChannelSystem]] = {
    "augmented_outputs": augmented_outputs,
    "dual": dual,
    "error": lambda plant: error_system(plant, [[[1, -2]], [["-1/2", 0]]]),
    "extended": lambda plant: extended_system(plant, (1, 2)),
    "feedback": fed_back,
    "full_output": lambda plant: full_output(plant, 1),
    "integrators": setpoint_system,
    "merged": lambda plant: merged(plant, [["1", "2"]]),
    "restricted": lambda plant: restricted(plant, ["2"]),
}
PAIRS = [
    ("feedback", "error"),
    ("error", "feedback"),
    ("error", "dual"),
    ("augmented_outputs", "feedback"),
    ("feedback", "feedback"),
]
UNCERTAIN = MultiChannelSystem(
    [[1, -2], ["1/2", 3]],
    [[[1], [-1]], [[0], [2]]],
    [[[1, 0]], [["-1/4", 1]]],
    neighbors={"1": ["2"], "2": ["1"]},
)


@pytest.mark.parametrize("names", [*([name] for name in CONSTRUCTIONS), *PAIRS], ids="-".join)
def test_what_constructions_make_of_members_is_within_their_radii(names: Sequence[str]) -> None:
    made = Box.relative(UNCERTAIN, "1/10").system
    box = Box(made)
    members = [box.member(random.Random(k), vertex=k < 6) for k in range(8)]
    for name in names:
        made = CONSTRUCTIONS[name](made)
        members = [CONSTRUCTIONS[name](member) for member in members]
    radii = radii_of(made)
    for member in members:
        whole = zip(matrices_of(member), matrices_of(made), radii.matrices(), strict=True)
        for M, M0, (_, D) in whole:
            pairs = zip((M - M0).rows(), D.rows(), strict=True)
            assert all(abs(x) <= d for rows in pairs for x, d in zip(*rows, strict=True))


def test_radii_of_a_product_are_those_of_its_factors_together() -> None:
    plant = MultiChannelSystem([[5]], [[[2]]], [[[3]]])
    box = Box.absolute(plant, A=[[1]], B=[[["1/2"]]], C=[[["1/3"]]])
    radii = radii_of(feedback(box.system, [[[-7]]]))
    assert radii.A[0, 0] == 1 + 7 * (Fraction(5, 2) * Fraction(10, 3) - 6)
    proof = box_fixed_modes(feedback(box.system, [[["-1/7"]]]))
    assert check(proof, box.system).verdict == "VALID"


def test_radii_of_a_loop_are_a_matter_of_its_stability() -> None:
    plant = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), "1/2").system
    loop = closed_loop(plant, local_controllers(plant, [[[-3]]])).system
    with pytest.raises(UsageError, match="radii of a closed loop are a matter of box_stability"):
        box_fixed_modes(loop)


def test_a_mode_that_radii_alone_move_is_left_open() -> None:
    """Inputs and outputs by which gains move it are 0 at the values: weights were too large."""
    plant = MultiChannelSystem([["1/2"]], [[[0]], [[0]]], [[[0]], [[-1]]], time="discrete")
    box = Box.absolute(plant, [[1]], [[[0]], [["1/2"]]], [[["1/2"]], [[2]]])
    with refusal(LimitReached):
        box_fixed_modes(box.system, bound=1, starts=1)
