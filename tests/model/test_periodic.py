"""Periodic controllers: what is refused, their files, and their loops run step by step."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from mcexact.designs import (
    PeriodicController,
    load_periodic_controller,
    local_controllers,
    save_periodic_controller,
)
from mcexact.errors import InputError, McexactError
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.controller import (
    AgentProgram,
    Controller,
    LinearMap,
    is_controller,
    is_periodic,
    load_controller,
)
from mcexact.model.periodic import periodic_loop, periodic_text, read_periodic_controller
from mcexact.model.system import MultiChannelSystem
from tests.checker.test_subject import drawn_plant, periodic
from tests.oracle.periodic import monodromy_by_hand

PLANT = gallery.load("movable-by-periodic-gains")
EVEN = local_controllers(PLANT, [[[0]], [["121/500"]]])
ODD = local_controllers(PLANT, [[[1]], [[0]]])
GAINS = PeriodicController((ODD, EVEN))


def test_the_loop_over_a_period_is_what_agents_do_step_by_step() -> None:
    rng = random.Random(1)
    for _ in range(20):
        system = drawn_plant(rng, "discrete")
        controller = periodic(rng, system)
        phases = json.loads(periodic_text(controller))["phases"]
        for first in range(controller.period):
            expected = monodromy_by_hand(system, phases, first)
            later = PeriodicController(controller.phases[first:] + controller.phases[:first])
            assert periodic_loop(system, later).A.rows() == tuple(map(tuple, expected))


def test_the_known_gains_of_the_gallery() -> None:
    loop = periodic_loop(PLANT, GAINS)
    assert (loop.n, loop.m, loop.subject[-1]["construction"]) == (3, 0, "periodic_loop")
    assert (GAINS.period, GAINS.order, GAINS.names) == (2, 0, ("1", "2"))
    assert GAINS.bit_length() == 9
    assert "repeat after 2 steps" in GAINS.explain()


def test_a_file_is_read_back(tmp_path: Path) -> None:
    file = tmp_path / "gains.json"
    save_periodic_controller(GAINS, file)
    read = load_periodic_controller(file)
    assert read.to_dict() == GAINS.to_dict()
    assert read.system == PLANT.digest_of_values()
    assert read.warnings_for(PLANT) == ()
    assert is_controller(file.read_bytes())
    assert is_periodic(file.read_bytes())
    assert not is_periodic(json.dumps(EVEN.to_dict()).encode())
    with pytest.raises(InputError, match="this controller is periodic"):
        load_controller(file)


def changed(path: tuple[Any, ...], value: Any) -> str:
    """The file of the known gains with another value at one place."""
    document = GAINS.to_dict()
    place: Any = document
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return json.dumps(document)


FIRST = ("phases", 0, "agents", 0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[]", "expected a JSON object"),
        (changed(("format",), "mcexact-periodic-controller/2"), "mcexact-periodic-controller/1"),
        (changed(("time",), "continuous"), "expected 'discrete'"),
        (changed(("phases",), []), "expected at least one phase"),
        (changed(("phases",), {}), "expected a list"),
        (changed(("phases",), [{"agents": []}] * 1001), "at most 1000 phases"),
        (changed(("phases", 1), {}), r"phases\[1\].*agents"),
        (changed(("phases", 0, "agents"), []), r"phases\[0\].*at least one agent"),
        (changed((*FIRST, "shared"), 1), "share no states"),
        (changed((*FIRST, "private"), 1), "as many states"),
        (changed((*FIRST, "limits"), [[-1, 1]]), "no limits"),
        (changed((*FIRST, "input", "outputs", "2"), [[1]]), "uses its own output alone"),
        (changed((*FIRST, "input", "reference"), [[1]]), "no set-points"),
        (changed((*FIRST, "hold"), {"2": 1}), "share no states"),
        (changed(("phases", 1, "agents", 0, "name"), "3"), "agents of the first phase"),
        (changed((*FIRST, "input", "outputs"), {"1": [["a"]]}), r"phases\[0\]"),
    ],
)
def test_a_file_that_is_wrong_is_refused_with_its_place(text: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_periodic_controller(text)


def test_phases_in_continuous_time_are_refused() -> None:
    agent = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.from_rows([[1]])}))
    with pytest.raises(InputError, match="in discrete time"):
        PeriodicController((Controller("continuous", "", (agent,)),))


def test_a_controller_that_does_not_fit_is_refused() -> None:
    other = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    with pytest.raises(McexactError, match="agents"):
        periodic_loop(other, GAINS)
    direct = MultiChannelSystem(
        [[Fraction(1)]], [[[1]], [[1]]], [[[1]], [[1]]], time="discrete", D=[[0, 0], [1, 0]]
    )
    with pytest.raises(InputError, match="feedthrough"):
        periodic_loop(direct, GAINS)
