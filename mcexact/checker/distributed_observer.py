"""Kind ``distributed_observer``: separation, both spectra; ``proofs/distributed_observer.md``."""

from . import budget
from .arithmetic import Matrix
from .closed_loop_spectrum import moduli, require_spectrum
from .location import in_region
from .reading import Json, fields, polynomial, require
from .region import inside, read_bound
from .statement import polynomial_text
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
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
    bound = read_bound(limit, system)
    if bound is not None:
        met = all(in_region(factor, system.time, bound) for factor in (p, q))
        require(met, "bound", "claim.bound", "a root does not meet it")


def statement(claim: Json, system: System) -> str:
    """The separation of the errors, and both polynomials."""
    feedback, error = (polynomial_text(claim[key]) for key in ("feedback", "error"))
    limit = claim["bound"]
    return (
        "in the coordinates (x, e_1, z_1, e_2, z_2, ...), e_i = x_i - x for the x_i that agent i "
        "shares, the matrix of the loop is [M_F, *; 0, M_E], where M_F has the characteristic "
        f"polynomial {feedback} and M_E has {error}"
        + ("" if limit is None else f"; every root of both has {inside(limit, system)}")
    )


def separated(system: System) -> tuple[Matrix, Matrix]:
    """The diagonal blocks in the coordinates (x, e_1, z_1, …), e_i = x_i − x.

    Theorem ``distributed_observer.separation``.
    """
    blocks = list(system.blocks)
    good = len(blocks) > 1 and sum(blocks) == system.n and set(blocks[1::2]) == {blocks[0]}
    require(good, "subject", "subject", "not a loop in which every agent estimates the state")
    budget.spend(2 * budget.table(system.n, system.n, system.A.limbs) + len(blocks) ** 2)
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
