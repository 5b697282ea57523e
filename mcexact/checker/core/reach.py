"""Kinds about structure: what inputs reach, which channels reach which, and set-points.

Each kind has a function ``check_…``, which stops unless the witness proves the claim, and a
function ``…_statement``, which says the claim in words.

Ranks and dimensions are bounded from above by rows or subspaces that are annihilated exactly, and
from below by ranks modulo ℓ (`krylov_ranks`), which take short numbers; controllability also by
blocks of states, for large systems with few nonzero entries.  The transfer graph needs a proof for
each edge (a Markov parameter that is not 0 modulo ℓ) and for each pair that is no edge (no path, or
a zero transfer).
"""

import math
from collections.abc import Iterable, Sequence

from . import budget
from .arithmetic import (
    SMALL,
    Matrix,
    PackedRows,
    Rows,
    SparseMatrix,
    beside,
    characteristic_polynomial,
    diagonal,
    echelon,
    entries_of,
    product,
    rank_modulo,
    stack,
)
from .budget import counted, spend
from .evidence import (
    Blocks,
    annihilator,
    by_blocks,
    inputs,
    modulus,
    outputs,
    require_identity,
    unseen,
    without_path,
    zero_transfer,
)
from .reading import (
    Json,
    boolean,
    fields,
    integer,
    items,
    malformed,
    matrix,
    names,
    polynomial,
    polynomial_matrix,
    positions,
    require,
    shown,
)
from .system import PENCIL, System, channel_set, denied, edge_set, polynomial_text

# Kind ``controllability``: the subspace that channels control; ``proofs/controllability.md``.

CONTROLLABILITY_CLAIM = ("channels", "dimension", "controllable", "uncontrollable_polynomial")


def check_controllability(claim: Json, witness: Json, system: System) -> None:
    """Check an annihilator W from above, and a Krylov rank modulo ℓ or a bound from below.

    Theorems ``controllability.controllability_rule``,
    ``controllability_bound.controllability_by_bound``.
    """
    listed, size, verdict, factor = fields(claim, "claim", *CONTROLLABILITY_CLAIM)
    keys = ("blocks", "measured") if by_blocks(witness) else ("modulus",)
    *proof, rows, columns = fields(witness, "witness", *keys, "annihilator", "pivots")
    T = names(listed, "claim.channels", system.names)
    d, n = integer(size, "claim.dimension"), system.n
    chi = polynomial(factor, "claim.uncontrollable_polynomial")
    W, Z = annihilator(rows, columns, "witness", system.A, (system.B[i] for i in T))
    require(W.nrows == n - d, "dimension", "witness.pivots", f"expected {n} - {d} of them")
    low = _by_blocks if by_blocks(witness) else _by_rank
    reached = low(system, T, *proof)
    require(reached >= d, "rank", "claim.dimension", f"only {reached} are proved to be reached")
    controllable = boolean(verdict, "claim.controllable")
    require(controllable == (d == n), "claim", "claim.controllable", f"{d} of {n} are controllable")
    same = characteristic_polynomial(Z) == chi
    require(same, "claim", "claim.uncontrollable_polynomial", "not det(xI - Z)")


def controllability_statement(claim: Json, system: System) -> str:
    """The statement: the dimension that the channels control, and the uncontrollable polynomial."""
    return (
        f"the channels {channel_set(claim['channels'])} together control a subspace of dimension "
        f"exactly {claim['dimension']}; it is {denied(claim['controllable'])}controllable through "
        "them, with the uncontrollable polynomial "
        f"{polynomial_text(claim['uncontrollable_polynomial'])}"
    )


def _by_rank(system: System, T: list[int], number: Json) -> int:
    """A lower bound for the dimension that T controls: a rank modulo ℓ."""
    return krylov_ranks(system, T, modulus(number, "witness.modulus"), system.n)[-1]


def _by_blocks(system: System, T: list[int], parts: Json, measured: Json) -> int:
    """L, if at most n − L modes of the channels T are fixed, whatever these measure.

    Theorem ``controllability_bound.bounded_reach``.
    """
    C = [system.C[i] for i in T]
    if measured is not None:
        place = "witness.measured"
        C = [
            _picking(positions(chosen, f"{place}[{k}]", system.n), system.n)
            for k, chosen in enumerate(items(measured, place, len(T)))
        ]
    named, B = [system.names[i] for i in T], [system.B[i] for i in T]
    return system.n - Blocks(parts, "witness", System(system.time, named, system.A, B, C)).left


def _picking(places: list[int], ncols: int) -> Matrix:
    """The rows of the identity matrix at these positions, as a sparse matrix."""
    spend(100 * len(places))
    return SparseMatrix(len(places), ncols, [(k, place, 1) for k, place in enumerate(places)])


def krylov_ranks(system: System, T: list[int], ell: int, blocks: int) -> list[int]:
    """Ranks modulo ℓ of [B_T], [B_T, A B_T], …, at most this many, until they stop growing.

    Each bounds the rank over Q from below: the block k + 1 adds A times what the block k added.

    Theorem ``arithmetic.rank_from_below``.
    """
    n = system.n
    columns = list(zip(*system.A.modulo(ell), strict=True))
    A, basis, ranks = PackedRows(columns, n, ell), echelon(ell, n), [0]
    fresh: list[Sequence[int]] = list(zip(*inputs(system, T).modulo(ell), strict=True))
    while len(ranks) <= blocks and fresh:
        left = [basis.add(vector) for vector in fresh]
        fresh = [A.combined(vector) for vector in left if vector is not None]
        ranks.append(basis.count)
    return ranks


# Kind ``transfer_graph``: which channels reach which; ``proofs/transfer_graph.md``.

PAIRS = 100
"""The units for one pair of channels where a step looks at every pair."""


def check_transfer_graph(claim: Json, witness: Json, system: System) -> None:
    """Check a power for each edge, no path or a zero transfer for other pairs, and the components.

    Theorems ``transfer_graph.transfer_graph_rule``, ``transfer_graph.zero_transfer_no_arc``.
    """
    listed, parts, verdict = fields(claim, "claim", "arcs", "components", "strongly_connected")
    number, exponents, zeros = fields(witness, "witness", "modulus", "powers", "zeros")
    powers = items(exponents, "witness.powers", len(items(listed, "claim.arcs")))
    ends = [items(arc, "claim.arcs", 2) for arc in listed]
    joined = [[*arc, power] for arc, power in zip(ends, powers, strict=True)]
    triples = read_arcs(joined, "claim.arcs", system)
    require_arcs(system, triples, modulus(number, "witness.modulus"))
    arcs = [(j, i) for j, i, _ in triples]
    spend(PAIRS * system.m**2)
    missing = {(j, i) for j in range(system.m) for i in range(system.m)} - set(arcs)
    require_no_edges(missing, zeros, "witness.zeros", system)
    claimed = [names(p, "claim.components", system.names) for p in items(parts, "claim.components")]
    strong = components(system.m, arcs)
    require(claimed == strong, "claim", "claim.components", "these are not the strong components")
    connected = boolean(verdict, "claim.strongly_connected")
    require(connected == (len(strong) <= 1), "claim", "claim.strongly_connected", "does not follow")


def require_no_edges(
    missing: set[tuple[int, int]], zeros: Json, place: str, system: System
) -> None:
    """Stop unless none of these pairs (j, i) is an edge, by zero transfers or as no path leads.

    Theorems ``transfer_graph.zero_transfer_no_arc``, ``transfer_graph.closed_states_no_arc``.
    """
    for k, entry in enumerate(items(zeros, place)):
        sources, X = zero_transfer(entry, f"{place}[{k}]", system)
        unseen = [i for i, C in enumerate(system.C) if (C @ X).is_zero()]
        spend(10 * len(sources) * len(unseen))
        missing -= {(j, i) for j in sources for i in unseen}
    if missing:
        missing -= without_path(system, missing)
    pair = [(system.names[j], system.names[i]) for j, i in sorted(missing)][:1]
    require(not missing, "arc", place, f"nothing proves that {pair!a} is not an edge")


def transfer_graph_statement(claim: Json, system: System) -> str:
    """The statement: the edges, the strong components, and whether there is at most one."""
    return (
        "its transfer graph, in which j -> i means that C_i (xI - A)^-1 B_j is not zero, has "
        f"exactly the edges {edge_set(claim['arcs'])}, the strong components "
        f"{', '.join(map(channel_set, claim['components'])) or 'none'}, and is "
        f"{denied(claim['strongly_connected'])}strongly connected"
    )


def read_arcs(value: Json, where: str, system: System) -> list[tuple[int, int, int]]:
    """Read edges (j, i) with a power k each, sorted and none twice."""
    arcs, known = [], {name: i for i, name in enumerate(system.names)}
    spend(60 * len(items(value, where)))
    for number, entry in enumerate(value):
        place = f"{where}[{number}]"
        *ends, power = items(entry, place, 3)
        for end in ends:
            if type(end) is not str or end not in known:
                malformed(place, f"expected the name of a channel, found {shown(end)}")
        arcs.append((known[ends[0]], known[ends[1]], integer(power, place)))
    if [arc[:2] for arc in arcs] != sorted({arc[:2] for arc in arcs}):
        malformed(where, "expected them sorted, none twice")
    return arcs


def require_arcs(system: System, triples: list[tuple[int, int, int]], ell: int) -> None:
    """Stop unless k < n and C_i A^k B_j ≠ 0 modulo ℓ for every (j, i, k).

    Theorem ``transfer_graph.arc_rule``.
    """
    proved: set[tuple[int, int, int]] = system.kept(("arcs", ell), set)
    triples = [triple for triple in triples if triple not in proved]
    wanted: dict[int, dict[int, list[int]]] = {}
    for j, i, k in triples:
        require(k < system.n, "arc", "witness", f"the power {k} is not below {system.n}")
        wanted.setdefault(j, {}).setdefault(k, []).append(i)
    if triples:
        _require_parameters(system, wanted, triples, ell)
    proved.update(triples)


def _require_parameters(
    system: System,
    wanted: dict[int, dict[int, list[int]]],
    triples: list[tuple[int, int, int]],
    ell: int,
) -> None:
    """Stop unless C_i A^k B_j ≠ 0 modulo ℓ for every (j, i, k), which are ``wanted`` by j and k."""
    if ell <= SMALL:
        j, i, k = unseen(system, triples, ell) or (0, 0, -1)
        message = f"C A^{k} B is 0 modulo l from channel number {j + 1} to {i + 1}"
        require(k < 0, "arc", "witness", message)
        return
    A, C = system.A.modulo(ell), [M.modulo(ell) for M in system.C]
    for j, targets in counted(list(wanted.items())):
        width = system.B[j].ncols
        power: Rows = system.B[j].modulo(ell)
        for k in counted(range(max(targets) + 1)):
            for i in targets.get(k, []):
                seen = any(map(any, product(C[i], power, width, ell)))
                message = f"C A^{k} B is 0 modulo l from channel number {j + 1} to {i + 1}"
                require(seen, "arc", "witness", message)
            power = product(A, power, width, ell)


def require_connected(value: Json, place: str, system: System, ell: int) -> None:
    """Stop unless these edges of the transfer graph make it strongly connected.

    Theorem ``transfer_graph.strongly_connected_arcs``.
    """
    arcs = read_arcs(value, place, system)
    require_arcs(system, arcs, ell)
    connected = len(components(system.m, [(j, i) for j, i, _ in arcs])) <= 1
    require(connected, "arc", place, "these edges do not connect all channels")


def components(m: int, arcs: Iterable[tuple[int, int]]) -> list[list[int]]:
    """The strong components of the graph on m nodes with edges j → i, sorted by first member.

    Theorems ``strong_components.closure_connect``, ``strong_components.component_rule``.
    """
    spend(m * m * (12 + m // 500) + 100)
    ahead, behind = ([1 << j for j in range(m)] for _ in range(2))  # sets of nodes, as bits
    for j, i in arcs:
        ahead[j] |= 1 << i
        behind[i] |= 1 << j
    for reached in (ahead, behind):
        for k in range(m):
            for j in range(m):
                if reached[j] >> k & 1:
                    reached[j] |= reached[k]
    parts = {a & b for a, b in zip(ahead, behind, strict=True)}
    return sorted([i for i in range(m) if part >> i & 1] for part in parts)


# Kind ``setpoint``: whether integrators can hold outputs at set-points; ``proofs/setpoint.md``.


def check_setpoint(claim: Json, witness: Json, system: System) -> None:
    """Check bounds on the rank of [A B; C 0], and whether a rank defect is an invariant zero.

    Theorems ``setpoint.setpoint_rank``, ``setpoint.setpoint_unreachable``,
    ``setpoint.setpoint_output_part``, ``setpoint.normal_rank_deficient``.
    """
    verdict, size, zero = fields(claim, "claim", "solvable", "rank", "invariant_zero")
    keys = ("modulus", "left", "pivots", "point", "normal")
    number, left, columns, x0, row = fields(witness, "witness", *keys)
    A, n = system.A, system.n
    B, C = inputs(system, range(system.m)), outputs(system, range(system.m))
    rows, width = n + C.nrows, n + B.ncols
    S = _steady_matrix(system)
    r, ell = integer(size, "claim.rank"), modulus(number, "witness.modulus")
    require(r <= rows and rank_modulo(S, ell) >= r, "rank", "claim.rank", "not reached modulo l")
    pivots = positions(columns, "witness.pivots", rows)
    require(len(pivots) == rows - r, "rank", "witness.pivots", f"expected {rows} - {r} of them")
    W = matrix(left, "witness.left", rows - r, rows)
    require_identity([W.T], pivots, "witness.pivots")
    annihilates = not pivots or (W @ S).is_zero()
    require(annihilates, "identity", "witness.left", "W [A B; C 0] is not zero")
    solvable = boolean(verdict, "claim.solvable")
    require(solvable == (r == rows), "claim", "claim.solvable", f"the rank is {r} of {rows}")
    if solvable:
        unused = zero is None and x0 is None and row is None
        require(unused, "claim", "claim.invariant_zero", "expected null where it is solvable")
        return
    lower = beside([C, Matrix.zeros(C.nrows, B.ncols)], C.nrows)
    fixed = stack([beside([A.times(-1), B], n), lower], width)
    moving = diagonal(Matrix.unit_rows(n, 0, n), Matrix.zeros(C.nrows, B.ncols))
    if boolean(zero, "claim.invariant_zero"):
        require(row is None, "claim", "witness.normal", "expected null for an invariant zero")
        point = integer(x0, "witness.point")
        full = rank_modulo(fixed + moving.times(point), ell) == rows
        require(full, "rank", "witness.point", "the rank there is not full modulo l")
        return
    require(x0 is None, "claim", "witness.point", "expected null where there is no such point")
    layers = polynomial_matrix(row, "witness.normal", 1, rows, rows + 1)
    require(not all(w.is_zero() for w in layers), "zero", "witness.normal", "the row is zero")
    below = [Matrix.zeros(1, rows), *layers]
    for w, before in zip([*layers, below[0]], below, strict=True):
        same = (w @ fixed + before @ moving).is_zero()
        require(same, "identity", "witness.normal", "the row does not annihilate the pencil")


def _steady_matrix(system: System) -> Matrix:
    """[A B; C 0], in discrete time [A − I B; C 0], by its entries if A is."""
    A, n, discrete = system.A, system.n, system.time == "discrete"
    B, C = inputs(system, range(system.m)), outputs(system, range(system.m))
    if not isinstance(A, SparseMatrix):
        lower = beside([C, Matrix.zeros(C.nrows, B.ncols)], C.nrows)
        shifted = A - Matrix.unit_rows(n, 0, n).times(int(discrete))
        return stack([beside([shifted, B], n), lower], n + B.ncols)
    d, cells = math.lcm(A.denominator, B.denominator, C.denominator), dict[tuple[int, int], int]()
    for M, down, right in ((A, 0, 0), (B, 0, n), (C, n, 0)):
        entries, f = entries_of(M), d // M.denominator
        spend(200 * len(entries) + budget.products(len(entries), M.limbs, budget.limbs([f])))
        cells |= {(down + i, right + j): f * x for i, j, x in entries}
    if discrete:
        spend(budget.fractions(n, budget.limbs([d])))
        cells |= {(a, a): cells.get((a, a), 0) - d for a in range(n)}
    kept = sorted((i, j, x) for (i, j), x in cells.items() if x)
    return SparseMatrix(n + C.nrows, n + B.ncols, kept, d)


def setpoint_statement(claim: Json, system: System) -> str:
    """The statement: whether the rank is full, and otherwise what follows from the defect."""
    shift, place = (" - I", 1) if system.time == "discrete" else ("", 0)
    which = f"[A{shift}, B; C, 0], B and C those of all channels, has rank exactly {claim['rank']}"
    rows = f"{which}, which is {denied(claim['solvable'])}its number of rows"
    if claim["solvable"]:
        return f"{rows}, so that integrators of all outputs add no uncontrollable mode"
    zero = f", so that {place} is an invariant zero" if claim["invariant_zero"] else ""
    goal = "every output tends to every constant set-point"
    normal = f"the normal rank of {PENCIL} is {denied(claim['invariant_zero'])}its number of rows"
    return f"{rows}, so that in no stable linear time-invariant loop {goal}; {normal}{zero}"
