"""An answer about a derived system is read back with its system, whatever the constructions."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import mcexact
from mcexact.analysis.stability import open_loop_spectrum
from mcexact.derived.constructions import (
    add_links,
    feedback,
    full_output,
    regulated_outputs,
    servo_system,
)
from mcexact.derived.modulo import without_part
from mcexact.designs import PeriodicController, certify_periodic, local_controllers
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem

GRAPH = NeighborGraph(("a", "b"), [[1], [0]], [(0, 1, 2)])
PLANT = MultiChannelSystem(
    [["1/2", 1], [0, 2]],
    [[[1, 0], [0, 0]], [[], []]],
    [[[1, 1]], [[0, 1], [1, 0]]],
    time="discrete",
    names=["a", "b"],
    neighbors=GRAPH,
)
CONTINUOUS = MultiChannelSystem(
    [["-1/2", 1], [0, 2]], [[[1, 0], [0, 0]], [[], []]], [[[1, 1]], [[0, 1]]], names=["a", "b"]
)
HIDDEN = MultiChannelSystem(
    [[1, 0, 0], [0, "1/3", 0], [0, 0, "1/3"]],
    [[[1], [1], [0]], [[0], [2], [1]]],
    [[[0, 2, -1]], [[3, 0, 0]]],
    names=["a", "b"],
)
ONE_WAY = PLANT.with_neighbors(NeighborGraph(("a", "b"), [[], [0]]))
GAINS = [[["1/3"], [2]], []]
FEEDBACK = [[["1/3", 0], [2, -1]], []]


MADE: dict[str, Callable[[], MultiChannelSystem]] = {
    "the plant": lambda: PLANT,
    "augmented_outputs": lambda: mcexact.constructions.augmented_outputs(PLANT),
    "dual": lambda: mcexact.constructions.dual(PLANT),
    "failed": lambda: mcexact.constructions.failed(PLANT, sensors=[("b", 1)], links=[("a", "b")]),
    "feedback": lambda: feedback(PLANT, GAINS),
    "full_output": lambda: full_output(PLANT, 1),
    "arcs": lambda: add_links(ONE_WAY, [(1, 0)]),
    "extended": lambda: mcexact.constructions.extended_system(PLANT, [1, 2], "states"),
    "lifted": lambda: mcexact.constructions.lifted_system(PLANT, [1, 0]),
    "held": lambda: mcexact.constructions.held_system(PLANT, [0, 2]),
    "slow": lambda: mcexact.constructions.slow_system(PLANT, 2 * PLANT.n),
    "input_filters": lambda: mcexact.constructions.input_filters(PLANT),
    "integrators": lambda: mcexact.constructions.setpoint_system(PLANT),
    "regulated": lambda: regulated_outputs(PLANT, [[[2]], [["1/2", 1]]]),
    "sampled": lambda: mcexact.constructions.sampled_system(CONTINUOUS, "1/10", 1),
    "servo": lambda: servo_system(PLANT, [[], [[0, 1]]]),
    "internal_model": lambda: mcexact.constructions.internal_model(
        PLANT, "poly:z^2+1/2", [[], [[0, 1]]]
    ),
    "merged": lambda: mcexact.constructions.merged(PLANT, [["a", "b"]]),
    "modulo": lambda: without_part(HIDDEN, "unobservable", [[0, "1/2", 1]]),
    "restricted": lambda: mcexact.constructions.restricted(PLANT, ["b"]),
    "error": lambda: mcexact.constructions.error_system(PLANT, FEEDBACK),
    "several": lambda: mcexact.constructions.dual(
        full_output(mcexact.constructions.extended_system(add_links(ONE_WAY, [(1, 0)]), [0, 1]), 0)
    ),
}


def test_a_line_is_made_again(tmp_path: Path) -> None:
    ports = [[["a"], [1]], [["b"], [1]]], [[[1, "a*b"]], [[0, 1]]]
    plant = mcexact.ParametricSystem([["a", 1], [0, "b"]], *ports, parameters=["a", "b"])
    line = mcexact.constructions.along_line(plant, {"a": 1, "b": 0}, {"a": "1/2", "b": -1})
    for found in (mcexact.fixed_spectrum(line), mcexact.joint_observability(line)):
        mcexact.save_certificate(found, tmp_path / "line.json", system_by_digest=True)
        read = mcexact.load_certificate(tmp_path / "line.json", plant)
        assert read == found and read.about.subject == found.about.subject


@pytest.mark.parametrize("name", MADE)
def test_the_system_of_an_answer_is_made_again(name: str, tmp_path: Path) -> None:
    system = MADE[name]()
    for found in (mcexact.fixed_spectrum(system), mcexact.transfer_graph(system)):
        file = tmp_path / f"{found.kind}.json"
        mcexact.save_certificate(found, file)
        read = mcexact.load_certificate(file)
        assert read == found
        assert read.about == system
        assert read.to_dict() == found.to_dict()


def test_a_loop_over_a_period_is_made_again(tmp_path: Path) -> None:
    plant = gallery.load("movable-by-periodic-gains")
    gains = [local_controllers(plant, each) for each in ([[[0]], [["1/4"]]], [[[1]], [[0]]])]
    found = certify_periodic(plant, PeriodicController(tuple(gains)), radius="9/10")
    mcexact.save_certificate(found, tmp_path / "loop.json")
    read = mcexact.load_certificate(tmp_path / "loop.json")
    assert read == found
    assert read.about == found.about


def test_a_closed_loop_is_made_again(tmp_path: Path) -> None:
    plant = MultiChannelSystem(
        [[2]], [[[1]], [[1]]], [[[1]], [[1]]], neighbors={"1": ["2"], "2": ["1"]}
    )
    made = mcexact.design_observer(plant, rate=1)
    system = closed_loop(plant, made.controller).system
    for found in (open_loop_spectrum(system), mcexact.questions.certify_stability(system, rate=1)):
        mcexact.save_certificate(found, tmp_path / "loop.json")
        read = mcexact.load_certificate(tmp_path / "loop.json")
        assert read == found
        assert read.about == system
