"""Kind ``setpoint``: whether integrators can hold outputs at set-points; ``proofs/setpoint.md``."""

from .arithmetic import Matrix, beside, diagonal, rank_modulo, stack
from .evidence import inputs, modulus, outputs, require_identity
from .reading import Json, boolean, fields, integer, matrix, polynomial_matrix, positions, require
from .statement import PENCIL, denied
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Check bounds on the rank of [A B; C 0], and whether a rank defect is an invariant zero.

    Theorems ``setpoint.setpoint_rank``, ``setpoint.setpoint_unreachable``,
    ``setpoint.setpoint_output_part``, ``setpoint.normal_rank_deficient``.
    """
    verdict, size, zero = fields(claim, "claim", "solvable", "rank", "invariant_zero")
    keys = ("modulus", "left", "pivots", "point", "normal")
    number, left, columns, x0, row = fields(witness, "witness", *keys)
    A, n = system.A, system.n
    B, C = inputs(system, range(system.m)), outputs(system, range(system.m))
    rows, width, place = n + C.nrows, n + B.ncols, int(system.time == "discrete")
    lower = beside([C, Matrix.zeros(C.nrows, B.ncols)], C.nrows)
    fixed = stack([beside([A.times(-1), B], n), lower], width)
    moving = diagonal(Matrix.unit_rows(n, 0, n), Matrix.zeros(C.nrows, B.ncols))
    S = stack([beside([A - Matrix.unit_rows(n, 0, n).times(place), B], n), lower], width)
    r, ell = integer(size, "claim.rank"), modulus(number, "witness.modulus")
    require(r <= rows and rank_modulo(S, ell) >= r, "rank", "claim.rank", "not reached modulo l")
    pivots = positions(columns, "witness.pivots", rows)
    require(len(pivots) == rows - r, "rank", "witness.pivots", f"expected {rows} - {r} of them")
    W = matrix(left, "witness.left", rows - r, rows)
    require_identity([W.T], pivots, "witness.pivots")
    require((W @ S).is_zero(), "identity", "witness.left", "W [A B; C 0] is not zero")
    solvable = boolean(verdict, "claim.solvable")
    require(solvable == (r == rows), "claim", "claim.solvable", f"the rank is {r} of {rows}")
    if solvable:
        unused = zero is None and x0 is None and row is None
        require(unused, "claim", "claim.invariant_zero", "expected null where it is solvable")
        return
    if boolean(zero, "claim.invariant_zero"):
        require(row is None, "claim", "witness.normal", "expected null for an invariant zero")
        point = integer(x0, "witness.point")
        full = rank_modulo(fixed + moving.times(point), ell) == rows
        require(full, "rank", "witness.point", "the rank there is not full modulo l")
        return
    require(x0 is None, "claim", "witness.point", "expected null where there is no such point")
    layers = polynomial_matrix(row, "witness.normal", 1, rows, rows + 1)
    require(not all(w.is_zero() for w in layers), "zero", "witness.normal", "the row is zero")
    below = [Matrix.zeros(1, rows), *layers]
    for w, before in zip([*layers, below[0]], below, strict=True):
        same = (w @ fixed + before @ moving).is_zero()
        require(same, "identity", "witness.normal", "the row does not annihilate the pencil")


def statement(claim: Json, system: System) -> str:
    """Whether the rank is full, and else what follows from the defect."""
    shift, place = (" - I", 1) if system.time == "discrete" else ("", 0)
    which = f"[A{shift}, B; C, 0], B and C those of all channels, has rank exactly {claim['rank']}"
    rows = f"{which}, which is {denied(claim['solvable'])}its number of rows"
    if claim["solvable"]:
        return f"{rows}, so that integrators of all outputs add no uncontrollable mode"
    zero = f", so that {place} is an invariant zero" if claim["invariant_zero"] else ""
    goal = "every output tends to every constant set-point"
    normal = f"the normal rank of {PENCIL} is {denied(claim['invariant_zero'])}its number of rows"
    return f"{rows}, so that in no stable linear time-invariant loop {goal}; {normal}{zero}"
