"""Kind ``complementary_subsystem``: a Smith form; ``proofs/complementary_subsystem.md``."""

import math
from dataclasses import replace
from fractions import Fraction
from functools import reduce
from itertools import pairwise

from . import evidence, reading
from .arithmetic import Matrix, diagonal, poly_divide, poly_product, rank_modulo, stack
from .controllability import require_reached
from .reading import Json, boolean, fields, integer, items, polynomial, require
from .statement import PENCIL, channel_set, denied, polynomial_text
from .system import System

CLAIM = ["subset", "normal_rank", "invariant_polynomials", "remnant", "transfer_zero", "complete"]
WITNESS = ["modulus", "reachable", "X", "F", "A1", "S", "B1", "L", "G", "N"]


def check(claim: Json, witness: Json, system: System) -> None:
    """Check bases that bring the pencil to block triangular form, and read off its Smith form.

    Theorems ``complementary_subsystem.invariant_polynomials``,
    ``complementary_subsystem.normal_rank``, ``complementary_subsystem.remnant_gcd``,
    ``complementary_subsystem.remnant_roots``, ``complementary_subsystem.transfer_zero``,
    ``complementary_subsystem.complete_rule``.
    """
    listed, rank, invariants, rest, zero, verdict = fields(claim, "claim", *CLAIM)
    number, size, *values = fields(witness, "witness", *WITNESS)
    s, n = reading.names(listed, "claim.subset", system.names), system.n
    others = evidence.complement(system, s)
    require(bool(s and others), "claim", "claim.subset", "expected a nonempty proper subset")
    B, C = evidence.inputs(system, others), evidence.outputs(system, s)
    f = [polynomial(g, "claim.invariant_polynomials", 1) for g in items(invariants, CLAIM[2])]
    require(not any(poly_divide(g, h)[1] for h, g in pairwise(f)), "divisor", "claim", "no chain")
    a, k = integer(size, "witness.reachable"), integer(rank, "claim.normal_rank", n)
    v, free = a + sum(len(g) - 1 for g in f), n + B.ncols - k
    require(v <= n and free >= 0, "claim", "claim.normal_rank", "the dimensions do not fit")
    c, p, q = n - v, B.ncols, C.nrows
    shapes = [(n, v), (p, v), (a, v), (p, free), (a, free), (c, n), (c, q), (c, c)]
    X, F, A1, S, B1, L, G, N = reading.matrices(values, "witness", shapes)
    K = reduce(diagonal, map(_companion, f), Matrix.zeros(0, a))
    identities = {
        "A X + B F = X [A1; 0 K]": (system.A @ X + B @ F).equals(X @ stack([A1, K], v)),
        "B S = X1 B1": (B @ S).equals(X.take(cols=range(a)) @ B1),
        "[C; L] X = 0": (stack([C, L], n) @ X).is_zero(),
        "L = G C + N L A": L.equals(G @ C + N @ L @ system.A),
        "N L B = 0": (N @ L @ B).is_zero(),
        "N strictly lower triangular": not any(any(row[i:]) for i, row in enumerate(N.rows)),
    }
    for name, good in identities.items():
        require(good, "identity", "witness", f"expected {name}")
    ell = evidence.modulus(number, "witness.modulus")
    for M, least in ((X.T, v), (L, c), (S.T, free), (L @ B, k - n)):
        reached = rank_modulo(M, ell)
        require(reached == least, "rank", "witness", f"rank {reached} modulo l, not {least}")
    require_reached(replace(system, A=A1.take(cols=range(a)), B=[B1]), 0, ell, a)
    remnant = reduce(poly_product, f[: max(len(f) - (k - n), 0)], [Fraction(1)])
    given = polynomial(rest, "claim.remnant"), boolean(zero, "claim"), boolean(verdict, "claim")
    implied = remnant, k == n, k > n and len(remnant) == 1
    require(given == implied, "claim", "claim", "does not follow from the invariant polynomials")


def statement(claim: Json, system: System) -> str:
    """The Smith form of the pencil, and what follows from it."""
    found = ", ".join(map(polynomial_text, claim["invariant_polynomials"]))
    return (
        f"the pencil {PENCIL}, C the outputs of the channels {channel_set(claim['subset'])} and B "
        f"the inputs of the others, has normal rank {claim['normal_rank']}; its invariant "
        f"polynomials of degree at least 1 are {found or 'none'}; the greatest common divisor of "
        f"its minors of order {system.n}, the remnant polynomial, is "
        f"{polynomial_text(claim['remnant'])}; C (xI - A)^-1 B is {denied(claim['transfer_zero'])}"
        f"zero; the complementary subsystem is {denied(claim['complete'])}complete"
    )


def _companion(p: list[Fraction]) -> Matrix:
    """Ones below the diagonal, −p in the last column."""
    d = math.lcm(*(c.denominator for c in p))
    rows = [[d * (i == j + 1) for j in range(len(p) - 2)] + [int(-c * d)] for i, c in enumerate(p)]
    return Matrix(rows[:-1], len(p) - 1, d)
