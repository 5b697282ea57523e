"""A controller that was made for another plant runs, is certified, and is warned of."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from mcexact.model.box import Box
from mcexact.model.controller import load_controller, save_controller
from mcexact.model.files import save_system
from mcexact.model.system import MultiChannelSystem
from tests.end_to_end.command_line import run

WARNING = "mcexact: warning: the controller was made for another plant, of digest "


def plant(pole: str) -> MultiChannelSystem:
    return MultiChannelSystem([[pole]], [[[1]]], [[[1]]])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A plant with the controller designed for it, and another plant that it fits as well."""
    save_system(plant("1"), tmp_path / "own.json")
    save_system(plant("1/2"), tmp_path / "other.json")
    where = str(tmp_path / "controller.json")
    made = run("design", "decentralized", str(tmp_path / "own.json"), "--rate=1", "-o", where)
    assert made.status == 0, made.stderr
    return tmp_path


@pytest.mark.parametrize("command", ["certify", "simulate"])
def test_only_a_controller_for_another_plant_is_warned_of(folder: Path, command: str) -> None:
    controller = str(folder / "controller.json")
    own = run(command, str(folder / "own.json"), controller, "--json")
    assert (own.status, own.messages, json.loads(own.stdout)["warnings"]) == (0, [], [])
    other = run(command, str(folder / "other.json"), controller, "--json")
    [message] = other.messages
    assert other.status == 0
    assert message.startswith(WARNING)
    assert plant("1").digest()[:12] in message and plant("1/2").digest()[:12] in message
    assert message.endswith(json.loads(other.stdout)["warnings"][0])
    told = run(command, str(folder / "other.json"), controller)
    assert told.messages == [message]


@pytest.mark.parametrize("command", ["certify", "simulate"])
def test_a_controller_that_names_no_plant_is_not_warned_of(folder: Path, command: str) -> None:
    nameless = replace(load_controller(folder / "controller.json"), system="")
    save_controller(nameless, folder / "nameless.json")
    done = run(command, str(folder / "other.json"), str(folder / "nameless.json"))
    assert (done.status, done.messages) == (0, [])


def test_another_neighbor_graph_makes_another_plant(folder: Path) -> None:
    """Its certificates are about another system, too."""
    save_system(plant("1").with_neighbors({"1": []}), folder / "linked.json")
    done = run("certify", str(folder / "linked.json"), str(folder / "controller.json"))
    assert done.status == 0
    assert done.messages[0].startswith(WARNING)


def test_other_radii_make_no_other_plant(folder: Path) -> None:
    """A controller for a file with radii is one for the same file with those of an option."""
    doubtful = Box.relative(plant("1"), "1/100").system
    save_system(doubtful, folder / "doubtful.json")
    where = str(folder / "own.controller.json")
    file = str(folder / "doubtful.json")
    assert run("design", "decentralized", file, "--rate=1", "-o", where).status == 0
    done = run("certify", file, where, "--uncertainty", "2%")
    assert (done.status, done.messages) == (0, [])
