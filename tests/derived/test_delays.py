"""Lifted and held systems against hand-written matrices, and against messages really sent late."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.derived.constructions import extended_system, held_system, lifted_system
from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix, vstack
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem


def paper(delay):
    """The paper's example in discrete time, with this delay on every link."""
    found = gallery.load("liu2020-3ch-no-communication")
    ring = NeighborGraph.ring(found.names)
    delays = [(i, j, delay) for j, i in ring.edges()]
    return MultiChannelSystem(
        found.A,
        [channel.B for channel in found.channels],
        [channel.C for channel in found.channels],
        time="discrete",
        neighbors=NeighborGraph(found.names, ring.neighbors, delays),
    )


def test_the_paper_s_example_with_delay_3_on_every_link():
    assert lifted_system(paper(3), [0, 0, 1]).n == 19
    assert held_system(paper(3), [1, 0, 1]).n == 11
    # n + Σ (n_i + d_i n_i), without the outputs on the links.
    assert lifted_system(paper(3), [0, 0, 1], "states").n == 7


def pair(delay):
    """One state, two agents, the first hears the second."""
    graph = NeighborGraph(("1", "2"), [[1], []], [(0, 1, delay)])
    return MultiChannelSystem(
        [[7]], [[[1]], [[2]]], [[[3]], [[5]]], time="discrete", neighbors=graph
    )


def test_the_lifted_matrices_are_the_paper_s():
    """State (x, x_1, x_2(t), x_2(t−1), x_2(t−2), y_2(t−1), y_2(t−2)); d_1 = 0, d_2 = 2."""
    made = lifted_system(pair(2), [1, 1])
    assert made.A.numerators == (
        (7, 0, 0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0, 0, 0),
        (0, 0, 1, 0, 0, 0, 0),
        (0, 0, 0, 1, 0, 0, 0),
        (5, 0, 0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0, 1, 0),
    )
    assert made.B(1).T.numerators == ((2, 0, 0, 0, 0, 0, 0), (0, 0, 1, 0, 0, 0, 0))
    assert made.C(0).numerators == (
        (3, 0, 0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0, 0, 1),
        (0, 1, 0, 0, 0, 0, 0),
        (0, 0, 0, 0, 1, 0, 0),
    )
    assert made.C(1).numerators == ((5, 0, 0, 0, 0, 0, 0), (0, 0, 1, 0, 0, 0, 0))
    assert made.subject[-1] == {
        "construction": "lifted",
        "share": "outputs+states",
        "dimensions": [1, 1],
    }


def test_the_held_matrices_are_the_paper_s():
    """State (x, x_1, x_2(t), x_2(t−1), x_2(t−2)); agent 2 uses its own x_2(t−2)."""
    made = held_system(pair(2), [1, 1])
    assert made.A.numerators == (
        (7, 0, 0, 0, 0),
        (0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0),
        (0, 0, 1, 0, 0),
        (0, 0, 0, 1, 0),
    )
    assert made.B(1).T.numerators == ((2, 0, 0, 0, 0), (0, 0, 1, 0, 0))
    assert made.C(0).numerators == ((3, 0, 0, 0, 0), (0, 1, 0, 0, 0), (0, 0, 0, 0, 1))
    assert made.C(1).numerators == ((5, 0, 0, 0, 0), (0, 0, 0, 0, 1))
    assert made.subject[-1] == {"construction": "held", "dimensions": [1, 1]}


@pytest.mark.parametrize("share", ["outputs+states", "states"])
def test_without_delays_lifted_and_held_are_the_extended_system(share):
    plant = paper(0)
    extended = extended_system(plant, [1, 0, 2], share)
    lifted = lifted_system(plant, [1, 0, 2], share)
    assert lifted.A == extended.A and lifted.channels == extended.channels
    held = held_system(plant, [1, 0, 2])
    states = extended_system(plant, [1, 0, 2], "states")
    assert held.A == states.A and held.channels == states.channels


discrete_on_graphs = testing.systems_on_graphs(
    testing.systems(max_states=3, max_channels=3, time="discrete"), longest_delay=3
)


@given(discrete_on_graphs, st.data())
def test_agents_of_the_lifted_system_see_what_links_with_delays_bring(drawn, data):
    system = drawn.system
    share = data.draw(st.sampled_from(["outputs+states", "states"]))
    made, history = simulate(data, system, lambda n: lifted_system(system, n, share))
    for t, (state, past) in enumerate(history):
        for i in range(system.m):
            heard = system.neighbors.neighborhood(i)
            d = [system.neighbors.delay(i, j) for j in heard]
            outputs = [(late, j) for late, j in zip(d, heard, strict=True)]
            if share == "states":
                outputs = [(0, i)]
            seen = [past(t - late)[0][j] for late, j in outputs if not late]
            seen += [past(t - late)[0][j] for late, j in outputs if late]
            seen += [past(t - late)[1][j] for late, j in zip(d, heard, strict=True)]
            assert made.C(i) @ state == vstack(seen, ncols=1)


@given(discrete_on_graphs, st.data())
def test_agents_of_the_held_system_all_see_the_same_old_substate(drawn, data):
    system = drawn.system
    made, history = simulate(data, system, lambda n: held_system(system, n))
    for t, (state, past) in enumerate(history):
        for i in range(system.m):
            heard = system.neighbors.neighborhood(i)
            held = [past(t - system.neighbors.longest_delay(j))[1][j] for j in heard]
            assert made.C(i) @ state == vstack([past(t)[0][i], *held], ncols=1)


def simulate(data, system, make):
    """Run a system from rest under drawn inputs, beside the plant with queues of past signals."""
    m = system.m
    sizes = data.draw(st.lists(st.integers(0, 2), min_size=m, max_size=m))
    made = make(sizes)
    rng = data.draw(st.randoms(use_true_random=False))

    def column(size):
        return Matrix.from_integers([[rng.randint(-3, 3)] for _ in range(size)], ncols=1)

    x, shared = Matrix.zeros(system.n, 1), [Matrix.zeros(n, 1) for n in sizes]
    state, signals, history = Matrix.zeros(made.n, 1), [], []

    def past(t):
        if t >= 0:
            return signals[t]
        return [Matrix.zeros(system.q(j), 1) for j in range(m)], [Matrix.zeros(n, 1) for n in sizes]

    for _ in range(6):
        signals.append(([system.C(j) @ x for j in range(m)], shared))
        history.append((state, past))
        u, v = [column(system.p(i)) for i in range(m)], [column(n) for n in sizes]
        state = made.A @ state
        x = system.A @ x
        for i in range(m):
            state = state + made.B(i) @ vstack([u[i], v[i]], ncols=1)
            x = x + system.B(i) @ u[i]
        shared = v
    return made, history


def test_continuous_time_has_no_delays_here():
    plant = gallery.load("liu2020-3ch-no-communication")
    plant = plant.with_neighbors(NeighborGraph.ring(plant.names))
    for make in (lifted_system, held_system):
        with pytest.raises(UsageError, match="discrete time only"):
            make(plant, [1, 1, 1])


def test_absurd_delays_are_refused_before_memory_is_used():
    for make in (lifted_system, held_system):
        with pytest.raises(LimitReached, match="states, more than 20000"):
            make(pair(10**9), [1, 1])
