"""Kind ``controllability_indices``; ``proofs/controllability_indices.md``."""

from itertools import pairwise

from .arithmetic import rank_modulo
from .controllability import krylov_ranks
from .evidence import inputs, modulus
from .reading import Json, fields, integer, items, matrix, names, require
from .statement import canonical_json, channel_set
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Check rows that annihilate the first k blocks, and the ranks modulo ℓ from below.

    Theorems ``controllability.indices_rule``, ``controllability.indices_stationary``,
    ``controllability.rank_from_above``.
    """
    listed, claimed, top, parts = fields(claim, "claim", "channels", "ranks", "index", "indices")
    number, rows = fields(witness, "witness", "modulus", "annihilator")
    T, n = names(listed, "claim.channels", system.names), system.n
    ranks = [0, *(integer(r, "claim.ranks", 1) for r in items(claimed, "claim.ranks"))]
    growing = ranks == sorted(set(ranks)) and ranks[-1] <= n
    require(growing, "claim", "claim.ranks", f"expected strictly increasing ranks up to {n}")
    ell, nu = modulus(number, "witness.modulus"), len(ranks) - 1
    W = matrix(rows, "witness.annihilator", n - ranks[min(nu, 1)], n)
    independent = rank_modulo(W, ell) == W.nrows
    require(independent, "rank", "witness.annihilator", "its rows are dependent modulo l")
    power = inputs(system, T)
    for k in range(1, nu + 2):
        first = W.take(range(n - ranks[min(k, nu)]))
        message = f"its first {first.nrows} rows do not annihilate block {k}"
        require((first @ power).is_zero(), "identity", "witness.annihilator", message)
        power = system.A @ power
    reached = krylov_ranks(system, T, ell, nu)
    # Where the blocks stop growing modulo ℓ, the last rank stands for all that follow.
    reached += [reached[-1]] * (nu + 1 - len(reached))
    enough = all(low >= r for low, r in zip(reached, ranks, strict=True))
    require(enough, "rank", "claim.ranks", f"only {reached[1:]} are reached modulo l")
    index = None if top is None else integer(top, "claim.index")
    require(index == (nu if ranks[-1] == n else None), "claim", "claim.index", "does not follow")
    steps = [b - a for a, b in pairwise(ranks)]
    conjugate = [sum(step > i for step in steps) for i in range(max(steps, default=0))]
    kappa = [integer(part, "claim.indices") for part in items(parts, "claim.indices")]
    require(kappa == conjugate, "claim", "claim.indices", f"the ranks give {conjugate}")


def statement(claim: Json, system: System) -> str:
    """The ranks, and the indices that follow from them."""
    index = "none" if claim["index"] is None else claim["index"]
    return (
        "the ranks of [B, A B, ..., A^(k-1) B], B the inputs of the channels "
        f"{channel_set(claim['channels'])}, for k = 1, 2, ... are {canonical_json(claim['ranks'])} "
        f"and do not grow further; the controllability indices are "
        f"{canonical_json(claim['indices'])} and the controllability index is {index}"
    )
