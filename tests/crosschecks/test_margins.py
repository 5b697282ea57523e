"""Disk margins by python-control on a grid of frequencies, beside those that are proved."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mcexact.crosschecks.table import CrossCheck, crosscheck
from mcexact.model.controller import save_controller
from mcexact.model.files import save_system
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from tests.cli.calling import call
from tests.wording import says, worded

control = pytest.importorskip("control")
PLANT = MultiChannelSystem([[0, 1], [-1, "-0.0002"]], [[[0], [1]]], [[[1, 0]]])


def margins(plant: MultiChannelSystem, gain: str) -> list[CrossCheck]:
    found = crosscheck(plant, local_controllers(plant, [[[gain]]]))
    return [row for row in found.rows if row.question.startswith("disk margin")]


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_where_the_grid_is_fine_enough_both_agree(time: str) -> None:
    plant = MultiChannelSystem([["1/2"]], [[[1]]], [[[1]]], time=time)
    rows = margins(plant, "-1")
    assert worded([row.question for row in rows])
    for row in rows:
        assert row.agree and "artifact" not in row.floating
        assert float(row.exact.split()[-1]) <= float(row.floating.split(",")[0])


def test_a_resonance_between_two_frequencies_of_the_grid_is_an_artifact() -> None:
    for row in margins(PLANT, "0.0003"):
        assert row.agree is False and says(row.floating, "artifact grid")
        assert float(row.floating.split(",")[0]) > 1.5 > 0.7 > float(row.exact.split()[-1])


def test_a_loop_that_is_not_stable_has_no_margin_though_a_number_is_computed() -> None:
    for row in margins(PLANT, "2"):
        assert row.agree is False and worded(row.exact)
        assert float(row.floating) > 0


def test_an_old_control_gives_no_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(control, "disk_margins")
    for row in margins(PLANT, "-1"):
        assert row.agree is None and "before 0.10.2" in row.floating
        assert row.exact.startswith("at least")


def test_the_command_takes_a_controller(tmp_path: Path) -> None:
    plant, controller = str(tmp_path / "plant.json"), str(tmp_path / "controller.json")
    save_system(PLANT, plant)
    save_controller(local_controllers(PLANT, [[["0.0003"]]]), controller)
    status, out, _ = call("crosscheck", plant, controller)
    assert status == 0 and says(out, "artifact grid") and out.count("artifact") == 2
    rows = json.loads(call("crosscheck", plant, controller, "--json")[1])["rows"]
    assert sum(row["question"].startswith("disk margin") for row in rows) == 2
    assert call("crosscheck", plant)[1].count("disk margin") == 0
