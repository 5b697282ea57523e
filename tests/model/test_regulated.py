"""Which outputs a controller holds: as positions, as a matrix, in Python and in files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mcexact import MultiChannelSystem, load_system, save_system
from mcexact.checker.core.reading import Refused
from mcexact.errors import InputError
from mcexact.exact.matrix import Matrix
from mcexact.model.regulated import (
    positions_of,
    read_selection,
    selection_document,
    selection_in_words,
)
from mcexact.model.system_file import read_system, system_text
from tests.checker.test_system import digest_of
from tests.wording import refusal

NAMES, COUNTS = ("left", "right"), (2, 1)
TEXT = """{"format": "mcexact-system/1", "time": "continuous", "A": [[0, 1], [0, 0]],
    "channels": [{"name": "left", "B": [[0], [1]], "C": [[1, 0], [0, 1]]},
                 {"name": "right", "B": [[1], [0]], "C": [[1, 1]]}],
    "regulated": %s}"""


def plant(regulated: Any = None) -> MultiChannelSystem:
    return MultiChannelSystem(
        [[0, 1], [0, 0]],
        [[[0], [1]], [[1], [0]]],
        [[[1, 0], [0, 1]], [[1, 1]]],
        names=NAMES,
        regulated=regulated,
    )


@pytest.mark.parametrize(
    ("given", "rows"),
    [
        ({"left": [2, 1]}, ([[0, 1], [1, 0]], [])),
        ({"left": None, "right": [1]}, ([[1, 0], [0, 1]], [[1]])),
        ({"right": [["1/3"]]}, ([], [["1/3"]])),
        ({"left": Matrix.from_rows([[1, -1]])}, ([[1, -1]], [])),
    ],
)
def test_a_selection_is_read_as_positions_or_as_a_matrix(given: Any, rows: Any) -> None:
    selection = read_selection(given, NAMES, COUNTS)
    assert selection == tuple(
        Matrix.from_rows(S, ncols=q) for S, q in zip(rows, COUNTS, strict=True)
    )
    again = read_selection(selection_document(selection, NAMES), NAMES, COUNTS)
    assert again == selection


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"middle": [1]}, "there is no channel 'middle'"),
        ({"left": [3]}, "expected outputs from 1 to 2, found 3"),
        ({"left": [0]}, "expected outputs from 1 to 2, found 0"),
        ({"left": [[1]]}, "expected 2 columns"),
        ({"left": [[1, 0.5]]}, "float"),
        ({"left": []}, "at least one output"),
        ({}, "at least one output"),
        ([1], "by agent"),
        ({"left": "first"}, "expected"),
    ],
)
def test_what_cannot_be_held_is_refused_with_its_place(given: Any, message: str) -> None:
    with pytest.raises(InputError, match=message) as refused:
        read_selection(given, NAMES, COUNTS)
    assert "regulate" in str(refused.value)


def test_positions_are_those_of_single_outputs_alone() -> None:
    assert positions_of(Matrix.from_rows([[0, 2]])) is None
    assert positions_of(Matrix.zeros(0, 2)) == []
    both = Matrix.from_rows([[0, 1], ["-1/2", -1], [0, 0]]), Matrix.identity(1)
    assert selection_in_words(both, NAMES) == "left[2], -1/2 left[1] - left[2], 0, right"


def test_a_plant_keeps_what_is_regulated_and_no_digest_depends_on_it(tmp_path: Path) -> None:
    held = plant({"left": [1], "right": [["1/2"]]})
    assert held.digest() == plant().digest() and held == plant()
    assert "left[1]" in held.explain()
    for suffix in ("json", "yaml"):
        save_system(held, tmp_path / f"plant.{suffix}")
        assert load_system(tmp_path / f"plant.{suffix}").regulated == held.regulated
    assert read_system(json.dumps(held.to_dict())).regulated == held.regulated
    with refusal(InputError):
        save_system(held, tmp_path / "plant.npz")


def test_what_is_made_of_a_plant_regulates_nothing_of_its_own() -> None:
    held = plant({"left": [1]})
    made = held.derived(held.A, held.B, held.C, {"construction": "dual"})
    assert made.regulated is None and held.with_neighbors({}).regulated == held.regulated


@pytest.mark.parametrize("value", ['{"left": [1]}', '{"left": [[1, "1/2"]], "right": [1]}'])
def test_the_checker_reads_the_same_digest(value: str) -> None:
    text = TEXT % value
    ours = read_system(text)
    assert digest_of(text) == ours.digest() == plant().digest()
    assert read_system(system_text(ours)).regulated == ours.regulated


@pytest.mark.parametrize(
    "value", ['{"left": [3]}', '{"left": [[1]]}', '{"other": [1]}', '{"left": 1}', "[]"]
)
def test_package_and_checker_refuse_the_same(value: str) -> None:
    text = TEXT % value
    with pytest.raises(InputError):
        read_system(text)
    with pytest.raises(Refused) as refused:
        digest_of(text)
    assert refused.value.args[0] == "MALFORMED"
