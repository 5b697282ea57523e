"""The kinds about fixed modes, and gains for single channels."""

from __future__ import annotations

import random
from typing import Any

from flint import fmpq_mat

from . import algebra
from .constructions import output_gains
from .modes import connected, drawn_loop, fixed_modes, pencil_rank
from .reading import Unspecified, integer, listed, matrix, polynomial, positions, record, truth
from .roots import discs_hold, inside, rate_holds
from .structure import index_ranks
from .systems import System


def fixed_spectrum(claim: Any, witness: Any, system: System) -> bool:
    """Every factor of χ_A that is fixed is in exactly one factor of the claim."""
    found = record(claim, "polynomial", "factors", "stabilizable", "best_rate")
    modes = {algebra.coefficients(mode.polynomial): mode for mode in fixed_modes(system)}
    product, seen, stable, polynomials = algebra.ONE, [], [], []
    keys = ("polynomial", "multiplicity_in_A", "multiplicity_at_most", "channels", "rank")
    for factor in listed(found["factors"]):
        given = record(factor, *keys, "stable", "roots")
        p = polynomial(given["polynomial"], monic=True)
        parts = [
            algebra.coefficients(q) for q, e in algebra.irreducible_factors(p) for _ in range(e)
        ]
        if not parts or any(part not in modes for part in parts):
            return False
        seen += parts
        product *= p
        polynomials.append(p)
        stable.append(inside(p, system.time, None))
        s = tuple(positions(given["channels"], system.names))
        rank, held = integer(given["rank"]), [modes[part] for part in parts]
        if any(mode.least != rank or mode.ranks[s] != rank for mode in held):
            return False
        times = given["multiplicity_in_A"]
        if times is not None and integer(times) != min(mode.in_A for mode in held):
            return False
        if integer(given["multiplicity_at_most"]) < min(mode.in_every_loop for mode in held):
            return False
        if truth(given["stable"]) is not stable[-1] or not discs_hold(given["roots"], p):
            return False
    return (
        sorted(map(str, seen)) == sorted(map(str, modes))
        and polynomial(found["polynomial"], monic=True) == product
        and truth(found["stabilizable"]) is all(stable)
        and rate_holds(found["best_rate"], polynomials, system.time)
    )


def completeness(claim: Any, witness: Any, system: System) -> bool:
    """Connected, and no mode fixed."""
    complete = connected(system) and not fixed_modes(system)
    return truth(record(claim, "complete")["complete"]) is complete


def deficiency(claim: Any, witness: Any, system: System) -> bool:
    """The largest n − rank P_s(λ): at a mode that is not fixed no rank is below n."""
    most = max((system.n - mode.least for mode in fixed_modes(system)), default=0)
    return integer(record(claim, "deficiency")["deficiency"]) == most


def rank_of_pencil(claim: Any, witness: Any, system: System) -> bool:
    """The rank at the roots of every irreducible factor."""
    found = record(claim, "subset", "polynomial", "rank")
    s = positions(found["subset"], system.names)
    parts = algebra.irreducible_factors(polynomial(found["polynomial"]))
    rank = integer(found["rank"])
    return bool(parts) and all(pencil_rank(system, s, p) == rank for p, _ in parts)


SIDES = {
    "controllable": ("controllable",),
    "observable": ("observable",),
    "both": ("controllable", "observable"),
}


def _indices(A: fmpq_mat, system: System, q: int, sides: tuple[str, ...]) -> list[int | None]:
    pairs = {
        "controllable": (A, system.B[q]),
        "observable": (A.transpose(), system.C[q].transpose()),
    }
    found = [index_ranks(*pairs[side]) for side in sides]
    return [len(r) if (r[-1] if r else 0) == system.n else None for r in found]


def cyclic(A: fmpq_mat) -> bool:
    """Whether the minimal polynomial has degree n."""
    return bool(A.minpoly().degree() == A.nrows()) if A.nrows() else True


def single_channel_gains(claim: Any, witness: Any, system: System) -> bool:
    """Gains that are given or drawn have these indices; or drawn gains of all sizes fail."""
    found = record(claim, "channels", "property", "exists", "cyclic", "indices")
    Q, asked = positions(found["channels"], system.names), found["property"]
    if asked not in SIDES:
        raise Unspecified("expected a property")
    wanted, turns = found["indices"], truth(found["cyclic"])
    rng = random.Random(11)
    loops = [drawn_loop(system, rng, bound) for bound in (2**40, 2**40, 3, 3, 1, 1, 1, 1)]
    if not truth(found["exists"]):
        reached = any(
            all(None not in _indices(A, system, q, SIDES[asked]) for q in Q) for A in loops[:2]
        )
        return not reached and not turns and wanted is None
    given = [[integer(k) for k in listed(pair)] for pair in listed(wanted, len(Q))]
    for A in (*_given_loop(witness, system), system.A, *loops):
        if [_indices(A, system, q, SIDES[asked]) for q in Q] == given and (not turns or cyclic(A)):
            return True
    return False


def _given_loop(witness: Any, system: System) -> list[fmpq_mat]:
    """A_F for the gains of a witness, which are only a hint where to look."""
    try:
        gains = output_gains(system, witness["gains"])
    except (KeyError, TypeError, Unspecified):
        return []
    A = system.A
    for B, F, C in zip(system.B, gains, system.C, strict=True):
        A = A + B * F * C
    return [A]


def exceptional_gains(claim: Any, witness: Any, system: System) -> bool:
    """The last determinantal divisor of [B, (M+gA)B, …], squarefree; its real roots."""
    found = record(claim, "M", "blocks", "polynomial", "roots")
    n, k = system.n, integer(found["blocks"])
    if not 1 <= k <= max(n, 1):
        return False
    M = matrix(found["M"], n, n).tolist()
    A = system.A.tolist()
    moving = [[M[i][j] + algebra.X * A[i][j] for j in range(n)] for i in range(n)]
    zero = 0 * algebra.X
    block = [[zero + v for v in row] for row in system.inputs().tolist()]
    rows: list[list[Any]] = [[] for _ in range(n)]
    for _ in range(k):
        rows = [row + new for row, new in zip(rows, block, strict=True)]
        columns = list(zip(*block, strict=True))
        block = [
            [sum((a * b for a, b in zip(r, c, strict=True)), zero) for c in columns] for r in moving
        ]
    factors = algebra.invariant_factors(rows) if n else []
    if len(factors) < n:
        return False
    product = algebra.ONE
    for f, _ in algebra.irreducible_factors(factors[-1] if factors else algebra.ONE):
        product *= f
    p = polynomial(found["polynomial"], monic=True)
    return p == product and discs_hold(found["roots"], p, real=True)


JUDGES = {
    "completeness": completeness,
    "deficiency": deficiency,
    "exceptional_gains": exceptional_gains,
    "fixed_spectrum": fixed_spectrum,
    "pencil_rank": rank_of_pencil,
    "single_channel_gains": single_channel_gains,
}
"""The judge of each kind."""
