"""Kind ``stability``: whether every eigenvalue lies in a region; ``proofs/stability.md``."""

from fractions import Fraction

from .arithmetic import Matrix
from .characteristic_polynomial import characteristic_polynomial
from .quadratic_forms import decreasing, require_dominant, transformed
from .reading import Json, boolean, fields, integer, items, matrix, require, string
from .sector import LIMITS, read_region, within
from .statement import denied
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Locate the roots of the characteristic polynomial, or check quadratic forms.

    Theorems ``instability.instability_continuous``, ``instability.instability_discrete``,
    ``stability.stability_continuous``, ``stability.stability_discrete``,
    ``stability.stability_blocks``.
    """
    bound, verdict, zeta, largest = fields(claim, "claim", "bound", "stable", optional=LIMITS)
    stable, region = boolean(verdict, "claim.stable"), read_region(bound, zeta, largest, system)
    method, M = witness.get("method") if isinstance(witness, dict) else None, system.A
    if string(method, "witness.method", "polynomial", "lyapunov", "instability") == "polynomial":
        fields(witness, "witness", "method")
        found = region.contains(characteristic_polynomial(M))
        require(found == stable, "claim", "claim.stable", "the characteristic polynomial differs")
    elif method == "lyapunov":
        require(stable, "claim", "claim.stable", "this evidence is for a stable loop")
        _, change, listed = fields(witness, "witness", "method", "transformation", "blocks")
        start, Delta = 0, M if change is None else transformed(change, M)
        for place, entry in ((f"witness.blocks[{k}]", e) for k, e in enumerate(items(listed, ""))):
            keys = ("size", "P", "R", "R2", *region.limits)
            size = integer(fields(entry, place, *keys)[0], f"{place}.size")
            block, rest = range(start, start + size), range(start + size, M.nrows)
            require(block.stop <= M.nrows, "size", place, f"expected {M.nrows} states in all")
            below = Delta.take(rest, block)
            require(below.is_zero(), "blocks", place, "not block upper triangular")
            for key, side in region.sides(Delta.take(block, block)).items():
                _require_inside(entry, place, key, side)
            start += size
        require(start == M.nrows, "size", "witness.blocks", f"expected {M.nrows} states in all")
    else:
        require(not stable, "claim", "claim.stable", "this evidence is for an unstable loop")
        given, sides = ("side",) * bool(region.limits), region.sides(M)
        *_, direction = fields(witness, "witness", *given, "method", "P", "R2", "v")
        side = sides[string(witness.get("side", "bound"), "witness.side", *sides)]
        P = decreasing(witness, "witness", *side)
        v = matrix(direction, "witness.v", P.nrows, 1)
        falls = not v.is_zero() and (v.T @ (P @ v)).rows[0][0] <= 0
        require(falls, "direction", "witness.v", "expected v not 0 with v'Pv <= 0")


def _require_inside(entry: Json, place: str, key: str, side: tuple[Matrix, str, Fraction]) -> None:
    """Stop unless a quadratic form shows that a block lies on one side of the region's border."""
    if key != "bound":
        entry, place = entry[key], f"{place}.{key}"
        fields(entry, place, "P", "R", "R2")
    P = decreasing(entry, place, *side)
    R = matrix(entry["R"], f"{place}.R", P.nrows, P.nrows)
    require_dominant(R.T @ (P @ R), f"{place}.R")


def statement(claim: Json, system: System) -> str:
    """Where all eigenvalues lie, or that they do not."""
    return f"{denied(claim['stable'])}every eigenvalue of A has {within(claim, system)}"
