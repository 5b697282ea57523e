"""Boxes of plants: how radii are given, read and written, what is a member, and digests."""

from __future__ import annotations

import json
import random
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import Matrix, MultiChannelSystem, load_system, save_system, testing
from mcexact.boxes import Box, Radii, box_fixed_modes
from mcexact.constructions import dual
from mcexact.errors import FloatRefused, InputError, UsageError
from mcexact.exact.rational import Limits
from mcexact.model.radii import typed_radii, typed_radius
from mcexact.model.system_file import read_system, system_text
from tests.wording import refusal, says

TYPED: dict[str, Any] = {
    "0.10": Fraction(1, 200),
    "0.1": Fraction(1, 20),
    "-12.5": Fraction(1, 20),
    "1e3": 500,
    "1.0e3": 50,
    "25E-2": Fraction(1, 200),
    "3": 0,
    "1/3": 0,
    "0.000": 0,
    "-0e5": 0,
}

PLANT = """{"format": "mcexact-system/1", "time": "continuous", "uncertainty": PLACE,
    "A": [[0.10, -0.20], [0.0, 3]],
    "channels": [{"name": "1", "B": [["2.5e3"], ["1/3"]], "C": [[1, 0.0]]},
                 {"name": "2", "B": [[1], [0]], "C": []}]}"""


def read(uncertainty: Any) -> MultiChannelSystem:
    """The plant of a file with this uncertainty."""
    text = uncertainty if isinstance(uncertainty, str) else json.dumps(uncertainty)
    return read_system(PLANT.replace("PLACE", text))


def radii(system: MultiChannelSystem) -> Radii:
    """The radii that a system has."""
    assert system.uncertainty is not None
    return system.uncertainty


@pytest.mark.parametrize("text", TYPED)
def test_a_decimal_is_known_to_half_a_unit_of_its_last_digit(text: str) -> None:
    assert typed_radius(text) == TYPED[text]
    if "/" not in text:
        assert typed_radius(Decimal(text)) == TYPED[text]


def test_what_is_no_decimal_is_certain() -> None:
    found = typed_radii(np.array([[1, 2]]), "A")
    assert found == Matrix.zeros(1, 2) == typed_radii(Matrix.from_rows([["0.1", 1]]), "A")
    assert typed_radius(Fraction(1, 10)) == 0


def test_radii_are_a_part_of_the_moduli() -> None:
    found = radii(read({"relative": "1/10"}))
    assert found.A.rows() == ((Fraction(1, 100), Fraction(1, 50)), (0, Fraction(3, 10)))
    assert found.B[0].rows() == ((250,), (Fraction(1, 30),)) and found.C[1].shape == (0, 2)


def test_radii_are_those_of_the_digits() -> None:
    found = radii(read({"digits": "as typed"}))
    assert found.A.rows() == ((Fraction(1, 200), Fraction(1, 200)), (0, 0))
    assert found.B[0].rows() == ((50,), (0,)) and found.C[0].is_zero()


def test_radii_are_given_entry_by_entry_and_others_are_certain() -> None:
    found = radii(read({"absolute": {"A": [[0.5, 0], [1, 0]]}}))
    assert found.A.rows() == ((Fraction(1, 2), 0), (1, 0)) and found.B[0].is_zero()
    port = {"shape": [2, 1], "entries": [[1, 0, "1/2"]]}
    found = radii(read({"absolute": {"B": {"1": port}}}))
    assert found.A.is_zero() and found.B[0].rows() == ((0,), (Fraction(1, 2),))
    assert found.B[1].is_zero()


@pytest.mark.parametrize("said", [{"absolute": {}}, {"relative": 0}, {"absolute": {"B": {}}}])
def test_a_plant_of_which_every_entry_is_certain_has_no_radii(said: Any) -> None:
    plant = read(said)
    assert plant.uncertainty is None and '"uncertainty"' not in plant.canonical_text()
    assert Box(plant).radii.is_zero() and Box(plant).nominal == plant


def test_a_large_matrix_that_lists_its_entries_is_known_as_typed() -> None:
    text = PLANT.replace("PLACE", '{"digits": "as typed"}').replace(
        "[[0.10, -0.20], [0.0, 3]]", '{"shape": [2, 2], "entries": [[1, 0, 0.50], [0, 0, 7]]}'
    )
    assert radii(read_system(text)).A.rows() == ((0, 0), (Fraction(1, 200), 0))


def test_the_digest_of_a_box_covers_values_and_radii() -> None:
    plain = read({"digits": "as typed"})
    shorter = read_system(
        PLANT.replace("PLACE", '{"digits": "as typed"}').replace("0.10, ", "0.1, ")
    )
    assert plain.A == shorter.A and plain.digest() != shorter.digest()
    assert plain != shorter and plain.with_uncertainty(None) == shorter.with_uncertainty(None)
    assert plain.digest() != plain.with_uncertainty(None).digest()


def test_a_box_is_written_with_the_radius_of_each_entry() -> None:
    document = read({"relative": "1/2"}).canonical_document()["uncertainty"]
    assert document["absolute"]["A"]["entries"] == [[0, 0, "1/20"], [0, 1, "1/10"], [1, 1, "3/2"]]
    assert document["absolute"]["B"]["2"] == {"shape": [2, 1], "entries": [[0, 0, "1/2"]]}
    assert list(document["absolute"]["C"]) == ["1"]


@given(testing.systems(), st.fractions(min_value=0, max_value=1, max_denominator=9))
def test_what_is_written_is_read_back(drawn: testing.Drawn, part: Fraction) -> None:
    system = Box.relative(drawn.system, part).system
    copy = read_system(system_text(system))
    assert copy == system and copy.digest() == system.digest()
    assert read_system(json.dumps(system.to_dict())) == system


REFUSED: dict[str, str] = {
    '{}': "uncertainty: expected one of 'relative', 'digits' and 'absolute', found 0",
    '{"relative": 1, "digits": "as typed"}': "uncertainty: .* found 2",
    '{"relative": -1}': "uncertainty.relative: expected a radius that is at least 0, found -1",
    '{"relative": "10%"}': 'a file gives a part as a number such as 0.1 or "1/10", found "10%"',
    '{"relative": true}': "uncertainty.relative: expected a number, found true",
    '{"relative": "x"}': "uncertainty.relative: expected an integer, a decimal",
    '{"relativ": 1}': r"uncertainty: unknown key 'relativ' \(did you mean 'relative'",
    '{"digits": "typed"}': 'uncertainty.digits: expected "as typed"',
    '{"digits": 3}': "uncertainty.digits: expected a string, found a number",
    '3': 'uncertainty: expected an object such as {"relative": "1/100"}, found a number',
    '{"absolute": []}': "uncertainty.absolute: expected a JSON object, found a list",
    '{"absolute": {"A": [[1]]}}': "uncertainty.absolute.A: expected 2 rows, found 1",
    '{"absolute": {"A": [[0, 0], [0, "-1/2"]]}}':
        r"uncertainty.absolute.A\[1\]\[1\]: expected a radius that is at least 0, found -1/2",
    '{"absolute": {"B": []}}': "uncertainty.absolute.B: expected a JSON object, found a list",
    '{"absolute": {"D": {}}}': "uncertainty.absolute: unknown key 'D'",
    '{"absolute": {"B": {"3": [[1]]}}}': "uncertainty.absolute.B: unknown key '3'",
    '{"absolute": {"C": {"2": [[1, 2]]}}}':
        r"uncertainty.absolute.C\['2'\]: expected 0 rows, found 1",
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSED)
def test_a_malformed_uncertainty_is_refused_with_its_place(text: str) -> None:
    with pytest.raises(InputError, match=REFUSED[text]):
        read(text)


def test_arrays_have_no_place_for_radii(tmp_path: Any) -> None:
    system = read({"relative": "1/10"})
    with refusal(InputError):
        save_system(system, tmp_path / "plant.npz", rounding="decimal")
    save_system(system, tmp_path / "plant.json")
    assert load_system(tmp_path / "plant.json") == system


PLANTS = testing.systems(max_states=3)


@given(PLANTS, st.integers(0, 2**32), st.booleans())
def test_what_is_drawn_is_a_member(drawn: testing.Drawn, seed: int, vertex: bool) -> None:
    box = Box.relative(drawn.system, "1/3")
    member = box.member(random.Random(seed), vertex=vertex)
    assert box.contains(member) and box.contains(box.nominal)
    far = [M * 3 for M in (member.A, *member.B, *member.C)]
    m = box.m
    other = MultiChannelSystem(far[0], far[1 : m + 1], far[m + 1 :], time=drawn.system.time)
    assert box.contains(other) == all(M.is_zero() for M in far)
    if vertex and box.radii != box.scaled(0).radii:
        assert not box.scaled("99/100").contains(member)


BOX = Box(read({"relative": "1/4"}))


@given(testing.members(BOX), testing.members(BOX, vertices=True))
def test_strategies_draw_members(inside: MultiChannelSystem, corner: MultiChannelSystem) -> None:
    assert BOX.contains(inside) and BOX.contains(corner)
    assert abs(corner.A[1, 1] - 3) == Fraction(3, 4) and corner.C[1].nrows == 0


def test_a_member_has_the_shapes_and_the_time_of_the_plant() -> None:
    box = Box(read({"relative": "1/10"}))
    assert not box.contains(MultiChannelSystem([[1]], [[[1]]] * 2, [[[1]]] * 2))
    discrete = MultiChannelSystem(box.nominal.A, box.nominal.B, box.nominal.C, time="discrete")
    assert not box.contains(discrete)


def test_a_box_is_made_in_three_ways_and_by_radii() -> None:
    plant = MultiChannelSystem([["0.5"]], [[[2]]], [[[1]]])
    half = Box.absolute(plant, A=[["1/20"]])
    assert half == Box.as_typed([["0.5"]], [[[2]]], [[[1]]])
    assert half == Box(plant, Radii([["1/20"]], [[[0]]], [[[0]]])) == Box(half.system)
    assert half.scaled(2).radii.A[0, 0] == Fraction(1, 10) and half.nominal == plant
    assert Box.absolute(plant, B=[[[1]]], C=[[[1]]]).radii.A.is_zero()
    assert (half.n, half.m) == (1, 1) and says(repr(half), "entry uncertain")
    assert says(repr(Box.absolute(plant)), "entry uncertain 2")
    assert says(half.explain(), "entry uncertain 3")
    assert "radii" in half._repr_html_() and "uncertainty" in half.system._repr_html_()


def test_boxes_that_make_no_sense_are_refused() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    with refusal(UsageError):
        Box.relative(dual(plant), "1/10")
    with pytest.raises(UsageError, match="of a plant, and not of a derived system"):
        Box(dual(plant))
    with pytest.raises(InputError, match="uncertainty: A: expected 1 row, found 2"):
        Box.absolute(plant, A=[[1, 0], [0, 1]])
    with pytest.raises(InputError, match="uncertainty: expected radii of 1 channels, found 2"):
        Box(plant, Radii([[0]], [[[0]]] * 2, [[[0]]] * 2))
    with refusal(InputError):
        Radii([[0]], [[[0]]], [])
    with refusal(FloatRefused, where="B[0][0][0]"):
        Radii([[0]], [[[0.5]]], [[[0]]])
    with pytest.raises(InputError, match="relative: expected a part from 0 on"):
        Box.relative(plant, -1)


def test_constructions_keep_the_radii_of_the_plant_alone() -> None:
    system = read({"relative": "1/10"})
    turned = dual(system)
    assert turned.uncertainty is None and turned.plant.uncertainty == system.uncertainty
    assert turned.canonical_text() == system.canonical_text()


def test_a_box_where_a_system_is_expected_is_told_how_to_give_it() -> None:
    box = Box.relative(MultiChannelSystem([[1]], [[[1]]], [[[1]]]), "1/10")
    with pytest.raises(InputError, match="found Box; give the `system` of the box"):
        box_fixed_modes(box)  # type: ignore[call-overload]


def test_radii_with_more_digits_than_numbers_may_have_are_refused() -> None:
    """1/10 times the part has twelve digits."""
    text = PLANT.replace("PLACE", '{"relative": "1/99999999977"}')
    assert read_system(text, limits=Limits(digits=12)).uncertainty is not None
    with pytest.raises(InputError, match=r"the radius of A\[0\]\[0\] has more than 11 digits"):
        read_system(text, limits=Limits(digits=11))


def test_a_part_is_written_alike_in_python_and_on_the_command_line() -> None:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
    written = [Box.relative(plant, each).radii for each in ("10%", "10 %", "0.1", "1/10")]
    assert all(each == written[0] for each in written)
    with pytest.raises(FloatRefused, match='write a part such as "10%"'):
        Box.relative(plant, 0.1)
    with pytest.raises(InputError, match='write "10%" for 10 percent'):
        Box.relative(plant, "10")
