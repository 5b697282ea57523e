"""Arguments of the wrong kind: every message says what was expected, and what was found."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

import mcexact
from mcexact import MultiChannelSystem, NeighborGraph, StabilityRegion
from mcexact.designs import Aims
from mcexact.errors import FloatRefused, InputError, UsageError, one_of, several, shown_value

ONES = [[[1]], [[1]]]
PLANT = MultiChannelSystem([[1]], ONES, ONES, names=["pump", "valve"])
LINKED = PLANT.with_neighbors(NeighborGraph.ring(["pump", "valve"]))
CONTROLLER = mcexact.designs.local_controllers(PLANT, [[[-3]], [[0]]])
FLOATS = np.array([0.5, 1.5])
FRAME = pd.DataFrame([[1.0, 2.0]])
NAMES = {"np": np, "mcexact": mcexact, "Aims": Aims, "MultiChannelSystem": MultiChannelSystem}
NAMES |= {"NeighborGraph": NeighborGraph, "StabilityRegion": StabilityRegion, "ONES": ONES}
NAMES |= {"PLANT": PLANT, "LINKED": LINKED, "CONTROLLER": CONTROLLER}
NAMES |= {"FLOATS": FLOATS, "FRAME": FRAME}

SAID: dict[str, str] = {
    # Files.
    "mcexact.load_system([1])": "path: expected the name of a file, found list; matrices make a "
    "system with MultiChannelSystem(A, B, C)",
    "mcexact.load_controller(None)": "path: expected the name of a file, found NoneType",
    "mcexact.load_certificate(FRAME)": "path: expected the name of a file, found DataFrame",
    "mcexact.parameters.load_parametric_system(3)": "path: expected the name of a file, found int",
    "mcexact.save_system(PLANT, [1])": "path: expected the name of a file, found list",
    "mcexact.save_controller(CONTROLLER, 3)": "path: expected the name of a file, found int",
    "next(mcexact.sweep([PLANT], results=3))": "path: expected the name of a file, found int",
    "mcexact.load_certificate('c.json', system=[1])": "c.json: there is no such file",
    "mcexact.gallery([1])": "there is no system list in the gallery",
    # Lists.
    "MultiChannelSystem([[1]], ONES, ONES, names=2)": "names: expected a list of names, found 2",
    "MultiChannelSystem([[1]], ONES, ONES, names='ab')": "names: expected a list of names, found "
    "'ab': write ['ab']",
    "mcexact.joint_controllability(PLANT, 'pump')": "channels: expected a list of names, found "
    "'pump': write ['pump']",
    "mcexact.joint_controllability(PLANT, [0])": "there is no channel 0; the channels are 'pump', "
    "'valve'",
    "mcexact.questions.pencil_rank(PLANT, None, 1)": "channels: expected a list of names, found "
    "None",
    "mcexact.analyze(PLANT, 3)": "questions: expected a list of names, found 3",
    "mcexact.analyze(PLANT, [[1]])": "there is no question list; expected ",
    "mcexact.analyze(PLANT, also='completeness')": "also: expected a list of names, found "
    "'completeness': write ['completeness']",
    "mcexact.analyze(PLANT, subset=FRAME)": "subset: expected a list of names, found DataFrame",
    "mcexact.constructions.extended_system(LINKED, 2)": "dimensions: expected a list of integers, "
    "found 2",
    "mcexact.constructions.extended_system(LINKED, [0.5, 1])": "dimensions[0]: expected an "
    "integer >= 0",
    "mcexact.design_extended(LINKED, rate=1, dimensions=FLOATS)": "dimensions[0]: expected an "
    "integer >= 0",
    "mcexact.constructions.from_stacked([[1]], [[1]], [[1]], inputs=1, outputs=[1])": "inputs: "
    "expected a list "
    "of integers, found 1: write [1]",
    "mcexact.constructions.merged(PLANT, 3)": "parts: expected a list of lists of names, found 3",
    "mcexact.designs.local_controllers(PLANT, 3)": "parts: expected a list of controllers",
    "mcexact.sharing.minimal_shared_dimensions(LINKED, costs=1)": "costs: expected a list of "
    "numbers",
    "mcexact.minimal_communication(PLANT, forbidden=['pump'])": "forbidden: expected links as "
    "pairs (sender, receiver) of names, found 'pump'",
    "mcexact.minimal_communication(PLANT, costs=[1])": "costs: expected a Mapping, found list",
    "mcexact.simulate(PLANT, CONTROLLER, initial=1)": "initial: expected a list of numbers",
    "mcexact.simulate(PLANT, CONTROLLER, steps=[1])": "steps[0]: expected a pair (time, numbers)",
    "mcexact.simulate(PLANT, CONTROLLER, ramps=1)": "ramps: expected a list of pairs (time, num",
    "mcexact.simulate(PLANT, CONTROLLER, points=FRAME)": "points: expected an integer, found Data",
    # Numbers.
    "mcexact.simulate(PLANT, CONTROLLER, horizon=FLOATS)": "expected a number, found an array of "
    "shape (2,)",
    "mcexact.certify_controller(PLANT, CONTROLLER, rate=FLOATS)": "rate: expected a number, found "
    "an array of shape (2,)",
    "mcexact.questions.pencil_rank(PLANT, ['pump'], 'fast')": "expected an integer, a decimal",
    "Aims(margin='0.5')": "margin: expected a number, found '0.5'",
    "Aims(effort=[1])": "effort: expected a number of seconds, found list",
    # Choices.
    "MultiChannelSystem([[1]], ONES, ONES, time=FLOATS)": 'time: expected "continuous" or "disc',
    "MultiChannelSystem.from_float([[0.5]], ONES, ONES, rounding='up')": 'rounding: expected "dec',
    "mcexact.analyze(PLANT, information=[1])": 'information: expected "own" or "outputs", found l',
    "mcexact.sharing.shared_dimension_bound(LINKED, share='all')": 'share: expected "outputs+sta',
    "mcexact.minimal_communication(PLANT, share=3)": 'share: expected "outputs", "outputs+states"',
    "mcexact.design_extended(LINKED, rate=1, network='lift')": 'network: expected "extended", "li',
    "mcexact.design_observer(LINKED, rate=1, order=1)": 'order: expected "least" or "low", found 1',
    "mcexact.design_setpoint(PLANT, rate=1, method=1)": 'method: expected "observer" or "extended',
    "mcexact.design_decentralized(PLANT, rate=1, arithmetic=FLOATS)": 'arithmetic: expected "exac',
    "mcexact.certify_controller(PLANT, CONTROLLER, method='routh')": 'method: expected "polynomia',
    "mcexact.questions.single_channel_gains(PLANT, want=3)": "want: expected ",
    # Objects of another type.
    "mcexact.minimal_communication(PLANT, region=0.5)": "region: expected a StabilityRegion",
    "mcexact.design_decentralized(PLANT, aims={'margin': 0.5})": "aims: expected an Aims, found d",
    "mcexact.simulation.proved_envelope(CONTROLLER)": "run: expected a Trajectory, found "
    "Controller",
    "mcexact.pencil_ranks(PLANT, ['pump'], spectrum=[1])": "spectrum: expected a ClosedLoopSpect",
    "mcexact.completeness(PLANT, spectrum=[1])": "spectrum: expected a FixedSpectrum, found list",
    "mcexact.assignability(PLANT, graph=[1])": "graph: expected a TransferGraph, found list",
    "next(mcexact.constructions.parameter_grid(PLANT, {'t': [1]}))": "plant: expected a "
    "ParametricSystem",
    "mcexact.boxes.box_controllability([[1]])": "system: expected a MultiChannelSystem, found list",
    "mcexact.boxes.box_observability([[1]])": "system: expected a MultiChannelSystem, found list",
    "mcexact.boxes.box_fixed_modes(FLOATS)": "system: expected a MultiChannelSystem, found ndarray",
    "mcexact.boxes.box_stabilizability(FRAME)": "system: expected a MultiChannelSystem, found "
    "DataF",
    "mcexact.boxes.box_stability(PLANT, [[1]])": "controller: expected a Controller, found list",
    # Graphs.
    "NeighborGraph.ring('abc')": "names: expected a list of names, or a number of agents, found",
    "NeighborGraph.ring(-1)": "names: expected a number of agents >= 0, found -1",
    "NeighborGraph(['a'], 3)": "neighbors: expected a list of sets of positions",
    "NeighborGraph(['a'], [3])": "neighbors[0]: expected a list of positions, found 3",
    "NeighborGraph(['a'], [[]], [1])": "delays[0]: expected a list of the two positions and the",
    "NeighborGraph(['a'], [[]], [(1, 2)])": "delays[0]: expected (i, j, d), found (1, 2)",
    "mcexact.sharing.neighbor_graph(PLANT, [1])": "neighbors: expected a NeighborGraph, "
    "a networkx.DiGraph or a mapping of names, found list",
}


@pytest.mark.parametrize("typed", SAID)
def test_the_message_says_what_was_expected_and_found(typed: str) -> None:
    with pytest.raises((InputError, UsageError)) as caught:
        eval(typed, dict(NAMES))
    assert SAID[typed] in str(caught.value) and "\n" not in str(caught.value)


def test_a_number_of_agents_stands_for_the_default_names() -> None:
    assert NeighborGraph.ring(3) == NeighborGraph.ring(["1", "2", "3"])
    assert NeighborGraph.complete(2).edges() == ((0, 1), (1, 0))
    assert NeighborGraph.empty(0).names == ()


def test_lists_of_all_kinds_are_lists() -> None:
    for value in (["1", "2"], ("1", "2"), iter(["1", "2"]), np.array(["1", "2"])):
        assert list(several(value, "names")) == ["1", "2"]
    with pytest.raises(InputError, match="expected a list of names, found ndarray with 2 dimens"):
        several(np.array([["1"]]), "names")


def test_a_choice_is_a_text_that_is_offered() -> None:
    one_of(None, (None, "least"), "order")
    for value in ("most", 1, FLOATS, {}):
        with pytest.raises(UsageError, match='order: expected "least", found'):
            one_of(value, (None, "least"), "order")


def test_a_value_is_told_shortly() -> None:
    found: list[Any] = [shown_value(each) for each in (1, True, 0.5, "a" * 50, FRAME)]
    assert found == ["1", "True", "0.5", ascii("a" * 40) + "…", "DataFrame"]
    assert len(shown_value(10**3000)) == 40


def test_a_float_is_still_refused_with_its_advice() -> None:
    with pytest.raises(FloatRefused):
        mcexact.questions.pencil_rank(PLANT, ["pump"], 0.5)
