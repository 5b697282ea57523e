"""Kind ``deficiency``: the largest loss of rank over all subsets; ``proofs/deficiency.md``."""

from . import arithmetic, evidence, subspaces
from .absence import Blocks, Loss, by_blocks
from .arithmetic import Polynomial
from .characteristic_polynomial import characteristic_polynomial
from .reading import Json, fields, integer, items, matrix, polynomial, require
from .statement import PENCIL
from .system import System

WITNESS = ("modulus", "gains", "B0", "C0", "polynomial", "subspace")


def check(claim: Json, witness: Json, system: System) -> None:
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
        subspaces.shrunk_subspace(subspace, "witness.subspace", system, p, rho)
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
    product: Polynomial = [1]
    for k, entry in enumerate(items(listed, "witness.losses")):
        place = f"witness.losses[{k}]"
        coefficients, loss, space = fields(entry, place, "polynomial", "deficiency", "subspace")
        p, d = polynomial(coefficients, place, 1), integer(loss, place, 1)
        subspaces.shrunk_subspace(space, f"{place}.subspace", system, p, d)
        evidence.require_coprime(product, p, proof.ell, "two factors")
        product = arithmetic.poly_product(product, p)
        losses.append((p, proof.multiplicity(p, d)))
    proof.require_no_more(losses)
    return max((d for _, d in losses), default=0)


def statement(claim: Json, system: System) -> str:
    """The largest loss of rank."""
    return (
        f"the largest {system.n} - rank {PENCIL}, over all complex x and all sets of channels, C "
        f"the outputs of the set and B the inputs of the others, is {claim['deficiency']}"
    )
