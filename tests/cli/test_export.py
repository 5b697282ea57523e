"""`mcexact export`: code into a folder, equations to standard output, and refusals."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema

from mcexact import MultiChannelSystem, save_controller
from mcexact.model.statespace import local_controllers
from mcexact.report.schema import schema_text
from tests.cli.calling import call


def controller(folder: Path, time: str = "discrete") -> Path:
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time=time, names=["pump"])
    path = folder / f"{time}.json"
    save_controller(local_controllers(plant, [[["-1/3"]]]), path)
    return path


def test_code_goes_into_a_folder_and_again(tmp_path: Path) -> None:
    path, code = controller(tmp_path), tmp_path / "code"
    for language, files in (("c", {"pump.c", "pump.h"}), ("st", {"pump.st"})):
        for _ in range(2):
            status, _, err = call("export", str(path), "--to", language, "-o", str(code))
            assert status == 0, err
        assert {each.name for each in code.iterdir()} == {*files, "equations.json"}


def test_equations_go_to_standard_output(tmp_path: Path) -> None:
    path, code = controller(tmp_path), tmp_path / "code"
    status, out, _ = call("export", str(path), "--to", "json")
    assert status == 0 and json.loads(out)["agents"][0]["name"] == "pump"
    jsonschema.validate(json.loads(out), json.loads(schema_text("export")))
    status, again, _ = call("export", str(path), "-o", str(code), "--json")
    assert status == 0 and again == out == (code / "equations.json").read_text()
    target = tmp_path / "sums.json"
    assert call("export", str(path), "--to", "json", "-o", str(target))[0] == 0
    assert target.read_text() == out


def test_what_cannot_be_exported_is_refused_and_nothing_is_overwritten(tmp_path: Path) -> None:
    path = controller(tmp_path)
    status, _, err = call("export", str(path))
    assert status != 0 and "-o FOLDER" in err
    status, _, err = call("export", str(controller(tmp_path, "continuous")), "--to", "json")
    assert status != 0 and "discrete time" in err
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "work.c").write_text("int x;")
    status, _, err = call("export", str(path), "-o", str(tmp_path / "mine"))
    assert status != 0 and (tmp_path / "mine" / "work.c").read_text() == "int x;"
