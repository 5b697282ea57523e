"""What the paper's question is about, by exhaustive search: numbers of graphs, and least totals.

A graph is a list of sets: ``graph[i]`` is N_i, and contains i.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Sequence
from fractions import Fraction

from tests.oracle.allocation import Neighbors, boundary, demands
from tests.oracle.enumeration import PlainSystem, subsets

Graph = Sequence[set[int]]


def all_graphs(m: int) -> Iterator[list[set[int]]]:
    """Every directed graph on m agents."""
    links = [(j, i) for j in range(m) for i in range(m) if i != j]
    for chosen in itertools.product((False, True), repeat=len(links)):
        graph = [{i} for i in range(m)]
        for (j, i), there in zip(links, chosen, strict=True):
            if there:
                graph[i].add(j)
        yield graph


def drawn_graph(rng: random.Random, m: int) -> list[set[int]]:
    """A directed graph on m agents, dense or sparse."""
    density = rng.choice((0.1, 0.2, 0.3, 0.5, 0.7))
    return [{j for j in range(m) if j == i or rng.random() < density} for i in range(m)]


def neighborhood_of(graph: Graph, S: Sequence[int]) -> set[int]:
    """N_S."""
    return set().union(*(graph[i] for i in S))


def relay_number(graph: Graph) -> int:
    """β: over all S, and the largest R that is apart from S, which has the most relays."""
    most = 0
    for S in subsets(len(graph)):
        senders = neighborhood_of(graph, S)
        R = set(range(len(graph))) - senders
        if S and R:
            most = max(most, sum(1 for j in senders if graph[j] & R))
    return most


def relay_number_of_all_pairs(graph: Graph) -> int:
    """β by its definition, over all pairs of nonempty sets."""
    most = 0
    for S, R in itertools.product(subsets(len(graph)), repeat=2):
        senders = neighborhood_of(graph, S)
        if S and R and not senders & set(R):
            most = max(most, sum(1 for j in senders if graph[j] & set(R)))
    return most


def domination_number(graph: Graph) -> int:
    """γ: the least size of a set that together has everybody as neighbors."""
    everybody = set(range(len(graph)))
    return min(len(s) for s in subsets(len(graph)) if neighborhood_of(graph, s) == everybody)


def boundary_number(graph: Graph) -> int:
    """The largest number of agents in N_s∖s."""
    return max(len(boundary(s, [sorted(N) for N in graph])) for s in subsets(len(graph)))


def least_common_dimension(needed: Sequence[tuple[frozenset[int], int]]) -> int | None:
    """The least c with c |N_s∖s| ≥ δ_s for all s, tried one after the other."""
    most = max((d for _, d in needed), default=0)
    for c in range(most + 1):
        if all(c * len(around) >= d for around, d in needed):
            return c
    return None


def least_total(
    system: PlainSystem, neighbors: Neighbors, costs: Sequence[Fraction], *, outputs: bool
) -> Fraction | None:
    """The least Σ c_i n_i, over all dimensions up to the largest demand."""
    needed = demands(system, neighbors, outputs=outputs)
    most = max((d for _, d in needed), default=0)
    best = None
    for sizes in itertools.product(range(most + 1), repeat=system.m):
        if all(sum(sizes[i] for i in around) >= d for around, d in needed):
            cost = sum((c * k for c, k in zip(costs, sizes, strict=True)), Fraction(0))
            best = cost if best is None else min(best, cost)
    return best
