"""Kind ``communication``: the cheapest links to add; ``proofs/communication.md``."""

from dataclasses import replace
from fractions import Fraction

from . import covering, reading, region, subspaces
from .arithmetic import Matrix, diagonal
from .budget import spend
from .information_structure import arcs, augmented_outputs, extended, neighbors_of, shared
from .reading import Json, fields, items, malformed, names, rational, require
from .statement import edge_set
from .system import System

CLAIM = ("share", "dimensions", "bound", "candidates", "feasible", "added", "cost")


def check(claim: Json, witness: Json, system: System) -> None:
    """Check that the added links suffice, every cut, and the tree that excludes a lower cost.

    Theorem ``allocation.communication_cut``.
    """
    share, sizes, limit, listed, _, added, _ = fields(claim, "claim", *CLAIM)
    absence, cuts, tree = fields(witness, "witness", "absence", "cuts", "tree")
    reading.string(share, "claim.share", "outputs", "outputs+states", "states")
    if system.neighbors is None:
        system = replace(system, neighbors=[[i] for i in range(system.m)])
    require((sizes is None) == (share == "outputs"), "claim", "claim.dimensions", "do not fit")
    bound, known = region.read_bound(limit, system), candidates(listed, system)
    costs, ends = [cost for *_, cost in known], [(j, i) for j, i, _ in known]
    make, step = extended, {"share": share, "dimensions": sizes}
    if sizes is None:
        make, step = augmented_outputs, {}
    subject, found = make(system, step, "claim"), []
    for place, entry in ((f"witness.cuts[{k}]", e) for k, e in enumerate(items(cuts, "cuts"))):
        factor, subspace = fields(entry, place, "polynomial", "subspace")
        p = reading.polynomial(factor, f"{place}.polynomial", 1)
        region.require_outside(p, subject, bound, place)
        T = subspaces.shrunk_subspace(subspace, f"{place}.subspace", subject, p, 1)
        width = len(subspace["pivots"])
        U = reading.polynomial_matrix(subspace["U"], place, subject.n, width, len(p) - 1)
        rows = [carried(system, share, sizes, j) for j in range(system.m)]
        sends = [j for j, S in enumerate(rows) if any(not (S @ part).is_zero() for part in U)]
        spend(4 * len(ends) * (2 + len(sends) + len(T)))
        found.append(({v for v, (j, i) in enumerate(ends) if j in sends and i not in T}, 1))
    value = region.claimed_cost(claim, "added", absence)
    if value is not None:
        chosen = [link(e, "claim.added", system) for e in items(added, "claim.added")]
        spend(4 * len(chosen) * len(known))
        right = chosen == sorted(set(chosen)) and set(chosen) <= set(ends)
        total = sum(c for j, i, c in known if (j, i) in chosen)
        require(right and value == total, "claim", "claim.cost", "not the cost of such candidates")
        final = make(arcs(system, {"added": added}, "claim.added"), step, "claim")
        region.require_absence(absence, final, bound)
    labels = [[system.names[j], system.names[i]] for j, i in ends]
    covering.Program(costs, found, "arc", labels, value).require_bound(tree, [1] * len(ends))


def statement(claim: Json, system: System) -> str:
    """Which links suffice, at which cost, and that nothing cheaper does."""
    share, added = claim["share"], claim["added"]
    given = share if share == "outputs" else shared(system, share, claim["dimensions"])
    freedom = region.no_fixed_mode(claim["bound"], system)
    goal = f"{given} with neighbors, without delay, leaves {freedom}"
    graph = "the graph without edges" if system.neighbors is None else "its neighbor graph"
    listed = f"the candidate links, with their costs, {edge_set(claim['candidates'])}"
    if not claim["feasible"]:
        return f"no set out of {listed}, added to {graph}, is such that sharing {goal}"
    start = f"with the links {edge_set(added)}, of cost {claim['cost']}, added to {graph}"
    return f"{start}, sharing {goal}, and so it does with no set of lower cost out of {listed}"


def link(value: Json, place: str, system: System) -> tuple[int, int]:
    """A link [from, to], as positions of channels."""
    j, i = (names([end], place, system.names)[0] for end in items(value, place, 2))
    return j, i


def candidates(value: Json, system: System) -> list[tuple[int, int, Fraction]]:
    """The candidate links, which the graph lacks, with their costs."""
    place, N, found = "claim.candidates", neighbors_of(system, "claim"), []
    for *ends, price in (items(entry, place, 3) for entry in items(value, place)):
        found.append((*link(ends, place, system), rational(price, place)))
    keys = [(j, i) for j, i, _ in found]
    spend(len(keys) * (100 + system.m))
    if keys != sorted(set(keys)) or any(j in N[i] for j, i in keys):
        malformed(place, "expected links that the graph lacks, sorted, none twice")
    require(all(c > 0 for *_, c in found), "claim", place, "expected positive costs")
    return found


def carried(system: System, share: str, sizes: Json, j: int) -> Matrix:
    """S_j: C_j, diag(C_j, E_j') or [0, E_j'], the rows that a link from j adds to the outputs.

    Theorem ``allocation.communication_cut``.
    """
    C = Matrix.zeros(0, system.n) if share == "states" else system.C[j]
    if sizes is None:
        return C
    return diagonal(C, Matrix.unit_rows(sum(sizes), sum(sizes[:j]), sizes[j]))
