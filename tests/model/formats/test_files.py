"""Systems go out to files of every kind and come back as they were."""

import io
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse
from hypothesis import HealthCheck, given, settings

from mcexact.errors import InputError, MissingExtra, NotWritten, UsageError
from mcexact.model import gallery
from mcexact.model.formats.files import load_system, save_system
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.testing import systems
from tests.model.formats.hostile import archive, cell, csv, mat, npz

FULL = MultiChannelSystem(
    [["1/2", "0.1", 0], [-3, "1e-3", "1/3"], [0, 0, 12345678901234567890]],
    [[[1, 2], [0, "2/7"], [0, 0]], [[], [], []], [[0], [0], [-1]]],
    [[], [[1, 0, 0]], [["1/3", 0, 0], [0, 0, "0.7"]]],
    time="discrete",
    sample_time="0.05",
    names=["pump, left", 'the "valve"', "Wärme"],
    neighbors=NeighborGraph(["pump, left", 'the "valve"', "Wärme"], [[1], [0, 2], []], [(1, 2, 3)]),
    name="a name",
    source="a source,\nof two lines",
)
PLAIN = MultiChannelSystem([["0.1", 0], [3, -4]], [[[1], [0]]], [[[0, "2.5"]]])
EMPTY = MultiChannelSystem([], [[], []], [[], []])


@pytest.mark.parametrize("file", ["p.json", "p.yaml", "p.yml", "p.npz", "p", "p.txt"])
@pytest.mark.parametrize("system", [FULL, PLAIN, EMPTY], ids=["full", "plain", "empty"])
def test_exact_kinds_lose_nothing(system: MultiChannelSystem, file: str, tmp_path: Path) -> None:
    save_system(system, tmp_path / file)
    read = load_system(tmp_path / file)
    assert read == system and (read.name, read.source) == (system.name, system.source)


@pytest.mark.parametrize("file", ["p.mat", "p.npz"])
@pytest.mark.parametrize("rounding", ["decimal", "dyadic"])
def test_floats_are_written_if_the_rounding_makes_the_numbers_again(
    file: str, rounding: Any, tmp_path: Path
) -> None:
    path = tmp_path / file
    if rounding == "decimal":
        save_system(PLAIN, path, rounding=rounding)
        assert load_system(path, rounding=rounding) == PLAIN
        with pytest.raises(InputError, match=r"A: found 0\.1: a float is not exact"):
            load_system(path)
    else:
        with pytest.raises(
            InputError, match=r"A\[0\]\[0\]: no float is read as 0\.1 with the rounding"
        ):
            save_system(PLAIN, path, rounding=rounding)
        assert not path.exists()
        save_system(PLAIN, path, nearest=True)
        assert load_system(path, rounding="dyadic").A[0, 0] == Fraction(0.1)


def test_a_number_beyond_floats_is_not_written_as_one(tmp_path: Path) -> None:
    huge = MultiChannelSystem([[10**400]], [[[1]]], [[[1]]])
    with pytest.raises(InputError, match="beyond the range of floats"):
        save_system(huge, tmp_path / "p.mat", nearest=True)
    with pytest.raises(UsageError, match=r"rounded in \.mat and \.npz files only"):
        save_system(huge, tmp_path / "p.json", nearest=True)
    with pytest.raises(InputError, match=r"A\[0\]\[0\]: no float is read as 1/3: .* --rounding"):
        save_system(MultiChannelSystem([["1/3"]], [[[1]]], [[[1]]]), tmp_path / "p.mat")


@given(systems(max_states=3))
@settings(
    max_examples=15, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
def test_drawn_systems_come_back_from_every_kind(tmp_path: Path, drawn: Any) -> None:
    system = drawn.system if hasattr(drawn, "system") else drawn
    for file in ("p.npz", "p.yaml"):
        save_system(system, tmp_path / file)
        assert load_system(tmp_path / file) == system


@pytest.mark.parametrize("file", ["p.mat", "p.npz"])
def test_equal_systems_are_equal_bytes(file: str, tmp_path: Path) -> None:
    made = []
    for _ in range(2):
        save_system(PLAIN, tmp_path / file, rounding="decimal")
        made.append((tmp_path / file).read_bytes())
    assert made[0] == made[1]


EXPECTED = MultiChannelSystem([[0, 1], [2, 3]], [[[1], [0]]], [[[1, 0]]])
KINDS = {
    "stacked": mat(),
    "not compressed": mat(compressed=False),
    "small integers": mat(A=np.array([[0, 1], [2, 3]], dtype=np.int8)),
    "single precision": mat(A=np.array([[0, 1], [2, 3]], dtype=np.float32)),
    "cells": mat(
        B=cell(np.array([[1], [0]])), C=cell(np.array([[1, 0]])), inputs=None, outputs=None
    ),
    "sparse": mat(A=scipy.sparse.csc_array(np.array([[0.0, 1], [2, 3]]))),
    "a text": mat(time="continuous", D=np.zeros((1, 1))),
    "numpy": npz(),
    "numpy by columns": npz(A=np.asfortranarray([[0, 1], [2, 3]])),
    "numpy of texts": npz(A=np.array([["0", "1.0"], ["4/2", "3e0"]])),
    "numpy one by one": npz(B=None, C=None, B_1=np.array([[1], [0]]), C_1=np.array([[1, 0]])),
    "numpy of booleans": npz(B=np.array([[True], [False]])),
    "csv": archive(csv()),
    "csv with a mark and blanks": archive(csv(A="\ufeff0 , 1\r\n2,3\r\n\r\n")),
    "csv of quotients": archive(csv(A="0/5,1\n2,3.0\n")),
    "yaml": (
        b"format: mcexact-system/1\ntime: continuous\nA:\n- [0, 1]\n- [2, 3.0]\n"
        b"channels:\n- B: [[1], ['0/2']]\n  C: [[1e0, 0]]  # a comment\n"
    ),
}


@pytest.mark.parametrize("data", KINDS.values(), ids=KINDS)
def test_what_other_programs_write_is_read(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "p.yaml"
    path.write_bytes(data)
    assert load_system(path) == EXPECTED


def test_floats_are_read_in_their_own_precision_and_by_the_rounding(tmp_path: Path) -> None:
    path = tmp_path / "p.mat"
    for A in (np.array([[0.1, 0], [0, 1]], dtype=np.float32), np.array([[0.1, 0], [0, 1]])):
        path.write_bytes(mat(A=A))
        assert load_system(path, rounding="decimal").A[0, 0] == Fraction(1, 10)
        assert load_system(path, rounding="dyadic").A[0, 0] == Fraction(*A[0, 0].as_integer_ratio())


def test_sizes_are_given_where_a_file_has_none(tmp_path: Path) -> None:
    path = tmp_path / "p.mat"
    path.write_bytes(mat(inputs=None, outputs=None))
    assert load_system(path, inputs=[1], outputs=[1]) == EXPECTED
    two = load_system(path, inputs=[1, 0], outputs=[0, 1])
    assert two.m == 2 and two.p(1) == two.q(0) == 0


def test_a_file_of_the_other_byte_order_is_read() -> None:
    """One of those that scipy is tested with; its only variable is none of a plant."""
    folder = Path(scipy.io.__file__).parent / "matlab" / "tests" / "data"
    path = folder / "testdouble_6.1_SOL2.mat"
    if not path.exists():
        pytest.skip("scipy was installed without its tests")
    with pytest.raises(InputError, match="unknown variable 'testdouble'"):
        load_system(path)


def test_a_sample_time_means_discrete_time(tmp_path: Path) -> None:
    stream = io.BytesIO(npz(sample_time=np.array("0.1")))
    (tmp_path / "p.npz").write_bytes(stream.getvalue())
    read = load_system(tmp_path / "p.npz")
    assert (read.time, read.sample_time) == ("discrete", Fraction(1, 10))


@pytest.mark.parametrize("name", ["quadruple-tank-pminus", "hidden-triple-mode"])
def test_a_plant_of_the_gallery_is_a_file(name: str) -> None:
    assert load_system(f"gallery:{name}") == gallery.load(name)


def test_a_plant_that_is_not_in_the_gallery_has_near_ones() -> None:
    with pytest.raises(UsageError, match="did you mean 'quadruple-tank-p"):
        load_system("gallery:quadruple-tank")
    with pytest.raises(UsageError, match="'mcexact gallery' lists them"):
        load_system("gallery:x")


def test_yaml_without_its_library_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "p.yaml"
    path.write_text("a: 1\n")
    monkeypatch.setitem(sys.modules, "yaml", None)
    with pytest.raises(MissingExtra, match=r"pip install 'mcexact\[yaml\]'"):
        load_system(path)


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises(NotWritten, match="taken: cannot write"):
        save_system(PLAIN, tmp_path / "taken")
