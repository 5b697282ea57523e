"""Kind ``communication``: the cheapest arcs to add; ``proofs/communication.md``."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from . import evidence
from .arithmetic import Matrix, diagonal
from .covering import Program, read_bound, require_absence, require_outside
from .exchange import arcs, augmented_outputs, extended, neighbors_of
from .reading import (
    boolean,
    fields,
    integer,
    items,
    malformed,
    names,
    polynomial,
    polynomial_matrix,
    rational,
    require,
    string,
)
from .system import System
from .words import channel, described


def check(claim: Any, witness: Any, system: System) -> str:
    """Check that the added arcs suffice, every cut, and the tree that leaves nothing cheaper."""
    share, sizes, limit, listed, verdict, added, total = fields(
        claim, "claim", "share", "dimensions", "bound", "candidates", "feasible", "added", "cost"
    )
    absence, cuts, tree = fields(witness, "witness", "absence", "cuts", "tree")
    carried = string(share, "claim.share", "outputs", "outputs+states", "states")
    require((sizes is None) == (carried == "outputs"), "claim", "claim.dimensions", "do not fit")
    bound, candidates = read_bound(limit, system), _candidates(listed, system)
    costs = [cost for *_, cost in candidates]
    ends = [(j, i) for j, i, _ in candidates]
    step = {"share": carried, "dimensions": sizes}

    def wired(plant: System) -> System:
        if sizes is None:
            return augmented_outputs(plant, {}, "claim")
        return extended(plant, step, "claim")

    subject, rows = wired(system), _carried(system, carried, sizes)
    found = []
    for k, entry in enumerate(items(cuts, "witness.cuts")):
        place = f"witness.cuts[{k}]"
        factor, subspace = fields(entry, place, "polynomial", "subspace")
        p = polynomial(factor, f"{place}.polynomial", 1)
        require_outside(p, subject, bound, place)
        T = evidence.shrunk_subspace(subspace, f"{place}.subspace", subject, p, 1)
        U = polynomial_matrix(subspace["U"], place, subject.n, len(subspace["pivots"]), len(p) - 1)
        sends = [j for j, S in enumerate(rows) if any(not (S @ layer).is_zero() for layer in U)]
        broken = {v for v, (j, i) in enumerate(ends) if j in sends and i not in T}
        found.append((broken, 1))
    value: Fraction | None = None
    if boolean(verdict, "claim.feasible"):
        value = rational(total, "claim.cost")
        chosen = [_arc(entry, "claim.added", system) for entry in items(added, "claim.added")]
        if chosen != sorted(set(chosen)) or not set(chosen) <= set(ends):
            malformed("claim.added", "expected candidates, sorted, none twice")
        right = value == sum((c for j, i, c in candidates if (j, i) in chosen), Fraction(0))
        require(right, "claim", "claim.cost", "not the cost of the added arcs")
        final = wired(arcs(system, {"added": added}, "claim.added"))
        require_absence(absence, final, bound)
    else:
        nothing = added is None and total is None and absence is None
        require(nothing, "claim", "claim", "expected null where nothing suffices")
    labels = [[system.names[j], system.names[i]] for j, i in ends]
    Program(costs, found, "arc", labels, value).require_bound(tree, [1] * len(ends))
    return _theorem(claim, system, candidates, value)


def _arc(value: Any, place: str, system: System) -> tuple[int, int]:
    j, i = (names([end], place, system.names)[0] for end in items(value, place, 2))
    return j, i


def _candidates(value: Any, system: System) -> list[tuple[int, int, Fraction]]:
    """Arcs that the graph lacks, with their costs."""
    place, N = "claim.candidates", neighbors_of(system, "claim")
    found = []
    for entry in items(value, place):
        *ends, price = items(entry, place, 3)
        found.append((*_arc(ends, place, system), rational(price, place)))
    keys = [(j, i) for j, i, _ in found]
    if keys != sorted(set(keys)) or any(j in N[i] for j, i in keys):
        malformed(place, "expected arcs that are missing, sorted, none twice")
    require(all(c > 0 for *_, c in found), "claim", place, "expected positive costs")
    return found


def _carried(system: System, share: str, sizes: Any) -> list[Matrix]:
    """S_j: C_j, diag(C_j, E_j') or [0, E_j'], what an arc from j adds to the outputs."""
    if sizes is None:
        return system.C
    widths = [integer(size, "claim.dimensions") for size in sizes]
    starts = [sum(widths[:j]) for j in range(system.m)]
    E = [Matrix.unit_rows(sum(widths), s, w) for s, w in zip(starts, widths, strict=True)]
    C = system.C if share == "outputs+states" else [Matrix.zeros(0, system.n)] * system.m
    return [diagonal(C_j, E_j) for C_j, E_j in zip(C, E, strict=True)]


def _theorem(
    claim: dict[str, Any],
    system: System,
    candidates: list[tuple[int, int, Fraction]],
    value: Fraction | None,
) -> str:
    def arrow(j: int, i: int) -> str:
        return f"{channel(system, j)} -> {channel(system, i)}"

    sizes = "" if claim["dimensions"] is None else f" with dimensions {claim['dimensions']}"
    modes = "no mode" if claim["bound"] is None else f"no mode beyond {claim['bound']}"
    priced = ", ".join(f"{arrow(j, i)} at {c}" for j, i, c in candidates) or "none"
    start = f"so that {modes} of {described(system)}, sharing {claim['share']}{sizes}, is fixed,"
    if value is None:
        return f"{start} no set of the candidate arcs suffices (candidates: {priced})"
    pairs = [_arc(entry, "claim.added", system) for entry in claim["added"]]
    shown = ", ".join(arrow(j, i) for j, i in pairs) or "no arc"
    return (
        f"{start} adding {shown} suffices, and nothing of cost below {value} does "
        f"(candidates: {priced})"
    )
