"""Kind ``deficiency``: the largest loss of rank over all subsets; ``proofs/deficiency.md``."""

from __future__ import annotations

from typing import Any

from . import evidence, subspaces
from .characteristic_polynomial import characteristic_polynomial_modulo
from .reading import fields, integer, matrix, polynomial, require
from .statement import PENCIL
from .system import System


def check(claim: Any, witness: Any, system: System) -> None:
    """Check a completed loop that moves every mode, and a shrunk subspace that loses as much.

    Theorems ``deficiency.deficiency_rule``, ``deficiency.deficiency_bound``.
    """
    (number,) = fields(claim, "claim", "deficiency")
    ell, gains, left, right, coefficients, subspace = fields(
        witness, "witness", "modulus", "gains", "B0", "C0", "polynomial", "subspace"
    )
    rho, n = integer(number, "claim.deficiency"), system.n
    ell = evidence.modulus(ell, "witness.modulus")
    F = evidence.read_gains(gains, "witness.gains", system)
    B0, C0 = matrix(left, "witness.B0", n, rho), matrix(right, "witness.C0", rho, n)
    completed = evidence.closed_loop(system, F) + B0 @ C0
    before = characteristic_polynomial_modulo(system.A.modulo(ell), ell)
    after = characteristic_polynomial_modulo(completed.modulo(ell), ell)
    evidence.require_coprime(before, after, ell, "det(xI - A) and det(xI - A_F - B0 C0)")
    if rho:
        p = polynomial(coefficients, "witness.polynomial", 1)
        subspaces.shrunk_subspace(subspace, "witness.subspace", system, p, rho)
    else:
        null = coefficients is None and subspace is None
        require(
            null, "claim", "witness", "expected no polynomial and no subspace, rank is not lost"
        )


def statement(claim: Any, system: System) -> str:
    """The largest loss of rank."""
    return (
        f"the largest {system.n} - rank {PENCIL}, over all complex x and all sets of channels, C "
        f"the outputs of the set and B the inputs of the others, is {claim['deficiency']}"
    )
