"""Observers over any directed graph: what is fixed for their errors, designs, and refusals."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import augmented_outputs
from mcexact.errors import Impossible
from mcexact.model.system import MultiChannelSystem, with_graph
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.design import Design
from mcexact.synthesis.distributed_observer import design_observer
from mcexact.synthesis.networks import stays_over
from tests.assurance.campaigns.any_graph import closed_sets, examined


@pytest.mark.parametrize("number", range(4))
def test_modes_over_any_graph_are_those_of_closed_sets(number: int) -> None:
    """A sample of the campaign."""
    wrong, seen = examined(number)
    assert wrong == [] and seen["certificates"] >= 4


def test_a_closed_set_receives_nothing_from_outside() -> None:
    assert closed_sets([[0], [0, 1], [1, 2]]) == [(), (0,), (0, 1), (0, 1, 2)]


def canal(*links: tuple[str, str]) -> MultiChannelSystem:
    """Three pools below each other, of which the gates at the first two are moved."""
    names = ("head", "middle", "tail")
    graph = {name: [start for start, end in links if end == name] for name in names}
    return MultiChannelSystem(
        [[0, 0, 0], ["1/10", 0, 0], [0, "1/10", 0]],
        [[[1], [0], [0]], [[0], ["-1/5"], ["1/5"]], [[0], [0], [0]]],
        [[[1, 0, 0]], [[0, 1, 0]], [[0, 0, 1]]],
        names=names,
        neighbors=graph,
    )


DOWN = ("head", "middle"), ("middle", "tail")


@pytest.mark.parametrize("design", [design_observer, design_extended])
def test_a_refusal_names_the_agents_that_receive_too_little_and_the_mode(
    design: Callable[[MultiChannelSystem], Design],
) -> None:
    with pytest.raises(Impossible) as refused:
        design(canal(*DOWN))
    said: Any = refused.value.args[0]
    assert said.template.key == "refused-over-links"
    assert said.values["inside"] == ["head", "middle"] and said.values["outside"] == ["tail"]
    assert str(said.values["p"]) == "x"
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"


def proved(design: Design) -> bool:
    checked = [check_document(encode(each).encode()) for each in design.certificates.values()]
    return design.stable and all(each.verdict == "VALID" for each in checked)


def test_one_more_link_lets_the_observer_be_designed() -> None:
    design = design_observer(canal(*DOWN, ("tail", "middle")), rate="1/10")
    assert design.method == "observer" and proved(design)
    blocks = [block.agent for block in design.parts["blocks"]]
    assert len(blocks) > 1 and all(agent.shared == 3 for agent in design.controller.agents)
    assert "shared_fixed_spectrum" in design.certificates


def test_agents_that_do_not_observe_a_mode_leave_it_to_others_that_do() -> None:
    """The source component does not detect the mode 2, which agent b sees and moves."""
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]],
        [[[1], [1]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        names=("a", "b"),
        neighbors={"a": [], "b": ["a"]},
    )
    stays = stays_over(*with_graph(plant, None))
    assert stays is not None and stays.empty
    assert proved(design_observer(plant, rate="1/2"))
    assert proved(design_observer(plant, rate="1/2", arithmetic="float"))


def test_a_rate_that_is_chosen_is_slow_enough_for_stable_modes_that_stay() -> None:
    plant = MultiChannelSystem(
        [[1, 0], [0, "-1/100"]],
        [[[1], [0]], [[0], [0]]],
        [[[1, 0]], [[0, 1]]],
        names=("a", "b"),
        neighbors={"a": [], "b": ["a"]},
    )
    design = design_observer(plant)
    assert proved(design) and design.region.bound is not None and design.region.bound < 1 / 100


def test_what_is_measured_two_links_away_is_used() -> None:
    """Agent 1 sees the mode that agent 3 drives, and agent 2 passes on what it estimates."""
    chain = {"2": ["1"], "3": ["2"]}
    ports = [[[0]], [[0]], [[1]]], [[[1]], [[0]], [[0]]]
    plant = MultiChannelSystem([[1]], *ports, neighbors=chain)
    stays = stays_over(*with_graph(plant, None))
    assert stays is not None and stays.empty and not fixed_spectrum(augmented_outputs(plant)).empty
    assert proved(design_observer(plant, rate="1/2"))
