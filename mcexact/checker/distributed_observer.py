"""Kind ``distributed_observer``: separation, both spectra; ``proofs/distributed_observer.md``."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from . import budget
from .arithmetic import Matrix, Polynomial
from .budget import spend
from .closed_loop_spectrum import moduli, require_spectrum
from .location import in_region
from .reading import fields, polynomial, rational, require
from .system import System
from .words import polynomial_text


def check(claim: Any, witness: Any, system: System) -> str:
    """Check that the errors evolve by themselves, and the polynomials of both diagonal blocks.

    Theorems ``distributed_observer.observer_rate``, ``distributed_observer.observer_radius``.
    """
    first, second, limit = fields(claim, "claim", "feedback", "error", "bound")
    (numbers,) = fields(witness, "witness", "moduli")
    M_F, M_E = separated(system)
    p, q = polynomial(first, "claim.feedback"), polynomial(second, "claim.error")
    ells = moduli(numbers, "witness.moduli")
    require_spectrum(M_F, p, "claim.feedback", ells)
    require_spectrum(M_E, q, "claim.error", ells)
    words = "" if limit is None else _placed(rational(limit, "claim.bound"), system.time, [p, q])
    return (
        f"in {system.words} ({system.time} time) the estimation errors evolve by themselves with "
        f"characteristic polynomial {polynomial_text(q)}, the rest with {polynomial_text(p)}{words}"
    )


def separated(system: System) -> tuple[Matrix, Matrix]:
    """The diagonal blocks in the coordinates (x, e_1, z_1, …), e_i = x_i − x.

    Theorem ``distributed_observer.separation``.
    """
    blocks = list(system.blocks)
    good = len(blocks) > 1 and sum(blocks) == system.n and set(blocks[1::2]) == {blocks[0]}
    require(good, "subject", "subject", "not a loop in which every agent estimates the state")
    spend(2 * budget.table(system.n, system.n, system.A.limbs) + len(blocks) ** 2)
    n, rows = blocks[0], [list(row) for row in system.A.rows]
    starts = [sum(blocks[:k]) for k in range(1, len(blocks), 2)]
    for start in starts:
        for i in range(n):
            rows[start + i] = [a - b for a, b in zip(rows[start + i], rows[i], strict=True)]
    for row in rows:
        row[:n] = [row[i] + sum(row[start + i] for start in starts) for i in range(n)]
    M, x, rest = Matrix(rows, system.n, system.A.denominator), range(n), range(n, system.n)
    alone = M.take(rest, x).is_zero()
    require(alone, "separation", "subject", "the state of the plant drives the estimation errors")
    return M.take(x, x), M.take(rest, rest)


def _placed(bound: Fraction, time: str, polynomials: list[Polynomial]) -> str:
    """Stop unless every root meets the rate or radius, and return it in words."""
    sensible = bound >= 0 if time == "continuous" else 0 < bound <= 1
    require(sensible, "bound", "claim.bound", "no rate or radius")
    inside = all(in_region(p, time, bound) for p in polynomials)
    require(inside, "bound", "claim.bound", "a root does not meet it")
    return (
        f"; every {'real part is below -' if time == 'continuous' else 'modulus is below '}{bound}"
    )
