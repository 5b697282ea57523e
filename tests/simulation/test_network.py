"""Agents on a network: only what links bring is used, and the whole moves like its matrix."""

import random
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.errors import FloatRefused, InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.controller import AgentProgram, Controller, LinearMap, controller_text
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.simulation.network import ExactArithmetic, InitialState, Network, SignalNotReceived
from mcexact.simulation.trajectory import simulate
from mcexact.synthesis.distributed_observer import design_observer
from tests.assurance.campaigns.observer import compare_discrete, one_design
from tests.model.test_controller import drawn_controller
from tests.oracle.controller_loop import applied, loop_rows
from tests.synthesis.three_channels import three_channels
from tests.wording import refusal

discrete = testing.systems_on_graphs(
    testing.systems(max_states=3, max_channels=3, time="discrete"), longest_delay=2
)


@given(discrete, st.integers(0, 10**6), st.booleans())
def test_steps_are_powers_of_the_matrix_assembled_from_the_file(drawn, seed, holding):
    system, rng = drawn.system, random.Random(seed)
    controller = drawn_controller(rng, system, holding=holding)
    matrix = loop_rows(system.canonical_document(), controller_text(controller))
    initial = InitialState(
        tuple(Fraction(rng.randint(-3, 3)) for _ in range(system.n)),
        tuple(
            tuple(Fraction(rng.randint(-3, 3)) for _ in range(a.shared)) for a in controller.agents
        ),
        tuple(tuple(Fraction(1) for _ in range(a.private)) for a in controller.agents),
    )
    run = simulate(system, controller, initial=initial, horizon=5)
    size = len(run.snapshots[0].flat())
    state = run.snapshots[0].flat() + [Fraction(0)] * (len(matrix) - size)
    for snapshot in run.snapshots[1:]:
        state = applied(matrix, state)
        assert snapshot.flat() == state[:size]


@pytest.mark.parametrize("seed", [1, 3, 5])
def test_an_observer_moves_like_the_powers_of_its_loop(seed):
    system, design = one_design(seed)
    assert system.time == "discrete"
    compare_discrete(system, design, seed)


@pytest.fixture(scope="module")
def deadbeat():
    return design_observer(
        three_channels("discrete"), spectrum={"feedback": [0] * 3, "error": [0] * 11}
    )


@pytest.mark.parametrize("q", ["1", "2", "3"])
def test_deadbeat_errors_are_exactly_zero_after_eleven_steps(q):
    system = three_channels("discrete")
    design = design_observer(system, agent=q, spectrum={"feedback": [0] * 3, "error": [0] * 11})
    rng = random.Random(int(q))
    initial = InitialState(
        tuple(Fraction(rng.randint(-9, 9)) for _ in range(3)),
        tuple(tuple(Fraction(rng.randint(-9, 9)) for _ in range(3)) for _ in range(3)),
        tuple(
            tuple(Fraction(rng.randint(-9, 9)) for _ in range(agent.private))
            for agent in design.controller.agents
        ),
    )
    run = simulate(system, design.controller, initial=initial, horizon=14)
    assert any(any(e) for e in run.errors(0))
    assert not any(any(e) for k in (11, 12, 13, 14) for e in run.errors(k))
    assert not any(run.snapshots[14].plant)


def test_removing_any_edge_in_use_makes_the_agents_refuse(deadbeat):
    system = three_channels("discrete")
    graph, used = system.neighbors, deadbeat.controller.edges()
    assert set(used) == {(1, 0), (2, 1), (0, 2)}
    for edge in used:
        edges = [(j, i) for j, i in graph.edges() if (j, i) != edge]
        fewer = NeighborGraph(graph.names, [[j for j, k in edges if k == i] for i in range(3)])
        with pytest.raises(SignalNotReceived, match="does not receive"):
            simulate(system, deadbeat.controller, fewer)


def test_removing_any_edge_in_use_of_a_drawn_observer_makes_the_agents_refuse():
    system, design = one_design(7)
    graph = system.neighbors
    assert design.controller.edges()
    for edge in design.controller.edges():
        heard = [[j for j in graph.neighborhood(i) if (j, i) != edge] for i in range(system.m)]
        with pytest.raises(SignalNotReceived):
            simulate(system, design.controller, NeighborGraph(graph.names, heard), horizon=1)


def test_an_edge_more_changes_nothing(deadbeat):
    system = three_channels("discrete")
    complete = NeighborGraph.complete(system.names)
    first = simulate(system, deadbeat.controller, horizon=5)
    second = simulate(system, deadbeat.controller, complete, horizon=5)
    assert first.snapshots == second.snapshots


def test_a_delay_is_felt(deadbeat):
    system = three_channels("discrete")
    late = NeighborGraph(system.names, system.neighbors.neighbors, [(0, 1, 1)])
    first = simulate(system, deadbeat.controller, horizon=5)
    second = simulate(system, deadbeat.controller, late, horizon=5)
    assert first.snapshots != second.snapshots


def relay(hold=None):
    """Agent 1 sends x_1(t+1) = y_1(t); agent 2 keeps x_2(t+1) = x_1 as it arrives."""
    one = AgentProgram("1", 1, 0, LinearMap({0: Matrix.identity(1)}), hold=hold or {})
    two = AgentProgram("2", 1, 0, LinearMap(shared={0: Matrix.identity(1)}))
    return Controller("discrete", "", (one, two))


@pytest.mark.parametrize(("delay", "hold"), [(0, 0), (2, 0), (0, 2), (1, 3)])
def test_a_message_takes_the_delay_of_its_link_and_the_time_it_is_held(delay, hold):
    graph = NeighborGraph(("1", "2"), [[], [0]], [(1, 0, delay)])
    plant = MultiChannelSystem([[2]], [[[0]]] * 2, [[[1]], [[0]]], time="discrete", neighbors=graph)
    run = simulate(plant, relay({1: hold}), horizon=8)
    seen = [snapshot.shared[1][0] for snapshot in run.snapshots]
    wait = 2 + delay + hold
    assert seen == [0] * wait + [2**k for k in range(9 - wait)]


def test_own_signals_need_no_link_but_can_be_held():
    agent = AgentProgram(
        "1",
        1,
        0,
        LinearMap({0: Matrix.identity(1)}),
        LinearMap(),
        LinearMap(shared={0: Matrix.identity(1)}),
        {0: 1},
    )
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete")
    run = simulate(plant, Controller("discrete", "", (agent,)), horizon=3)
    # x_1(1) = y(0) = 1 is used at t = 2, so x(3) = 1
    assert [snapshot.plant[0] for snapshot in run.snapshots] == [1, 0, 0, 1]


def test_set_points_reach_their_agent_only():
    pull = LinearMap(reference=Matrix.identity(1))
    agents = (AgentProgram("1", 0, 0, input=pull), AgentProgram("2", 0, 0, input=pull))
    plant = MultiChannelSystem(
        [[0, 0], [0, 0]], [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]], time="discrete"
    )
    run = simulate(plant, Controller("discrete", "", agents), horizon=1, reference=[[3], [5]])
    assert run.snapshots[1].plant == [3, 5]


def test_shapes_are_checked_before_anything_runs():
    plant = MultiChannelSystem([[0]], [[[1]]], [[[1]]], time="discrete")
    wrong = AgentProgram("1", 0, 0, input=LinearMap({0: Matrix.zeros(2, 1)}))
    with pytest.raises(InputError, match="expected a 1 × 1 matrix, found 2 × 1"):
        Network(
            plant,
            Controller("discrete", "", (wrong,)),
            NeighborGraph.empty(("1",)),
            ExactArithmetic(),
        )


@pytest.mark.parametrize(
    ("options", "kind", "message"),
    [
        ({"horizon": "1/2"}, UsageError, "number of steps"),
        ({"horizon": -1}, UsageError, "number of steps"),
        ({"arithmetic": "decimal"}, UsageError, "exact, multiprecision or float"),
        ({"reference": [[1]]}, InputError, "reference: expected 2 channels, found 1"),
        ({"reference": [[1], [1, 2]]}, InputError, r"reference\[1\]: expected 1 numbers"),
        ({"reference": [1, 2, 3]}, InputError, "reference: expected 2 numbers, found 3"),
        ({"steps": [(-1, [1, 1])]}, InputError, r"steps\[0\]: expected a time of at least 0"),
        ({"ramps": [(1, [1])]}, InputError, r"ramps\[0\]: expected 2 numbers"),
        ({"initial": [1, 2]}, InputError, "initial: expected 1 numbers"),
        ({"initial": [0.5]}, FloatRefused, r"initial\[0\]: a float is not exact"),
        ({"initial": InitialState((), ((), ()), ((), ()))}, InputError, "expected 1 numbers"),
    ],
)
def test_what_does_not_fit_is_said(options, kind, message):
    graph = NeighborGraph(("1", "2"), [[], [0]])
    plant = MultiChannelSystem([[2]], [[[0]]] * 2, [[[1]], [[0]]], time="discrete", neighbors=graph)
    with pytest.raises(kind, match=message):
        simulate(plant, relay(), **options)


def test_a_start_without_all_agents_is_refused():
    start = InitialState((Fraction(1),), (), ())
    plant = MultiChannelSystem([[1]], [[[1]]], [[[1]]], time="discrete")
    agents = Controller("discrete", "", (AgentProgram("1", 0, 0),))
    with refusal(InputError, where="initial"):
        simulate(plant, agents, initial=start)
