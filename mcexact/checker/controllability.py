"""Kind ``controllability``: the subspace that channels control; ``proofs/controllability.md``."""

from .absence import Blocks, by_blocks
from .arithmetic import Echelon, Matrix, product
from .budget import spend
from .characteristic_polynomial import characteristic_polynomial
from .evidence import inputs, modulus, require_identity
from .reading import (
    Json,
    boolean,
    fields,
    integer,
    items,
    matrix,
    names,
    polynomial,
    positions,
    require,
)
from .sparse import SparseMatrix
from .statement import channel_set, denied, polynomial_text
from .system import System

CLAIM = ("channels", "dimension", "controllable", "uncontrollable_polynomial")


def check(claim: Json, witness: Json, system: System) -> None:
    """Check an annihilator W from above, and a Krylov rank modulo ℓ or a bound from below.

    Theorems ``controllability.controllability_rule``,
    ``controllability_bound.controllability_by_bound``.
    """
    listed, size, verdict, factor = fields(claim, "claim", *CLAIM)
    keys = ("blocks", "measured") if by_blocks(witness) else ("modulus",)
    *proof, rows, columns = fields(witness, "witness", *keys, "annihilator", "pivots")
    T = names(listed, "claim.channels", system.names)
    d, n = integer(size, "claim.dimension"), system.n
    chi = polynomial(factor, "claim.uncontrollable_polynomial")
    pivots = positions(columns, "witness.pivots", n)
    require(len(pivots) == n - d, "dimension", "witness.pivots", f"expected {n} - {d} of them")
    W = matrix(rows, "witness.annihilator", n - d, n)
    require_identity([W.T], pivots, "witness.pivots")
    WA = W @ system.A
    Z = WA.take(cols=pivots)
    require(WA.equals(Z @ W), "identity", "witness.annihilator", "W A is not Z W")
    unmoved = all((W @ system.B[i]).is_zero() for i in T)
    require(unmoved, "identity", "witness.annihilator", "W B is not zero")
    low = _by_blocks if by_blocks(witness) else _by_rank
    reached = low(system, T, *proof)
    require(reached >= d, "rank", "claim.dimension", f"only {reached} are proved to be reached")
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


def _by_rank(system: System, T: list[int], number: Json) -> int:
    """The dimension that the inputs of T reach modulo ℓ."""
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
    """The rows of the identity for these places."""
    spend(100 * len(places))
    return SparseMatrix(len(places), ncols, [(k, place, 1) for k, place in enumerate(places)])


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
