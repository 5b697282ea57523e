"""What is proved of boxes of drawn systems, decided about members and about whole segments."""

from __future__ import annotations

from fractions import Fraction

import pytest

from tests.assurance.campaigns.boxes import QUESTIONS, examined, is_inside, largest_proved


@pytest.mark.slow
@pytest.mark.parametrize("number", [3, 8])
def test_members_and_segments_do_not_contradict_what_is_proved(number: int) -> None:
    wrong, seen = examined(number)
    assert wrong == []
    assert seen["members"] and seen["segments"]


@pytest.mark.slow
def test_boxes_that_are_larger_than_what_is_proved_are_contradicted() -> None:
    found = [line for number in (3, 8) for line in examined(number, Fraction(20))[0]]
    assert {line.partition(",")[0] for line in found} > {"stable"}
    assert {line.partition(",")[0] for line in found} <= QUESTIONS.keys()
    assert any("not at" in line for line in found) and any("between" in line for line in found)


@pytest.mark.parametrize(
    ("p", "time", "expected"),
    [
        ([1, 1], "continuous", True),
        ([0, 1], "continuous", False),
        ([2, 2, 1], "continuous", True),
        ([1, 0, 1], "continuous", False),
        ([1, 1, 1, 1], "continuous", False),
        ([2, 3, 3, 1], "continuous", True),
        ([0, 1], "discrete", True),
        ([1, 1], "discrete", False),
        (["1/2", 1, 1], "discrete", True),
        ([1, 1, 1], "discrete", False),
        (["-9/4", 0, 0, 1], "discrete", False),
        (["-1/2", 0, 0, 1], "discrete", True),
        ([1], "discrete", True),
    ],
)
def test_roots_are_placed_by_determinants(p: list[str | int], time: str, expected: bool) -> None:
    assert is_inside([Fraction(c) for c in p], time) is expected


@pytest.mark.parametrize("most", [0, "1/65", "1/64", "20/64", "2", "5"])
def test_the_largest_factor_is_one_that_is_proved(most: str) -> None:
    found = largest_proved(lambda growth: growth <= Fraction(most))
    assert found is None if Fraction(most) < Fraction(1, 64) else found <= Fraction(most)
