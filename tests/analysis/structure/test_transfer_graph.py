"""Transfer graphs: published answers, oddities of reachability, certificates."""

import pytest

from mcexact.analysis.structure import transfer_graph
from mcexact.answer import protocol
from mcexact.answer.protocol import Answer
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import dual
from mcexact.exact.matrix import Matrix
from mcexact.model import gallery
from mcexact.model.system import MultiChannelSystem
from tests.oracle.draws import exact


def valid(answer: Answer) -> bool:
    return check_document(protocol.encode(answer).encode()).verdict == "VALID"


@pytest.mark.parametrize("name", gallery.names())
def test_published_systems_have_the_published_arcs_and_components(name: str) -> None:
    system, wanted = gallery.load(name), gallery.expected(name)
    graph = transfer_graph(system)
    arcs = [[system.index(j) + 1, system.index(i) + 1] for j, i in graph.arcs]
    assert arcs == sorted(wanted["transfer_graph_arcs"])
    components = [[system.index(c) + 1 for c in part] for part in graph.components]
    assert components == sorted(sorted(part) for part in wanted["strong_components"])
    assert valid(graph)


def test_arcs_need_not_be_transitive() -> None:
    """Channel 1 reaches 2 and 2 reaches 3, by different states: 1 does not reach 3."""
    A = [[0] * 2] * 2
    B = [[[1], [0]], [[0], [1]], [[0], [0]]]
    C = [[[0, 0]], [[1, 0]], [[0, 1]]]
    graph = transfer_graph(MultiChannelSystem(A, B, C))
    assert graph.arcs == (("1", "2"), ("2", "3"))
    assert graph.components == (("1",), ("2",), ("3",))
    assert graph.inactive == ("1", "3")
    assert graph.successors == {"1": ("2",), "2": ("3",)}
    assert valid(graph)


def test_a_late_markov_parameter_makes_an_arc() -> None:
    """A chain of 12 integrators: the input reaches the output after 11 steps only."""
    n = 12
    A = [[int(i == j + 1) for j in range(n)] for i in range(n)]
    B, C = [[1]] + [[0]] * (n - 1), [[0] * (n - 1) + [1]]
    graph = transfer_graph(MultiChannelSystem(A, [B], [C]))
    assert graph.arcs == (("1", "1"),)
    assert graph.powers == (n - 1,)
    assert valid(graph)


def test_one_channel_without_arcs_is_strongly_connected() -> None:
    graph = transfer_graph(MultiChannelSystem([[1]], [[[0]]], [[[0]]]))
    assert graph.strongly_connected
    assert graph.arcs == ()
    assert valid(graph)


def test_without_states_there_are_no_arcs() -> None:
    empty_B, empty_C = Matrix.zeros(0, 1), Matrix.zeros(1, 0)
    graph = transfer_graph(MultiChannelSystem([], [empty_B] * 2, [empty_C] * 2))
    assert graph.arcs == ()
    assert not graph.strongly_connected
    assert valid(graph)


def test_the_dual_reverses_all_arcs() -> None:
    import random

    from tests.oracle.draws import sparse_system

    rng = random.Random(6)
    for _ in range(20):
        system = exact(sparse_system(rng))
        reversed_arcs = {(i, j) for j, i in transfer_graph(dual(system)).arcs}
        assert reversed_arcs == set(transfer_graph(system).arcs)
