"""Kind ``shared_dimensions``: the least to share; ``proofs/shared_dimensions.md``."""

from . import covering, evidence, reading, region, subspaces
from .information_structure import SHARED, augmented_outputs, extended, neighbors_of
from .reading import Json, fields, items, require
from .statement import by_channel, canonical_json
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Check that the dimensions suffice, every cut, and the tree that excludes a lower cost.

    Theorems ``allocation.branch_tree``, ``allocation.branch_tree_infeasible``.
    """
    keys = ("share", "bound", "free_assignability", "costs", "upper", "feasible", "dimensions")
    share, limit, free, prices, most, _, sizes, _ = fields(claim, "claim", *keys, "cost")
    absence, listed, tree = fields(witness, "witness", "absence", "cuts", "tree")
    reading.string(share, "claim.share", *SHARED)
    bound = region.read_bound(limit, system)
    connected = reading.boolean(free, "claim.free_assignability")
    costs = [reading.rational(c, "claim.costs") for c in items(prices, "claim.costs", system.m)]
    require(all(c > 0 for c in costs), "claim", "claim.costs", "expected positive costs")
    ceilings = items(most, "claim.upper", system.m)
    upper = [None if u is None else reading.integer(u, "claim.upper") for u in ceilings]
    base = augmented_outputs(system, {}, "claim.share") if share == "outputs+states" else system
    N, cuts = neighbors_of(system, "claim"), []
    for k, entry in enumerate(items(listed, "witness.cuts")):
        s, demand = read_cut(entry, f"witness.cuts[{k}]", base, bound, connected)
        cuts.append(({j for i in s for j in N[i]} - set(s), demand))
    value = region.claimed_cost(claim, "dimensions", absence)
    if value is not None:
        subject = extended(system, {"share": share, "dimensions": sizes}, "claim")
        region.require_absence(absence, subject, bound, connected=connected)
        fits = all(u is None or n_i <= u for n_i, u in zip(sizes, upper, strict=True))
        total = sum(n_i * c for n_i, c in zip(sizes, costs, strict=True))
        right = fits and value == total
        require(right, "claim", "claim.cost", "not the cost of dimensions below `upper`")
    covering.Program(costs, cuts, "agent", system.names, value).require_bound(tree, upper)


def statement(claim: Json, system: System) -> str:
    """Which dimensions suffice, at which cost, and that nothing cheaper does."""
    upper, costs, sizes = (
        canonical_json(value and by_channel(system, value))
        for value in (claim["upper"], claim["costs"], claim["dimensions"])
    )
    goal = region.no_fixed_mode(claim["bound"], system)
    if claim["free_assignability"]:
        goal += " and a strongly connected transfer graph"
    start = f"the extended system without delays sharing {SHARED[claim['share']]} has {goal} for"
    end = f"dimensions with the upper bounds {upper} and the costs {costs} of one dimension each"
    if not claim["feasible"]:
        return f"{start} no {end}"
    return f"{start} the dimensions {sizes} of cost {claim['cost']}, and for no cheaper {end}"


def read_cut(
    entry: Json, place: str, base: System, bound: region.Bound, free: bool
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
        T, X = subspaces.zero_transfer(zero, f"{place}.zero", base)
        unseen = 0 < len(s) < base.m and all((base.C[i] @ X).is_zero() for i in s)
        require(unseen, "identity", place, "something reaches the subset, or it is not proper")
    else:
        keys = ("subset", "polynomial", "deficiency", "subspace")
        listed, factor, number, subspace = fields(entry, place, *keys)
        s = reading.names(listed, f"{place}.subset", base.names)
        p, demand = reading.polynomial(factor, place, 1), reading.integer(number, place, 1)
        region.require_outside(p, base, bound, place)
        T = subspaces.shrunk_subspace(subspace, f"{place}.subspace", base, p, demand)
    require(evidence.complement(base, s) == T, "cut", place, "T is not the complement of s")
    return s, demand
