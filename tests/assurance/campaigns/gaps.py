"""The paper's open question on graphs and plants, beside enumeration of all sets of agents.

Run as ``python -m tests.assurance.campaigns.gaps PART [COUNT [FIRST [FILE]]]``; what is in the file
(by default ``build/gaps-PART.jsonl``) is not examined again.  The parts:

- ``graphs``: every directed graph on 4 agents, then drawn ones on 5 to 8: both numbers of the graph
  beside brute force, and the plants that attain them, certified in both time domains;
- ``plants``: drawn plants, none of which exceeds the factors of its graph, and how far each goes;
- ``nested``: drawn plants with one deficient eigenvalue: nested sets and branch trees agree.
"""

from __future__ import annotations

import functools
import itertools
import random
import sys
from collections import Counter
from collections.abc import Callable, Mapping
from fractions import Fraction
from pathlib import Path
from unittest import mock

import mcexact
from mcexact.analysis import sharing
from mcexact.analysis.sharing_gap import extremal_plant, sharing_gap
from mcexact.answer.check import check
from mcexact.answer.protocol import Answer
from mcexact.derived.constructions import Share
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle import gaps
from tests.oracle.allocation import demands
from tests.oracle.enumeration import plain

FOUR = 2**12
"""The number of directed graphs on 4 agents."""
SHARES: tuple[Share, ...] = ("outputs+states", "states")


@functools.cache
def _graphs_on_four() -> tuple[list[set[int]], ...]:
    return tuple(gaps.all_graphs(4))


def _graph(number: int) -> list[set[int]]:
    if number < FOUR:
        return _graphs_on_four()[number]
    rng = random.Random(number)
    return gaps.drawn_graph(rng, rng.randint(5, 8))


def _named(graph: gaps.Graph) -> NeighborGraph:
    return NeighborGraph([str(i + 1) for i in range(len(graph))], [sorted(N) for N in graph])


def invalid(*answers: Answer) -> list[str]:
    """What the checker says of answers that it does not accept."""
    verdicts = (check(answer) for answer in answers)
    return [verdict.line() for verdict in verdicts if verdict.verdict != "VALID"]


def of_a_graph(number: int) -> Examined:
    """Both numbers, and both plants in both time domains."""
    graph = _graph(number)
    gap = sharing_gap(_named(graph))
    true = (gaps.relay_number(graph), gaps.boundary_number(graph))
    wrong = invalid(gap)
    if (gap.relays, gap.boundary) != true or not gap.exact:
        wrong.append(f"{gap}, and by enumeration {true}")
    seen = Counter[str](graphs=1, relays=int(true[0] > 0), several=int(true[0] > 1))
    for share, factor in zip(SHARES, true, strict=True):
        if not factor:
            continue
        for time in ("continuous", "discrete"):
            plant = extremal_plant(gap, share, dimension=1, eigenvalue="1/2", time=time)
            bound = mcexact.sharing.shared_dimension_bound(plant, share=share)
            common = mcexact.sharing.common_dimension(plant, share=share)
            wrong += invalid(bound, common)
            if (bound.deficiency, common.dimension) != (factor, 1):
                wrong.append(f"{share}, {time}: {bound.deficiency} and {common.dimension}")
            seen[f"extremal plants, {share}"] += 1
    return wrong, seen


def drawn_plant(rng: random.Random, *, one: bool) -> MultiChannelSystem:
    """A plant over a drawn graph, with one eigenvalue if ``one``, else often with two.

    A few agents drive all states, and a few measure all; every other one drives or measures a few.
    Some of these plants are near those that attain a factor of the graph.
    """
    m, n = rng.randint(3, 6), rng.randint(1, 4)
    graph = gaps.drawn_graph(rng, m)
    if rng.random() < 0.7:
        graph = [{i} | (N if rng.random() < 0.3 else set()) for i, N in enumerate(graph)]
        around = rng.sample(range(m), m)
        for k, i in enumerate(around):
            graph[i].add(around[k - 1])
    drivers, sensors = ({rng.randrange(m) for _ in range(rng.randint(1, 2))} for _ in range(2))
    share, near = rng.choice((0.0, 0.1, 0.3)), rng.random()
    if near < 0.5:
        gap = sharing_gap(_named(graph))
        S, R = (gap.receivers, gap.senders) if near < 0.3 else (gap.dominating, ())
        drivers = {int(name) - 1 for name in S} or drivers
        sensors = {int(name) - 1 for name in R} or {i for i in range(m) if i not in drivers}
        n, share = rng.randint(2, 7), rng.choice((0.0, 0.0, 0.1))

    def whole() -> list[list[int]]:
        return [[int(i == j) for j in range(n)] for i in range(n)]

    def some(nrows: int, ncols: int) -> list[list[int]]:
        return [
            [rng.choice((1, -1, 2)) if rng.random() < share else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]

    modes = [1 if one else rng.choice((1, 1, 1, 2)) for _ in range(n)]
    A = [[modes[i] if i == j else 0 for j in range(n)] for i in range(n)]
    if one and n > 1 and rng.random() < 0.3:
        A[0][1] = 1
    return MultiChannelSystem(
        A,
        [whole() if i in drivers else some(n, 1) for i in range(m)],
        [whole() if i in sensors else some(1, n) for i in range(m)],
        time=rng.choice(("continuous", "discrete")),
        neighbors=_named(graph),
    )


def of_a_plant(number: int) -> Examined:
    """The bound against the least common dimension, and against the factor of the graph."""
    plant = drawn_plant(random.Random(number), one=False)
    assert plant.neighbors is not None
    graph = [set(N) for N in plant.neighbors.neighbors]
    factors = (gaps.relay_number(graph), gaps.boundary_number(graph))
    wrong, seen = [], Counter[str](plants=1)
    for share, factor in zip(SHARES, factors, strict=True):
        needed = demands(plain(plant), plant.neighbors.neighbors, outputs=share != "states")
        common = mcexact.sharing.common_dimension(plant, share=share).dimension
        if common != gaps.least_common_dimension(needed) and (common or needed):
            wrong.append(f"{share}: the least is {common}")
        if not common:
            seen[f"{share}: nothing to share, or in vain"] += 1
            continue
        bound = mcexact.sharing.shared_dimension_bound(plant, share=share).deficiency
        if bound != max(d for _, d in needed) or bound > factor * common:
            wrong.append(f"{share}: {bound} against {common}, the factor is {factor}")
        seen[f"{share}: ratio {Fraction(bound, common)}"] += 1
        seen[f"{share}: the factor of the graph attained"] += int(bound == factor * common)
    return wrong, seen


def of_one_factor(number: int) -> Examined:
    """The least total by nested sets and by a branch tree."""
    rng = random.Random(number)
    plant, share = drawn_plant(rng, one=True), rng.choice(SHARES)
    costs = [Fraction(rng.randint(1, 3)) for _ in plant.names]
    least = mcexact.sharing.minimal_shared_dimensions(plant, share=share, costs=costs)
    with mock.patch.object(sharing, "_by_nested_sets", lambda *_: None):
        other = mcexact.sharing.minimal_shared_dimensions(plant, share=share, costs=costs)
    wrong = invalid(least, other)
    if (least.cost, least.dimensions) != (other.cost, other.dimensions):
        wrong.append(f"{least.cost} by nested sets, {other.cost} by a tree")
    nested = least.multiplicities
    if least.cost and nested is None:
        wrong.append("no nested sets")
    chain = [set(cut.subset) for cut in least.cuts]
    if nested is not None and not all(s < t for s, t in itertools.pairwise(chain)):
        wrong.append("the sets are not nested")
    seen = Counter[str](plants=1)
    seen["proved by nested sets"] += int(nested is not None)
    seen["by several sets"] += int(len(nested or ()) > 1)
    seen["infeasible"] += int(least.cost is None)
    return wrong, seen


PARTS: Mapping[str, tuple[Callable[[int], Examined], int]] = {
    "graphs": (of_a_graph, FOUR + 500),
    "plants": (of_a_plant, 10_000),
    "nested": (of_one_factor, 1000),
}

if __name__ == "__main__":
    part, *rest = sys.argv[1:]
    examine, usual = PARTS[part]
    file = Path("build") / f"gaps-{part}.jsonl"
    sys.exit(main(rest, usual, file, examine, "things that are wrong", "number"))
