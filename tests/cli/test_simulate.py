"""Runs on the command line, and how they start."""

from __future__ import annotations

import csv
from pathlib import Path

from mcexact import MultiChannelSystem, local_controllers, save_controller, save_system
from tests.cli.calling import call


def test_one_number_is_that_of_all_states(tmp_path: Path) -> None:
    plant = MultiChannelSystem([[-1, 0], [0, -2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    files = str(tmp_path / "plant.json"), str(tmp_path / "gains.json")
    save_system(plant, files[0])
    save_controller(local_controllers(plant, [[[-1]], [[-1]]]), files[1])
    starts = []
    for initial in ("3", "3,3", "0"):
        run = str(tmp_path / "run.csv")
        status, _, said = call("simulate", *files, "--initial", initial, "-o", run)
        assert status == 0, said
        with open(run, encoding="utf-8") as file:
            head, first, *_ = csv.reader(file)
        starts.append([float(x) for name, x in zip(head, first, strict=True) if name != "t"])
    assert starts[0] == starts[1] and 3.0 in starts[0]
    assert set(starts[2]) == {0.0}
    status, _, said = call("simulate", *files, "--initial", "1,2,3")
    assert status == 3 and "expected 2 numbers, found 3" in said
