"""A stranger who has the page of controller files alone rebuilds the closed loop of each."""

import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest

from mcexact.derived.drawn.systems import Draw, drawn_system
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.controller import (
    AgentProgram,
    Controller,
    LinearMap,
    load_controller,
    save_controller,
)
from mcexact.model.files import save_system
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.statespace import local_controllers
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.decentralized import design_extended

SCRIPT = Path(__file__).with_name("stranger.py")


def rebuilt(system: MultiChannelSystem, controller: Controller, folder: Path) -> Matrix:
    """The matrix of the closed loop, from the files alone."""
    save_system(system, folder / "plant.json")
    save_controller(controller, folder / "controller.json")
    files = [str(folder / name) for name in ("plant.json", "controller.json")]
    done = subprocess.run(
        [sys.executable, "-I", str(SCRIPT), *files], capture_output=True, text=True, check=True
    )
    return Matrix.from_rows([[Fraction(x) for x in row] for row in json.loads(done.stdout)])


def test_the_script_knows_the_page_alone() -> None:
    assert "mcexact" not in SCRIPT.read_text(encoding="utf-8")


def test_static_and_dynamic_gains_are_rebuilt(tmp_path: Path) -> None:
    plant = gallery.load("quadruple-tank-pminus")
    parts = [[["-1/3"]], ([[-5]], [[1]], [["-0.6"]], [[0]])]
    controller = local_controllers(plant, parts)
    assert rebuilt(plant, controller, tmp_path) == closed_loop(plant, controller).matrix


def test_shared_states_are_rebuilt(tmp_path: Path) -> None:
    plant = gallery.load("liu2020-3ch-no-communication").with_neighbors(
        {"1": ["2"], "2": ["3"], "3": ["1"]}
    )
    controller = design_extended(plant, rate=1).controller
    assert controller.order > 0
    assert rebuilt(plant, controller, tmp_path) == closed_loop(plant, controller).matrix


@pytest.mark.parametrize("delay", [0, 1, 3])
def test_signals_that_are_late_are_rebuilt(delay: int, tmp_path: Path) -> None:
    drawn = drawn_system(Draw(3, states=3, channels=2, time="discrete"))
    graph = NeighborGraph(drawn.names, [[1], [0]], [(0, 1, delay), (1, 0, 1)])
    plant = drawn.with_neighbors(graph)
    entry = iter(range(1, 1000))

    def some(nrows: int, ncols: int) -> Matrix:
        return Matrix.from_rows(
            [[Fraction(next(entry), 7) for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
        )

    def program(i: int, shared: int, private: int) -> AgentProgram:
        def each(nrows: int) -> LinearMap:
            heard = {j: some(nrows, plant.q(j)) for j in (0, 1)}
            states = {j: some(nrows, (2, 1)[j]) for j in (0, 1)}
            return LinearMap(heard, states, some(nrows, private) if private else None)

        maps = each(shared), each(private), each(plant.p(i))
        return AgentProgram(plant.names[i], shared, private, *maps, hold={0: i, 1: 2 - i})

    controller = Controller("discrete", "", (program(0, 2, 1), program(1, 1, 0)))
    save_controller(controller, tmp_path / "c.json")
    assert load_controller(tmp_path / "c.json").order == 4
    assert rebuilt(plant, controller, tmp_path) == closed_loop(plant, controller).matrix
