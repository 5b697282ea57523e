"""Families of systems: every member is there, once, and is what its name says."""

import math
from fractions import Fraction

import networkx
import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.derived.constructions import augmented_outputs
from mcexact.derived.variants import neighbor_graph_variants, parameter_grid, sensor_variants
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.model import gallery
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem
from tests.wording import refusal

PLANT = gallery.load("liu2020-3ch-no-communication")


def agents(m: int) -> MultiChannelSystem:
    """m agents that are alike."""
    return MultiChannelSystem([[0]], [[[1]]] * m, [[[1]]] * m)


def graph_of(system: MultiChannelSystem) -> networkx.DiGraph:
    graph = system.neighbors
    assert graph is not None
    found = networkx.DiGraph()
    found.add_nodes_from(range(system.m))
    found.add_edges_from((j, i) for i in range(system.m) for j in graph.neighborhood(i) if i != j)
    return found


@pytest.mark.parametrize(("m", "graphs", "classes"), [(1, 1, 1), (2, 4, 3), (3, 64, 16)])
def test_all_neighbor_graphs_are_there_once(m: int, graphs: int, classes: int) -> None:
    found = [v.system() for v in neighbor_graph_variants(agents(m))]
    assert len({system.neighbors for system in found}) == len(found) == graphs
    names = {v.name for v in neighbor_graph_variants(agents(m))}
    assert len(names) == graphs
    kept = [
        graph_of(v.system()) for v in neighbor_graph_variants(agents(m), up_to_isomorphism=True)
    ]
    assert len(kept) == classes
    for k, graph in enumerate(kept):
        assert not any(networkx.is_isomorphic(graph, other) for other in kept[:k])


def test_four_agents_have_218_graphs_up_to_isomorphism_of_which_83_are_strongly_connected() -> None:
    """Sequences A000273 and A035512 of the encyclopedia of integer sequences."""
    kept = list(neighbor_graph_variants(agents(4), up_to_isomorphism=True))
    strong = list(
        neighbor_graph_variants(agents(4), up_to_isomorphism=True, strongly_connected=True)
    )
    assert (len(kept), len(strong)) == (218, 83)
    assert {v.name for v in strong} <= {v.name for v in kept}
    assert all(networkx.is_strongly_connected(graph_of(v.system())) for v in strong)


def test_agents_that_send_outputs_are_plants_with_more_outputs() -> None:
    for variant in neighbor_graph_variants(PLANT, information="outputs", strongly_connected=True):
        made = variant.system()
        assert made.subject == () and made.plant is made
        own = PLANT.with_neighbors(made.neighbors)
        assert made.output_matrix() == augmented_outputs(own).output_matrix()
    everything = [*neighbor_graph_variants(PLANT, information="outputs")][-1]
    assert not fixed_spectrum(everything.system()).factors


def test_a_grid_has_all_combinations_in_order() -> None:
    plant = ParametricSystem([["a + b"]], [[["1/a"]]], [[[1]]], parameters=["a", "b"])
    found = list(parameter_grid(plant, {"b": [0, "1/3"], "a": [1, 0]}))
    assert [v.name for v in found] == ["a=1, b=0", "a=1, b=1/3", "a=0, b=0", "a=0, b=1/3"]
    assert found[1].system().A[0, 0] == Fraction(4, 3)
    with pytest.raises(InputError, match="undefined"):
        found[2].system()


@pytest.mark.parametrize(
    ("values", "message"),
    [({"a": [1]}, "'b' is without any"), ({"a": [1], "b": [1], "c": [1]}, "'c' is no parameter")],
)
def test_a_grid_is_about_all_parameters(values: dict[str, list[int]], message: str) -> None:
    plant = ParametricSystem([["a + b"]], [[[1]]], [[[1]]], parameters=["a", "b"])
    with pytest.raises(UsageError, match=message):
        parameter_grid(plant, values)


@pytest.mark.parametrize("unused", [False, True])
def test_sensors_go_to_channels_in_all_ways(unused: bool) -> None:
    inputs = [[[1], [0]], [[0], [1]], [[1], [1]]]
    plant = MultiChannelSystem([[0, 1], [2, 3]], inputs, [[[1, 0], [0, 1]], [], [[1, 1]]])
    found = [v.system() for v in sensor_variants(plant, unused=unused)]
    assert len(set(found)) == len(found) == (3 + unused) ** 3
    assert plant in found
    rows = sorted(plant.output_matrix().rows())
    for made in found:
        assert made.A == plant.A and made.input_matrix() == plant.input_matrix()
        kept = sorted(made.output_matrix().rows())
        assert kept == rows or (unused and len(kept) < len(rows))


def test_a_family_that_is_too_long_is_refused_at_once() -> None:
    with pytest.raises(LimitReached, match=r"6 agents have 2\^30 neighbor graphs"):
        neighbor_graph_variants(agents(6))
    with refusal(LimitReached):
        sensor_variants(agents(20))
    plant = ParametricSystem([["a + b"]], [[[1]]], [[[1]]], parameters=["a", "b"])
    with pytest.raises(LimitReached, match="combinations of values"):
        parameter_grid(plant, {"a": range(1001), "b": range(1000)})
    assert math.log2(10**6) > 5 * 4 - 1
