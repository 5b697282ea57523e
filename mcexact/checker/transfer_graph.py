"""Kind ``transfer_graph``: which channels reach which; ``proofs/transfer_graph.md``."""

from .arithmetic import Rows, product
from .budget import counted, spend
from .evidence import modulus
from .markov import unseen
from .neighbor_graph import components
from .packed_rows import SMALL
from .paths import without_path
from .reading import Json, boolean, fields, integer, items, malformed, names, require, shown
from .statement import channel_set, denied, edge_set
from .subspaces import zero_transfer
from .system import System

PAIRS = 100
"""What a pair of channels costs where every pair is looked at."""


def check(claim: Json, witness: Json, system: System) -> None:
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
    for k, entry in enumerate(items(zeros, "witness.zeros")):
        sources, X = zero_transfer(entry, f"witness.zeros[{k}]", system)
        unseen = [i for i, C in enumerate(system.C) if (C @ X).is_zero()]
        spend(10 * len(sources) * len(unseen))
        missing -= {(j, i) for j in sources for i in unseen}
    if missing:
        missing -= without_path(system, missing)
    pair = [(system.names[j], system.names[i]) for j, i in sorted(missing)][:1]
    require(not missing, "arc", "witness.zeros", f"nothing proves that {pair!a} is not an edge")
    claimed = [names(p, "claim.components", system.names) for p in items(parts, "claim.components")]
    found = components(system.m, arcs)
    require(claimed == found, "claim", "claim.components", "these are not the strong components")
    connected = boolean(verdict, "claim.strongly_connected")
    require(connected == (len(found) <= 1), "claim", "claim.strongly_connected", "does not follow")


def statement(claim: Json, system: System) -> str:
    """The edges, the strong components and whether there is one at most."""
    return (
        "its transfer graph, in which j -> i means that C_i (xI - A)^-1 B_j is not zero, has "
        f"exactly the edges {edge_set(claim['arcs'])}, the strong components "
        f"{', '.join(map(channel_set, claim['components'])) or 'none'}, and is "
        f"{denied(claim['strongly_connected'])}strongly connected"
    )


def read_arcs(value: Json, where: str, system: System) -> list[tuple[int, int, int]]:
    """Read edges (j, i) with a power k each, sorted and none twice."""
    arcs, known = [], {name: i for i, name in enumerate(system.names)}
    for place, entry in ((f"{where}[{k}]", e) for k, e in enumerate(items(value, where))):
        *ends, power = items(entry, place, 3)
        spend(40)
        for end in ends:
            if type(end) is not str or end not in known:
                malformed(place, f"expected the name of a channel, found {shown(end)}")
        j, i = (known[end] for end in ends)
        arcs.append((j, i, integer(power, place)))
    if [arc[:2] for arc in arcs] != sorted({arc[:2] for arc in arcs}):
        malformed(where, "expected them sorted, none twice")
    return arcs


def require_arcs(system: System, triples: list[tuple[int, int, int]], ell: int) -> None:
    """Stop unless k < n and C_i A^k B_j ≠ 0 modulo ℓ for every (j, i, k).

    Theorem ``transfer_graph.arc_rule``.
    """
    wanted: dict[int, dict[int, list[int]]] = {}
    for j, i, k in triples:
        require(k < system.n, "arc", "witness", f"the power {k} is not below {system.n}")
        wanted.setdefault(j, {}).setdefault(k, []).append(i)
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
