"""Augmented outputs and extended systems against the paper's example and its rank identity."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact import testing
from mcexact.derived.constructions import add_links, augmented_outputs, dual, extended_system
from mcexact.errors import InputError, UsageError
from mcexact.exact.linear_algebra import rank
from mcexact.exact.matrix import Matrix, block
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from tests.wording import refusal


@pytest.fixture
def plant():
    """The paper's example with its cyclic neighbor graph."""
    found = gallery.load("liu2020-3ch-no-communication")
    return found.with_neighbors(NeighborGraph.ring(found.names))


def rows(M):
    return sorted(M.numerators)


def test_augmented_outputs_are_the_published_ones_up_to_the_order_of_rows(plant):
    made, published = augmented_outputs(plant), gallery.load("liu2020-3ch-augmented-outputs")
    assert made.A == published.A
    for ours, theirs in zip(made.channels, published.channels, strict=True):
        assert (ours.name, ours.B) == (theirs.name, theirs.B)
        assert rows(ours.C) == rows(theirs.C)
    assert made.subject == ({"construction": "augmented_outputs"},)


@pytest.mark.parametrize(
    ("share", "name"),
    [
        ("outputs+states", "liu2020-3ch-extended-n1"),
        ("states", "liu2020-3ch-extended-n1-no-y"),
    ],
)
def test_the_extended_system_is_the_published_one(plant, share, name):
    made, published = extended_system(plant, [1, 1, 1], share), gallery.load(name)
    assert made.A == published.A and made.channels == published.channels
    assert made.subject == ({"construction": "extended", "share": share, "dimensions": [1, 1, 1]},)
    assert made.plant == plant


def test_without_shared_states_an_extended_system_has_augmented_outputs(plant):
    assert extended_system(plant, [0, 0, 0]).channels == augmented_outputs(plant).channels
    assert extended_system(plant, [0, 0, 0], "states").channels == plant.channels


@given(testing.systems_on_graphs(testing.systems(max_states=3, max_channels=3)), st.data())
def test_the_rank_of_the_extended_pencil_grows_by_what_crosses_the_cut(drawn, data):
    """At every integer λ: rank P̄_s = rank P_s + Σ n_i + Σ_{N_s∖s} n_i, neighbors counted once."""
    system = drawn.system
    m, graph = system.m, system.neighbors
    sizes = data.draw(st.lists(st.integers(0, 2), min_size=m, max_size=m))
    s = sorted(data.draw(st.sets(st.integers(0, m - 1))))
    share = data.draw(st.sampled_from(["outputs+states", "states"]))
    eigenvalue = data.draw(st.integers(-3, 3))
    seen = graph.union(s) if share == "outputs+states" else s

    def pencil_rank(A, B, C):
        upper = [eigenvalue * Matrix.identity(A.nrows) - A, B]
        return rank(block([upper, [C, Matrix.zeros(C.nrows, B.ncols)]]))

    rest = [i for i in range(m) if i not in s]
    made = extended_system(system, sizes, share)
    before = pencil_rank(system.A, system.input_matrix(rest), system.output_matrix(seen))
    after = pencil_rank(made.A, made.input_matrix(rest), made.output_matrix(s))
    crossing = sum(sizes[i] for i in graph.union(s) if i not in s)
    assert after == before + sum(sizes) + crossing


def test_added_edges_join_the_neighborhoods_and_keep_the_plant(plant):
    made = add_links(plant, [(2, 0), (0, 1), (0, 1), (1, 0), (1, 1)])
    assert made.neighbors.edges() == tuple(sorted({*plant.neighbors.edges(), (0, 1), (2, 0)}))
    assert made.subject == ({"construction": "arcs", "added": [["1", "2"], ["3", "1"]]},)
    assert made.plant == plant and made.channels == plant.channels
    assert augmented_outputs(made).C(0) == plant.output_matrix()


@given(testing.systems())
def test_the_dual_of_the_dual_is_the_system(drawn):
    twice = dual(dual(drawn.system))
    assert twice.A == drawn.system.A and twice.channels == drawn.system.channels
    assert dual(drawn.system).neighbors is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([1, 1],), "dimensions: expected 3 dimensions, one for each agent, found 2"),
        (([1, 1, -1],), r"dimensions\[2\]: expected an integer >= 0, found -1"),
        (([1, 1, True],), r"dimensions\[2\]: expected an integer >= 0, found True"),
        (([1, 1, 1], "all"), 'share: expected "outputs\\+states" or "states", found \'all\''),
    ],
)
def test_wrong_dimensions_or_ways_of_sharing_are_refused(plant, arguments, message):
    with pytest.raises(InputError, match=message):
        extended_system(plant, *arguments)


def test_without_a_graph_there_is_no_extended_system():
    plant = gallery.load("liu2020-3ch-no-communication")
    with refusal(UsageError):
        extended_system(plant, [1, 1, 1])
