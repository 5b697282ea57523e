"""Kind ``completeness``: connected and nothing fixed, or not; ``proofs/completeness.md``."""

from . import evidence, subspaces
from .absence import Blocks, TwoPolynomials, by_blocks
from .reading import Json, boolean, fields, polynomial, require
from .statement import FIXED, denied
from .system import System
from .transfer_graph import require_connected


def check(claim: Json, witness: Json, system: System) -> None:
    """Check freedom and edges for yes; a fixed mode or a cut of the transfer graph for no.

    Theorems ``completeness.completeness_yes``, ``completeness.completeness_no_mode``,
    ``completeness.completeness_no_cut``.
    """
    (verdict,) = fields(claim, "claim", "complete")
    if boolean(verdict, "claim.complete"):
        _require_freedom(witness, system)
    elif isinstance(witness, dict) and "zero" in witness:
        (zero,) = fields(witness, "witness", "zero")
        sources, X = subspaces.zero_transfer(zero, "witness.zero", system)
        rest = evidence.complement(system, sources)
        proper = bool(sources and rest)
        require(proper, "cut", "witness.zero.from", "expected a nonempty proper set")
        for i in rest:
            message = f"C X is not zero for channel number {i + 1}"
            require((system.C[i] @ X).is_zero(), "identity", "witness.zero", message)
    else:
        coefficients, subspace = fields(witness, "witness", "polynomial", "subspace")
        p = polynomial(coefficients, "witness.polynomial", 1)
        subspaces.shrunk_subspace(subspace, "witness.subspace", system, p, 1)


def statement(claim: Json, system: System) -> str:
    """Whether the system is complete."""
    means = f"its transfer graph is strongly connected and no mode is {FIXED}"
    return f"it is {denied(claim['complete'])}complete, which means that {means}"


def _require_freedom(witness: Json, system: System) -> None:
    """Check that no mode is fixed, and edges that connect all channels.

    Theorem ``transfer_graph.strongly_connected_arcs``.
    """
    if by_blocks(witness):
        number, value, listed = fields(witness, "witness", "modulus", "blocks", "arcs")
        ell = evidence.modulus(number, "witness.modulus")
        Blocks(value, "witness", system).require_no_more([])
    else:
        number, gains, listed = fields(witness, "witness", "modulus", "gains", "arcs")
        proof = TwoPolynomials(gains, number, "witness", system)
        proof.require_moved([])
        ell = proof.ell
    require_connected(listed, "witness.arcs", system, ell)
