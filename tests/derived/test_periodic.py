"""Plants in windows of several steps, and agents over graphs that vary, simulated step by step."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import design_extended, testing
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.sharing import shared_dimension_bound
from mcexact.constructions import held_system
from mcexact.derived.constructions import slow_system, union_graph
from mcexact.errors import InputError, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.periodic import differing, drawn, examined
from tests.oracle.windows import strongly_connected
from tests.wording import refusal

plants = testing.systems_on_graphs(
    testing.systems(max_states=3, max_channels=3, time="discrete"), longest_delay=0
)


@given(plants, st.integers(0, 3), st.integers(0, 10**6))
def test_a_window_takes_the_state_to_where_its_steps_do(drawn: Any, more: int, seed: int) -> None:
    """Inputs only in the last n steps, and the outputs of the first n."""
    plant, rng = drawn.system, random.Random(seed)
    n, m = plant.n, plant.m
    window = max(2 * n, 1) + more
    slow = slow_system(plant, window)
    start = x = Matrix.column([rng.randint(-3, 3) for _ in range(n)]) if n else Matrix.zeros(0, 1)
    u = [
        [Matrix.column([rng.randint(-3, 3) for _ in range(plant.p(i))]) for _ in range(n)]
        for i in range(m)
    ]
    seen: list[list[Fraction]] = [[] for _ in range(m)]
    for t in range(window):
        k = t - (window - n)
        for i in range(m):
            if t < n:
                seen[i] += [entry for [entry] in (plant.C(i) @ x).rows()]
        after = plant.A @ x
        for i in range(m):
            if k >= 0 and plant.p(i):
                after = after + plant.B(i) @ u[i][k]
        x = after
    end = slow.A @ start
    for i in range(m):
        inputs = [entry for part in u[i] if plant.p(i) for [entry] in part.rows()]
        if inputs:
            end = end + slow.B(i) @ Matrix.column(inputs)
        assert [entry for [entry] in (slow.C(i) @ start).rows()] == seen[i]
    assert end == x


def test_the_links_of_some_graphs_are_those_of_their_union_one_window_late() -> None:
    plant = MultiChannelSystem([[2]], [[[1]], [[0]]], [[[0]], [[1]]], time="discrete")
    graphs = [NeighborGraph(plant.names, [[1], []]), NeighborGraph(plant.names, [[], [0]])]
    slow = slow_system(plant, 3, graphs)
    assert slow.neighbors is not None
    assert slow.neighbors.edges() == ((0, 1), (1, 0))
    assert slow.neighbors.delays == ((0, 1, 1), (1, 0, 1))
    assert slow.subject == ({"construction": "slow", "window": 3},)


def test_powers_can_make_eigenvalues_equal_which_then_need_more() -> None:
    """1 and −1 are simple, and equal after two steps: the condition is not necessary."""
    ring = {"1": ["2"], "2": ["1"]}
    plant = MultiChannelSystem(
        [[1, 0], [0, -1]],
        [[[1], [1]], [[0], [0]]],
        [[[0, 0]], [[1, 1]]],
        time="discrete",
        neighbors=ring,
    )
    assert shared_dimension_bound(plant, share="states").deficiency == 1
    assert shared_dimension_bound(slow_system(plant, 4), share="states").deficiency == 2
    assert fixed_spectrum(held_system(slow_system(plant, 4), [2, 2])).empty
    assert not fixed_spectrum(held_system(slow_system(plant, 4), [1, 1])).empty


@pytest.mark.parametrize("number", range(8))
def test_a_certified_loop_over_graphs_that_vary_is_the_one_that_is_simulated(number: int) -> None:
    wrong, seen = examined(number)
    assert (wrong, seen["simulated"]) == ([], 1)


def test_a_loop_over_graphs_without_one_link_is_another_one() -> None:
    number = next(
        k
        for k in range(200)
        if examined(k)[1]["shared"] and not all(strongly_connected(graph) for graph in drawn(k)[1])
    )
    plant, graphs, window = drawn(number)
    names = plant.names
    slow = slow_system(plant, window, [NeighborGraph(names, graph) for graph in graphs])
    design = design_extended(slow, agent=names[0], network="held", dimensions="bound", radius="1/2")
    assert differing(plant, slow, design.controller, graphs, window) == []
    silent = [[{i} for i in range(plant.m)] for _ in graphs]
    with pytest.raises(KeyError):
        differing(plant, slow, design.controller, silent, window)


def test_arguments_are_refused_with_what_was_expected() -> None:
    A, B, C = [[1]], [[[1]], [[1]]], [[[1]], [[1]]]
    plant = MultiChannelSystem(A, B, C, time="discrete", neighbors={"1": ["2"]})
    with refusal(UsageError):
        slow_system(plant, 1)
    with pytest.raises(UsageError, match="discrete"):
        slow_system(MultiChannelSystem(A, B, C, neighbors={"1": ["2"]}), 2)
    with refusal(UsageError):
        slow_system(MultiChannelSystem(A, B, C, time="discrete"), 2)
    with refusal(InputError):
        union_graph([])
    with refusal(InputError):
        union_graph([NeighborGraph.ring(2), NeighborGraph.ring(3)])
    with pytest.raises(InputError, match="without delays"):
        union_graph([NeighborGraph(["1", "2"], [[1], []], [(0, 1, 1)])])
