"""Neighbor graphs: construction, refusals, and conversion to and from networkx."""

import itertools

import networkx
import pytest
from hypothesis import given

from mcexact.errors import FloatRefused, InputError
from mcexact.model.graph import NeighborGraph
from mcexact.testing import neighbor_graphs

NAMES = ("a", "b", "c")


@given(neighbor_graphs(NAMES, longest_delay=3))
def test_networkx_and_names_give_the_same_graph_back(graph):
    assert NeighborGraph.from_networkx(graph.to_networkx(), NAMES) == graph
    neighbors = {NAMES[i]: [NAMES[j] for j in graph.neighborhood(i)] for i in range(3)}
    delays = {NAMES[i]: {NAMES[j]: d} for i, j, d in graph.delays}
    for i, j, d in graph.delays:
        delays[NAMES[i]][NAMES[j]] = d
    assert NeighborGraph.from_names(NAMES, neighbors, delays) == graph


@given(neighbor_graphs(NAMES, longest_delay=3))
def test_followers_unions_edges_and_delays_agree_with_the_neighborhoods(graph):
    for i, j in itertools.product(range(3), repeat=2):
        assert (j in graph.neighborhood(i)) == (i in graph.followers(j))
        assert (i != j and j in graph.neighborhood(i)) == ((j, i) in graph.edges())
        assert graph.delay(i, j) <= graph.longest_delay(j)
    assert graph.union([0, 2]) == tuple(sorted({*graph.neighborhood(0), *graph.neighborhood(2)}))
    assert graph.union([]) == ()
    for j in range(3):
        late = [graph.delay(i, j) for i in graph.followers(j)]
        assert graph.longest_delay(j) == max(late)


@given(neighbor_graphs(NAMES))
def test_strong_connectivity_is_reachability_both_ways(graph):
    reach = {(i, i) for i in range(3)} | set(graph.edges())
    for k, i, j in itertools.product(range(3), repeat=3):
        if (i, k) in reach and (k, j) in reach:
            reach.add((i, j))
    assert graph.is_strongly_connected() == (len(reach) == 9)


def test_the_ring_is_the_paper_s_cyclic_graph():
    ring = NeighborGraph.ring(("1", "2", "3"))
    assert [ring.neighborhood(i) for i in range(3)] == [(0, 1), (1, 2), (0, 2)]
    assert NeighborGraph.complete(NAMES).edges() == tuple(itertools.permutations(range(3), 2))
    assert NeighborGraph.empty(NAMES).edges() == ()
    assert NeighborGraph.empty(("1",)).is_strongly_connected()


def test_added_edges_keep_the_delays_of_the_others():
    graph = NeighborGraph(NAMES, [[1], [], []], [(0, 1, 2)]).with_edges([(2, 0), (1, 0)])
    assert graph.edges() == ((1, 0), (2, 0)) and graph.delay(0, 1) == 2 and graph.delay(0, 2) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((NAMES, [[1]]), "neighbors: expected 3 neighbor sets, one for each agent, found 1"),
        ((NAMES, [[3], [], []]), r"neighbors\[0\]: expected positions of agents 0 … 2, found 3"),
        ((NAMES, [[True], [], []]), r"neighbors\[0\]: .* found True"),
        ((("a", "a"), [[], []]), r"names\[1\]: expected a name of its own, found 'a'"),
        ((("é", "e\u0301"), [[], []]), r"names\[1\]: expected a name of its own"),
        ((("",), [[]]), r"names\[0\]: expected a name, found the empty string"),
        ((("u\u202e1",), [[]]), r"names\[0\]: remove the character U\+202E"),
        ((("a" * 257,), [[]]), "at most 256 characters, found 257"),
        ((NAMES, [[1], [], []], [(0, 1, -1)]), r"delays\['a'\]\['b'\]: expected an integer >= 0"),
        ((NAMES, [[1], [], []], [(0, 1, True)]), "expected an integer >= 0, found True"),
        ((NAMES, [[1], [], []], [(0, 0, 1)]), "an agent has its own signals without delay"),
        (
            (NAMES, [[1], [], []], [(0, 2, 1)]),
            "there is no such link: list 'c' among the neighbors",
        ),
        ((NAMES, [[1], [], []], [(0, 1, 1), (0, 1, 1)]), "expected one delay, found two"),
    ],
)
def test_a_wrong_graph_is_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        NeighborGraph(*arguments)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((NAMES, {"d": []}), "neighbors: there is no agent 'd'"),
        ((NAMES, {"a": ["d"]}), r"neighbors\['a'\]\[0\]: there is no agent 'd'"),
        ((NAMES, {"a": ["b", "b"]}), r"neighbors\['a'\]\[1\]: 'b' is listed twice"),
        ((NAMES, {"a": None}), r"neighbors\['a'\]: expected a list of names, found None"),
        ((NAMES, {"a": "bc"}), r"neighbors\['a'\]: expected a list of names, found a string"),
        ((NAMES, {"a": [1]}), r"neighbors\['a'\]\[0\]: expected a name as a string"),
        ((NAMES, {}, {"x": {}}), "delays: there is no agent 'x'"),
        ((NAMES, {}, {"x": {"a": 1}}), "delays: there is no agent 'x'"),
    ],
)
def test_a_wrong_name_is_refused(arguments, message):
    with pytest.raises(InputError, match=message):
        NeighborGraph.from_names(*arguments)


def test_a_delay_that_is_a_float_is_refused_as_a_float():
    with pytest.raises(FloatRefused):
        NeighborGraph(NAMES, [[1], [], []], [(0, 1, 1.0)])  # type: ignore[list-item]


@pytest.mark.parametrize(
    ("graph", "names", "message"),
    [
        (networkx.Graph([("a", "b")]), None, "found an undirected one; use graph.to_directed"),
        (networkx.MultiDiGraph([("a", "b")]), None, "found a multigraph"),
        ("a graph", None, "expected a directed graph"),
        (networkx.DiGraph([(True, 2)]), None, "expected names or integers as nodes, found True"),
        (networkx.DiGraph([(1.0, 2)]), None, "found 1.0"),
        (networkx.DiGraph([((1, 2), 2)]), None, r"found \(1, 2\)"),
        (networkx.DiGraph([("a", "b")]), NAMES, "no node for 'c'"),
        (networkx.DiGraph([("a", "b"), ("b", "d")]), ("a", "b"), "no channel for 'd'"),
        # networkx keeps one node for 1, True and 1.0; the names tell.
        (networkx.DiGraph([(1, 2), (True, 2)]), ("1", "2", "3"), "no node for '3'"),
        (networkx.DiGraph([(1, "1")]), None, r"names\[1\]: expected a name of its own"),
        (
            networkx.DiGraph([("a", "b", {"weight": 0.1})]),
            None,
            "edge 'a' -> 'b': an edge has a delay",
        ),
        (networkx.DiGraph([("a", "b", {"weight": 2})]), None, "no weight, found 2"),
        (networkx.DiGraph([("a", "b", {"delay": 0.5})]), None, "expected an integer >= 0"),
        (networkx.DiGraph([("a", "b", {"delay": "1"})]), None, "expected an integer >= 0"),
    ],
)
def test_a_networkx_graph_that_would_lose_something_is_refused(graph, names, message):
    with pytest.raises(InputError, match=message):
        NeighborGraph.from_networkx(graph, names)


def test_integer_nodes_become_names():
    graph = NeighborGraph.from_networkx(networkx.DiGraph([(2, 1)]), ("1", "2"))
    assert graph.edges() == ((1, 0),)
