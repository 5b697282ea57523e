"""Values of a parameter in claims: their discs, ranges and words."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.cells import rearranged
from mcexact.checker.core.reading import Refused
from mcexact.checker.parameters import listed_value, roots_text, values_left_out, where_text
from mcexact.checker.parametric_system import ParametricSystem, one_parameter, read_parametric
from tests.assurance.attack.forgeries.parametric_traps import plant
from tests.wording import worded


def ranged(low: Any, high: Any) -> ParametricSystem:
    """A plant with poles at −1 and twice at 0, and a range."""
    system = plant([["(1)/(t + 1)"]], ([["(1)/(t^2)"]], [[1]]))
    return one_parameter(read_parametric({**system, "parameters": {"t": {"range": [low, high]}}}))


def disc(re: str, im: str = "0", radius: str = "0") -> Any:
    return {"re": re, "im": im, "radius": radius}


def code(value: Any, discs: list[Any]) -> str:
    """Why a value is refused, if it is."""
    try:
        known = listed_value(value, discs, "claim.values[0]", ranged(None, None))
        assert known == [Fraction(c) for c in value]
    except Refused as found:
        assert found.place.startswith("claim.values[0]")
        return found.code
    return ""


def test_discs_tell_real_roots_from_others() -> None:
    assert code([-2, 1], [disc("2")]) == ""
    assert code([-2, 1], [disc("2.1", radius="0.2")]) == ""
    assert code([-2, 1], [disc("2", "0.1", "0.2")]) == "disc"
    assert code([-2, 1], [disc("2", "-0.1", "0.1")]) == "disc"
    assert code([1, 0, 1], [disc("0", "1"), disc("0", "-1")]) == ""
    assert code([1, 0, 1], [disc("0", "1.1", "0.3"), disc("0", "-1")]) == ""
    assert code([1, 0, 1], [disc("0", "1"), disc("0", "1")]) == "disc"
    assert code([-2, 1], []) == "form"
    assert code([1], []) == "form"
    assert code([-4, 2], [disc("2")]) == "form"


def test_nothing_is_said_of_a_value_at_which_an_entry_is_undefined() -> None:
    assert code([0, 1], [disc("0")]) == code([1, 1], [disc("-1")]) == "pole"
    assert code([0, -2, 1], [disc("0"), disc("2")]) == "pole"


def test_what_is_made_of_a_plant_has_its_poles() -> None:
    """The whole state is measured instead of 1/(t + 1), and 1/t² drives no channel of {2}."""
    system = plant([["t"]], ([["(1)/(t^2)"]], [["(1)/(t + 1)"]]), ([[1]], [["t"]]))
    known = one_parameter(read_parametric(system))
    for steps in (
        [{"construction": "restricted", "channels": ["2"]}],
        [{"construction": "dual"}, {"construction": "full_output", "channel": "2"}],
    ):
        made = one_parameter(rearranged(steps, known))
        assert made.poles == known.poles and [1, 1] in made.poles and made.scale == [1]
        with pytest.raises(Refused, match="undefined there"):
            listed_value([0, 1], [disc("0")], "claim.values[0]", made)


def left_out(value: Any, discs: list[Any], low: Any = None, high: Any = 1) -> str:
    """Why a value cannot be out of the range, if it cannot."""
    entry = {"value": value, "roots": discs}
    try:
        found = values_left_out([entry], [], ranged(low, high))
    except Refused as refused:
        assert refused.place.startswith("claim.outside[0]")
        return refused.code
    assert found == [[Fraction(c) for c in value]]
    return ""


def test_what_is_beyond_a_range_is_beyond_it_with_its_disc() -> None:
    assert left_out([-2, 1], [disc("2")]) == ""
    assert left_out([-2, 1], [disc("2.1", radius="0.9")]) == ""
    assert left_out([-2, 1], [disc("2", radius="1")]) == "range"
    assert left_out([-2, 1], [disc("2")], 0) == left_out([-2, 1], [disc("2")], 0, "3/2") == ""
    assert left_out([-2, 1], [disc("2")], 0, 2) == left_out([-2, 1], [disc("2")], 2, 3) == "range"
    assert left_out([-2, 1], [disc("2")], 3, None) == left_out([-2, 1], [disc("2")], 3, 4) == ""
    assert left_out([-2, 1], [disc("2", radius="0.9")], 3, None) == ""
    assert left_out([-2, 1], [disc("2", radius="1")], 3, None) == "range"
    assert left_out([-1, 1], [disc("1")], 0, None) == left_out([-1, 1], [disc("1")]) == "range"
    # not real
    assert left_out([1, 0, 1], [disc("0", "1"), disc("0", "-1")]) == ""
    assert left_out([1, 0, 1], [disc("0", "1"), disc("0", "-1")], -1, 1) == ""
    assert left_out([1, 0, 1], [disc("0", "1.4", "1.3"), disc("0", "-1")]) == ""
    assert left_out([1, 0, 1], [disc("0", "1.2", "1.2"), disc("0", "-1.2", "1")]) != ""
    assert left_out([-2, 1], [disc("2", "0.5", "0.7")]) == ""
    assert left_out([0, 1], [disc("0", "0.5", "0.5")]) == "range"
    # one root of two
    assert left_out([0, -2, 1], [disc("0"), disc("2")], 1, 3) == "range"
    assert left_out([0, -2, 1], [disc("0"), disc("2")], "1/2", "3/2") == ""
    assert left_out([1], []) == "form"


def undefined(value: Any) -> str:
    """Why a value is defined, if it is."""
    try:
        found = values_left_out([], [value], ranged(None, 1))
    except Refused as refused:
        assert refused.place.startswith("witness.undefined[0]")
        return refused.code
    assert found == [[Fraction(c) for c in value]]
    return ""


def test_a_pole_divides_the_product_of_all_denominators() -> None:
    for value in ([1, 1], [0, 1], [0, 0, 1], [0, 1, 1], [0, 0, 1, 1]):
        assert undefined(value) == ""
    for value in ([0, 0, 0, 1], [1, 2, 1], [-1, 1], [0, 0, 0, 1, 1]):
        assert undefined(value) == "pole"
    assert undefined([1]) == "form"


def test_both_sorts_of_values_are_found_in_their_order() -> None:
    outside = [{"value": [-k, 1], "roots": [disc(str(k))]} for k in (2, 3)]
    found = values_left_out(outside, [[1, 1], [0, 1]], ranged(None, 1))
    assert found == [[-2, 1], [-3, 1], [1, 1], [0, 1]]
    assert values_left_out([], [], ranged(None, 1)) == []


TWO = {"value": [-2, 1], "roots": [disc("2")]}


def test_values_have_words() -> None:
    assert worded(roots_text(TWO, "t"))
    start = (
        "for every complex value of the parameter t at which all entries of the plant are defined"
    )
    assert where_text({"outside": []}, ranged(None, 1)) == start
    said = f"{start}, except at the roots of t - 2, one in each of the discs {{2 +- 0}}"
    for ends, words in (
        ((None, 1), "-infinity and 1"),
        ((3, None), "3 and infinity"),
        (("5/2", 7), "5/2 and 7"),
    ):
        expected = f"{said}, none of which is real and between {words}"
        assert where_text({"outside": [TWO]}, ranged(*ends)) == expected
    both = where_text({"outside": [TWO, TWO]}, ranged(None, 1))
    assert both.count("the roots of t - 2") == 2 and "}, the roots" in both


def test_keys_are_those_of_the_format() -> None:
    for entry in ({"value": [-2, 1]}, {**TWO, "modes": []}, [], None):
        with pytest.raises(Refused) as found:
            values_left_out([entry], [], ranged(None, 1))
        assert found.value.verdict == "MALFORMED"
