"""Kind ``pencil_rank``: the rank of P_s at the roots of a polynomial; ``proofs/pencil_rank.md``."""

from __future__ import annotations

from fractions import Fraction
from itertools import zip_longest
from typing import Any

from . import evidence, reading, subspaces
from .arithmetic import Matrix, NotAUnit, Polynomial, beside, inverse, stack
from .arithmetic import poly_divide as divide
from .arithmetic import poly_modulo as modulo
from .arithmetic import poly_product as times
from .reading import fields, require
from .statement import PENCIL, channel_set, polynomial_text
from .system import System


def check(claim: Any, witness: Any, system: System) -> None:
    """Check a kernel from above, and elimination modulo (ℓ, p) from below.

    Theorems ``deficiency.pencil_rank_upper``, ``deficiency.pencil_rank_lower``.
    """
    listed, coefficients, number = fields(claim, "claim", "subset", "polynomial", "rank")
    ell, layers, rows = fields(witness, "witness", "modulus", "kernel", "pivots")
    s, n = reading.names(listed, "claim.subset", system.names), system.n
    p = reading.polynomial(coefficients, "claim.polynomial", 1)
    B, C = evidence.inputs(system, evidence.complement(system, s)), evidence.outputs(system, s)
    c, r = n + B.ncols, reading.integer(number, "claim.rank")
    pivots = reading.positions(rows, "witness.pivots", c)
    require(len(pivots) == c - r, "rank", "witness.pivots", f"expected {c} - {r} of them")
    kernel = reading.polynomial_matrix(layers, "witness.kernel", c, c - r, len(p) - 1)
    evidence.require_identity(kernel, pivots, "witness.pivots")
    U = [layer.take(range(n)) for layer in kernel]
    V = [layer.take(range(n, c)).times(Fraction(-1)) for layer in kernel]
    subspaces.require_pencil_kernel(system.A, B, U, V, p, "witness.kernel")
    require(all((C @ layer).is_zero() for layer in U), "identity", "witness.kernel", "C U is not 0")
    ell = evidence.modulus(ell, "witness.modulus")
    kept = sorted(set(range(c)) - set(pivots))
    top = beside([system.A.times(Fraction(-1)), B], n)
    constant = stack([top, beside([C, Matrix.zeros(C.nrows, B.ncols)], C.nrows)], c)
    residues = enumerate(constant.take(cols=kept).modulo(ell))
    pencil = [[[e, int(i == j < n)] for j, e in zip(kept, row, strict=True)] for i, row in residues]
    independent = _are_independent(pencil, len(kept), modulo(p, ell), ell)
    require(independent, "rank", "witness", f"elimination modulo l and p does not reach {r}")


def statement(claim: Any, system: System) -> str:
    """The rank of the pencil at the roots."""
    sets = f"C the outputs of the channels {channel_set(claim['subset'])} and B the inputs of the"
    which = f"the pencil {PENCIL}, {sets} others, has rank exactly {claim['rank']}"
    return f"{which} at every root of {polynomial_text(claim['polynomial'])}"


def _are_independent(rows: list[list[Polynomial]], ncols: int, p: Polynomial, ell: int) -> bool:
    """Whether every column finds a pivot that is a unit of (Z/ℓ)[x]/(p)."""
    for j in range(ncols):
        inverses = ((k, _inverse(row[j], p, ell)) for k, row in enumerate(rows))
        k, f = next(((k, f) for k, f in inverses if f), (-1, []))
        if not f:
            return False
        pivot = rows.pop(k)
        for row in rows:
            if g := divide(times(row[j], f), p, ell)[1]:
                for c in range(j, ncols):
                    row[c] = _less(row[c], times(g, pivot[c]), p, ell)
    return True


def _less(a: Polynomial, b: Polynomial, p: Polynomial, ell: int) -> Polynomial:
    return divide([x - y for x, y in zip_longest(a, b, fillvalue=0)], p, ell)[1]


def _inverse(a: Polynomial, p: Polynomial, ell: int) -> Polynomial:
    """The inverse of a modulo p, or None if it is not a unit or that is undecided."""
    (r, t), (rest, u) = (p, []), (divide(a, p, ell)[1], [1])
    try:
        while rest:
            q, left = divide(r, rest, ell)
            (r, t), (rest, u) = (rest, u), (left, _less(t, times(q, u), p, ell))
        return [c * inverse(r[0], ell) % ell for c in t] if len(r) == 1 else []
    except NotAUnit:
        return []
