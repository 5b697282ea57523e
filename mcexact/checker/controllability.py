"""Kind ``controllability``: the subspace that channels control; ``proofs/controllability.md``."""

from .arithmetic import Echelon, product
from .characteristic_polynomial import characteristic_polynomial
from .evidence import inputs, modulus, require_identity
from .reading import Json, boolean, fields, integer, matrix, names, polynomial, positions, require
from .statement import channel_set, denied, polynomial_text
from .system import System

CLAIM = ("channels", "dimension", "controllable", "uncontrollable_polynomial")


def check(claim: Json, witness: Json, system: System) -> None:
    """Check an annihilator W from above and a Krylov rank modulo ℓ from below.

    Theorem ``controllability.controllability_rule``.
    """
    listed, size, verdict, factor = fields(claim, "claim", *CLAIM)
    ell, rows, columns = fields(witness, "witness", "modulus", "annihilator", "pivots")
    T = names(listed, "claim.channels", system.names)
    d, n = integer(size, "claim.dimension"), system.n
    chi = polynomial(factor, "claim.uncontrollable_polynomial")
    pivots = positions(columns, "witness.pivots", n)
    require(len(pivots) == n - d, "dimension", "witness.pivots", f"expected {n} - {d} of them")
    W = matrix(rows, "witness.annihilator", n - d, n)
    require_identity([W.T], pivots, "witness.pivots")
    WA, B_T = W @ system.A, inputs(system, T)
    Z = WA.take(cols=pivots)
    require(WA.equals(Z @ W), "identity", "witness.annihilator", "W A is not Z W")
    require((W @ B_T).is_zero(), "identity", "witness.annihilator", "W B is not zero")
    reached = krylov_ranks(system, T, modulus(ell, "witness.modulus"), n)[-1]
    require(reached >= d, "rank", "claim.dimension", f"only {reached} reached modulo l")
    controllable = boolean(verdict, "claim.controllable")
    require(controllable == (d == n), "claim", "claim.controllable", f"{d} of {n} are controllable")
    same = characteristic_polynomial(Z) == chi
    require(same, "claim", "claim.uncontrollable_polynomial", "not det(xI - Z)")


def statement(claim: Json, system: System) -> str:
    """How much of the state the channels control."""
    return (
        f"the channels {channel_set(claim['channels'])} together control a subspace of dimension "
        f"exactly {claim['dimension']}; it is {denied(claim['controllable'])}controllable through "
        "them, with the uncontrollable polynomial "
        f"{polynomial_text(claim['uncontrollable_polynomial'])}"
    )


def krylov_ranks(system: System, T: list[int], ell: int, blocks: int) -> list[int]:
    """Ranks modulo ℓ of [B_T], [B_T, A B_T], …, at most this many, until they stop growing.

    Each bounds the rank over Q from below: the block k + 1 adds A times what the block k added.

    Theorem ``arithmetic.rank_from_below``.
    """
    A, fresh = system.A.modulo(ell), list(zip(*inputs(system, T).modulo(ell), strict=True))
    echelon, ranks = Echelon(ell), [0]
    while len(ranks) <= blocks and fresh:
        left = [echelon.add(vector) for vector in fresh]
        kept = [vector for vector in left if vector is not None]
        images = product(A, [list(row) for row in zip(*kept, strict=True)], len(kept), ell)
        fresh = list(zip(*images, strict=True)) if kept else []
        ranks.append(len(echelon.rows))
    return ranks


def require_reached(system: System, channel: int, ell: int, blocks: int) -> None:
    """Stop unless [B_q, …, A^{blocks−1}B_q] has rank n modulo ℓ."""
    reached = krylov_ranks(system, [channel], ell, blocks)[-1]
    message = f"only {reached} dimensions are reached modulo l in {blocks} blocks"
    require(reached == system.n, "rank", "witness", message)
