"""`mcexact analyze` with plants nearby: what leads, what is written, and what is left out."""

from __future__ import annotations

import json
from pathlib import Path

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.model.files import load_system
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import system_text
from tests.cli.calling import call
from tests.wording import says

FLOATS = [["-0.30000000000000004", "0.7"], ["0.3", "-0.7"]]
"""No input moves the sum of both states, but for a rounding error."""


def plant_file(folder: Path, first: str = FLOATS[0][0]) -> Path:
    path = folder / "plant.json"
    A = [[first, FLOATS[0][1]], FLOATS[1]]
    path.write_text(system_text(MultiChannelSystem(A, [[["0.1"], ["-0.1"]]], [[[1, 0]]])), "utf-8")
    return path


def test_the_plant_nearby_leads_and_is_written_exactly(tmp_path: Path) -> None:
    near = tmp_path / "near.json"
    status, out, _ = call("analyze", str(plant_file(tmp_path)), "--nearby", str(near))
    assert status == 0 and says(out, "depends errors")
    assert not fixed_spectrum(load_system(near)).stabilizable


def test_without_a_plant_nearby_no_file_is_written_and_it_is_said(tmp_path: Path) -> None:
    near = tmp_path / "near.json"
    status, _, err = call("analyze", str(plant_file(tmp_path, "-3")), "--nearby", str(near))
    assert status == 0 and says(err, "plant nearby") and not near.exists()


def test_the_search_is_left_out_on_request_and_that_is_said(tmp_path: Path) -> None:
    path = plant_file(tmp_path)
    status, out, _ = call("analyze", str(path), "--no-nearby")
    assert status == 0 and "depends on" not in out and "nearby plants" in out
    told = json.loads(call("analyze", str(path), "--no-nearby", "--json")[1])
    assert "nearby" not in told
    [left] = [each for each in told["questions"] if each["question"] == "nearby_plants"]
    assert left["outcome"] == "left out"
    assert "nearby" in json.loads(call("analyze", str(path), "--json")[1])


def test_the_options_contradict_each_other(tmp_path: Path) -> None:
    path = plant_file(tmp_path)
    status, _, err = call("analyze", str(path), "--no-nearby", "--nearby", str(tmp_path / "n.json"))
    assert status == 2 and "contradict" in err
    assert call("analyze", str(path), "--nearby", str(path))[0] == 3
