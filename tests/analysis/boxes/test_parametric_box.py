"""All values of parameters within ranges: what is proved holds for drawn values, and exactly."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mcexact import (
    MultiChannelSystem,
    ParametricSystem,
    check,
    fixed_spectrum,
    joint_controllability,
    load_certificate,
    save_certificate,
)
from mcexact.analysis.boxes.cells import members_of_cell, proofs, whole_cell
from mcexact.analysis.boxes.pencils import Members
from mcexact.boxes import (
    box_controllability,
    box_fixed_modes,
    box_observability,
    box_stabilizability,
)
from mcexact.checker.cells import box_of_cell as checked_box
from mcexact.checker.parametric_system import read_parametric
from mcexact.errors import LimitReached, UsageError
from tests.wording import refusal

PENDULA = ParametricSystem(
    [
        [0, 1, 0, 0],
        ["-g/l - k/(m*l^2)", 0, "k/(m*l^2)", 0],
        [0, 0, 0, 1],
        ["k/(m*l^2)", 0, "-g/l - k/(m*l^2)", 0],
    ],
    [[[0], ["1/(m*l^2)"], [0], [0]], [[0], [0], [0], ["1/(m*l^2)"]]],
    [[[1, 0, 0, 0]], [[0, 0, 1, 0]]],
    parameters=["g", "k", "l", "m"],
    assume={
        "g": ("9.8", "9.82"),
        "k": ("0.99", "1.01"),
        "l": ("0.99", "1.01"),
        "m": ("0.99", "1.01"),
    },
)
"""Two pendula, joined by a spring, which is in four entries."""


def found(plant: ParametricSystem, **given: Any) -> Any:
    """The proof, if there is one."""
    try:
        return box_fixed_modes(plant, **given)
    except LimitReached:
        return None


def drawn_values(plant: ParametricSystem, rng: random.Random) -> dict[str, Fraction]:
    """Values within the ranges, often at their ends."""
    shares = [Fraction(rng.choice((0, 8, rng.randint(0, 8))), 8) for _ in plant.parameters]
    ends = zip(plant.parameters, whole_cell(plant), shares, strict=True)
    return {name: low + s * (high - low) for name, (low, high), s in ends}


def test_coupled_pendula_have_no_fixed_mode_for_any_spring() -> None:
    proof = box_fixed_modes(PENDULA)
    assert check(proof).verdict == "VALID" and proof.cuts == (None,)
    control, observe = box_controllability(PENDULA, ["1"]), box_observability(PENDULA, ["2"])
    assert check(control).verdict == check(observe).verdict == "VALID"
    rng = random.Random(1)
    for _ in range(4):
        plant = PENDULA.at(drawn_values(PENDULA, rng))
        assert fixed_spectrum(plant).empty and joint_controllability(plant, ["1"]).controllable


def test_what_is_saved_is_read_back(tmp_path: Any) -> None:
    for k, proof in enumerate((box_fixed_modes(PENDULA), box_observability(PENDULA))):
        save_certificate(proof, tmp_path / f"{k}.json")
        assert load_certificate(tmp_path / f"{k}.json") == proof


MODES = [["t", 0], [0, "t + 1"]]


def test_tied_entries_are_proved_where_independent_ones_fail() -> None:
    """With t and t + 1 apart, both can be 1, and one input does not move them."""
    plant = ParametricSystem(
        MODES, [[[1], [1]]], [[[1, 1]]], parameters=["t"], assume={"t": (0, 1)}
    )
    proof = box_fixed_modes(plant)
    assert check(proof).verdict == "VALID" and len(proof.parts) > 1
    equal = MultiChannelSystem([[1, 0], [0, 1]], plant.at(0).B, plant.at(0).C)
    assert not fixed_spectrum(equal).empty


def test_where_a_mode_is_fixed_is_said() -> None:
    plant = ParametricSystem(
        [[1, "k - 1"], [0, 2]], [[[0], [1]]], [[[1, 0]]], parameters=["k"], assume={"k": (0, 2)}
    )
    with refusal(LimitReached):
        box_fixed_modes(plant)
    with refusal(LimitReached):
        box_controllability(plant)
    with refusal(LimitReached):
        box_stabilizability(plant)
    for ends in ((1, 2), ("1/3", 1)):
        with refusal(LimitReached):
            box_fixed_modes(plant.along({"k": "k"}, ["k"], {"k": ends}))
    beside = plant.along({"k": "k"}, ["k"], {"k": ("11/10", 2)})
    assert check(box_stabilizability(beside)).verdict == "VALID"


def test_a_denominator_must_not_vanish_in_the_range() -> None:
    plant = ParametricSystem([["1/k"]], [[[1]]], [[[1]]], parameters=["k"], assume={"k": (-1, 2)})
    with refusal(LimitReached, part=True):
        box_fixed_modes(plant)
    around = plant.along({"k": "k"}, ["k"], {"k": (-1, 1)})
    with refusal(LimitReached):
        box_fixed_modes(around)
    with refusal(UsageError):
        box_fixed_modes(plant.along({"k": "k"}, ["k"], {"k": (1, None)}))


@pytest.mark.parametrize("seed", range(4))
def test_the_checker_makes_the_same_boxes(seed: int) -> None:
    rng = random.Random(seed)
    some = ("a*b", "a^2 - b/3", "(a + 1)*(b - 2)", "1/a", "b/(a*b^2)", "7")
    plant = ParametricSystem(
        [[rng.choice(some) for _ in range(2)] for _ in range(2)],
        [[[rng.choice(some)], [1]]],
        [[[rng.choice(some), 0]]],
        parameters=["a", "b"],
        assume={"a": (4, 5), "b": ("1/2", "5/8")},
    )
    own = members_of_cell(plant, whole_cell(plant))
    other = checked_box(read_parametric(plant.document()), list(whole_cell(plant)))
    radii = own.radii
    pairs = [((own.system.A, *own.system.B, *own.system.C), other)]
    pairs += [((radii.A, *radii.B, *radii.C), other.radii)]  # type: ignore[list-item]
    pairs += [((e.A, *e.B, *e.C), x) for e, x in zip(own.generators, other.tied, strict=True)]  # type: ignore[misc]
    for matrices, system in pairs:
        for M, N in zip(matrices, (system.A, *system.B, *system.C), strict=True):
            known = [[Fraction(x, N.denominator) for x in row] for row in N.rows]
            assert [list(row) for row in M.rows()] == known


ENTRY = st.sampled_from([0, 0, 1, -1, "t", "t - 1", "1 - 2*t", "t^2 - 1/4", "1/(t + 1)"])


@given(
    st.lists(ENTRY, min_size=10, max_size=10),
    st.sampled_from(["continuous", "discrete"]),
    st.sampled_from([("0", "1"), ("1/8", "3/8"), ("3/4", "1")]),
)
@settings(max_examples=6)
def test_a_proof_agrees_with_the_exact_answer_for_one_parameter(
    entries: list[Any], time: str, ends: tuple[str, str]
) -> None:
    plant = ParametricSystem(
        [entries[0:2], entries[2:4]],
        [[[entries[4]], [entries[5]]], [[1], [entries[6]]]],
        [[entries[7:9]], [[entries[9], 1]]],
        parameters=["t"],
        assume={"t": ends},
        time=time,
    )
    proof = found(plant, starts=1)
    if proof is not None:
        assert check(proof).verdict == "VALID"
        exact = fixed_spectrum(plant)
        assert not exact.generic and not exact.in_range()


def test_a_region_and_the_subject_are_those_of_the_claim() -> None:
    plant = ParametricSystem(
        [["k", 0], [0, "1/2"]],
        [[[1], [0]]],
        [[[1, 0]]],
        parameters=["k"],
        assume={"k": (1, 2)},
        time="discrete",
    )
    proof = box_fixed_modes(plant, bound="3/4")
    assert proof.region is not None and proof.region.edge == Fraction(3, 4)
    assert check(proof).verdict == "VALID"
    with refusal(LimitReached):
        box_fixed_modes(plant)
    control = box_controllability(plant, bound="3/4")
    assert control.region == proof.region and check(control).verdict == "VALID"


def test_what_fails_at_a_corner_is_found_before_ranges_are_cut() -> None:
    """The channel does nothing at b = 1, next to which no cell is ever proved."""
    tried: list[Members] = []

    def nothing(members: Members) -> None:
        tried.append(members)

    plant = ParametricSystem(
        [["a"]],
        [[["b - 1"]]],
        [[[1]]],
        parameters=["a", "b"],
        assume={"a": (1, 3), "b": ("1/3", 1)},
    )
    with refusal(LimitReached):
        proofs(
            plant,
            nothing,
            lambda at: not fixed_spectrum(at).empty,
            claim="",
            failure="a mode is fixed",
        )
    assert len(tried) == 1
