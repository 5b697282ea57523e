"""Controllability, indices, transfer graphs, zeros and set-points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from flint import fmpq_mat

from . import algebra
from .algebra import X
from .modes import components, pencil, subsets, transfer_edges
from .reading import edges, integer, listed, polynomial, positions, record, truth
from .systems import System

Claim = Mapping[str, Any]


def controllability(claim: Any, witness: Any, system: System) -> bool:
    """The rank of [B_T, A B_T, …], and χ_A on the quotient."""
    found = record(claim, "channels", "dimension", "controllable", "uncontrollable_polynomial")
    K = algebra.krylov(
        system.A, system.inputs(positions(found["channels"], system.names)), system.n
    )
    d = K.rank()
    return (
        integer(found["dimension"]) == d
        and truth(found["controllable"]) is (d == system.n)
        and polynomial(found["uncontrollable_polynomial"], monic=True)
        == algebra.quotient_polynomial(system.A, K)
    )


def index_ranks(A: fmpq_mat, B: fmpq_mat) -> list[int]:
    """The ranks of [B … A^{k−1}B] as long as they grow."""
    ranks = [0]
    for k in range(1, A.nrows() + 2):
        rank = algebra.krylov(A, B, k).rank()
        if rank == ranks[-1]:
            break
        ranks.append(rank)
    return ranks[1:]


def controllability_indices(claim: Any, witness: Any, system: System) -> bool:
    """The ranks one by one, and their conjugate partition."""
    found = record(claim, "channels", "ranks", "index", "indices")
    ranks = index_ranks(system.A, system.inputs(positions(found["channels"], system.names)))
    steps = [b - a for a, b in zip([0, *ranks], ranks, strict=False)]
    partition = [sum(step > i for step in steps) for i in range(max(steps, default=0))]
    reached = (ranks[-1] if ranks else 0) == system.n
    index = found["index"]
    return (
        [integer(r) for r in listed(found["ranks"])] == ranks
        and (integer(index) == len(ranks) if reached and index is not None else index is None)
        and reached is (index is not None)
        and [integer(k) for k in listed(found["indices"])] == partition
    )


def transfer_graph(claim: Any, witness: Any, system: System) -> bool:
    """Edges by Markov parameters, components by transitive closure."""
    found = record(claim, "arcs", "components", "strongly_connected")
    arcs = transfer_edges(system)
    parts = components(system.m, arcs)
    return (
        edges(found["arcs"], system.names) == arcs
        and [positions(c, system.names) for c in listed(found["components"])] == parts
        and truth(found["strongly_connected"]) is (len(parts) <= 1)
    )


def neighbor_graph(claim: Any, witness: Any, system: System) -> bool:
    """Strong connectivity of the neighbor graph."""
    found = record(claim, "strongly_connected")
    links = [(j, i) for i, N in enumerate(system.graph()) for j in N]
    return truth(found["strongly_connected"]) is (len(components(system.m, links)) <= 1)


def sharing_gap(claim: Any, witness: Any, system: System) -> bool:
    """All pairs of sets, and all sets: attained, and not exceeded."""
    keys = ("relays", "relays_at_most", "boundary", "boundary_at_most")
    found = record(claim, *keys)
    relays, most, boundary, farthest = (integer(found[key], 0) for key in keys)
    graph = [set(N) for N in system.graph()]
    between, around = numbers_of_relays(graph), boundary_sizes(graph)
    return (
        relays in between
        and max(between) <= most
        and boundary in around
        and max(around) <= farthest
    )


def numbers_of_relays(graph: Sequence[set[int]]) -> set[int]:
    """The numbers of relays of all pairs of sets S and R that are apart."""
    found = set()
    for S in subsets(len(graph)):
        senders = set().union(*(graph[i] for i in S))
        for R in subsets(len(graph)):
            if not senders & set(R):
                found.add(sum(1 for j in senders if graph[j] & set(R)))
    return found


def boundary_sizes(graph: Sequence[set[int]]) -> set[int]:
    """The sizes of N_s∖s for all sets s."""
    return {len(set().union(*(graph[i] for i in s)) - set(s)) for s in subsets(len(graph))}


def mcmillan_degree(system: System, c: list[int]) -> int:
    """The rank of the Hankel matrix of C_c (xI − A)⁻¹ B_c."""
    n = system.n
    reach = algebra.krylov(system.A, system.inputs(c), n)
    seen = algebra.krylov(system.A.transpose(), system.outputs(c).transpose(), n).transpose()
    return int((seen * reach).rank())


def assignability(claim: Any, witness: Any, system: System) -> bool:
    """McMillan degrees of the strong components."""
    found = record(claim, "blocks", "fixed_degree")
    parts = components(system.m, transfer_edges(system))
    blocks = [record(b, "channels", "dimension") for b in listed(found["blocks"])]
    given = [(positions(b["channels"], system.names), integer(b["dimension"])) for b in blocks]
    expected = [(c, mcmillan_degree(system, c)) for c in parts]
    fixed = system.n - sum(d for _, d in expected)
    return given == expected and integer(found["fixed_degree"]) == fixed


def complementary_subsystem(claim: Any, witness: Any, system: System) -> bool:
    """The invariant factors of P_s over Q[x]."""
    keys = ("subset", "normal_rank", "invariant_polynomials", "remnant", "transfer_zero")
    found = record(claim, *keys, "complete")
    s = positions(found["subset"], system.names)
    if not 0 < len(s) < system.m:
        return False
    constant, slope = (M.tolist() for M in pencil(system, s))
    rows = [
        [a + X * b for a, b in zip(*pair, strict=True)]
        for pair in zip(constant, slope, strict=True)
    ]
    factors = algebra.invariant_factors(rows)
    remnant = algebra.ONE
    for f in factors[: system.n]:
        remnant *= f
    outside = [i for i in range(system.m) if i not in s]
    K = algebra.krylov(system.A, system.inputs(outside), system.n)
    zero = not any(v != 0 for v in (system.outputs(s) * K).entries())
    given = [polynomial(f, monic=True) for f in listed(found["invariant_polynomials"])]
    return (
        integer(found["normal_rank"]) == len(factors)
        and given == [f for f in factors if f.degree() > 0]
        and polynomial(found["remnant"], monic=True) == remnant
        and truth(found["transfer_zero"]) is zero
        and truth(found["complete"]) is (not zero and remnant == 1)
    )


def setpoint(claim: Any, witness: Any, system: System) -> bool:
    """The rank at 0 or 1, and the rank over Q(x)."""
    found = record(claim, "solvable", "rank", "invariant_zero")
    n, B, C = system.n, system.inputs(), system.outputs()
    q, p = C.nrows(), B.ncols()
    place = int(system.time == "discrete")
    S = algebra.stacked(
        [[system.A - place * algebra.identity(n), B], [C, fmpq_mat(q, p)]], n + q, n + p
    )
    rank, full = S.rank(), n + q
    zero = found["invariant_zero"]
    if truth(found["solvable"]) is not (rank == full) or integer(found["rank"]) != rank:
        return False
    if rank == full:
        return zero is None
    # the rank over Q(x) is met at one of more points than any minor has roots
    P = algebra.stacked([[-system.A, B], [C, fmpq_mat(q, p)]], full, n + p)
    I = algebra.stacked(
        [[algebra.identity(n), fmpq_mat(n, p)], [fmpq_mat(q, n), fmpq_mat(q, p)]], full, n + p
    )
    normal = max((P + k * I).rank() for k in range(101, 101 + n + 1))
    return truth(zero) is (normal == full)


JUDGES = {
    "assignability": assignability,
    "complementary_subsystem": complementary_subsystem,
    "controllability": controllability,
    "controllability_indices": controllability_indices,
    "neighbor_graph": neighbor_graph,
    "setpoint": setpoint,
    "sharing_gap": sharing_gap,
    "transfer_graph": transfer_graph,
}
"""The judge of each kind."""
