"""Kinds about shared dimensions and links.

Each claim names a least cost.  That it suffices is proved by the absence of fixed modes outside the
allowed region (`modes.require_fixed_modes_inside`).  That nothing cheaper suffices is proved by a
covering program: each cut says of which variables the sum must be at least d, and is proved by a
loss of rank, or by channels that others do not reach.  A branch tree proves that no integer point
that meets all cuts costs less, or that none exists (`Program`).  The kind ``common_dimension`` has
one variable, and needs one subset of channels instead of a tree.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from . import modes
from .constructions import SHARED, arcs, augmented_outputs, extended, neighbors_of, shared
from .core import budget, evidence, reading
from .core.arithmetic import Matrix, diagonal
from .core.budget import spend
from .core.reading import Json, fields, integer, items, malformed, names, rational, require
from .core.system import FIXED, System, by_channel, canonical_json, edge_set

# Branch trees of covering programs; ``proofs/shared_dimensions.md``.

Upper = Sequence[int | None]
"""The upper bound of each variable; None where there is no limit."""


@dataclass(frozen=True)
class Program:
    """Minimize Σ c_i x_i over integers with Σ_{i ∈ S} x_i ≥ d for every cut (S, d).

    ``labels`` are the names of the variables in the tree, under the key ``key``; the tree has to
    show that nothing costs less than ``value``, or without it that the cuts have no common point.
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
            end = least if r >= 0 else most
            if end is None:
                malformed(place, "a variable without an upper bound costs less the larger it is")
            bound += r * end
        grid = math.lcm(1, *(c.denominator for c in self.costs))
        proved = Fraction(math.ceil(bound * grid), grid)
        require(proved >= (self.value or 0), "leaf", place, f"proves only {proved}")


# Kind ``shared_dimensions``: the least to share; ``proofs/shared_dimensions.md``.


def check_shared_dimensions(claim: Json, witness: Json, system: System) -> None:
    """Check that the dimensions suffice, every cut, and the tree that excludes a lower cost.

    Where `at_least` is claimed, the tree excludes what costs less than that.

    Theorems ``allocation.branch_tree``, ``allocation.branch_tree_infeasible``.
    """
    keys = ("share", "bound", "free_assignability", "costs", "upper", "feasible", "dimensions")
    found = fields(claim, "claim", *keys, "cost", optional=("at_least",))
    share, limit, free, prices, most, _, sizes, _, least = found
    absence, listed, tree = fields(witness, "witness", "absence", "cuts", "tree")
    reading.string(share, "claim.share", *SHARED)
    bound = modes.read_rate_or_radius(limit, system)
    connected = reading.boolean(free, "claim.free_assignability")
    costs = [reading.rational(c, "claim.costs") for c in items(prices, "claim.costs", system.m)]
    require(all(c > 0 for c in costs), "claim", "claim.costs", "expected positive costs")
    ceilings = items(most, "claim.upper", system.m)
    upper = [None if u is None else reading.integer(u, "claim.upper") for u in ceilings]
    base = augmented_outputs(system, {}, "claim.share") if share == "outputs+states" else system
    N, cuts, subsets = neighbors_of(system, "claim"), [], []
    for k, entry in enumerate(items(listed, "witness.cuts")):
        s, demand = read_cut(entry, f"witness.cuts[{k}]", base, bound, connected)
        cuts.append(({j for i in s for j in N[i]} - set(s), demand))
        subsets.append(set(s))
    value = modes.claimed_cost(claim, "dimensions", absence)
    if value is not None:
        subject = extended(system, {"share": share, "dimensions": sizes}, "claim")
        modes.require_fixed_modes_inside(absence, subject, bound, connected=connected)
        fits = all(u is None or n_i <= u for n_i, u in zip(sizes, upper, strict=True))
        total = sum(n_i * c for n_i, c in zip(sizes, costs, strict=True))
        right = fits and value == total
        require(right, "claim", "claim.cost", "not the cost of dimensions below `upper`")
    if least is not None:
        below = reading.rational(least, "claim.at_least")
        less = value is not None and 0 <= below < value
        require(less, "claim", "claim.at_least", "expected less than the cost, and at least 0")
        value = below
    program = Program(costs, cuts, "agent", system.names, value)
    first = tree[0] if isinstance(tree, list) and tree else None
    if isinstance(first, dict) and "nested" in first:
        require(not connected, "nested", "witness.tree", "expected a branch tree")
        require_nested(items(tree, "witness.tree", 1)[0], program, subsets)
    else:
        program.require_bound(tree, upper)


def require_nested(node: Json, program: Program, subsets: list[set[int]]) -> None:
    """Stop unless nested sets prove that no dimensions cost less than ``value``.

    The sets ascend.  Their multipliers are positive, and for every agent those of the sets whose
    boundary has it sum up to at most its cost.

    Theorems ``nested_sets.total_at_least``, ``nested_sets.total_at_least_states``.
    """
    place = "witness.tree[0]"
    (listed,) = fields(node, place, "nested")
    require(program.value is not None, "nested", place, "expected a violated cut")
    around, proved, inner = [Fraction(0)] * len(program.costs), Fraction(0), None
    longest = budget.limbs_of((*program.costs, program.value or 0))
    for entry in items(listed, place):
        number, weight = items(entry, place, 2)
        if integer(number, place) >= len(subsets):
            malformed(place, f"expected the number of a cut, below {len(subsets)}")
        (support, demand), y = program.cuts[number], rational(weight, place)
        require(y > 0, "nested", place, "expected positive multipliers")
        nested = inner is None or inner < subsets[number]
        require(nested, "nested", place, "the sets are not nested, in ascending order")
        inner = subsets[number]
        longest += budget.limbs_of((y, demand))
        spend(budget.fractions(len(support) + 2, longest) + 10 * len(inner))
        proved += y * demand
        for i in support:
            around[i] += y
    spend(budget.fractions(len(around) + 1, longest))
    fits = all(y <= c for y, c in zip(around, program.costs, strict=True))
    require(fits, "nested", place, "an agent is in boundaries of more than its cost")
    require(proved >= (program.value or 0), "nested", place, f"proves only {proved}")


def shared_dimensions_statement(claim: Json, system: System) -> str:
    """Which dimensions suffice, at which cost, and that nothing cheaper does."""
    upper, costs, sizes = (
        canonical_json(value and by_channel(system, value))
        for value in (claim["upper"], claim["costs"], claim["dimensions"])
    )
    goal = modes.no_fixed_mode(claim["bound"], system)
    if claim["free_assignability"]:
        goal += " and a strongly connected transfer graph"
    start = f"the extended system without delays sharing {SHARED[claim['share']]} has {goal} for"
    end = f"dimensions with the upper bounds {upper} and the costs {costs} of one dimension each"
    if not claim["feasible"]:
        return f"{start} no {end}"
    cheaper = "no cheaper"
    if "at_least" in claim:
        end, cheaper = f"{end}, of cost below {claim['at_least']}", "no"
    return f"{start} the dimensions {sizes} of cost {claim['cost']}, and for {cheaper} {end}"


def read_cut(
    entry: Json, place: str, base: System, bound: modes.RateOrRadius, free: bool
) -> tuple[list[int], int]:
    """A subset s, and how much its boundary N_s∖s has to share at least.

    Theorems ``shared_dimensions.dimensions_cut_outputs``,
    ``shared_dimensions.dimensions_cut_states``, ``shared_dimensions.connection_cut_outputs``,
    ``shared_dimensions.connection_cut_states``, ``extended.rank_extended``,
    ``extended.rank_extended_states``, ``transfer_graph.zero_transfer_cut``.
    """
    if free and isinstance(entry, dict) and "zero" in entry:
        listed, zero = fields(entry, place, "subset", "zero")
        s, demand = reading.names(listed, f"{place}.subset", base.names), 1
        T, X = evidence.zero_transfer(zero, f"{place}.zero", base)
        unseen = 0 < len(s) < base.m and all((base.C[i] @ X).is_zero() for i in s)
        require(unseen, "identity", place, "something reaches the subset, or it is not proper")
    else:
        keys = ("subset", "polynomial", "deficiency", "subspace")
        listed, factor, number, subspace = fields(entry, place, *keys)
        s = reading.names(listed, f"{place}.subset", base.names)
        p, demand = reading.polynomial(factor, place, 1), reading.integer(number, place, 1)
        modes.require_outside(p, base, bound, place)
        T = evidence.Losses(base).checked(subspace, f"{place}.subspace", p, demand)
    require(evidence.complement(base, s) == T, "cut", place, "T is not the complement of s")
    return s, demand


# Kind ``common_dimension``: the least common dimension; ``proofs/common_dimension.md``.


def check_common_dimension(claim: Json, witness: Json, system: System) -> None:
    """Check that k dimensions of each agent suffice, and that for one subset k − 1 do not.

    Theorems ``shared_dimensions.common_dimension_outputs``,
    ``shared_dimensions.common_dimension_states``, ``shared_dimensions.frees_more``,
    ``shared_dimensions.frees_states_more``, ``shared_dimensions.no_common_dimension_outputs``,
    ``shared_dimensions.no_common_dimension_states``.
    """
    share, listed, number = fields(claim, "claim", "share", "feasible", "dimension")
    absence, cut = fields(witness, "witness", "absence", "cut")
    reading.string(share, "claim.share", *SHARED)
    feasible, N = reading.boolean(listed, "claim.feasible"), neighbors_of(system, "claim")
    k = 0
    if feasible:
        k = reading.integer(number, "claim.dimension")
        step = {"share": share, "dimensions": [k] * system.m}
        modes.require_fixed_modes_inside(absence, extended(system, step, "claim.dimension"), None)
    else:
        nothing = number is None and absence is None
        require(nothing, "claim", "claim", "expected null where nothing suffices")
    needed = not feasible or k > 0
    require((cut is not None) == needed, "cut", "witness.cut", "expected unless 0 suffices")
    if needed:
        outputs = share == "outputs+states"
        base = augmented_outputs(system, {}, "claim.share") if outputs else system
        s, lost = read_cut(cut, "witness.cut", base, None, False)
        around = len({j for i in s for j in N[i]} - set(s))
        short = around * (k - 1) < lost if feasible else around == 0
        require(short, "cut", "witness.cut", f"{around} agents around the subset can do with less")


def common_dimension_statement(claim: Json, system: System) -> str:
    """For which common dimensions no mode is fixed."""
    when = f"exactly for k >= {claim['dimension']}" if claim["feasible"] else "for no k"
    what = f"{SHARED[claim['share']]} of dimension k for each agent"
    return f"the extended system without delays sharing {what} has no mode that is {FIXED} {when}"


# Kind ``communication``: the cheapest links to add; ``proofs/communication.md``.

CLAIM = ("share", "dimensions", "bound", "candidates", "feasible", "added", "cost")


def check_communication(claim: Json, witness: Json, system: System) -> None:
    """Check that the added links suffice, every cut, and the tree that excludes a lower cost.

    Theorem ``allocation.communication_cut``.
    """
    share, sizes, limit, listed, _, added, _ = fields(claim, "claim", *CLAIM)
    absence, cuts, tree = fields(witness, "witness", "absence", "cuts", "tree")
    reading.string(share, "claim.share", "outputs", "outputs+states", "states")
    if system.neighbors is None:
        system = replace(system, neighbors=[[i] for i in range(system.m)])
    require((sizes is None) == (share == "outputs"), "claim", "claim.dimensions", "do not fit")
    bound, known = modes.read_rate_or_radius(limit, system), candidates(listed, system)
    costs, ends = [cost for *_, cost in known], [(j, i) for j, i, _ in known]
    make, step = extended, {"share": share, "dimensions": sizes}
    if sizes is None:
        make, step = augmented_outputs, {}
    subject, needs = make(system, step, "claim"), []
    for place, entry in ((f"witness.cuts[{k}]", e) for k, e in enumerate(items(cuts, "cuts"))):
        factor, subspace = fields(entry, place, "polynomial", "subspace")
        p = reading.polynomial(factor, f"{place}.polynomial", 1)
        modes.require_outside(p, subject, bound, place)
        T = evidence.shrunk_subspace(subspace, f"{place}.subspace", subject, p, 1)
        width = len(subspace["pivots"])
        U = reading.polynomial_matrix(subspace["U"], place, subject.n, width, len(p) - 1)
        rows = [carried(system, share, sizes, j) for j in range(system.m)]
        sends = [j for j, S in enumerate(rows) if any(not (S @ part).is_zero() for part in U)]
        spend(4 * len(ends) * (2 + len(sends) + len(T)))
        needs.append(({v for v, (j, i) in enumerate(ends) if j in sends and i not in T}, 1))
    value = modes.claimed_cost(claim, "added", absence)
    if value is not None:
        chosen = [link(e, "claim.added", system) for e in items(added, "claim.added")]
        spend(4 * len(chosen) * len(known))
        right = chosen == sorted(set(chosen)) and set(chosen) <= set(ends)
        total = sum(c for j, i, c in known if (j, i) in chosen)
        require(right and value == total, "claim", "claim.cost", "not the cost of such candidates")
        final = make(arcs(system, {"added": added}, "claim.added"), step, "claim")
        modes.require_fixed_modes_inside(absence, final, bound)
    labels = [[system.names[j], system.names[i]] for j, i in ends]
    Program(costs, needs, "arc", labels, value).require_bound(tree, [1] * len(ends))


def communication_statement(claim: Json, system: System) -> str:
    """Which links suffice, at which cost, and that nothing cheaper does."""
    share, added = claim["share"], claim["added"]
    signals = share if share == "outputs" else shared(system, share, claim["dimensions"])
    freedom = modes.no_fixed_mode(claim["bound"], system)
    goal = f"{signals} with neighbors, without delay, leaves {freedom}"
    graph = "the graph without edges" if system.neighbors is None else "its neighbor graph"
    listed = f"the candidate links, with their costs, {edge_set(claim['candidates'])}"
    if not claim["feasible"]:
        return f"no set out of {listed}, added to {graph}, is such that sharing {goal}"
    start = f"with the links {edge_set(added)}, of cost {claim['cost']}, added to {graph}"
    return f"{start}, sharing {goal}, and so it does with no set of lower cost out of {listed}"


def link(value: Json, place: str, system: System) -> tuple[int, int]:
    """Read a link [from, to] as a pair of positions of channels."""
    j, i = (names([end], place, system.names)[0] for end in items(value, place, 2))
    return j, i


def candidates(value: Json, system: System) -> list[tuple[int, int, Fraction]]:
    """The candidate links, which the graph lacks, with their costs."""
    place, N, links = "claim.candidates", neighbors_of(system, "claim"), []
    for *ends, price in (items(entry, place, 3) for entry in items(value, place)):
        links.append((*link(ends, place, system), rational(price, place)))
    keys = [(j, i) for j, i, _ in links]
    spend(len(keys) * (100 + system.m))
    if keys != sorted(set(keys)) or any(j in N[i] for j, i in keys):
        malformed(place, "expected links that the graph lacks, sorted, none twice")
    require(all(c > 0 for *_, c in links), "claim", place, "expected positive costs")
    return links


def carried(system: System, share: str, sizes: Json, j: int) -> Matrix:
    """S_j: C_j, diag(C_j, E_j') or [0, E_j'], the rows that a link from j adds to the outputs.

    Theorem ``allocation.communication_cut``.
    """
    C = Matrix.zeros(0, system.n) if share == "states" else system.C[j]
    if sizes is None:
        return C
    return diagonal(C, Matrix.unit_rows(sum(sizes), sum(sizes[:j]), sizes[j]))
