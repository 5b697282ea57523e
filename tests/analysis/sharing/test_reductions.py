"""The reductions that show that least totals and relay numbers are NP-hard, on small instances."""

from __future__ import annotations

import itertools
import random

import pytest

from mcexact.analysis.sharing import minimal_shared_dimensions
from mcexact.analysis.sharing_gap import sharing_gap
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.oracle import gaps


def least_cover(sets: list[set[int]], union: set[int]) -> int:
    """The least number of sets that together are the union."""
    return next(
        size
        for size in range(len(sets) + 1)
        for some in itertools.combinations(sets, size)
        if set().union(*some) == union
    )


@pytest.mark.parametrize("seed", range(12))
def test_relay_numbers_contain_set_cover(seed: int) -> None:
    rng = random.Random(seed)
    size, k = rng.randint(1, 3), rng.randint(1, 3)
    sets = [{u for u in range(size) if rng.random() < 0.5} for _ in range(k)]
    union = set().union(*sets)
    # The agents s and t, then those of the elements, then a_i and s_i for each set.
    elements = {u: 2 + number for number, u in enumerate(sorted(union))}
    first = 2 + len(elements)
    m = first + 2 * k
    graph = [{i} for i in range(m)]
    graph[0] |= set(elements.values())
    for i, each in enumerate(sets):
        a, listener = first + 2 * i, first + 2 * i + 1
        graph[listener].add(a)
        graph[a].add(1)
        for u in each:
            graph[elements[u]].add(a)
    wanted = len(union) + k - least_cover(sets, union)
    assert gaps.relay_number(graph) == wanted
    gap = sharing_gap(NeighborGraph([str(i) for i in range(m)], [sorted(N) for N in graph]))
    assert (gap.relays, gap.relays_at_most) == (wanted, wanted)


@pytest.mark.parametrize("seed", range(8))
def test_least_totals_contain_vertex_cover(seed: int) -> None:
    rng = random.Random(seed)
    vertices = range(rng.randint(3, 5))
    edges = [e for e in itertools.combinations(vertices, 2) if rng.random() < 0.6] or [(0, 1)]
    n, r = len(edges), len(vertices) + len(edges)
    m = r + 1
    neighbors: list[list[int]] = [[r] for _ in vertices]
    neighbors += [[*edge] for edge in edges]
    neighbors.append(list(range(m)))
    zero = [[0]] * n
    B = [zero for _ in vertices]
    B += [[[int(i == k)] for i in range(n)] for k in range(n)]
    plant = MultiChannelSystem(
        [[(i + 1) * int(i == j) for j in range(n)] for i in range(n)],
        [*B, zero],
        [*([[[0] * n]] * r), [[int(i == j) for j in range(n)] for i in range(n)]],
        neighbors=NeighborGraph([str(i + 1) for i in range(m)], neighbors),
    )
    least = next(
        size
        for size in range(len(vertices) + 1)
        for some in itertools.combinations(vertices, size)
        if all({*edge} & {*some} for edge in edges)
    )
    assert minimal_shared_dimensions(plant).cost == least
