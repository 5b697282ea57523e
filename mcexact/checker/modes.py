"""Further kinds about fixed modes, and their absence beyond a region.

Each kind has a function ``check_…``, which stops unless the witness proves the claim, and a
function ``…_statement``, which says the claim in words.  Most claims bound a number from both
sides: a `shrunk_subspace` proves that a rank is no larger; coprime polynomials, blocks, or
elimination modulo ℓ prove that no more modes are fixed, or that a rank is no smaller
(`core.evidence`).  ``fixed_spectrum`` itself is in the core (`core.fixed_modes`).

`require_fixed_modes_inside` is shared with the kinds about shared dimensions and links: it checks
that every fixed mode lies in a region where fixed modes are allowed, and that the transfer graph is
strongly connected if this is claimed, too.
"""

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from functools import partial
from itertools import zip_longest

from . import structure
from .core import arithmetic, evidence, reach, reading
from .core.arithmetic import (
    Matrix,
    NotAUnit,
    Polynomial,
    characteristic_polynomial,
    exponent,
    inverse,
    poly_divide,
    poly_modulo,
    poly_product,
)
from .core.budget import spend
from .core.evidence import Blocks, Loss, TwoPolynomials, by_blocks
from .core.reach import require_connected
from .core.reading import (
    Json,
    boolean,
    fields,
    integer,
    items,
    malformed,
    matrix,
    names,
    polynomial,
    positions,
    rational,
    require,
)
from .core.roots import in_region
from .core.system import FIXED, PENCIL, System, channel_set, polynomial_text
from .parametric_system import FunctionSystem
from .structure import require_reached

# Absence of fixed modes beyond a region; ``proofs/shared_dimensions.md``.

RateOrRadius = Fraction | None
"""The rate or the radius of a claim, if any; certificates have it under the key ``bound``."""


def require_fixed_modes_inside(
    value: Json, system: System, bound: RateOrRadius, connected: bool = False
) -> None:
    """Stop unless every fixed mode lies in the region.

    If ``connected``, stop also unless the transfer graph is strongly connected.

    Theorem ``transfer_graph.strongly_connected_arcs``.
    """
    place = "witness.absence"
    if by_blocks(value):
        parts, number, arcs = fields(value, place, "blocks", "modulus", "arcs")
        Blocks(parts, place, system).require_no_more([])
        alone = (number is None) == (arcs is None)
        require(alone, "claim", f"{place}.modulus", "expected for edges alone")
    else:
        keys = ("gains", "modulus", "allowed", "arcs")
        gains, number, listed, arcs = fields(value, place, *keys)
        proof = TwoPolynomials(gains, number, place, system)
        proof.require_moved(_without(listed, f"{place}.allowed", system, bound))
    require((arcs is not None) == connected, "claim", f"{place}.arcs", "expected iff claimed")
    if arcs is not None:
        ell = evidence.modulus(number, f"{place}.modulus")
        require_connected(arcs, f"{place}.arcs", system, ell)


def _without(value: Json, place: str, system: System, bound: RateOrRadius) -> Polynomial:
    """det(xI − A) without factors that lie in the region; [] if there is none."""
    allowed = items(value, place)
    rest = characteristic_polynomial(system.A) if allowed else []
    for k, entry in enumerate(allowed):
        where = f"{place}[{k}]"
        factor, power = items(entry, where, 2)
        p = polynomial(factor, where, 1)
        inside = in_region(p, system.time, bound)
        require(inside, "region", where, "has a root outside the region")
        times, rest = exponent(p, rest)
        require(times == integer(power, where, 1), "exponent", where, f"divides {times} times")
    return rest


def read_rate_or_radius(value: Json, system: System) -> RateOrRadius:
    """A rate ≥ 0 in continuous time, a radius in (0, 1] in discrete time, or null."""
    if value is None:
        return None
    bound = rational(value, "claim.bound")
    fits = bound >= 0 if system.time == "continuous" else 0 < bound <= 1
    require(fits, "bound", "claim.bound", "expected a rate >= 0, or a radius in (0, 1]")
    return bound


def inside(bound: Json, system: System | FunctionSystem) -> str:
    """The region within a rate or a radius, in words."""
    limit = Fraction(bound)
    return f"modulus below {limit}" if system.time == "discrete" else f"real part below {-limit}"


def no_fixed_mode(bound: Json, system: System | FunctionSystem) -> str:
    """That no mode is fixed; with a rate or a radius, none that violates it."""
    if bound is None:
        return f"no mode that is {FIXED}"
    where = inside(bound, system).replace("below", "at least")
    return f"no mode of {where} that is {FIXED}"


def require_outside(p: Polynomial, system: System, bound: RateOrRadius, place: str) -> None:
    """Stop if every root of p lies inside the region, where fixed modes are allowed."""
    inside = in_region(p, system.time, bound)
    require(not inside, "region", place, "every root lies inside the region")


def claimed_cost(claim: dict[str, Json], answer: str, absence: Json) -> Fraction | None:
    """The cost of the claimed answer; None if it claims that nothing suffices."""
    if boolean(claim["feasible"], "claim.feasible"):
        return rational(claim["cost"], "claim.cost")
    nothing = claim[answer] is None and claim["cost"] is None and absence is None
    require(nothing, "claim", "claim", "expected null where nothing suffices")
    return None


# Kind ``pencil_rank``: the rank of P_s at the roots of a polynomial; ``proofs/pencil_rank.md``.


def check_pencil_rank(claim: Json, witness: Json, system: System) -> None:
    """Check a kernel from above, and elimination modulo (ℓ, p) from below.

    Theorems ``deficiency.pencil_rank_upper``, ``deficiency.pencil_rank_lower``.
    """
    listed, coefficients, number = fields(claim, "claim", "subset", "polynomial", "rank")
    ell, layers, rows = fields(witness, "witness", "modulus", "kernel", "pivots")
    s, n = reading.names(listed, "claim.subset", system.names), system.n
    p = reading.polynomial(coefficients, "claim.polynomial", 1)
    B, C = evidence.inputs(system, evidence.complement(system, s)), evidence.outputs(system, s)
    c, r = n + B.ncols, reading.integer(number, "claim.rank")
    pivots = reading.positions(rows, "witness.pivots", c)
    require(len(pivots) == c - r, "rank", "witness.pivots", f"expected {c} - {r} of them")
    kernel = reading.polynomial_matrix(layers, "witness.kernel", c, c - r, len(p) - 1)
    evidence.require_identity(kernel, pivots, "witness.pivots")
    U = [layer.take(range(n)) for layer in kernel]
    V = [layer.take(range(n, c)).times(-1) for layer in kernel]
    evidence.require_pencil_kernel(system.A, B, U, V, p, "witness.kernel")
    require(all((C @ layer).is_zero() for layer in U), "identity", "witness.kernel", "C U is not 0")
    ell = evidence.modulus(ell, "witness.modulus")
    kept = sorted(set(range(c)) - set(pivots))
    top = arithmetic.beside([system.A.times(-1), B], n)
    bottom = arithmetic.beside([C, arithmetic.Matrix.zeros(C.nrows, B.ncols)], C.nrows)
    constant = arithmetic.stack([top, bottom], c)
    residues = enumerate(constant.take(cols=kept).modulo(ell))
    pencil = [[[e, int(i == j < n)] for j, e in zip(kept, row, strict=True)] for i, row in residues]
    independent = _are_independent(pencil, len(kept), poly_modulo(p, ell), ell)
    require(independent, "rank", "witness", f"elimination modulo l and p does not reach {r}")


def pencil_rank_statement(claim: Json, system: System) -> str:
    """The statement: the rank of the pencil at the roots of the polynomial."""
    sets = f"C the outputs of the channels {channel_set(claim['subset'])} and B the inputs of the"
    which = f"the pencil {PENCIL}, {sets} others, has rank exactly {claim['rank']}"
    return f"{which} at every root of {polynomial_text(claim['polynomial'])}"


def _are_independent(rows: list[list[Polynomial]], ncols: int, p: Polynomial, ell: int) -> bool:
    """Whether every column finds a pivot that is a unit of (Z/ℓ)[x]/(p)."""
    for j in range(ncols):
        inverses = ((k, _inverse(row[j], p, ell)) for k, row in enumerate(rows))
        k, f = next(((k, f) for k, f in inverses if f), (-1, []))
        if not f:
            return False
        pivot = rows.pop(k)
        for row in rows:
            if g := poly_divide(poly_product(row[j], f), p, ell)[1]:
                for c in range(j, ncols):
                    row[c] = _less(row[c], poly_product(g, pivot[c]), p, ell)
    return True


def _less(a: Polynomial, b: Polynomial, p: Polynomial, ell: int) -> Polynomial:
    return poly_divide([x - y for x, y in zip_longest(a, b, fillvalue=0)], p, ell)[1]


def _inverse(a: Polynomial, p: Polynomial, ell: int) -> Polynomial:
    """The inverse of a modulo p, or None if it is not a unit or that is undecided."""
    (r, t), (rest, u) = (p, []), (poly_divide(a, p, ell)[1], [1])
    try:
        while rest:
            q, left = poly_divide(r, rest, ell)
            (r, t), (rest, u) = (rest, u), (left, _less(t, poly_product(q, u), p, ell))
        return [c * inverse(r[0], ell) % ell for c in t] if len(r) == 1 else []
    except NotAUnit:
        return []


# Kind ``assignability``: how a spectrum splits; ``proofs/assignability.md``.


def check_assignability(claim: Json, witness: Json, system: System) -> None:
    """Check the components, and the McMillan degree of the transfer within each.

    Theorems ``strong_components.ordered_components``, ``assignability.assignability_rule``,
    ``assignability.component_own_gains``, ``assignability.mcmillan_degree``.
    """
    listed, left = fields(claim, "claim", "blocks", "fixed_degree")
    require_degree = _require_degree
    earlier = isinstance(witness, dict) and "realizations" in witness
    if earlier:
        keys = ("modulus", "transfer_graph", "realizations")
        number, graph, shown = fields(witness, "witness", *keys)
        require_degree = partial(_require_minimal, evidence.modulus(number, "witness.modulus"))
    else:
        graph, shown = fields(witness, "witness", "components", "degrees")
    place = "claim.blocks"
    blocks = [fields(block, place, "channels", "dimension") for block in items(listed, place)]
    parts = [names(component, place, system.names) for component, _ in blocks]
    if not earlier:
        structure.require_components(graph, "witness.components", system, parts)
    else:
        known, proof = fields(graph, "witness.transfer_graph", "claim", "witness")
        reach.check_transfer_graph(known, proof, system)
        same = [c for c, _ in blocks] == known["components"]
        require(same, "component", place, "not the components of the transfer graph")
    degrees, entries = [], items(shown, "witness", len(blocks))
    for c, (_, size), entry in zip(parts, blocks, entries, strict=True):
        degrees.append(integer(size, place))
        require_degree(system, c, degrees[-1], entry)
    fixed = integer(left, "claim.fixed_degree")
    require(fixed == system.n - sum(degrees), "degree", "claim.fixed_degree", "does not follow")


def assignability_statement(claim: Json, system: System) -> str:
    """The statement: the factors into which the characteristic polynomial of every loop splits."""
    blocks = ((block["channels"], block["dimension"]) for block in claim["blocks"])
    parts = ", ".join(f"{degree} for {channel_set(c)}" for c, degree in blocks)
    return (
        "for all constant gains F, det(xI - A_F) = phi(x) times the product of chi_c(x) over the "
        "strong components c of the transfer graph; phi is monic of degree "
        f"{claim['fixed_degree']} and the same for all F; chi_c is monic, depends on the F_i with "
        "i in c alone, and its degree is the McMillan degree of C_c (xI - A)^-1 B_c, "
        f"{parts or 'none'}"
    )


def _require_degree(system: System, c: list[int], d: int, value: Json) -> None:
    """Stop unless C_c (xI − A)⁻¹ B_c has the McMillan degree d.

    The realization on ker W / im U has the same transfer matrix, and a sequence of degree L has a
    nonsingular Hankel matrix of L rows.

    Theorems ``realization.kernel_realization``, ``hankel.mcmillan_from_below``.
    """
    place = "witness.degrees"
    keys = ("states", "annihilator", "pivots", "kernel", "kernel_pivots", "sequence")
    chosen, rows, columns, unseen, places, proof = fields(value, place, *keys)
    A, inputs, outputs = system.A, [system.B[i] for i in c], [system.C[i] for i in c]
    if chosen is not None:
        at = {a: k for k, a in enumerate(positions(chosen, f"{place}.states", system.n))}
        _require_paths_within(A, inputs, outputs, at)
        A = arithmetic.within(A, at, at)
        inputs = [arithmetic.within(M, at, None) for M in inputs]
        outputs = [arithmetic.within(M, None, at) for M in outputs]
    B, C = arithmetic.beside(inputs, A.nrows), arithmetic.stack(outputs, A.nrows)
    W, _ = evidence.annihilator(rows, columns, place, A, [B])
    U, _ = evidence.annihilator(unseen, places, place, A.T, [C.T, W.T])
    least = 0
    if proof is not None:
        merged = System(system.time, ["1"], A, [B], [C])
        least = A.nrows - evidence.unmoved_degree(proof, f"{place}.sequence", merged)
    most = A.nrows - W.nrows - U.nrows
    require(most == d == least, "degree", place, f"it is from {least} to {most}")


def _require_paths_within(
    A: Matrix, inputs: list[Matrix], outputs: list[Matrix], at: Mapping[int, int]
) -> None:
    """Stop unless all paths from inputs to outputs stay among some states.

    What inputs and these states drive outside of these states leads to none of them, and is not
    measured.

    Theorem ``realization.path_realization``.
    """
    driven = A.driven
    measured = {b for C in outputs for _, b, _ in arithmetic.entries_of(C)}
    rest = [a for B in inputs for a, _, _ in arithmetic.entries_of(B) if a not in at]
    spend(sum(40 * (1 + len(driven[b])) for b in at))
    rest += [a for b in at for a in driven[b] if a not in at]
    outside = set(rest)
    while rest:
        b = rest.pop()
        spend(40 * (1 + len(driven[b])))
        stays = b not in measured and not any(a in at for a in driven[b])
        require(stays, "path", "witness.degrees", "a path leaves the states")
        rest += (new := {a for a in driven[b] if a not in at} - outside)
        outside |= new


def _require_minimal(ell: int, system: System, c: list[int], d: int, value: Json) -> None:
    """Stop unless C_c (xI − A)⁻¹ B_c has a minimal realization of dimension d.

    Certificates of earlier versions have these.
    """
    place = "witness.realizations"
    rows, pivots, reduced, chosen = fields(value, place, "X", "pivots", "W", "columns")
    listed = [system.names[i] for i in c]
    space = {"from": listed, "X": rows, "pivots": pivots}
    _, X = evidence.zero_transfer(space, place, system)
    inner, C = (system.A @ X).take(pivots), evidence.outputs(system, c) @ X
    columns = positions(chosen, place, X.ncols)
    W = matrix(reduced, place, d, X.ncols)
    if len(columns) != d:
        malformed(place, f"expected {d} columns")
    evidence.require_identity([W.T], columns, place)
    A_d, C_d = (W @ inner).take(cols=columns), C.take(cols=columns)
    invariant = (W @ inner).equals(A_d @ W) and C.equals(C_d @ W)
    require(invariant, "identity", place, "expected W A_x = A_d W and C_x = C_d W")
    B_d = W @ evidence.inputs(system, c).take(pivots)
    require_reached(replace(system, A=A_d, B=[B_d]), 0, ell, d)
    require_reached(replace(system, A=A_d.T, B=[C_d.T]), 0, ell, d)


# Kind ``deficiency``: the largest loss of rank over all subsets; ``proofs/deficiency.md``.

WITNESS = ("modulus", "gains", "B0", "C0", "polynomial", "subspace")


def check_deficiency(claim: Json, witness: Json, system: System) -> None:
    """Check a completed loop that moves every mode, and a shrunk subspace that loses as much.

    Theorems ``deficiency.deficiency_rule``, ``deficiency.deficiency_bound``.
    """
    (number,) = fields(claim, "claim", "deficiency")
    rho, n = integer(number, "claim.deficiency"), system.n
    if by_blocks(witness):
        largest = _by_blocks(witness, system)
        require(rho == largest, "claim", "claim.deficiency", f"the largest loss is {largest}")
        return
    ell, gains, left, right, coefficients, subspace = fields(witness, "witness", *WITNESS)
    ell = evidence.modulus(ell, "witness.modulus")
    F = evidence.read_gains(gains, "witness.gains", system)
    B0, C0 = matrix(left, "witness.B0", n, rho), matrix(right, "witness.C0", rho, n)
    completed = evidence.closed_loop(system, F) + B0 @ C0
    before, after = (characteristic_polynomial(M, ell) for M in (system.A, completed))
    evidence.require_coprime(before, after, ell, "det(xI - A) and det(xI - A_F - B0 C0)")
    if rho:
        p = polynomial(coefficients, "witness.polynomial", 1)
        evidence.Losses(system).checked(subspace, "witness.subspace", p, rho)
    else:
        null = coefficients is None and subspace is None
        message = "expected no polynomial and no subspace, rank is not lost"
        require(null, "claim", "witness", message)


def _by_blocks(witness: Json, system: System) -> int:
    """The largest rank that a factor loses, where the factors are all that is fixed.

    Theorem ``fixed_bound.bounded_deficiency``.
    """
    parts, number, listed = fields(witness, "witness", "blocks", "modulus", "losses")
    proof, losses = Blocks(parts, "witness", system, number), list[Loss]()
    lost = evidence.Losses(system)
    product: Polynomial = [1]
    for k, entry in enumerate(items(listed, "witness.losses")):
        place = f"witness.losses[{k}]"
        coefficients, loss, space = fields(entry, place, "polynomial", "deficiency", "subspace")
        p, d = polynomial(coefficients, place, 1), integer(loss, place, 1)
        lost.checked(space, f"{place}.subspace", p, d)
        evidence.require_coprime(product, p, proof.ell, "two factors")
        product = arithmetic.poly_product(product, p)
        losses.append((p, proof.multiplicity(p, d)))
    proof.require_no_more(losses)
    return max((d for _, d in losses), default=0)


def deficiency_statement(claim: Json, system: System) -> str:
    """The statement: the largest loss of rank."""
    return (
        f"the largest {system.n} - rank {PENCIL}, over all complex x and all sets of channels, C "
        f"the outputs of the set and B the inputs of the others, is {claim['deficiency']}"
    )
