"""A page shows the matrices of its system, and says what it leaves out."""

from __future__ import annotations

from fractions import Fraction

import pytest

from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from mcexact.report.html import CUT, LARGEST, shown_plant, stamp


def plant_of(n: int, m: int = 1, entry: object = 1) -> MultiChannelSystem:
    """A full A, and one entry in every B_i and C_i."""
    unit = [int(k == 0) for k in range(n)]
    return MultiChannelSystem(
        [[entry] * n for _ in range(n)], [[[x] for x in unit]] * m, [[unit]] * m, source="a book"
    )


def test_small_matrices_are_shown_whole() -> None:
    plant = plant_of(2, entry="1/3")
    shown = shown_plant(plant)
    assert len(shown["matrices"]) == 3 and shown["notes"] == shown["listed"] == []
    assert str(shown["matrices"][0]).count("1/3") == 4
    rows = dict(shown["rows"])
    assert (rows["states"], rows["channels"], rows["source"]) == ("2", "1: 1", "a book")
    assert rows["SHA-256 of the system"] == plant.digest()


def test_a_large_matrix_is_cut_and_said_to_be() -> None:
    shown = shown_plant(plant_of(LARGEST + 1))
    A = str(shown["matrices"][0])
    assert A.count("<mtr>") == CUT + 1 and A.count("⋯") == CUT and A.count("⋮") == CUT + 1
    assert "A is 13 × 13" in shown["notes"][0] and "first 8 rows and columns" in shown["notes"][0]


def test_a_large_matrix_with_few_entries_is_listed() -> None:
    shown = shown_plant(plant_of(LARGEST + 1))
    assert shown["listed"] == [
        ("B_1, 13 × 1", "0 except for (1, 1) is 1"), ("C_1, 1 × 13", "0 except for (1, 1) is 1")
    ]  # fmt: skip


def test_of_many_channels_some_are_shown_and_said_to_be() -> None:
    shown = shown_plant(plant_of(1, m=LARGEST + 1))
    assert len(shown["matrices"]) == 1 + 2 * CUT
    assert "Of 13 channels the first 8 are shown." in shown["notes"]
    assert dict(shown["rows"])["channels"].endswith("8, …")


def test_long_numbers_are_rounded_and_said_to_be() -> None:
    shown = shown_plant(plant_of(1, entry=Fraction(10**20 + 1, 3 * 10**20)))
    assert "≈0.333333" in str(shown["matrices"][0]) and "≈" in shown["notes"][0]


def test_functions_of_parameters_have_no_parentheses_that_they_do_not_need() -> None:
    plant = ParametricSystem(
        [["1/t", "(1 + t)/t^2"], ["1/(1 + t)", "1/(2*t)"]],
        [[[1], [0]]],
        [[[1, 0]]],
        parameters=["t"],
    )
    shown = str(shown_plant(plant))
    assert "1/t" in shown and "(t + 1)/t^2" in shown and "1/(t + 1)" in shown
    assert "(1)" not in shown and "(t^2)" not in shown


def test_the_date_is_that_of_reproducible_builds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert stamp(dated=False).endswith(", 1970-01-02") and stamp(dated=True) == stamp(dated=False)
    monkeypatch.delenv("SOURCE_DATE_EPOCH")
    assert "," not in stamp(dated=False) and stamp(dated=True).startswith(stamp(dated=False))
