"""Kind ``assignability``: how a spectrum splits; ``proofs/assignability.md``."""

from dataclasses import replace

from . import evidence, subspaces, transfer_graph
from .controllability import require_reached
from .reading import Json, fields, integer, items, malformed, matrix, names, positions, require
from .statement import channel_set
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Check the components, and a minimal realization of the transfer within each.

    Theorems ``assignability.assignability_rule``, ``assignability.component_own_gains``,
    ``assignability.mcmillan_degree``.
    """
    listed, left = fields(claim, "claim", "blocks", "fixed_degree")
    number, graph, shown = fields(witness, "witness", "modulus", "transfer_graph", "realizations")
    ell = evidence.modulus(number, "witness.modulus")
    known, proof = fields(graph, "witness.transfer_graph", "claim", "witness")
    transfer_graph.check(known, proof, system)
    place = "claim.blocks"
    blocks = [fields(block, place, "channels", "dimension") for block in items(listed, place)]
    same = [c for c, _ in blocks] == known["components"]
    require(same, "component", place, "not the components of the transfer graph")
    degrees, entries = [], items(shown, "witness.realizations", len(blocks))
    for (component, size), entry in zip(blocks, entries, strict=True):
        c = names(component, place, system.names)
        degrees.append(integer(size, place))
        _require_minimal(system, c, degrees[-1], entry, ell)
    fixed = integer(left, "claim.fixed_degree")
    require(fixed == system.n - sum(degrees), "degree", "claim.fixed_degree", "does not follow")


def statement(claim: Json, system: System) -> str:
    """How the characteristic polynomial of every loop splits."""
    blocks = ((block["channels"], block["dimension"]) for block in claim["blocks"])
    parts = ", ".join(f"{degree} for {channel_set(c)}" for c, degree in blocks)
    return (
        "for all constant gains F, det(xI - A_F) = phi(x) times the product of chi_c(x) over the "
        "strong components c of the transfer graph; phi is monic of degree "
        f"{claim['fixed_degree']} and the same for all F; chi_c is monic, depends on the F_i with "
        "i in c alone, and its degree is the McMillan degree of C_c (xI - A)^-1 B_c, "
        f"{parts or 'none'}"
    )


def _require_minimal(system: System, c: list[int], d: int, value: Json, ell: int) -> None:
    """Stop unless C_c (xI − A)⁻¹ B_c has a minimal realization of dimension d."""
    place = "witness.realizations"
    rows, pivots, reduced, chosen = fields(value, place, "X", "pivots", "W", "columns")
    listed = [system.names[i] for i in c]
    space = {"from": listed, "X": rows, "pivots": pivots}
    _, X = subspaces.zero_transfer(space, place, system)
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
