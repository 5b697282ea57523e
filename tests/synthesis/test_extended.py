"""Designs through the extended system, with and without delays."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from mcexact.analysis.stability import certify_stability
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.drawn.networks import drawn_graph
from mcexact.derived.drawn.primary_form import SeededChoices
from mcexact.derived.drawn.systems import jointly_controllable_system
from mcexact.errors import Impossible, InputError, UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import controller_text, read_controller
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.decentralized import design_extended
from mcexact.synthesis.design import Design
from mcexact.synthesis.optimum.figures import THEOREM
from tests.synthesis.optimum.plants import delayed
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal


def late() -> MultiChannelSystem:
    """The paper's example in discrete time with delay 3 on every link."""
    plant = three_channels("discrete")
    graph = plant.neighbors
    assert graph is not None
    arcs = [(i, j, 3) for j, i in graph.edges()]
    return plant.with_neighbors(NeighborGraph(graph.names, graph.neighbors, arcs))


def dimensions_of(design: Design) -> tuple[int, ...]:
    """n_1 … n_m."""
    return tuple(design.parts["dimensions"].values())


def require_valid(design: Design) -> None:
    for name, made in design.certificates.items():
        verdict = check_document(encode(made).encode())
        assert verdict.verdict == "VALID", f"{name}: {verdict.line()}"


FREE = [Fraction(k, 16) for k in (-7, -5, -3, -1, 1, 3, 5, 7)] * 2


def test_the_papers_example_needs_less_than_the_observer() -> None:
    plant = three_channels()
    design = design_extended(plant, spectrum=["-1", "-2", {"re": "-1", "im": "3"}])
    assert dimensions_of(design) == (0, 0, 1)
    assert (design.order, design.parts["observer_order"]) == (1, 11)
    assert "single_channel_gains" in design.certificates, "that agent 3 reaches everything"
    loop = closed_loop(plant, design.controller).matrix
    wanted = Polynomial.from_roots([-1, -2]) * Polynomial.of(10, 2, 1)
    assert characteristic_polynomial(loop) == wanted
    require_valid(design)


@pytest.mark.parametrize("agent", ["1", "2", "3"])
@pytest.mark.parametrize("dimensions", ["minimal", "bound", [0, 1, 2]])
def test_any_agent_may_carry_the_channel_controller(agent: str, dimensions: object) -> None:
    plant = three_channels()
    design = design_extended(plant, agent=agent, dimensions=dimensions, rate=1)  # type: ignore[arg-type]
    (block,) = design.parts["blocks"]
    assert block.agent == agent
    assert design.order == sum(dimensions_of(design)) + block.order
    assert block.polynomial.degree == 3 + sum(dimensions_of(design)) + block.order
    require_valid(design)


def test_floating_point_meets_a_rate_and_the_proof_is_exact() -> None:
    design = design_extended(three_channels(), rate=2, arithmetic="float")
    assert "stability" in design.certificates
    assert design.certificates["stability"].claim()["stable"]
    require_valid(design)


def test_a_wrong_length_names_the_right_one() -> None:
    with pytest.raises(InputError, match="expected 4 numbers"):
        design_extended(three_channels(), spectrum=[-1, -2, -3])


def test_a_spectrum_for_the_observer_is_refused() -> None:
    with pytest.raises(InputError, match="closed_loop"):
        design_extended(three_channels(), spectrum={"feedback": [-1], "error": [-1]})


def test_floating_point_takes_no_spectrum() -> None:
    with refusal(UsageError):
        design_extended(three_channels(), spectrum=[-1], arithmetic="float")


def test_too_little_sharing_is_refused_with_the_fixed_modes() -> None:
    with pytest.raises(Impossible, match="moves the mode 1") as refused:
        design_extended(three_channels(), dimensions=[1, 0, 0], rate=1)
    assert refused.value.certificate.kind == "fixed_spectrum"
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"


def test_a_graph_that_no_sharing_mends_is_refused() -> None:
    plant = three_channels()
    with pytest.raises(Impossible) as refused:
        design_extended(plant, NeighborGraph.empty(plant.names), rate=1)
    assert refused.value.certificate.kind == "fixed_spectrum"
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"


def test_a_transfer_graph_that_no_sharing_connects_is_refused_as_such() -> None:
    plant = MultiChannelSystem(
        [[1, 0], [0, 2]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], neighbors={}
    )
    assert dimensions_of(design_extended(plant, rate=1)) == (0, 0)
    with refusal(Impossible) as refused:
        design_extended(plant, rate=1, free_assignability=True)
    assert refused.value.certificate.kind == "shared_dimensions"
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"


def test_delays_need_a_network_that_has_them() -> None:
    with pytest.raises(UsageError, match="lifted"):
        design_extended(late(), network="extended", radius=1)


def test_what_is_held_is_not_measured_outputs() -> None:
    with pytest.raises(UsageError, match="states"):
        design_extended(late(), network="held", share="outputs+states", radius=1)


def test_the_lifted_system_keeps_zero_alone() -> None:
    design = design_extended(late(), radius="1/2", aims=THEOREM)
    assert dimensions_of(design) == (0, 0, 1) and design.parts["fixed_spectrum"].about.n == 19
    assert design.parts["fixed_spectrum"].polynomial == Polynomial.x()
    assert not any(design.parts["kept"].coefficients[:-1])
    require_valid(design)


def test_the_held_system_takes_any_spectrum() -> None:
    plant = late()
    design = design_extended(plant, network="held", spectrum=FREE[:15], radius="1/2")
    assert dimensions_of(design) == (1, 0, 1) and design.parts["fixed_spectrum"].about.n == 11
    assert design.parts["fixed_spectrum"].empty
    assert design.parts["kept"].degree == 0
    loop = closed_loop(plant, design.controller).matrix
    assert characteristic_polynomial(loop) == Polynomial.from_roots(FREE[:15])
    require_valid(design)
    run = simulate(plant, design.controller, horizon=200)
    sizes = [max(map(abs, snapshot.flat())) for snapshot in run.snapshots]
    assert sizes[200] <= Fraction(1, 2) ** 80 * sizes[120], "slower than the certified radius"


def test_without_holding_the_loop_has_another_spectrum_and_a_proven_verdict() -> None:
    plant = late()
    design = design_extended(plant, network="held", spectrum=FREE[:15], radius="1/2")
    hasty = replace(
        design.controller,
        agents=tuple(replace(agent, hold={}) for agent in design.controller.agents),
    )
    loop = closed_loop(plant, hasty).system
    chi = characteristic_polynomial(loop.A)
    assert chi != Polynomial.from_roots(FREE[:15])
    verdict = certify_stability(loop)
    assert check_document(encode(verdict).encode()).verdict == "VALID"
    run = simulate(plant, hasty, horizon=120)
    grows = max(map(abs, run.snapshots[120].plant)) > max(map(abs, run.snapshots[60].plant))
    assert grows == (not verdict.stable)


def test_the_controller_file_holds_times_and_no_lifted_matrix() -> None:
    plant = late()
    design = design_extended(plant, network="held", radius="1/2", aims=THEOREM)
    text = controller_text(design.controller)
    assert read_controller(text.encode()).document() == design.controller.document()
    for i, agent in enumerate(design.controller.agents):
        assert all(steps == 3 for steps in agent.hold.values())
        assert set(agent.hold) <= {i}, "with equal delays only the own use has to wait"
        assert agent.shared == dimensions_of(design)[i]


def test_a_network_that_is_not_strongly_connected_is_assigned_block_by_block() -> None:
    plant = MultiChannelSystem(
        [[1, 0, 0], [0, 1, 2], [0, 0, 3]],
        [[[1], [0], [0]], [[0], [1], [0]], [[0], [0], [1]]],
        [[[1, 0, 0]], [[0, 1, 0]], [[0, 0, 1]]],
        neighbors={"1": [], "2": ["1"], "3": []},
    )
    design = design_extended(plant, spectrum={"1": ["-1"], "2": ["-2"], "3": ["-3"]})
    assert [block.channels for block in design.parts["blocks"]] == [("1",), ("2",), ("3",)]
    loop = closed_loop(plant, design.controller).matrix
    assert characteristic_polynomial(loop) == Polynomial.from_roots([-1, -2, -3])
    require_valid(design)
    with refusal(InputError):
        design_extended(plant, spectrum=[-1, -2, -3])


def test_fixed_modes_that_are_fast_enough_are_kept() -> None:
    plant = MultiChannelSystem(
        [[-5, 0], [0, 1]],
        [[[0], [1]], [[0], [0]]],
        [[[0, 1]], [[1, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    design = design_extended(plant, rate=1)
    assert design.parts["kept"] == Polynomial.from_roots([-5])
    require_valid(design)
    with pytest.raises(Impossible):
        design_extended(plant, rate=6)
    alone = design_extended(plant, spectrum=[-2])
    assert alone.parts["kept"] == Polynomial.from_roots([-5])
    assert characteristic_polynomial(alone.loop.matrix) == Polynomial.from_roots([-2, -5])
    require_valid(alone)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("network", ["lifted", "held"])
def test_drawn_networks_come_to_rest_with_late_messages(seed: int, network: str) -> None:
    choices = SeededChoices(f"rest {seed}")
    system = jointly_controllable_system(choices, 3, 3, time="discrete").system
    graph = drawn_graph(choices, system.names, strongly_connected=True, longest_delay=3)
    design = design_extended(system, graph, network=network, radius="1/100", aims=THEOREM)  # type: ignore[arg-type]
    require_valid(design)
    run = simulate(system, design.controller, graph, horizon=2 * design.loop.closed.dimension)
    assert not any(run.snapshots[-1].flat())


def test_over_delays_the_cheaper_network_is_kept_and_both_are_told() -> None:
    made = design_extended(delayed(), radius="19/20")
    assert made.parts["network"] in ("lifted", "held")
    [note] = made.notes
    assert f"the {made.parts['network']} one was kept (lifted: order" in note
    assert "; held: order" in note
    costs = {
        each: design_extended(delayed(), radius="19/20", network=each).parts["optimum"]
        for each in ("lifted", "held")
    }
    least = min(costs, key=lambda each: costs[each].figures.cost)
    assert made.parts["network"] == least


def test_a_network_with_delays_that_is_refused_leaves_the_other() -> None:
    """With share both, agents cannot hold; and for a prescribed spectrum nothing is compared."""
    made = design_extended(delayed(), radius="19/20", share="outputs+states")
    assert made.parts["network"] == "lifted" and not made.notes
