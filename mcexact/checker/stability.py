"""Kind ``stability``: whether every eigenvalue meets a rate or radius; ``proofs/stability.md``."""

from fractions import Fraction

from .characteristic_polynomial import characteristic_polynomial
from .location import in_region
from .quadratic_forms import decreasing, require_dominant, transformed
from .reading import Json, boolean, fields, integer, items, matrix, require, string
from .region import inside, read_bound
from .statement import denied
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Locate the roots of the characteristic polynomial, or check quadratic forms.

    Theorems ``instability.instability_continuous``, ``instability.instability_discrete``,
    ``stability.stability_continuous``, ``stability.stability_discrete``,
    ``stability.stability_blocks``.
    """
    limit, verdict = fields(claim, "claim", "bound", "stable")
    stable, given = boolean(verdict, "claim.stable"), read_bound(limit, system)
    bound = Fraction(int(system.time == "discrete")) if given is None else given
    method, M = witness.get("method") if isinstance(witness, dict) else None, system.A
    if string(method, "witness.method", "polynomial", "lyapunov", "instability") == "polynomial":
        fields(witness, "witness", "method")
        found = in_region(characteristic_polynomial(M), system.time, bound)
        require(found == stable, "claim", "claim.stable", "the characteristic polynomial differs")
    elif method == "lyapunov":
        require(stable, "claim", "claim.stable", "this evidence is for a stable loop")
        _, change, listed = fields(witness, "witness", "method", "transformation", "blocks")
        start, Delta = 0, M if change is None else transformed(change, M)
        for place, entry in ((f"witness.blocks[{k}]", e) for k, e in enumerate(items(listed, ""))):
            size = integer(fields(entry, place, "size", "P", "R", "R2")[0], f"{place}.size")
            block, rest = range(start, start + size), range(start + size, M.nrows)
            require(block.stop <= M.nrows, "size", place, f"expected {M.nrows} states in all")
            below = Delta.take(rest, block)
            require(below.is_zero(), "blocks", place, "not block upper triangular")
            P = decreasing(entry, place, Delta.take(block, block), system.time, bound)
            R = matrix(entry["R"], f"{place}.R", size, size)
            require_dominant(R.T @ (P @ R), f"{place}.R")
            start += size
        require(start == M.nrows, "size", "witness.blocks", f"expected {M.nrows} states in all")
    else:
        require(not stable, "claim", "claim.stable", "this evidence is for an unstable loop")
        *_, direction = fields(witness, "witness", "method", "P", "R2", "v")
        P = decreasing(witness, "witness", M, system.time, bound)
        v = matrix(direction, "witness.v", M.nrows, 1)
        falls = not v.is_zero() and (v.T @ (P @ v)).rows[0][0] <= 0
        require(falls, "direction", "witness.v", "expected v not 0 with v'Pv <= 0")


def statement(claim: Json, system: System) -> str:
    """Where all eigenvalues lie, or that they do not."""
    limit = claim["bound"]
    bound = int(system.time == "discrete") if limit is None else limit
    return f"{denied(claim['stable'])}every eigenvalue of A has {inside(bound, system)}"
