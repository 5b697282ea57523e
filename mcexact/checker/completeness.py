"""Kind ``completeness``: connected and nothing fixed, or not; ``proofs/completeness.md``."""

from __future__ import annotations

from typing import Any

from . import evidence, subspaces
from .characteristic_polynomial import characteristic_polynomial_modulo
from .neighbor_graph import components
from .reading import boolean, fields, polynomial, require
from .statement import FIXED, denied
from .system import System
from .transfer_graph import read_arcs, require_arcs


def check(claim: Any, witness: Any, system: System) -> None:
    """Check gains and edges for yes; a fixed mode or a cut of the transfer graph for no.

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
        require(
            bool(sources and rest), "cut", "witness.zero.from", "expected a nonempty proper set"
        )
        for i in rest:
            message = f"C X is not zero for channel number {i + 1}"
            require((system.C[i] @ X).is_zero(), "identity", "witness.zero", message)
    else:
        coefficients, subspace = fields(witness, "witness", "polynomial", "subspace")
        p = polynomial(coefficients, "witness.polynomial", 1)
        subspaces.shrunk_subspace(subspace, "witness.subspace", system, p, 1)


def statement(claim: Any, system: System) -> str:
    """Whether the system is complete."""
    means = f"its transfer graph is strongly connected and no mode is {FIXED}"
    return f"it is {denied(claim['complete'])}complete, which means that {means}"


def _require_freedom(witness: Any, system: System) -> None:
    """Check that gains move every mode, and edges that connect all channels.

    Theorem ``transfer_graph.strongly_connected_arcs``.
    """
    number, gains, listed = fields(witness, "witness", "modulus", "gains", "arcs")
    ell = evidence.modulus(number, "witness.modulus")
    A_F = evidence.closed_loop(system, evidence.read_gains(gains, "witness.gains", system))
    before = characteristic_polynomial_modulo(system.A.modulo(ell), ell)
    after = characteristic_polynomial_modulo(A_F.modulo(ell), ell)
    evidence.require_coprime(before, after, ell, "det(xI - A) and det(xI - A_F)")
    arcs = read_arcs(listed, "witness.arcs", system)
    require_arcs(system, arcs, ell)
    connected = len(components(system.m, [(j, i) for j, i, _ in arcs])) <= 1
    require(connected, "arc", "witness.arcs", "these edges do not connect all channels")
