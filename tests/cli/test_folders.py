"""A folder is written whole, or what stood there stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from mcexact.cli.files import require_replaceable, write_folder
from mcexact.errors import InputError, NotWritten


def test_a_folder_replaces_the_earlier_one_and_leaves_nothing_beside_it(tmp_path: Path) -> None:
    folder = tmp_path / "made"
    write_folder(folder, {"report.html": "1", "certificates/old.json": "{}"})
    require_replaceable(folder, "report.html")
    write_folder(folder, {"report.html": "2"})
    assert [path.name for path in folder.iterdir()] == ["report.html"]
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


def test_what_stood_there_stays_if_the_new_one_cannot_take_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "made"
    write_folder(folder, {"report.html": "1"})
    rename = Path.rename

    def failing(path: Path, target: Path) -> Path:
        if path.name == "new":
            raise OSError(28, "No space left on device")
        return rename(path, target)

    monkeypatch.setattr(Path, "rename", failing)
    with pytest.raises(NotWritten, match="No space left"):
        write_folder(folder, {"report.html": "2"})
    assert (folder / "report.html").read_text(encoding="utf-8") == "1"
    assert [path.name for path in tmp_path.iterdir()] == ["made"]


def test_a_file_in_the_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    with pytest.raises(InputError, match="expected a folder"):
        require_replaceable(tmp_path / "file", "report.html")
