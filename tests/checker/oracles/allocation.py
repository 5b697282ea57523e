"""What must be shared, by exhaustive search over subsets, dimensions and arcs."""

from __future__ import annotations

import itertools
import json
import random
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from mcexact.analysis.sharing.allocation import minimal_shared_dimensions
from mcexact.analysis.sharing.communication import minimal_communication
from mcexact.answer import codec
from mcexact.exact.location import StabilityRegion
from mcexact.exact.polynomial import Polynomial
from mcexact.model.neighbor_graph import NeighborGraph
from tests.campaigns.allocation import drawn, drawn_neighbors
from tests.checker.mutations import Document, Registration
from tests.checker.oracles.subjects import plant_of
from tests.oracle import enumeration
from tests.oracle.allocation import augmented, boundary
from tests.oracle.draws import exact

Demand = tuple[frozenset[int], int]


def _demands(
    base: enumeration.PlainSystem,
    neighbors: Sequence[Sequence[int]],
    time: str,
    bound: Any,
    connected: bool,
) -> list[Demand]:
    """Σ n_i over N_s∖s is at least what every s and every mode that counts asks for."""
    found: list[Demand] = []
    chi = enumeration.characteristic_polynomial(base.A)
    modes = [p for p in enumeration.irreducible_factors(chi) if not _allowed(p, time, bound)]
    arcs = set(enumeration.transfer_arcs(base)) if base.n else set()
    for s in enumeration.subsets(base.m):
        ranks = [enumeration.pencil_rank(base, s, p) for p in modes]
        demand = max((base.n - rank for rank in ranks), default=0)
        if connected and 0 < len(s) < base.m:
            outside = [j for j in range(base.m) if j not in s]
            reached = any((j, i) in arcs for j in outside for i in s)
            demand = max(demand, 0 if reached else 1)
        found.append((boundary(s, neighbors), demand))
    return [(support, demand) for support, demand in found if demand > 0]


def _allowed(p: enumeration.Coefficients, time: str, bound: Any) -> bool:
    """Whether a mode may stay: all its roots meet the bound."""
    if bound is None:
        return False
    value = Fraction(bound)
    region = StabilityRegion(time, None if time == "continuous" and value == 0 else value)
    return region.contains_roots_of(Polynomial(p))


def _heard(document: Document) -> list[list[int]]:
    plant = plant_of(document)
    graph = plant.neighbors or NeighborGraph.empty(plant.names)
    return [list(graph.neighborhood(i)) for i in range(graph.m)]


def draw_dimensions(seed: int) -> Document:
    """The least dimensions of a drawn plant."""
    rng = random.Random(seed)
    small = drawn(rng, 3, 3)
    system = exact(small, rng.choice(["continuous", "discrete"]))
    graph = NeighborGraph(system.names, drawn_neighbors(rng, small.m))
    costs = [Fraction(rng.randint(1, 3), rng.randint(1, 2)) for _ in range(small.m)]
    upper = [rng.choice([None, None, 1]) for _ in range(small.m)]
    found = minimal_shared_dimensions(
        system,
        graph,
        rng.choice(["outputs+states", "states"]),  # type: ignore[arg-type]
        costs=costs,
        upper=upper,
        free_assignability=seed % 2 == 1,
    )
    document: Document = json.loads(codec.encode(found))
    return document


def confirms_dimensions(document: Document) -> bool:
    """All dimensions within the bounds, cheapest first."""
    claim, plant = document["claim"], plant_of(document)
    small, heard = enumeration.plain(plant), _heard(document)
    base = augmented(small, heard) if claim["share"] == "outputs+states" else small
    needs = _demands(base, heard, plant.time, claim["bound"], claim["free_assignability"])
    costs = [Fraction(c) for c in claim["costs"]]
    # more than every demand is never of use
    most = max((demand for _, demand in needs), default=0)
    ranges = [range(min(most, u if u is not None else most) + 1) for u in claim["upper"]]
    fitting = [
        sum((c * v for c, v in zip(costs, values, strict=True)), Fraction(0))
        for values in itertools.product(*ranges)
        if all(sum(values[i] for i in support) >= demand for support, demand in needs)
    ]
    if not claim["feasible"]:
        return not fitting and claim["dimensions"] is None and claim["cost"] is None
    sizes = claim["dimensions"]
    enough = all(sum(sizes[i] for i in support) >= demand for support, demand in needs)
    within = all(u is None or v <= u for u, v in zip(claim["upper"], sizes, strict=True))
    total = sum((c * v for c, v in zip(costs, sizes, strict=True)), Fraction(0))
    return enough and within and bool(fitting) and min(fitting) == total == Fraction(claim["cost"])


def draw_communication(seed: int) -> Document:
    """The cheapest arcs of a drawn plant."""
    rng = random.Random(seed)
    small = drawn(rng, 3, 3)
    system = exact(small, rng.choice(["continuous", "discrete"]))
    graph = NeighborGraph(system.names, drawn_neighbors(rng, small.m))
    share = rng.choice(["outputs", "outputs+states", "states"])
    sizes = None if share == "outputs" else [rng.randint(0, 2) for _ in range(small.m)]
    found = minimal_communication(system, graph, dimensions=sizes, share=share)  # type: ignore[arg-type]
    document: Document = json.loads(codec.encode(found))
    return document


def confirms_communication(document: Document) -> bool:
    """All sets of candidates."""
    claim, plant = document["claim"], plant_of(document)
    small, heard = enumeration.plain(plant), _heard(document)
    sizes = claim["dimensions"] or [0] * small.m
    names = list(plant.names)
    arcs = {(names.index(j), names.index(i)): Fraction(cost) for j, i, cost in claim["candidates"]}

    def suffices(added: Sequence[tuple[int, int]]) -> bool:
        wider = [sorted({*heard[i], *(j for j, k in added if k == i)}) for i in range(small.m)]
        base = small if claim["share"] == "states" else augmented(small, wider)
        needs = _demands(base, wider, plant.time, claim["bound"], False)
        return all(sum(sizes[i] for i in support) >= demand for support, demand in needs)

    prices = [
        sum((arcs[arc] for arc in added), Fraction(0))
        for count in range(len(arcs) + 1)
        for added in itertools.combinations(arcs, count)
        if suffices(added)
    ]
    if not claim["feasible"]:
        return not prices and claim["added"] is None and claim["cost"] is None
    chosen = [(names.index(j), names.index(i)) for j, i in claim["added"]]
    total = sum((arcs[arc] for arc in chosen), Fraction(0))
    return suffices(chosen) and min(prices) == total == Fraction(claim["cost"])


KINDS = {
    "communication": Registration(draw_communication, confirms_communication),
    "shared_dimensions": Registration(draw_dimensions, confirms_dimensions),
}
