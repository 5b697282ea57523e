"""Least totals proved by nested sets, beside enumeration, and a plant where nested sets fail."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction
from typing import get_args
from unittest import mock

import pytest

from mcexact.analysis import sharing
from mcexact.analysis.covering import CoveringCut, CoveringProgram, linear_optimum
from mcexact.analysis.nested_sets import uncrossed
from mcexact.analysis.sharing import minimal_shared_dimensions
from mcexact.answer.check import check
from mcexact.derived.constructions import Share
from mcexact.errors import LimitReached
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle import gaps
from tests.oracle.enumeration import plain


def drawn(seed: int) -> MultiChannelSystem:
    """A plant with one eigenvalue, in chains of length 1, over a drawn graph."""
    rng = random.Random(seed)
    m, n = rng.randint(3, 5), rng.randint(1, 4)
    graph = gaps.drawn_graph(rng, m)

    def column() -> list[list[int]]:
        return [[rng.choice((0, 0, 0, 1, -1))] for _ in range(n)]

    def row() -> list[list[int]]:
        return [[rng.choice((0, 0, 0, 1, 2)) for _ in range(n)]]

    return MultiChannelSystem(
        [[int(i == j) for j in range(n)] for i in range(n)],
        [column() for _ in range(m)],
        [row() for _ in range(m)],
        neighbors=NeighborGraph([str(i + 1) for i in range(m)], [sorted(N) for N in graph]),
    )


def two_modes() -> MultiChannelSystem:
    """Two simple eigenvalues, 1 and 2; messages about 1 pass a, or b and c, about 2 pass b or c."""
    names = ("s1", "r1", "s2", "r2", "a", "b", "c")
    B = {"s1": [[1], [0]], "s2": [[0], [1]]}
    C = {"r1": [[1, 0]], "r2": [[0, 1]]}
    return MultiChannelSystem(
        [[1, 0], [0, 2]],
        [B.get(name, [[0], [0]]) for name in names],
        [C.get(name, [[0, 0]]) for name in names],
        names=names,
        neighbors={
            "s1": ["a", "c"],
            "s2": ["b", "c"],
            "a": ["r1"],
            "b": ["r1", "r2"],
            "c": ["b", "r2"],
        },
    )


@pytest.mark.parametrize("share", get_args(Share))
@pytest.mark.parametrize("seed", range(40))
def test_one_eigenvalue_alone_is_proved_by_nested_sets_as_enumeration_has_it(
    seed: int, share: Share
) -> None:
    plant, rng = drawn(seed), random.Random(-seed)
    costs = [Fraction(rng.randint(1, 4), rng.randint(1, 2)) for _ in plant.names]
    least = minimal_shared_dimensions(plant, share=share, costs=costs)
    assert plant.neighbors is not None
    total = gaps.least_total(
        plain(plant), plant.neighbors.neighbors, costs, outputs=share == "outputs+states"
    )
    assert least.cost == total
    assert check(least).verdict == "VALID"
    if least.cost:
        [node] = least.tree
        assert "nested" in node
        subsets = [set(cut.subset) for cut in least.cuts]
        assert all(s < t for s, t in itertools.pairwise(subsets))


@pytest.mark.parametrize("seed", range(10))
def test_a_branch_tree_proves_the_same_cost(seed: int) -> None:
    plant = drawn(seed)
    least = minimal_shared_dimensions(plant)
    with mock.patch.object(sharing, "_by_nested_sets", lambda *_: None):
        other = minimal_shared_dimensions(plant)
    assert (least.cost, least.dimensions) == (other.cost, other.dimensions)
    assert all("nested" not in node for node in other.tree)


def test_with_two_eigenvalues_the_linear_program_costs_less_than_any_dimensions() -> None:
    plant = two_modes()
    least = minimal_shared_dimensions(plant)
    assert (least.cost, check(least).verdict) == (2, "VALID")
    assert all("nested" not in node for node in least.tree)
    assert plant.neighbors is not None
    ones = [Fraction(1)] * plant.m
    assert gaps.least_total(plain(plant), plant.neighbors.neighbors, ones, outputs=True) == 2
    needed = gaps.demands(plain(plant), plant.neighbors.neighbors, outputs=True)
    program = CoveringProgram(
        tuple(ones), (None,) * plant.m, tuple(CoveringCut(around, d) for around, d in needed)
    )
    point, _ = linear_optimum(program)
    assert sum(point) == pytest.approx(1.5)


def test_at_the_node_limit_each_factor_alone_bounds_the_cost_from_below() -> None:
    names = [str(i) for i in range(7)]
    edges = list(itertools.combinations(range(3), 2))
    # Vertex cover of a triangle, each edge with a mode of its own, and one more mode that needs 1.
    n = len(edges)
    column = {3 + k: [[int(i == k)] for i in range(n)] for k in range(n)}
    plant = MultiChannelSystem(
        [[(i + 1) * int(i == j) for j in range(n)] for i in range(n)],
        [column.get(i, [[0]] * n) for i in range(7)],
        [[[int(i == 6)] * n] for i in range(7)],
        names=names,
        neighbors=NeighborGraph(names, [[6], [6], [6], *([*edge] for edge in edges), range(7)]),
    )
    assert minimal_shared_dimensions(plant).cost == 2
    nothing = Fraction(0), ({"multipliers": []},)
    with (
        mock.patch.object(
            sharing, "branch_tree", side_effect=LimitReached("full", lower=Fraction(0))
        ),
        mock.patch.object(sharing, "relaxation_bound", return_value=nothing),
    ):
        found = minimal_shared_dimensions(plant)
    assert (found.at_least, found.cost) == (1, 2)
    assert found.multiplicities is not None and check(found).verdict == "VALID"


@pytest.mark.parametrize("seed", range(30))
def test_uncrossing_keeps_the_sum_and_every_agent_and_leaves_a_chain(seed: int) -> None:
    rng = random.Random(seed)
    weights = {
        frozenset(i for i in range(5) if rng.random() < 0.5): Fraction(rng.randint(1, 5), 2)
        for _ in range(rng.randint(1, 6))
    }
    chain = uncrossed(weights)
    assert all(s <= t or t <= s for s in chain for t in chain)
    assert sum(chain.values()) == sum(weights.values())
    for i in range(5):
        before, after = (sum(y for s, y in w.items() if i in s) for w in (weights, chain))
        assert before == after
