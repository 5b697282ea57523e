"""β and m − γ of neighbor graphs, beside enumeration, and the plants that attain them."""

from __future__ import annotations

import random

import pytest

import mcexact
from mcexact.analysis.analyze import account_of_dimensions
from mcexact.analysis.sharing_gap import extremal_plant, sharing_gap
from mcexact.answer.check import check
from mcexact.derived.constructions import Share
from mcexact.errors import InputError, UsageError
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle import gaps
from tests.oracle.allocation import augmented, deficiencies, demands
from tests.oracle.enumeration import plain
from tests.wording import refusal

SHARES = ("outputs+states", "states")


def graph_of(sets: gaps.Graph) -> NeighborGraph:
    return NeighborGraph([str(i) for i in range(len(sets))], [sorted(N) for N in sets])


def diamond(m: int) -> NeighborGraph:
    """One agent receives from all others but the last, which all of these receive from."""
    middle = [[m - 1] for _ in range(m - 2)]
    return NeighborGraph([str(i) for i in range(m)], [range(m - 1), *middle, [0]])


def star(m: int) -> NeighborGraph:
    return NeighborGraph([str(i) for i in range(m)], [range(m), *([[0]] * (m - 1))])


@pytest.mark.parametrize("m", [1, 2, 3])
def test_all_graphs_on_a_few_agents_have_the_numbers_of_enumeration(m: int) -> None:
    for graph in gaps.all_graphs(m):
        assert gaps.relay_number(graph) == gaps.relay_number_of_all_pairs(graph)
        assert gaps.boundary_number(graph) == m - gaps.domination_number(graph)
        gap = sharing_gap(graph_of(graph))
        assert gap.exact
        assert (gap.relays, gap.boundary) == (
            gaps.relay_number(graph),
            gaps.boundary_number(graph),
        )


@pytest.mark.parametrize("seed", range(40))
def test_drawn_graphs_have_the_numbers_of_enumeration(seed: int) -> None:
    rng = random.Random(seed)
    graph = gaps.drawn_graph(rng, rng.randint(4, 7))
    gap = sharing_gap(graph_of(graph))
    assert gap.exact
    assert (gap.relays, gap.boundary) == (gaps.relay_number(graph), gaps.boundary_number(graph))
    assert check(gap).verdict == "VALID"


@pytest.mark.parametrize("seed", range(20))
def test_at_the_limit_both_numbers_are_between_valid_bounds(seed: int) -> None:
    rng = random.Random(seed)
    graph = gaps.drawn_graph(rng, 7)
    gap = sharing_gap(graph_of(graph), node_limit=rng.randint(1, 6))
    assert gap.relays <= gaps.relay_number(graph) <= gap.relays_at_most
    assert gap.boundary <= gaps.boundary_number(graph) <= gap.boundary_at_most
    assert check(gap).verdict == "VALID"


@pytest.mark.parametrize("m", range(3, 9))
def test_rings_diamonds_and_stars_are_as_the_theorems_say(m: int) -> None:
    ring = sharing_gap(NeighborGraph.ring(m))
    assert (ring.relays, ring.boundary) == (m // 3, m // 2)
    assert ring.always_right == (m <= 5, m <= 3)
    assert sharing_gap(diamond(m)).relays == m - 2
    assert sharing_gap(star(m)).boundary == m - 1


def test_a_graph_on_twenty_agents_is_decided_exactly() -> None:
    gap = sharing_gap(NeighborGraph.ring(20))
    assert (gap.relays, gap.boundary, gap.exact) == (6, 10, True)
    assert check(gap).verdict == "VALID"


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("share", SHARES)
@pytest.mark.parametrize("dimension", [1, 2])
@pytest.mark.parametrize("graph", [NeighborGraph.ring(4), diamond(4), star(4)])
def test_the_extremal_plant_exceeds_the_least_by_the_whole_factor(
    graph: NeighborGraph, dimension: int, share: Share, time: str
) -> None:
    gap = sharing_gap(graph)
    factor = gap.relays if share == "outputs+states" else gap.boundary
    plant = extremal_plant(gap, share, dimension=dimension, eigenvalue="1/2", time=time)
    bound = mcexact.sharing.shared_dimension_bound(plant, share=share)
    common = mcexact.sharing.common_dimension(plant, share=share)
    assert (bound.deficiency, common.dimension) == (factor * dimension, dimension)
    base = augmented(plain(plant), graph.neighbors) if share == "outputs+states" else plain(plant)
    assert max(deficiencies(base).values()) == factor * dimension
    needed = demands(plain(plant), graph.neighbors, outputs=share == "outputs+states")
    assert gaps.least_common_dimension(needed) == dimension
    assert mcexact.joint_controllability(plant).controllable
    assert mcexact.joint_observability(plant).controllable
    assert check(bound).verdict == check(common).verdict == "VALID"


def test_no_plant_exceeds_the_factor_of_a_graph_on_which_nothing_relays() -> None:
    gap = sharing_gap(NeighborGraph.complete(3))
    assert (gap.relays, gap.receivers, gap.senders) == (0, (), ())
    with pytest.raises(UsageError, match="no plant needs"):
        extremal_plant(gap)


def test_arguments_are_refused_with_what_was_expected() -> None:
    with refusal(UsageError):
        sharing_gap(MultiChannelSystem([[0]], [[[1]]], [[[1]]]))
    with pytest.raises(UsageError, match="node_limit"):
        sharing_gap(NeighborGraph.ring(3), node_limit=0)
    with pytest.raises(UsageError, match="dimension"):
        extremal_plant(sharing_gap(NeighborGraph.ring(3)), dimension=0)
    with pytest.raises(InputError, match="expected a SharingGap"):
        extremal_plant(NeighborGraph.ring(3))  # type: ignore[arg-type]


@pytest.mark.parametrize("share", SHARES)
def test_allocate_compares_the_bound_with_the_least_common_dimension(
    share: Share,
) -> None:
    plant = extremal_plant(sharing_gap(diamond(5)), share, dimension=2)
    said = account_of_dimensions(plant, share=share).sentences.at("bound and least")
    [compared] = said
    values = {pointer: value for _, pointer, value in compared.because}
    key = "relays_at_most" if share == "outputs+states" else "boundary_at_most"
    assert values["/claim/dimension"] * values[f"/claim/{key}"] == values["/claim/deficiency"]
