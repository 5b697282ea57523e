"""Every damaged or hostile file is refused in one sentence, and within the limits."""

import os
import signal
import tracemalloc
from pathlib import Path

import pytest

from mcexact.errors import InputError
from mcexact.exact.rational import Limits
from mcexact.model.files import load_system
from tests.assurance.campaigns import damaged_files
from tests.model.formats.hostile import CSV, MAT, NPZ, TEXTS, YAML

SMALL = Limits(bytes=2**20)
FILES = [
    *(("plant.mat", name, data, says) for name, (data, says) in MAT.items()),
    *(("plant.npz", name, data, says) for name, (data, says) in NPZ.items()),
    *(("plant.yaml", name, text.encode(), says) for name, (text, says) in YAML.items()),
    *(("plant", name, data, says) for name, (data, says) in TEXTS.items()),
]


def refuse(path: Path, says: str) -> None:
    """Read a file, which has to be refused in one line, with little memory."""
    tracemalloc.start()
    try:
        with pytest.raises(InputError, match=says) as raised:
            load_system(path, limits=SMALL)
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    message = str(raised.value)
    assert message.startswith(str(path)) and "\n" not in message
    assert "Expecting value" not in message
    assert most < 40 * 2**20


# Archives have the time in their bytes, so that these are no names.
@pytest.mark.parametrize(
    ("file", "name", "data", "says"), FILES, ids=[f"{file} {name}" for file, name, *_ in FILES]
)
def test_a_file_is_refused(file: str, name: str, data: bytes, says: str, tmp_path: Path) -> None:
    path = tmp_path / file
    path.write_bytes(data)
    refuse(path, says)


@pytest.mark.parametrize(("files", "says"), CSV.values(), ids=CSV)
def test_a_folder_is_refused(files: dict[str, bytes], says: str, tmp_path: Path) -> None:
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    refuse(tmp_path, says)


def test_a_folder_is_limited_as_a_whole(tmp_path: Path) -> None:
    for k in range(3):
        (tmp_path / f"{'ABC'[k]}.csv").write_text("1," * 2**18)
    refuse(tmp_path, "expected at most 1048576 bytes")


def test_a_single_table_is_no_system(tmp_path: Path) -> None:
    path = tmp_path / "A.csv"
    path.write_text("1\n")
    refuse(path, "found a single table; a system file is JSON")


@pytest.mark.parametrize("form", damaged_files.FORMATS)
def test_damaged_files_are_accepted_or_refused(form: str, tmp_path: Path) -> None:
    name, _, readers = damaged_files.FORMATS[form]
    for number in range(15):
        damaged_files.write(damaged_files.made_file(form, number), tmp_path / name)
        for reader in readers:
            found = damaged_files.outcome(reader, tmp_path / name)
            assert found in ("accepted", "refused"), (number, found)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes cannot be forked")
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_the_campaign_notices_deaths_and_errors(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of four files the second ends its process, and the third raises what nobody expects."""

    def reader(path: Path) -> None:
        content = path.read_bytes()
        if content == b"1":
            os.kill(os.getpid(), signal.SIGKILL)
        if content == b"2":
            raise ZeroDivisionError("a message")

    made = iter([b"0", b"1", b"2", b"3"])
    files = {number: next(made) for number in range(4)}
    formats = {"json": ("plant.json", lambda rng: b"", (reader,))}
    monkeypatch.setattr(damaged_files, "FORMATS", formats)
    monkeypatch.setattr(damaged_files, "made_file", lambda form, number: files[number])
    monkeypatch.setattr(damaged_files, "MOST_BYTES", -1)  # the tests map more
    found = list(damaged_files.read_files("json", list(files), tmp_path))
    assert found[0] == (0, "accepted") and found[3] == (3, "accepted")
    assert found[1][0] == 1 and "signal 9" in found[1][1]
    assert found[2] == (2, "ZeroDivisionError: a message")
