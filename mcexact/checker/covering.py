"""Branch trees of covering programs; ``proofs/shared_dimensions.md``."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from . import budget
from .reading import Json, fields, integer, items, malformed, rational, require

Upper = Sequence[int | None]
"""The most that each variable can be; None where there is no limit."""


@dataclass(frozen=True)
class Program:
    """Minimize Σ c_i x_i over integers with Σ_{i ∈ S} x_i ≥ d for every cut (S, d).

    ``labels`` are the names of the variables in the tree, under the key ``key``; without a
    ``value`` the tree has to show that the cuts have no common point.
    """

    costs: Sequence[Fraction]
    cuts: Sequence[tuple[set[int], int]]
    key: str
    labels: Sequence[Json]
    value: Fraction | None

    def require_bound(self, nodes: Json, upper: Upper) -> None:
        """Stop unless the tree proves that every point below ``upper`` costs at least ``value``.

        The nodes come in preorder: an inner node, then its tree below, then its tree above.

        Theorems ``allocation.branch_tree``, ``allocation.branch_tree_infeasible``.
        """
        if self.value is not None:
            # a cheaper point has x_i ≤ value / c_i, all costs being positive
            implied = [math.floor(self.value / c) for c in self.costs]
            budget.spend(budget.fractions(len(self.costs), self._limbs()))
            upper = [b if u is None else min(u, b) for u, b in zip(upper, implied, strict=True)]
        boxes: list[Json] = [([0] * len(self.costs), list(upper))]
        for number, node in enumerate(items(nodes, "witness.tree")):
            place = f"witness.tree[{number}]"
            budget.spend(20 * len(self.costs) + 200)
            require(bool(boxes), "tree", place, "more nodes than the tree has places")
            low, high = boxes.pop()
            if isinstance(node, dict) and "violated" in node:
                (cut,) = fields(node, place, "violated")
                support, demand = self._cut(cut, place)
                budget.spend(10 * len(support))
                known = [high[i] for i in support if high[i] is not None]
                enough = len(known) == len(support) and sum(known) < demand
                require(enough, "leaf", place, "the upper bounds do not violate that cut")
            elif isinstance(node, dict) and "multipliers" in node:
                self._require_multipliers(node, place, low, high)
            else:
                label, split = fields(node, place, self.key, "at_most")
                if label not in self.labels:
                    malformed(f"{place}.{self.key}", "expected a variable of the claim")
                i, k = self.labels.index(label), integer(split, f"{place}.at_most")
                boxes.append(([*low[:i], k + 1, *low[i + 1 :]], high))
                boxes.append((low, [*high[:i], k, *high[i + 1 :]]))
        require(not boxes, "tree", "witness.tree", "a branch of the tree is missing")

    def _limbs(self) -> int:
        """The limbs of the longest cost, or of the value."""
        return budget.limbs_of((*self.costs, self.value or 0))

    def _cut(self, number: Json, place: str) -> tuple[set[int], int]:
        if integer(number, place) >= len(self.cuts):
            malformed(place, f"expected the number of a cut, below {len(self.cuts)}")
        return self.cuts[int(number)]

    def _require_multipliers(self, node: Json, place: str, low: list[int], high: Upper) -> None:
        (listed,) = fields(node, place, "multipliers")
        require(self.value is not None, "leaf", place, "expected a violated cut")
        reduced, bound, longest = list(self.costs), Fraction(0), self._limbs()
        for entry in items(listed, place):
            number, weight = items(entry, place, 2)
            support, demand = self._cut(number, place)
            y = rational(weight, place)
            require(y >= 0, "leaf", place, "expected multipliers that are not negative")
            longest += budget.limbs_of((y, demand))
            budget.spend(budget.fractions(len(support) + 2, longest))
            bound += y * demand
            for i in support:
                reduced[i] -= y
        longest += len(reduced) * self._limbs() + budget.limbs(low)
        longest += budget.limbs(most for most in high if most is not None)
        budget.spend(budget.fractions(2 * len(reduced) + 2, longest))
        for r, least, most in zip(reduced, low, high, strict=True):
            bound += r * least if r >= 0 else r * (most or 0)
        grid = math.lcm(1, *(c.denominator for c in self.costs))
        proved = Fraction(math.ceil(bound * grid), grid)
        require(proved >= (self.value or 0), "leaf", place, f"proves only {proved}")
