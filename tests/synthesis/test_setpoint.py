"""Set-point control: integrators in the agents, and what no equilibrium holds."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from mcexact.answer.check import check
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import Expectation, check_document
from mcexact.errors import Impossible, InputError, UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model import gallery
from mcexact.model.controller import (
    AgentProgram,
    Controller,
    LinearMap,
    controller_text,
    read_controller,
)
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.design import Design
from mcexact.synthesis.optimum.figures import Aims
from mcexact.synthesis.setpoint import SetpointMethod, design_setpoint, with_integrators
from tests.assurance.campaigns import extended as campaign
from tests.wording import refusal, says


def two_tanks(time: str = "continuous") -> MultiChannelSystem:
    """Two levels that leak into each other, an inflow and a gauge for each agent."""
    return MultiChannelSystem(
        [[-2, 1], [1, -2]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 0]], [[0, 1]]],
        time=time,
        neighbors={"1": ["2"], "2": ["1"]},
    )


def require_valid(design: Design) -> None:
    for name, made in design.certificates.items():
        verdict = check_document(encode(made).encode())
        assert verdict.verdict == "VALID", f"{name}: {verdict.line()}"


@pytest.mark.parametrize("arithmetic", ["exact", "float"])
@pytest.mark.parametrize("method", ["observer", "extended"])
@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_both_methods_in_both_arithmetics(time: str, method: str, arithmetic: str) -> None:
    plant = two_tanks(time)
    bound = {"rate": 1} if time == "continuous" else {"radius": "1/2"}
    design = design_setpoint(plant, method=method, arithmetic=arithmetic, **bound)  # type: ignore[arg-type]
    require_valid(design)
    assert closed_loop(plant, design.controller).steady_gain == Matrix.identity(2)
    assert campaign.tracking_error(plant, design.controller, random.Random(1)) <= 1e-6


def test_a_four_tank_plant_in_floating_point() -> None:
    tanks = gallery.load("quadruple-tank-pminus")
    plant = tanks.with_neighbors(NeighborGraph.complete(tanks.names))
    design = design_setpoint(plant, rate="1/100", arithmetic="float")
    require_valid(design)
    wanted = [[Fraction(3)], [Fraction(-2)]]
    run = simulate(
        plant,
        design.controller,
        horizon=2000,
        points=4,
        reference=wanted,
        arithmetic="float",
    )
    state = run.snapshots[-1].plant
    for i, ((target,),) in enumerate(zip(wanted, strict=True)):
        (row,) = plant.C(i).rows()
        output = sum(float(c) * float(x) for c, x in zip(row, state, strict=True))
        assert abs(output / float(target) - 1) <= 1e-6


def test_prescribed_numbers_are_those_of_the_loop_with_the_plant() -> None:
    plant = two_tanks()
    spectrum = {"feedback": [-1, -2, -3, -4], "error": [-1, -2, -3] * 3}
    design = design_setpoint(plant, spectrum=spectrum)
    wanted = Polynomial.from_roots([-1, -2, -3, -4, *[-1, -2, -3] * 3])
    assert characteristic_polynomial(closed_loop(plant, design.controller).matrix) == wanted


def test_agents_take_their_own_reference_alone() -> None:
    design = design_setpoint(two_tanks(), rate=1)
    for agent in design.controller.agents:
        assert agent.private_update.reference is not None
        assert agent.private_update.reference.shape == (agent.private, 1)
        assert agent.input.reference is None
        assert agent.shared_update.reference is None
    text = controller_text(design.controller)
    assert read_controller(text.encode()).document() == design.controller.document()


def test_an_invariant_zero_at_0_is_refused_and_named() -> None:
    plant = MultiChannelSystem([[0, 1], [-2, -3]], [[[0], [1]]], [[[0, 1]]], neighbors={"1": []})
    with refusal(Impossible) as refused:
        design_setpoint(plant, rate=1)
    assert says(str(refused.value), "invariant zero")
    verdict = check_document(encode(refused.value.certificate).encode())
    assert verdict.verdict == "VALID"
    assert says(verdict.statement, "tends constant")


def test_dependent_outputs_are_refused_and_no_zero_is_named() -> None:
    plant = MultiChannelSystem(
        [[-1, 0], [0, -2]],
        [[[1], [0]], [[0], [1]]],
        [[[1, 1]], [[1, 1]]],
        neighbors={"1": ["2"], "2": ["1"]},
    )
    with pytest.raises(Impossible, match=r"\(-1, 1\) r ≠ 0") as refused:
        design_setpoint(plant, rate=1)
    assert "invariant zero" not in str(refused.value)
    assert refused.value.certificate.invariant_zero is False


def test_a_mode_that_nobody_controls_is_refused() -> None:
    plant = MultiChannelSystem([[1, 0], [0, -1]], [[[0], [1]]], [[[1, 1]]], neighbors={"1": []})
    with pytest.raises(Impossible, match="do not control") as refused:
        design_setpoint(plant, rate=1)
    assert refused.value.certificate.kind == "controllability"
    assert check_document(encode(refused.value.certificate).encode()).verdict == "VALID"


@pytest.mark.parametrize("method", ["observer", "extended"])
def test_a_cut_of_the_graph_is_refused_with_evidence_about_the_plant(method: str) -> None:
    plant = MultiChannelSystem(
        [[1]],
        [[[1]], Matrix.zeros(1, 0)],
        [Matrix.zeros(0, 1), [[1]]],
        neighbors={"1": [], "2": []},
    )
    with pytest.raises(Impossible) as refused:
        design_setpoint(plant, rate=1, method=method)  # type: ignore[arg-type]
    verdict = check_document(
        encode(refused.value.certificate).encode(), Expectation(system=plant.digest())
    )
    assert verdict.verdict == "VALID", verdict.line()


def test_delays_are_held_by_the_extended_method() -> None:
    plant = two_tanks("discrete")
    graph = NeighborGraph(plant.names, [[1], [0]], [(0, 1, 2), (1, 0, 1)])
    design = design_setpoint(plant, graph, radius="1/2", method="extended")
    slow = plant.with_neighbors(graph)
    assert campaign.tracking_error(slow, design.controller, random.Random(2)) <= 1e-6


def test_bad_calls_say_so() -> None:
    plant = two_tanks()
    with pytest.raises(UsageError, match="observer"):
        design_setpoint(plant, rate=1, method="sea")  # type: ignore[arg-type]
    with pytest.raises(UsageError, match="spectrum"):
        design_setpoint(plant, spectrum={}, arithmetic="float")


def test_integrators_of_another_agent_are_not_at_hand() -> None:
    plant = two_tanks()
    greedy = AgentProgram("1", 0, 0, input=LinearMap({1: Matrix.identity(1)}))
    idle = AgentProgram("2", 0, 0)
    with pytest.raises(InputError, match="integrators of another"):
        with_integrators(plant, Controller("continuous", "", (greedy, idle)))


def test_agents_that_are_searched_act_on_their_outputs_at_once() -> None:
    """Two tanks take proportional and integral control, without further states."""
    design = design_setpoint(two_tanks(), rate="1/2", aims=Aims(effort=1))
    for i, agent in enumerate(design.controller.agents):
        assert agent.private == 1 and set(agent.input.outputs) == {i}
    require_valid(design)


def test_what_agents_do_with_their_outputs_stays_theirs() -> None:
    plant = two_tanks()
    gains = Matrix.from_rows([[-3, -5]])
    given = AgentProgram("1", 0, 1, LinearMap(), LinearMap({0: gains}), LinearMap({0: gains}))
    made = with_integrators(
        plant, Controller("continuous", "", (given, AgentProgram("2", 0, 0)))
    ).agents[0]
    # w' = y − r, z' = −3 w − 5 y, u = −3 w − 5 y.
    assert made.private_update.outputs[0].rows() == ((1,), (-5,))
    assert made.private_update.private == Matrix.from_rows([[0, 0], [-3, 0]])
    assert made.input.outputs[0].rows() == ((-5,),)
    assert made.input.private == Matrix.from_rows([[-3, 0]])


def test_drawn_square_plants_reach_their_set_points() -> None:
    seen = campaign.setpoints(4, 1)
    assert seen["plants that satisfy the condition"] == 4


@pytest.mark.parametrize("method", [None, "extended"])
def test_without_links_a_refusal_is_about_the_plant_as_it_was_given(
    method: SetpointMethod | None,
) -> None:
    plant = gallery.load("hidden-triple-mode")
    assert plant.neighbors is None
    with pytest.raises(Impossible, match="no linear time-invariant decentralized") as refused:
        design_setpoint(plant, rate=1, method=method)
    assert check(refused.value.certificate, plant).valid
