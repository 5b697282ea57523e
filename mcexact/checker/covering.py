"""Branch trees and absence, for allocations; ``proofs/shared_dimensions.md``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from . import evidence
from .arithmetic import (
    Polynomial,
    characteristic_polynomial,
    characteristic_polynomial_modulo,
    exponent,
    poly_modulo,
)
from .location import in_region
from .reading import boolean, fields, integer, items, malformed, polynomial, rational, require
from .system import System
from .transfer_graph import read_arcs, require_arcs


@dataclass(frozen=True)
class Program:
    """Σ c_i x_i is to be small, Σ_{i ∈ S} x_i ≥ d for every cut (S, d), the x_i integers.

    ``labels`` are the names of the variables in the tree, under the key ``key``; without a
    ``value`` the tree has to show that there is no point at all.
    """

    costs: Sequence[Fraction]
    cuts: Sequence[tuple[set[int], int]]
    key: str
    labels: Sequence[Any]
    value: Fraction | None

    def require_bound(self, node: Any, upper: Sequence[int | None]) -> None:
        """Stop unless the tree proves that every point below ``upper`` costs at least ``value``."""
        if (
            self.value is not None
        ):  # a cheaper point has x_i ≤ value / c_i, all costs being positive
            implied = [math.floor(self.value / c) for c in self.costs]
            upper = [b if u is None else min(u, b) for u, b in zip(upper, implied, strict=True)]
        stack = [(node, "witness.tree", [0] * len(self.costs), list(upper))]
        while stack:
            here, place, low, high = stack.pop()
            if isinstance(here, dict) and "violated" in here:
                (number,) = fields(here, place, "violated")
                support, demand = self._cut(number, place)
                limits = [high[i] for i in support]
                known = [u for u in limits if u is not None]
                enough = len(known) == len(limits) and sum(known) < demand
                require(enough, "leaf", place, "the upper bounds do not violate that cut")
            elif isinstance(here, dict) and "multipliers" in here:
                self._require_multipliers(here, place, low, high)
            else:
                label, split, below, above = fields(
                    here, place, self.key, "at_most", "below", "above"
                )
                if label not in self.labels:
                    malformed(f"{place}.{self.key}", "expected a variable of the claim")
                i, k = self.labels.index(label), integer(split, f"{place}.at_most")
                stack.append((below, f"{place}.below", low, [*high[:i], k, *high[i + 1 :]]))
                stack.append((above, f"{place}.above", [*low[:i], k + 1, *low[i + 1 :]], high))

    def _cut(self, number: Any, place: str) -> tuple[set[int], int]:
        if integer(number, place) >= len(self.cuts):
            malformed(place, f"expected the number of a cut, below {len(self.cuts)}")
        return self.cuts[int(number)]

    def _require_multipliers(
        self, node: Any, place: str, low: list[int], high: list[int | None]
    ) -> None:
        (listed,) = fields(node, place, "multipliers")
        require(self.value is not None, "leaf", place, "expected a violated cut")
        reduced, bound = list(self.costs), Fraction(0)
        for entry in items(listed, place):
            number, weight = items(entry, place, 2)
            support, demand = self._cut(number, place)
            y = rational(weight, place)
            require(y >= 0, "leaf", place, "expected multipliers that are not negative")
            bound += y * demand
            for i in support:
                reduced[i] -= y
        for r, least, most in zip(reduced, low, high, strict=True):
            bound += r * least if r >= 0 else r * (most or 0)
        grid = math.lcm(1, *(c.denominator for c in self.costs))
        proved = Fraction(math.ceil(bound * grid), grid)
        require(proved >= (self.value or 0), "leaf", place, f"proves only {proved}")


def require_absence(
    value: Any, system: System, bound: Fraction | None, *, connected: bool = False
) -> None:
    """Stop unless every fixed mode lies in the region; and the graph is connected, if asked."""
    place = "witness.absence"
    gains, number, listed, arcs = fields(value, place, "gains", "modulus", "allowed", "arcs")
    ell = evidence.modulus(number, f"{place}.modulus")
    A_F = evidence.closed_loop(system, evidence.read_gains(gains, f"{place}.gains", system))
    after = characteristic_polynomial_modulo(A_F.modulo(ell), ell)
    allowed = items(listed, f"{place}.allowed")
    if allowed:
        rest = characteristic_polynomial(system.A)
        for k, entry in enumerate(allowed):
            where = f"{place}.allowed[{k}]"
            factor, power = items(entry, where, 2)
            p = polynomial(factor, where, 1)
            inside = in_region(p, system.time, bound)
            require(inside, "region", where, "has a root outside the region")
            times, quotient = exponent(p, rest)
            require(times == integer(power, where, 1), "exponent", where, f"divides {times} times")
            rest = quotient
        before = poly_modulo(rest, ell)
    else:
        before = characteristic_polynomial_modulo(system.A.modulo(ell), ell)
    what = "det(xI - A) without the allowed factors and det(xI - A_F)"
    evidence.require_coprime(before, after, ell, what)
    require((arcs is not None) == connected, "claim", f"{place}.arcs", "expected iff claimed")
    if arcs is not None:
        found = read_arcs(arcs, f"{place}.arcs", system)
        require_arcs(system, found, ell)
        parts = evidence.components(system.m, [(j, i) for j, i, _ in found])
        require(len(parts) <= 1, "arc", f"{place}.arcs", "these arcs do not connect all channels")


def read_bound(value: Any, system: System) -> Fraction | None:
    """A rate ≥ 0 in continuous time, a radius in (0, 1] in discrete time, or null."""
    if value is None:
        return None
    bound = rational(value, "claim.bound")
    fits = bound >= 0 if system.time == "continuous" else 0 < bound <= 1
    require(fits, "bound", "claim.bound", "expected a rate >= 0, or a radius in (0, 1]")
    return bound


def require_outside(p: Polynomial, system: System, bound: Fraction | None, place: str) -> None:
    """Stop if every root of p is where a fixed mode may stay."""
    inside = in_region(p, system.time, bound)
    require(not inside, "region", place, "every root lies inside the region")


def claimed_cost(claim: dict[str, Any], answer: str, absence: Any) -> Fraction | None:
    """The cost of the claimed answer; None where nothing suffices, and then there is no answer."""
    if boolean(claim["feasible"], "claim.feasible"):
        return rational(claim["cost"], "claim.cost")
    nothing = claim[answer] is None and claim["cost"] is None and absence is None
    require(nothing, "claim", "claim", "expected null where nothing suffices")
    return None
