"""Systems go out to files of every kind and come back as they were."""

import io
import random
import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.io
import scipy.sparse
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from mcexact.errors import InputError, MissingExtra, NotWritten, UsageError
from mcexact.exact.matrix import Matrix, reading_in_words
from mcexact.exact.rational import Limits
from mcexact.model import arrays, gallery
from mcexact.model.files import load_parametric_system, load_system, save_system
from mcexact.model.graph import NeighborGraph
from mcexact.model.parametric import ParametricSystem
from mcexact.model.sizes import TypicalSizes
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system, system_text
from tests.assurance.campaigns import damaged_files, grammar
from tests.model.formats import hostile
from tests.model.formats.hostile import archive, cell, csv, npz
from tests.wording import refusal

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
    typical_sizes=TypicalSizes(["0.2", 3, "1/7"], [[1, "1e-3"], [], [4]], [[], [5], [6, 7]], "1/4"),
)
PLAIN = MultiChannelSystem([["0.1", 0], [3, -4]], [[[1], [0]]], [[[0, "2.5"]]])
SIZED = PLAIN.with_typical_sizes(TypicalSizes(inputs=[["0.25"]]))
EMPTY = MultiChannelSystem([], [[], []], [[], []])


@pytest.mark.parametrize("file", ["p.json", "p.yaml", "p.yml", "p.npz", "p"])
@pytest.mark.parametrize(
    "system", [FULL, PLAIN, SIZED, EMPTY], ids=["full", "plain", "sized", "empty"]
)
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
        assert load_system(path, rounding=rounding) == load_system(path) == PLAIN
        assert load_system(path, rounding="dyadic").A[0, 0] == Fraction(0.1)
    else:
        with refusal(InputError, where="A[0][0]", quantity="0.1"):
            save_system(PLAIN, path, rounding=rounding)
        assert not path.exists()
        save_system(PLAIN, path, nearest=True)
        assert load_system(path, rounding="dyadic").A[0, 0] == Fraction(0.1)


def test_a_number_beyond_floats_is_not_written_as_one(tmp_path: Path) -> None:
    huge = MultiChannelSystem([[10**400]], [[[1]]], [[[1]]])
    with refusal(InputError):
        save_system(huge, tmp_path / "p.mat", nearest=True)
    with pytest.raises(UsageError, match=r"rounded in \.mat and \.npz files only"):
        save_system(huge, tmp_path / "p.json", nearest=True)
    with refusal(InputError, where="A[0][0]"):
        save_system(MultiChannelSystem([["1/3"]], [[[1]]], [[[1]]]), tmp_path / "p.mat")


def drawn(count: int) -> list[MultiChannelSystem]:
    """Systems with names, delays, texts, long numbers, no states, no inputs, or without these."""
    rng = random.Random(7)
    texts = [grammar.text_of(grammar.drawn_document(rng), rng) for _ in range(count)]
    return [read_system(text.encode("utf-8", "surrogatepass")) for text in texts]


def test_what_is_written_is_read_back_from_every_kind(tmp_path: Path) -> None:
    """Each kind is written over the system before, which must not shine through."""
    floats = 0
    for system in drawn(30):
        for file in ("p.json", "p.npz", "p.yaml", "p.mat", "p"):
            try:
                save_system(system, tmp_path / file)
            except InputError as error:
                assert file == "p.mat" and ("no float is" in str(error) or "range" in str(error))
                continue
            floats += file == "p.mat"
            assert system_text(load_system(tmp_path / file)) == system_text(system), file
    assert floats > 5


def test_the_nearest_floats_are_read_back_without_a_rounding(tmp_path: Path) -> None:
    plant = MultiChannelSystem([["1/3", 0], [0, "1/2"]], [[[1], [0]]], [[["0.1", 1]]])
    for file in ("p.mat", "p.npz"):
        for rounding in ("decimal", "dyadic", None):
            save_system(plant, tmp_path / file, rounding=rounding, nearest=True)
            near = load_system(tmp_path / file)
            assert near == load_system(tmp_path / file, rounding=rounding or "dyadic")
            assert near.A[0, 0] != Fraction(1, 3) and near.A[1, 1] == Fraction(1, 2)
            assert (near.channels[0].C[0, 0] == Fraction(1, 10)) is (rounding == "decimal")


def test_a_range_without_an_end_comes_back_from_yaml(tmp_path: Path) -> None:
    plant = ParametricSystem(
        [["t", "1/s"], [0, "t*s"]],
        [[[1], [0]]],
        [[[1, 0]]],
        parameters=["s", "t"],
        assume={"t": (0, None), "s": (None, "1/2")},
        names=["\U0001f600"],
    )
    for file in ("p.yaml", "p.yml", "p.json"):
        save_system(plant, tmp_path / file)
        assert load_parametric_system(tmp_path / file) == plant
    text = "format: mcexact-system/1\ntime: continuous\nparameters: {t: {range: [0, null]}}\n"
    (tmp_path / "p.yaml").write_text(text + "A: [[t]]\nchannels: [{B: [[1]], C: [[1]]}]\n")
    assert load_parametric_system(tmp_path / "p.yaml").ranges == ((0, None),)


def test_a_folder_holds_one_system_and_other_files_stay(tmp_path: Path) -> None:
    save_system(FULL, tmp_path / "p")
    (tmp_path / "p" / "notes.txt").write_text("mine")
    save_system(PLAIN, tmp_path / "p")
    assert load_system(tmp_path / "p") == PLAIN
    assert (tmp_path / "p" / "notes.txt").read_text() == "mine"
    (tmp_path / "p" / "measured.csv").write_text("1\n")
    with pytest.raises(InputError, match=r"measured\.csv: unknown table 'measured'"):
        save_system(EMPTY, tmp_path / "p")
    assert (tmp_path / "p" / "B_1.csv").exists()


def test_an_interrupted_folder_is_no_system(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_system(FULL, tmp_path / "p")

    def stop(path: Path, text: str) -> None:
        if path.name == "C_1.csv":
            raise KeyboardInterrupt

    monkeypatch.setattr(arrays, "write_text", stop)
    with pytest.raises(KeyboardInterrupt):
        save_system(PLAIN, tmp_path / "p")
    with pytest.raises(InputError):
        load_system(tmp_path / "p")


@pytest.mark.parametrize("name", ["p.xlsx", "p.txt", "p.csv", "p.json.bak"])
def test_a_file_of_an_unknown_kind_is_not_written(name: str, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"choose \.json, \.yaml"):
        save_system(PLAIN, tmp_path / name)
    assert not (tmp_path / name).exists()


def test_a_byte_order_mark_says_nothing_in_every_text(tmp_path: Path) -> None:
    for file in ("p.json", "p.yaml", "p"):
        save_system(PLAIN, tmp_path / file)
        paths = list((tmp_path / file).glob("*")) or [tmp_path / file]
        for path in paths:
            path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
        assert load_system(tmp_path / file) == PLAIN


def test_both_parsers_of_yaml_read_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng, path, both = random.Random(5), tmp_path / "p.yaml", []
    files = [damaged_files.yaml_file(rng) for _ in range(50)]
    for _ in range(2):
        both.append([])
        for data in files:
            path.write_bytes(data)
            try:
                both[-1].append(system_text(load_system(path)))
            except InputError:
                both[-1].append("refused")
        monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    assert both[0] == both[1] and both[0].count("refused") < len(files)


BAD = ("bad", "broken", "corrupted")
"""What the names of damaged files begin with."""


def scipys_files() -> list[Path]:
    """The sound files of MATLAB, version 5, that scipy is tested with."""
    folder = Path(scipy.io.__file__).parent / "matlab" / "tests" / "data"
    files = [path for path in sorted(folder.glob("*.mat")) if not path.name.startswith(BAD)]
    return [path for path in files if path.read_bytes().startswith(arrays.MAGIC)]


def test_matrices_and_texts_of_matlab_are_those_that_scipy_reads() -> None:
    """Both read each variable of these files that has numbers or a text."""
    matrices = texts = 0
    for path in scipys_files():
        try:
            plain = arrays._decompressed(path.read_bytes(), Limits())
            file = arrays._File(*plain)
            variables = file._variables()
            loaded = scipy.io.loadmat(path)
        except (InputError, ValueError, TypeError):
            continue  # structs, objects, complex numbers, more dimensions, and damaged files
        for variable in variables:
            expected = loaded.get(variable.name)
            if variable.kind == 4 and variable.shape[0] <= 1:
                texts += 1
                assert file._text(variable) == (str(expected[0]) if expected.size else "")
            elif variable.kind == 5 or 6 <= variable.kind <= 15:
                matrices += 1
                found = file._table(variable)
                if variable.kind == 5:
                    found, expected = found.toarray(), expected.toarray()
                assert found.shape == expected.shape and np.array_equal(found, expected)
    if not scipys_files():
        pytest.skip("scipy was installed without its tests")
    assert matrices > 10 and texts > 3


@given(st.integers(0, 10**6))
@settings(max_examples=40, deadline=None)
def test_drawn_matrices_of_matlab_are_those_that_scipy_reads(seed: int) -> None:
    rng = np.random.default_rng(seed)
    kind = rng.choice(["f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "sparse"])
    M = (rng.integers(-9, 9, rng.integers(0, 5, 2)) * rng.choice([0.25, 1, 1000])).round(3)
    M = scipy.sparse.csc_array(M) if kind == "sparse" else M.astype(kind)
    data = hostile.mat(compressed=bool(rng.integers(2)), A=M)
    found = arrays.read_mat(data, Limits()).tables["A"]
    stream: Any = io.BytesIO(data)
    expected = scipy.io.loadmat(stream)["A"]
    if kind == "sparse":
        found, expected = found.toarray(), expected.toarray()
    assert found.shape == expected.shape and np.array_equal(found, expected)
    if kind in ("f8", "f4"):
        assert found.dtype == expected.dtype or found.dtype.kind in "iu"


@pytest.mark.parametrize("file", ["p.mat", "p.npz"])
def test_equal_systems_are_equal_bytes(file: str, tmp_path: Path) -> None:
    made = []
    for _ in range(2):
        save_system(PLAIN, tmp_path / file, rounding="decimal")
        made.append((tmp_path / file).read_bytes())
    assert made[0] == made[1]


EXPECTED = MultiChannelSystem([[0, 1], [2, 3]], [[[1], [0]]], [[[1, 0]]])
KINDS = {
    "stacked": hostile.mat(),
    "not compressed": hostile.mat(compressed=False),
    "small integers": hostile.mat(A=np.array([[0, 1], [2, 3]], dtype=np.int8)),
    "single precision": hostile.mat(A=np.array([[0, 1], [2, 3]], dtype=np.float32)),
    "cells": hostile.mat(
        B=cell(np.array([[1], [0]])), C=cell(np.array([[1, 0]])), inputs=None, outputs=None
    ),
    "sparse": hostile.mat(A=scipy.sparse.csc_array(np.array([[0.0, 1], [2, 3]]))),
    "a text": hostile.mat(time="continuous", D=np.zeros((1, 1))),
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
        path.write_bytes(hostile.mat(A=A))
        assert load_system(path, rounding="decimal").A[0, 0] == Fraction(1, 10)
        assert load_system(path, rounding="dyadic").A[0, 0] == Fraction(*A[0, 0].as_integer_ratio())


OFF = [[0.1 + 0.2, 0], [1 / 3, 1]]
MEANT = Matrix.from_rows([["3/10", 0], ["1/3", 1]])


@pytest.mark.parametrize("kind", [np.float32, np.float64, scipy.sparse.csc_array])
@pytest.mark.parametrize("write", [hostile.mat, hostile.npz])
def test_floats_are_read_as_the_simplest_numbers_by_default(
    write: Any, kind: Any, tmp_path: Path
) -> None:
    if write is hostile.npz and kind is scipy.sparse.csc_array:
        pytest.skip("numpy writes no sparse arrays")
    path = tmp_path / "p"
    path.write_bytes(write(A=kind(OFF)))
    plant = load_system(path)
    assert plant.A == MEANT and plant.rounding == "simplest"
    assert plant.source is not None and plant.source.endswith("that prints it")
    assert "Rounding simplest: " in plant.explain()


def test_half_precision_keeps_too_few_digits_for_most_fractions(tmp_path: Path) -> None:
    path = tmp_path / "p.npz"
    path.write_bytes(hostile.npz(A=np.array([[0.5, 0.1], [1 / 3, 2048]], dtype=np.float16)))
    assert load_system(path).A == Matrix.from_rows([["1/2", "1/10"], ["0.3333", 2048]])


@pytest.mark.parametrize("rounding", ["decimal", "dyadic", "simplest"])
def test_a_system_says_how_its_floats_were_read(rounding: Any, tmp_path: Path) -> None:
    path = tmp_path / "p.mat"
    path.write_bytes(hostile.mat(A=np.array(OFF), source="a test"))
    plant = load_system(path, rounding=rounding)
    assert plant.rounding == rounding
    assert plant.source == f"a test; {reading_in_words(rounding)}"
    # Another file of the same numbers repeats it, whatever its kind, and nothing was read again.
    for file in ("p.json", "p.yaml", "folder", "p.npz"):
        save_system(plant, tmp_path / file)
        again = load_system(tmp_path / file)
        assert (again, again.source, again.rounding) == (plant, plant.source, None)


@pytest.mark.parametrize("A", [[[2.0, 0], [0, 2.0**53]], [[2, 0], [0, -1]]])
def test_nothing_is_said_of_floats_that_every_rounding_reads_alike(A: Any, tmp_path: Path) -> None:
    path = tmp_path / "p.mat"
    path.write_bytes(hostile.mat(A=np.array(A)))
    plant = load_system(path)
    assert plant.rounding is None and plant.source is None
    assert plant == load_system(path, rounding="dyadic")


def test_an_integer_that_was_rounded_is_said(tmp_path: Path) -> None:
    path = tmp_path / "p.mat"
    path.write_bytes(hostile.mat(A=np.array([[2.9999999999999996, 0], [0, 1]])))
    assert load_system(path).A[0, 0] == 3
    assert load_system(path).rounding == "simplest"


def test_a_source_that_is_as_long_as_a_file_may_have_stays_as_it_is(tmp_path: Path) -> None:
    path, source = tmp_path / "p.mat", "x" * 10_000
    path.write_bytes(hostile.mat(A=np.array(OFF), source=source))
    plant = load_system(path)
    assert plant.source == source and plant.rounding == "simplest"
    save_system(plant, tmp_path / "p.json")
    assert load_system(tmp_path / "p.json") == plant


@pytest.mark.parametrize("file", ["p.json", "p.yaml", "folder", "p.npz"])
def test_typed_text_is_never_rounded(file: str, tmp_path: Path) -> None:
    typed = MultiChannelSystem([["0.30000000000000004"]], [[["0.333333333333333"]]], [[[1]]])
    save_system(typed, tmp_path / file)
    assert load_system(tmp_path / file) == typed
    assert load_system(tmp_path / file, rounding="simplest") == typed
    assert load_system(tmp_path / file).rounding is None


@pytest.mark.parametrize("file", ["p.mat", "p.npz"])
def test_fractions_are_written_as_floats_that_are_read_as_these_fractions(
    file: str, tmp_path: Path
) -> None:
    plant = gallery.load("quadruple-tank-pminus")
    save_system(plant, tmp_path / file, rounding="simplest")
    again = load_system(tmp_path / file)
    assert again == plant and again.rounding is None
    with refusal(InputError):
        save_system(plant, tmp_path / file, rounding="decimal")
    long = MultiChannelSystem([[f"1/{10**9 + 7}"]], [[[1]]], [[[1]]])
    with refusal(InputError):
        save_system(long, tmp_path / file, rounding="simplest")


def test_sizes_are_given_where_a_file_has_none(tmp_path: Path) -> None:
    path = tmp_path / "p.mat"
    path.write_bytes(hostile.mat(inputs=None, outputs=None))
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
    with refusal(UsageError):
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
