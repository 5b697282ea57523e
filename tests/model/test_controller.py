"""Controllers as agent programs; the loop that they close, beside agents run one by one."""

import json
import random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.analysis.stability import certify_stability
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import feedback
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix, vstack
from mcexact.model.controller import (
    AgentProgram,
    Controller,
    LinearMap,
    controller_text,
    load_controller,
    read_controller,
    save_controller,
)
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from tests.wording import refusal


def drawn_matrix(rng, r, c):
    return Matrix.from_integers([[rng.randint(-2, 2) for _ in range(c)] for _ in range(r)], ncols=c)


def drawn_controller(rng, system, references=False, holding=False):
    """A controller that uses whatever each agent hears."""
    graph, m = system.neighbors, system.m
    shared = [rng.randint(0, 2) for _ in range(m)]
    private = [rng.randint(0, 2) for _ in range(m)]
    agents = []
    for i in range(m):
        heard = graph.neighborhood(i)

        def linear_map(rows, i=i, heard=heard):
            return LinearMap(
                {j: drawn_matrix(rng, rows, system.q(j)) for j in heard if rng.random() < 0.7},
                {j: drawn_matrix(rng, rows, shared[j]) for j in heard if rng.random() < 0.7},
                drawn_matrix(rng, rows, private[i]) if rng.random() < 0.7 else None,
                drawn_matrix(rng, rows, system.q(i)) if references else None,
            )

        hold = {k: rng.randint(0, 2) for k in graph.followers(i)} if holding else {}
        agents.append(
            AgentProgram(
                system.names[i],
                shared[i],
                private[i],
                linear_map(shared[i]),
                linear_map(private[i]),
                linear_map(system.p(i)),
                hold,
            )
        )
    return Controller(system.time, system.digest(), tuple(agents))


def run_agents(system, controller, state, steps, reference):
    """Run plant and agents one by one from a state of the loop without past messages.

    Returns the plant's and the agents' states after each step; agent i reads x_j(t−d_ij−hold) and
    y_j(t−d_ij), zeros before the start.
    """
    graph, agents, m = system.neighbors, controller.agents, system.m
    x, own, kept = state
    past = []
    trace = []
    for t in range(steps):
        outputs = [system.C(j) @ x for j in range(m)]
        past.append((outputs, own))

        def at(time, kind, j, past=past):
            return past[time][kind][j] if time >= 0 else 0 * past[0][kind][j]

        def evaluate(each, i, rows, t=t, at=at, kept=kept):
            total = Matrix.zeros(rows, 1)
            for j, M in each.outputs.items():
                total = total + M @ at(t - graph.delay(i, j), 0, j)
            for j, M in each.shared.items():
                total = total + M @ at(t - graph.delay(i, j) - agents[j].hold.get(i, 0), 1, j)
            if each.private is not None:
                total = total + each.private @ kept[i]
            if each.reference is not None:
                total = total + each.reference @ reference[i]
            return total

        u = [evaluate(agent.input, i, system.p(i)) for i, agent in enumerate(agents)]
        x = system.A @ x
        for i in range(m):
            x = x + system.B(i) @ u[i]
        own, kept = (
            [evaluate(agent.shared_update, i, agent.shared) for i, agent in enumerate(agents)],
            [evaluate(agent.private_update, i, agent.private) for i, agent in enumerate(agents)],
        )
        trace.append([x, *(part for i in range(m) for part in (own[i], kept[i]))])
    return trace


discrete = testing.systems_on_graphs(
    testing.systems(max_states=3, max_channels=3, time="discrete"), longest_delay=2
)


@given(discrete, st.integers(0, 10**6), st.booleans(), st.booleans())
def test_the_loop_matrix_moves_like_the_agents_themselves(drawn, seed, references, holding):
    system, rng = drawn.system, random.Random(seed)
    controller = drawn_controller(rng, system, references, holding)
    layout = closed_loop(system, controller)
    M, R = layout.matrix, layout.reference
    x = drawn_matrix(rng, system.n, 1)
    own = [drawn_matrix(rng, agent.shared, 1) for agent in controller.agents]
    kept = [drawn_matrix(rng, agent.private, 1) for agent in controller.agents]
    r = [drawn_matrix(rng, system.q(i), 1) for i in range(system.m)]
    visible = [x, *(part for i in range(system.m) for part in (own[i], kept[i]))]
    size = sum(part.nrows for part in visible)
    state = vstack([*visible, Matrix.zeros(M.nrows - size, 1)], ncols=1)
    for expected in run_agents(system, controller, (x, own, kept), 5, r):
        state = M @ state + R @ vstack(r, ncols=1)
        assert state.take(rows=range(size)) == vstack(expected, ncols=1)


@given(testing.systems_on_graphs(longest_delay=2), st.integers(0, 10**6))
def test_a_controller_file_gives_the_controller_and_the_loop_back(drawn, seed):
    system = drawn.system
    controller = drawn_controller(random.Random(seed), system, references=True, holding=True)
    copy = read_controller(controller_text(controller))
    assert copy.document() == controller.document() and copy.system == system.digest()
    assert closed_loop(system, copy).matrix == closed_loop(system, controller).matrix
    assert controller_text(copy) == controller_text(controller)


def test_a_controller_file_is_read_by_people():
    gains: list[list[Any]] = [["-0.0104", "1/3"], [2, f"1/{3**200}"]]
    plant = MultiChannelSystem([[1]], [[[1, 1]]], [[[1], [1]]], names=["1/2"])
    F = Matrix.from_rows(gains)
    controller = Controller(
        "continuous", plant.digest(), (AgentProgram("1/2", 0, 0, input=LinearMap({0: F})),)
    )
    text = controller_text(controller)
    assert '["-0.0104", "1/3"],\n' in text and f'[2, "1/{3**200}"]' in text
    assert '"name": "1/2"' in text and '"1/2": [' in text
    assert read_controller(text).document() == controller.document()


def test_static_programs_without_messages_are_decentralized_feedback():
    plant = MultiChannelSystem([[1, 2], [3, 4]], [[[1], [0]], [[0], [1]]], [[[1, 1]], [[0, 1]]])
    F = [Matrix.from_rows([[-5]]), Matrix.from_rows([["1/2"]])]
    agents = [AgentProgram(str(i + 1), 0, 0, input=LinearMap({i: F[i]})) for i in range(2)]
    controller = Controller("continuous", plant.digest(), tuple(agents))
    assert closed_loop(plant, controller).matrix == feedback(plant, F).A
    made = closed_loop(plant, controller).system
    assert made.m == 0 and made.plant == plant and made.plant.neighbors is None
    assert made.subject == ({"construction": "closed_loop", "controller": controller.document()},)
    assert controller.order == 0 and controller.edges() == () and controller.bit_length() == 3


def test_a_message_that_is_multiplied_by_zero_is_not_under_way():
    graph = NeighborGraph(("1", "2"), [[1], []], [(0, 1, 3)])
    plant = MultiChannelSystem(
        [[1]], [[[1]], [[1]]], [[[1]], [[1]]], time="discrete", neighbors=graph
    )
    agents = (
        AgentProgram("1", 0, 0, input=LinearMap({1: Matrix.zeros(1, 1)})),
        AgentProgram("2", 0, 0),
    )
    assert closed_loop(plant, Controller("discrete", "", agents)).matrix.shape == (1, 1)


ONE = Matrix.identity(1)


def plain(**changes):
    """The two-agent system of the refusals."""
    arguments = {"time": "discrete", "neighbors": {"1": ["2"]}, **changes}
    return MultiChannelSystem([[1]], [[[1]], [[1]]], [[[1]], [[1]]], **arguments)


@pytest.mark.parametrize(
    ("agents", "error", "message"),
    [
        ((AgentProgram("1", 0, 0),), UsageError, "expected the agents '1', '2' in this order"),
        (
            (AgentProgram("2", 0, 0), AgentProgram("1", 0, 0)),
            UsageError,
            "agents: expected the agents '1', '2' in this order, found '2', '1'",
        ),
        (
            (AgentProgram("1", 0, 0), AgentProgram("2", 0, 0, input=LinearMap({0: ONE}))),
            InputError,
            r"agents\[1\].input.outputs: agent '2' does not receive the signals of agent '1'",
        ),
        (
            (AgentProgram("1", 0, 0, input=LinearMap({1: Matrix.zeros(1, 2)})),) * 1
            + (AgentProgram("2", 0, 0),),
            InputError,
            r"agents\[0\].input.outputs\['2'\]: expected a 1 × 1 matrix, found 1 × 2",
        ),
        (
            (AgentProgram("1", 0, 0, input=LinearMap(private=ONE)), AgentProgram("2", 0, 0)),
            InputError,
            r"agents\[0\].input.private: expected a 1 × 0 matrix, found 1 × 1",
        ),
        (
            (
                AgentProgram("1", 0, 0, input=LinearMap(reference=Matrix.zeros(1, 2))),
                AgentProgram("2", 0, 0),
            ),
            InputError,
            r"agents\[0\].input.reference: expected a 1 × 1 matrix",
        ),
        (
            (AgentProgram("1", 0, 0, hold={1: 1}), AgentProgram("2", 0, 0)),
            InputError,
            r"agents\[0\].hold: agent '2' is not a follower",
        ),
    ],
)
def test_a_controller_that_does_not_fit_is_refused(agents, error, message):
    with pytest.raises(error, match=message):
        closed_loop(plain(), Controller("discrete", "", agents))


def test_time_domains_have_to_agree_and_continuous_time_knows_no_delays():
    agents = (AgentProgram("1", 0, 0), AgentProgram("2", 0, 0))
    with refusal(UsageError):
        closed_loop(plain(), Controller("continuous", "", agents))
    late = NeighborGraph(("1", "2"), [[1], []], [(0, 1, 1)])
    with refusal(UsageError):
        closed_loop(plain(time="continuous", neighbors=late), Controller("continuous", "", agents))
    held = (AgentProgram("1", 0, 0, hold={0: 1}), AgentProgram("2", 0, 0))
    with refusal(InputError):
        closed_loop(plain(time="continuous"), Controller("continuous", "", held))


def test_a_controller_of_a_derived_system_closes_its_loop():
    agents = (AgentProgram("1", 0, 0), AgentProgram("2", 0, 0))
    made = feedback(plain(), [[[1]], [[1]]])
    loop = closed_loop(made, Controller("discrete", "", agents)).system
    assert loop.A == made.A and loop.plant == plain()
    assert [each["construction"] for each in loop.subject] == ["feedback", "closed_loop"]
    verdict = check_document(encode(certify_stability(loop)).encode())
    assert verdict.verdict == "VALID", verdict.line()


def document(**changes):
    agent = {
        "name": "1",
        "shared": 1,
        "private": 0,
        "shared_update": {"shared": {"1": [["1/2"]]}},
        "private_update": {},
        "input": {"outputs": {"1": [[1]]}},
    }
    head = {"format": "mcexact-controller/1", "time": "discrete", "system": ""}
    top = {
        key: changes.pop(key) for key in ("format", "time", "system", "agents") if key in changes
    }
    return {**head, "agents": [{**agent, **changes}], **top}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": "mcexact-system/1"}, "expected a controller file, found a system file"),
        ({"time": "later"}, 'time: expected "continuous" or "discrete"'),
        ({"system": 3}, "system: expected the digest of a system"),
        ({"agents": []}, "agents: expected at least one agent, found none"),
        ({"agents": {}}, "agents: expected a list, found an object"),
        ({"name": ""}, r"agents\[0\].name: expected a name"),
        ({"shared": -1}, r"agents\[0\].shared: expected an integer >= 0, found -1"),
        ({"private": "1"}, r"agents\[0\].private: expected an integer >= 0"),
        ({"inputs": {}}, r"agents\[0\]: unknown key 'inputs' \(did you mean 'input'\?\)"),
        ({"input": {"output": {}}}, r"agents\[0\].input: unknown key 'output'"),
        ({"input": {"outputs": {"2": [[1]]}}}, r"input.outputs: there is no agent '2'"),
        ({"input": {"outputs": [[1]]}}, r"input.outputs: expected an object keyed by agents"),
        ({"shared_update": {"private": [[1], [1]]}}, "private: expected 1 row, found 2"),
        ({"input": {"outputs": {"1": [["x"]]}}}, r"outputs\['1'\]\[0\]\[0\]: expected an integer"),
        (
            {"input": {"outputs": {"1": [[1], [2]]}, "shared": {"1": [[1]]}}},
            r"agents\[0\].input: expected matrices of one number of rows, found 1 and 2",
        ),
        ({"hold": {"1": -1}}, r"agents\[0\].hold\['1'\]: expected an integer >= 0"),
        ({"hold": {"7": 1}}, r"agents\[0\].hold: there is no agent '7'"),
    ],
)
def test_a_malformed_controller_file_is_refused_with_its_place(changes, message):
    with pytest.raises(InputError, match=message):
        read_controller(json.dumps(document(**changes)))


def test_controller_files_are_loaded_and_saved_by_name(tmp_path):
    path = tmp_path / "controller.json"
    save_controller(read_controller(json.dumps(document())), path)
    assert (
        load_controller(path).agents[0].shared_update.shared[0][0, 0]
        == Matrix.from_rows([["1/2"]])[0, 0]
    )
    path.write_text("{}")
    with pytest.raises(InputError, match=r"controller\.json: the key 'format' is missing"):
        load_controller(path)
