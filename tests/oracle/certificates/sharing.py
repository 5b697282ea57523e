"""What agents must share, by enumeration of all dimensions and all sets of links."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from flint import fmpq, fmpq_poly

from . import algebra
from .constructions import augmented_outputs, extended
from .modes import connected, fixed_modes, pencil_rank, subsets, transfer_edges
from .reading import Unspecified, demand, edges, integer, listed, place, rational, record, truth
from .roots import inside
from .systems import System

Demand = tuple[frozenset[int], int]
SHARES = ("outputs+states", "states")


@dataclass(frozen=True)
class Region:
    """The modes that may stay: none without a bound."""

    time: str
    bound: fmpq | None

    def violated_by(self, p: fmpq_poly) -> bool:
        """Whether a root of an irreducible polynomial is not inside the region."""
        return self.bound is None or not inside(p, self.time, self.bound)


def demands(plant: System, share: str, region: Region, *, free: bool = False) -> list[Demand]:
    """All Σ n_i ≥ d, i ∈ N_s∖s, for every subset s.

    The rank of P̄_s(λ) is rank P_s(λ) + Σ n_i + Σ n_i over N_s∖s, of n + Σ n_i that are needed.
    """
    graph = plant.graph()
    base = augmented_outputs(plant, {}) if share != "states" else plant
    modes = [p for p, _ in algebra.irreducible_factors(base.A.charpoly()) if region.violated_by(p)]
    arcs = set(transfer_edges(base)) if free else set()
    found = []
    for s in subsets(base.m):
        most = max((base.n - pencil_rank(base, s, p) for p in modes), default=0)
        outside = [j for j in range(base.m) if j not in s]
        if free and s and outside and not any((j, i) in arcs for j in outside for i in s):
            most = max(most, 1)
        if most > 0:
            found.append((frozenset(j for i in s for j in graph[i]) - frozenset(s), most))
    return found


def meets(sizes: Sequence[int], needed: Sequence[Demand]) -> bool:
    """Whether dimensions satisfy all demands."""
    return all(sum(sizes[i] for i in support) >= d for support, d in needed)


def free_of_fixed_modes(
    plant: System, share: str, sizes: Sequence[int], region: Region, *, free: bool = False
) -> bool:
    """The definition itself, for the extended system of these dimensions."""
    system = extended(plant, {"share": share, "dimensions": list(sizes)})
    if any(region.violated_by(mode.polynomial) for mode in fixed_modes(system)):
        return False
    return not free or connected(system)


def _optional(value: Any) -> fmpq | None:
    return None if value is None else rational(value)


def shared_dimensions(claim: Any, witness: Any, system: System) -> bool:
    """All dimensions within the upper bounds, cheapest first."""
    keys = ("share", "bound", "free_assignability", "costs", "upper", "feasible", "dimensions")
    bounded = isinstance(claim, dict) and "at_least" in claim
    found = record(claim, *keys, "cost", *["at_least"] * bounded)
    share, m = found["share"], system.m
    demand(share in SHARES, "expected what is shared")
    region = Region(system.time, _optional(found["bound"]))
    free = truth(found["free_assignability"])
    costs = [rational(c) for c in listed(found["costs"], m)]
    upper = [None if u is None else integer(u, 0) for u in listed(found["upper"], m)]
    if any(c <= 0 for c in costs):
        return False
    needed = demands(system, share, region, free=free)
    most = max((d for _, d in needed), default=0)
    ranges = [range(most + 1 if u is None else min(most, u) + 1) for u in upper]
    prices = [
        sum((c * v for c, v in zip(costs, sizes, strict=True)), fmpq(0))
        for sizes in itertools.product(*ranges)
        if meets(sizes, needed)
    ]
    if not truth(found["feasible"]):
        nothing = found["dimensions"] is None and found["cost"] is None
        return not prices and nothing and not bounded
    sizes = [integer(d, 0) for d in listed(found["dimensions"], m)]
    if any(u is not None and d > u for d, u in zip(sizes, upper, strict=True)):
        return False
    total = sum((c * v for c, v in zip(costs, sizes, strict=True)), fmpq(0))
    holds = free_of_fixed_modes(system, share, sizes, region, free=free)
    if holds is not meets(sizes, needed):
        raise ArithmeticError("the formula for ranks of extended systems fails")
    if not holds or total != rational(found["cost"]):
        return False
    if bounded:
        return bool(
            0 <= rational(found["at_least"]) <= min(prices) and rational(found["at_least"]) < total
        )
    return bool(total == min(prices))


def common_dimension(claim: Any, witness: Any, system: System) -> bool:
    """Every k up to more than any demand."""
    found = record(claim, "share", "feasible", "dimension")
    demand(found["share"] in SHARES, "expected what is shared")
    region = Region(system.time, None)
    needed = demands(system, found["share"], region)
    most = max((d for _, d in needed), default=0)
    enough = [k for k in range(most + 1) if meets([k] * system.m, needed)]
    if not truth(found["feasible"]):
        return not enough and found["dimension"] is None
    k = integer(found["dimension"], 0)
    holds = free_of_fixed_modes(system, found["share"], [k] * system.m, region)
    return holds and enough[:1] == [k]


def communication(claim: Any, witness: Any, system: System) -> bool:
    """Every set of candidates."""
    keys = ("share", "dimensions", "bound", "candidates", "feasible", "added", "cost")
    found = record(claim, *keys)
    share, m = found["share"], system.m
    demand(share in (*SHARES, "outputs"), "expected what is shared")
    if (found["dimensions"] is None) is not (share == "outputs"):
        raise Unspecified("expected dimensions unless outputs alone are shared")
    sizes = (
        [0] * m if share == "outputs" else [integer(d, 0) for d in listed(found["dimensions"], m)]
    )
    graph = system.neighborhoods or tuple((i,) for i in range(m))
    plant = replace(system, neighborhoods=graph)
    prices = _candidates(found["candidates"], plant)
    region = Region(system.time, _optional(found["bound"]))
    sufficient = [
        sum((prices[link] for link in added), fmpq(0))
        for added in _sets(list(prices))
        if meets(sizes, demands(_widened(plant, added), share, region))
    ]
    if not truth(found["feasible"]):
        return not sufficient and found["added"] is None and found["cost"] is None
    added = edges(found["added"], system.names)
    if any(link not in prices for link in added):
        return False
    wider = _widened(plant, added)
    if share == "outputs":
        fixed = fixed_modes(augmented_outputs(wider, {}))
        holds = not any(region.violated_by(mode.polynomial) for mode in fixed)
    else:
        holds = free_of_fixed_modes(wider, share, sizes, region)
    total = sum((prices[link] for link in added), fmpq(0))
    return holds and total == rational(found["cost"]) == min(sufficient)


def _candidates(value: Any, plant: System) -> Mapping[tuple[int, int], fmpq]:
    rows = [listed(row, 3) for row in listed(value)]
    links = [(place(j, plant.names), place(i, plant.names)) for j, i, _ in rows]
    demand(links == sorted(set(links)), "expected sorted candidates")
    demand(all(j not in plant.graph()[i] for j, i in links), "expected links that are not there")
    costs = [rational(row[2]) for row in rows]
    demand(all(c > 0 for c in costs), "expected costs above 0")
    return dict(zip(links, costs, strict=True))


def _sets(links: Sequence[tuple[int, int]]) -> Iterator[tuple[tuple[int, int], ...]]:
    for count in range(len(links) + 1):
        yield from itertools.combinations(links, count)


def _widened(plant: System, added: Sequence[tuple[int, int]]) -> System:
    neighborhoods = [
        tuple(sorted({*h, *(j for j, k in added if k == i)})) for i, h in enumerate(plant.graph())
    ]
    return replace(plant, neighborhoods=tuple(neighborhoods))


JUDGES = {
    "common_dimension": common_dimension,
    "communication": communication,
    "shared_dimensions": shared_dimensions,
}
"""The judge of each kind."""
