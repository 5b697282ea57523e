"""Readers of floats warn where rounding errors decide an answer, and name the plant nearby."""

import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mcexact import MultiChannelSystem, errors, from_statespace, load_system
from mcexact.constructions import from_stacked
from mcexact.errors import RoundingWarning, examine_rounded_by, warn_of_rounding
from mcexact.model.files import save_system
from tests.wording import says

INERTIAS = np.array([1.2, 2.8, 0.7])
LINES = np.array([[0, 1.7, 2.4], [1.7, 0, 1.1], [2.4, 1.1, 0]])
"""A grid whose frequencies are measured: no output shows the angle that all machines share."""


def grid() -> tuple[Any, list[Any], list[Any]]:
    stiffness = (LINES - np.diag(LINES.sum(axis=1))) / INERTIAS[:, None]
    A = np.block([[np.zeros((3, 3)), np.eye(3)], [stiffness, -np.diag(0.1 / INERTIAS)]])
    unit = np.eye(6)
    return (
        A,
        [unit[:, [3 + i]] / inertia for i, inertia in enumerate(INERTIAS)],
        [unit[[3 + i]] for i in range(3)],
    )


class Model:
    """What `from_statespace` needs of a model."""

    def __init__(self) -> None:
        self.A, inputs, outputs = grid()
        self.B, self.C = np.hstack(inputs), np.vstack(outputs)
        self.D, self.dt = np.zeros((3, 3)), 0


def told(read: Callable[[], MultiChannelSystem]) -> list[warnings.WarningMessage]:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        read()
    return list(caught)


def read_float() -> MultiChannelSystem:
    return MultiChannelSystem.from_float(*grid(), rounding="decimal")


def read_stacked() -> MultiChannelSystem:
    A, B, C = grid()
    sizes = {"inputs": [1, 1, 1], "outputs": [1, 1, 1]}
    return from_stacked(A, np.hstack(B), np.vstack(C), rounding="decimal", **sizes)


def read_statespace() -> MultiChannelSystem:
    return from_statespace(Model(), [(i, i) for i in range(3)], rounding="dyadic")


@pytest.mark.parametrize("read", [read_float, read_stacked, read_statespace])
def test_readers_name_the_plant_nearby_and_the_place_of_the_call(
    read: Callable[[], MultiChannelSystem],
) -> None:
    caught = told(read)
    assert [each.category for each in caught] == [RoundingWarning] * 2
    assert {each.filename for each in caught} == {__file__}
    assert says(str(caught[0].message), "fixed mode")


def test_files_of_floats_are_read_with_the_same_warning(tmp_path: Path) -> None:
    path = tmp_path / "grid.npz"
    A, B, C = grid()
    np.savez(path, A=A, **{f"B_{i + 1}": b for i, b in enumerate(B)},
             **{f"C_{i + 1}": c for i, c in enumerate(C)})  # fmt: skip
    assert len(told(lambda: load_system(path, rounding="decimal"))) == 2
    assert not told(lambda: load_system(path))


def test_what_was_typed_is_what_is_meant(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        save_system(read_float(), tmp_path / "typed.json")
    assert not told(lambda: load_system(tmp_path / "typed.json"))


def test_a_plant_without_such_a_neighbor_is_read_in_silence() -> None:
    A, B, C = grid()
    assert not told(lambda: MultiChannelSystem.from_float(A, B, C))
    angles = [np.eye(6)[[i]] for i in range(3)]
    assert not told(lambda: MultiChannelSystem.from_float(A, B, angles, rounding="decimal"))


def test_a_plant_with_a_fixed_mode_of_its_own_is_left_to_analyze() -> None:
    A, B, C = grid()
    more = np.block([[A, np.zeros((6, 1))], [np.zeros((1, 6)), -0.3 * np.eye(1)]])
    B, C = [np.vstack([b, [[0.0]]]) for b in B], [np.hstack([c, [[0.0]]]) for c in C]
    assert not told(lambda: MultiChannelSystem.from_float(more, B, C, rounding="decimal"))


def test_nothing_is_examined_where_the_warning_is_ignored(monkeypatch: pytest.MonkeyPatch) -> None:
    examined: list[MultiChannelSystem] = []

    def examine(system: MultiChannelSystem) -> tuple[str, ...]:
        examined.append(system)
        return ("near",)

    monkeypatch.setattr(errors, "_examine", None)
    plant = read_float_in_silence()
    examine_rounded_by(examine)
    with pytest.warns(RoundingWarning, match="near"):
        warn_of_rounding(plant)
    assert examined == [plant]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RoundingWarning)
        warn_of_rounding(plant)
    assert examined == [plant]
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", ".*near", RoundingWarning)
        warn_of_rounding(plant)
    assert examined == [plant, plant]


def read_float_in_silence() -> MultiChannelSystem:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return read_float()
