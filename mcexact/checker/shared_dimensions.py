"""Kind ``shared_dimensions``: the least to share; ``proofs/shared_dimensions.md``."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from . import evidence
from .covering import Program, read_bound, require_absence, require_outside
from .exchange import augmented_outputs, extended, neighbors_of
from .reading import boolean, fields, integer, items, names, polynomial, rational, require, string
from .system import System
from .words import channel_set, described

PAIRS = {"outputs+states": "outputs and sub-states", "states": "sub-states"}


def check(claim: Any, witness: Any, system: System) -> str:
    """Check that the dimensions suffice, every cut, and the tree that leaves nothing cheaper."""
    share, limit, free, prices, most, verdict, sizes, total = fields(
        claim, "claim", "share", "bound", "free_assignability", "costs", "upper", "feasible",
        "dimensions", "cost",
    )  # fmt: skip
    absence, listed, tree = fields(witness, "witness", "absence", "cuts", "tree")
    string(share, "claim.share", *PAIRS)
    bound, connected = read_bound(limit, system), boolean(free, "claim.free_assignability")
    costs = [rational(c, "claim.costs") for c in items(prices, "claim.costs", system.m)]
    require(all(c > 0 for c in costs), "claim", "claim.costs", "expected positive costs")
    upper = [
        None if u is None else integer(u, "claim.upper")
        for u in items(most, "claim.upper", system.m)
    ]
    base = augmented_outputs(system, {}, "claim.share") if share == "outputs+states" else system
    cuts = [
        _cut(entry, f"witness.cuts[{k}]", base, neighbors_of(system, "claim"), bound, connected)
        for k, entry in enumerate(items(listed, "witness.cuts"))
    ]
    value: Fraction | None = None
    if boolean(verdict, "claim.feasible"):
        value = rational(total, "claim.cost")
        step = {"share": share, "dimensions": sizes}
        require_absence(absence, extended(system, step, "claim"), bound, connected=connected)
        pairs = list(zip(sizes, costs, upper, strict=True))
        fits = all(u is None or n_i <= u for n_i, _, u in pairs)
        right = value == sum((n_i * c for n_i, c, _ in pairs), Fraction(0))
        require(fits and right, "claim", "claim.cost", "not the cost of dimensions below `upper`")
    else:
        nothing = sizes is None and total is None and absence is None
        require(nothing, "claim", "claim", "expected null where nothing suffices")
    Program(costs, cuts, "agent", system.names, value).require_bound(tree, upper)
    return _theorem(claim, system, value)


def _cut(
    entry: Any, place: str, base: System, N: list[list[int]], bound: Fraction | None, free: bool
) -> tuple[set[int], int]:
    """The boundary N_s∖s and what it has to share at least."""
    if free and isinstance(entry, dict) and "zero" in entry:
        listed, zero = fields(entry, place, "subset", "zero")
        s, demand = names(listed, f"{place}.subset", base.names), 1
        sources, X = evidence.zero_transfer(zero, f"{place}.zero", base)
        proper = sources == evidence.complement(base, s) and 0 < len(s) < base.m
        require(proper, "cut", place, "expected a nonempty proper subset and its complement")
        unseen = all((base.C[i] @ X).is_zero() for i in s)
        require(unseen, "identity", place, "something reaches the subset")
    else:
        listed, factor, deficiency, subspace = fields(
            entry, place, "subset", "polynomial", "deficiency", "subspace"
        )
        s = names(listed, f"{place}.subset", base.names)
        p, demand = polynomial(factor, f"{place}.polynomial", 1), integer(deficiency, place, 1)
        require_outside(p, base, bound, place)
        T = evidence.shrunk_subspace(subspace, f"{place}.subspace", base, p, demand)
        others = evidence.complement(base, s)
        require(others == T, "cut", place, "T is not the complement of s")
    return {j for i in s for j in N[i]} - set(s), demand


def _theorem(claim: dict[str, Any], system: System, value: Fraction | None) -> str:
    modes = "no fixed mode" if claim["bound"] is None else f"no fixed mode beyond {claim['bound']}"
    goal = modes + (" and a strongly connected graph" if claim["free_assignability"] else "")
    limits = f"upper bounds {claim['upper']}, costs {claim['costs']}"
    start = f"to leave the extended system of {described(system)}, sharing {PAIRS[claim['share']]},"
    if value is None:
        return f"{start} with {goal}, no dimensions suffice ({limits})"
    shares = dict(zip(system.names, claim["dimensions"], strict=True))
    agents = channel_set(system, range(system.m))
    return (
        f"{start} with {goal}, dimensions {list(shares.values())} of the agents {agents} suffice, "
        f"and nothing of cost below {value} does ({limits})"
    )
