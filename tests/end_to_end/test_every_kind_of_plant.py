"""Every command answers, or says why it does not, about plants of every kind: none is a bug."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mcexact import load_system, save_controller
from mcexact.cli.commands import COMMANDS
from mcexact.designs import local_controllers
from tests.end_to_end.command_line import run

HEAD = {"format": "mcexact-system/1", "time": "continuous"}
OWN = [{"B": [[1], [0]], "C": [[1, 0]]}, {"B": [[0], [1]], "C": [[0, 1]]}]
LINKS = {"1": ["2"], "2": ["1"]}
FIXED: dict[str, Any] = {**HEAD, "A": [[1, "1/2"], [1, -2]], "channels": OWN, "neighbors": LINKS}
ONE = {**FIXED, "A": [["1 - k", "k"], ["k", "1 - k"]]}
KINDS: dict[str, dict[str, Any]] = {
    "no parameters": FIXED,
    "discrete time": {**FIXED, "time": "discrete"},
    "no links": {key: each for key, each in FIXED.items() if key != "neighbors"},
    "radii": {**FIXED, "uncertainty": {"relative": "1/100"}},
    "one parameter": {**ONE, "parameters": {"k": {}}},
    "one parameter with a range": {**ONE, "parameters": {"k": {"range": ["1/4", "3/4"]}}},
    "several parameters": {**ONE, "A": [["s", "k"], ["k", "-s"]], "parameters": {"k": {}, "s": {}}},
    "several parameters with ranges": {
        **ONE,
        "A": [["s", "k"], ["k", "-s"]],
        "parameters": {"k": {"range": [1, 2]}, "s": {"range": ["1/4", "1/2"]}},
    },
}
LOOP = ("PLANT", "GAINS")
SHORT = ("--effort", "0.1")
CALLS: dict[str, tuple[tuple[str, ...], ...]] = {
    "export": (("GAINS", "--to", "json"),),
    "analyze": (
        ("PLANT",),
        ("PLANT", "--minimal", "--subset", "1", "--channel", "1"),
        ("PLANT", "--information", "outputs"),
        ("PLANT", "--uncertainty", "1%"),
        ("PLANT", "--largest-uncertainty", *SHORT),
    ),
    "check": (("--system", "PLANT", "PLANT"),),
    "allocate": (("PLANT",),),
    "design": (
        ("decentralized", "PLANT", "--rate", "1/10"),
        ("extended", "PLANT", "--rate", "1/10"),
        ("observer", "PLANT", "--rate", "1/10"),
        ("setpoint", "PLANT", "--rate", "1/10"),
    ),
    "certify": (
        LOOP,
        (*LOOP, "--uncertainty", "1%", "--gains", "1%"),
        (*LOOP, "--largest-uncertainty", *SHORT),
        (*LOOP, "--round-gains", "2"),
        (*LOOP, "--largest"),
    ),
    "crosscheck": (("PLANT",),),
    "simulate": ((*LOOP, "--horizon", "1"), (*LOOP, "--step", "1/10", "--horizon", "1")),
    "convert": (("PLANT",), ("PLANT", "-o", "TEXT")),
    "c2d": (("PLANT", "--step", "1/10"),),
    "sweep": (("PLANT",),),
}
WITHOUT_A_PLANT = {"reproduce", "demo", "gallery", "sample", "schema"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file of each kind, and of constant gains for all of them in each time."""
    place = tmp_path_factory.mktemp("kinds")
    for kind, document in KINDS.items():
        (place / f"{kind}.json").write_text(json.dumps(document), encoding="utf-8")
    for kind in ("no parameters", "discrete time"):
        plant = load_system(place / f"{kind}.json")
        gains = local_controllers(plant, [[[-3]], [[0]]])
        save_controller(gains, place / f"gains in {plant.time} time.json")
    return place


def test_every_command_is_tried() -> None:
    assert CALLS.keys() | WITHOUT_A_PLANT == COMMANDS.keys()


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("command", CALLS)
def test_no_kind_of_plant_is_a_bug_in_a_command(command: str, kind: str, folder: Path) -> None:
    names = {"PLANT": str(folder / f"{kind}.json"), "TEXT": str(folder / f"{kind}.yaml")}
    names["GAINS"] = str(folder / f"gains in {KINDS[kind]['time']} time.json")
    for arguments in CALLS[command]:
        done = run(command, *(names.get(each, each) for each in arguments))
        assert done.status in {0, 1, 2, 3, 4}, (arguments, done)
        assert done.stdout or done.stderr, arguments
        assert "Traceback" not in done.stderr
