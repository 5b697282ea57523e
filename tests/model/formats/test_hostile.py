"""Every damaged or hostile file is refused in one sentence, and within the limits."""

import tracemalloc
from pathlib import Path

import pytest

from mcexact.errors import InputError
from mcexact.exact.rational import Limits
from mcexact.model.formats.files import load_system
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
