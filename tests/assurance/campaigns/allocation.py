"""Allocations of drawn systems against exhaustive search; prints the counts.

Run as ``python -m tests.assurance.campaigns.allocation [COUNT] [SEED]``; the tests call it with
small counts.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from fractions import Fraction
from typing import get_args

from mcexact.analysis.sharing import (
    minimal_communication,
    minimal_shared_dimensions,
    shared_dimension_bound,
)
from mcexact.answer.protocol import encode
from mcexact.checker.kinds import check_document
from mcexact.derived.constructions import Share
from mcexact.model.graph import NeighborGraph
from tests.oracle.allocation import demands, fewest_arcs, least_cost
from tests.oracle.draws import exact
from tests.oracle.enumeration import PlainSystem, Rows


def drawn(rng: random.Random, states: int = 4, channels: int = 4) -> PlainSystem:
    """A system with repeated eigenvalues, so that deficiencies above 1 occur."""
    n, m = rng.randint(1, states), rng.randint(1, channels)
    diagonal = [rng.choice([0, 1]) for _ in range(n)]
    if rng.random() < 0.5:
        diagonal = [diagonal[0]] * n
    A = [[Fraction(diagonal[i] if i == j else 0) for j in range(n)] for i in range(n)]
    for i in range(n - 1):
        if rng.random() < 0.3:
            A[i][i + 1] = Fraction(rng.choice([1, -1, 2]))
    if n >= 2 and rng.random() < 0.15:  # an irrational pair, x² − 2
        A[0][1], A[1][0], A[0][0], A[1][1] = Fraction(2), Fraction(1), Fraction(0), Fraction(0)

    def entries(nrows: int, ncols: int) -> Rows:
        return [
            [
                Fraction(rng.choice([1, 1, -1, 2]) if rng.random() < 0.45 else 0)
                for _ in range(ncols)
            ]
            for _ in range(nrows)
        ]

    if rng.random() < 0.75:  # every state driven by one channel and measured by one
        drivers = [rng.randrange(m) for _ in range(n)]
        sensors = [rng.randrange(m) for _ in range(n)]
        unit = [[Fraction(int(i == k)) for k in range(n)] for i in range(n)]
        B = [[[row[k] for k in range(n) if drivers[k] == i] for row in unit] for i in range(m)]
        C = [[unit[k] for k in range(n) if sensors[k] == i] for i in range(m)]
    else:
        widths = [rng.choice([0, 1, 1, 2]) for _ in range(2 * m)]
        B = [entries(n, widths[i]) for i in range(m)]
        C = [entries(widths[m + i], n) for i in range(m)]
    return PlainSystem(A, B, C)


def drawn_neighbors(rng: random.Random, m: int) -> list[list[int]]:
    """Sets N_i, each with i in it; half of the time a cycle makes them strongly connected."""
    order = rng.sample(range(m), m)
    heard = [{i} for i in range(m)]
    if rng.random() < 0.6:
        for j, i in zip(order, order[1:] + order[:1], strict=True):
            heard[i].add(j)
    for i in range(m):
        heard[i] |= {j for j in range(m) if rng.random() < 0.2}
    return [sorted(h) for h in heard]


def compare_dimensions(count: int, seed: int) -> Counter[str]:
    """Least shared dimensions against brute force; the counts of what occurred.

    Raises
    ------
    AssertionError
        On the first disagreement.
    """
    rng, seen = random.Random(seed), Counter[str]()
    for number in range(count):
        plain = drawn(rng)
        heard = drawn_neighbors(rng, plain.m)
        share = rng.choice(get_args(Share))
        system = exact(plain)
        graph = NeighborGraph(system.names, tuple(map(tuple, heard)))
        weighted = rng.random() < 0.3
        costs = [Fraction(rng.randint(1, 4), rng.randint(1, 3)) for _ in range(plain.m)]
        costs = costs if weighted else [Fraction(1)] * plain.m
        found = minimal_shared_dimensions(system, graph, share, costs=costs)
        needs = demands(plain, heard, outputs=share == "outputs+states")
        expected = least_cost(needs, costs, [max((d for _, d in needs), default=0)] * plain.m)
        if found.cost != expected:
            message = f"draw {number} of seed {seed}: found {found.cost}, enumerated {expected}"
            raise AssertionError(message)
        verdict = check_document(encode(found).encode("ascii"))
        if verdict.verdict != "VALID":
            raise AssertionError(f"draw {number} of seed {seed}: {verdict.line()}")
        seen["systems"] += 1
        seen["infeasible" if expected is None else "feasible"] += 1
        connected = graph.is_strongly_connected()
        seen["strongly connected graph"] += connected
        if expected is not None and connected:
            bound = shared_dimension_bound(system, graph, share)
            seen["something to share, connected graph"] += found.total != 0
            seen["largest deficiency 2 or more"] += bound.deficiency > 1
            if not weighted:
                seen["unit costs, connected, feasible"] += 1
                seen["uniform bound strictly larger"] += bound.total > (found.total or 0)
    return seen


def compare_arcs(count: int, seed: int) -> Counter[str]:
    """Fewest arcs to add against brute force over arc sets; the counts of what occurred."""
    rng, seen = random.Random(seed), Counter[str]()
    for number in range(count):
        plain = drawn(rng, states=3, channels=4 if number % 4 == 0 else 3)
        heard = drawn_neighbors(rng, plain.m)
        share = rng.choice(("outputs", *get_args(Share)))
        sizes = None if share == "outputs" else [rng.randint(0, 2) for _ in range(plain.m)]
        system = exact(plain)
        graph = NeighborGraph(system.names, tuple(map(tuple, heard)))
        found = minimal_communication(system, graph, dimensions=sizes, share=share)
        expected = fewest_arcs(plain, heard, sizes or [0] * plain.m, share=share)
        if found.cost != expected:
            message = f"draw {number} of seed {seed}: found {found.cost}, enumerated {expected}"
            raise AssertionError(message)
        verdict = check_document(encode(found).encode("ascii"))
        if verdict.verdict != "VALID":
            raise AssertionError(f"draw {number} of seed {seed}: {verdict.line()}")
        seen["systems"] += 1
        seen[f"{share}, {'infeasible' if expected is None else f'{min(expected, 2)}+ arcs'}"] += 1
    return seen


def main(arguments: list[str]) -> None:
    """Run both comparisons and print the counts."""
    count = int(arguments[0]) if arguments else 1000
    seed = int(arguments[1]) if len(arguments) > 1 else 1
    for name, seen in (
        ("dimensions", compare_dimensions(count, seed)),
        ("arcs", compare_arcs(max(1, count // 5), seed)),
    ):
        print(name)
        for what, number in sorted(seen.items()):
            print(f"  {number:6d}  {what}")


if __name__ == "__main__":
    main(sys.argv[1:])
