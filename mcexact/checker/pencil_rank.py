"""Kind ``pencil_rank``: the rank of P_s at the roots of a polynomial; ``proofs/pencil_rank.md``."""

from itertools import zip_longest

from . import arithmetic, evidence, reading, subspaces
from .arithmetic import NotAUnit, Polynomial, inverse, poly_divide, poly_modulo, poly_product
from .reading import Json, fields, require
from .statement import PENCIL, channel_set, polynomial_text
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
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
    V = [layer.take(range(n, c)).times(-1) for layer in kernel]
    subspaces.require_pencil_kernel(system.A, B, U, V, p, "witness.kernel")
    require(all((C @ layer).is_zero() for layer in U), "identity", "witness.kernel", "C U is not 0")
    ell = evidence.modulus(ell, "witness.modulus")
    kept = sorted(set(range(c)) - set(pivots))
    top = arithmetic.beside([system.A.times(-1), B], n)
    bottom = arithmetic.beside([C, arithmetic.Matrix.zeros(C.nrows, B.ncols)], C.nrows)
    constant = arithmetic.stack([top, bottom], c)
    residues = enumerate(constant.take(cols=kept).modulo(ell))
    pencil = [[[e, int(i == j < n)] for j, e in zip(kept, row, strict=True)] for i, row in residues]
    independent = _are_independent(pencil, len(kept), poly_modulo(p, ell), ell)
    require(independent, "rank", "witness", f"elimination modulo l and p does not reach {r}")


def statement(claim: Json, system: System) -> str:
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
            if g := poly_divide(poly_product(row[j], f), p, ell)[1]:
                for c in range(j, ncols):
                    row[c] = _less(row[c], poly_product(g, pivot[c]), p, ell)
    return True


def _less(a: Polynomial, b: Polynomial, p: Polynomial, ell: int) -> Polynomial:
    return poly_divide([x - y for x, y in zip_longest(a, b, fillvalue=0)], p, ell)[1]


def _inverse(a: Polynomial, p: Polynomial, ell: int) -> Polynomial:
    """The inverse of a modulo p, or None if it is not a unit or that is undecided."""
    (r, t), (rest, u) = (p, []), (poly_divide(a, p, ell)[1], [1])
    try:
        while rest:
            q, left = poly_divide(r, rest, ell)
            (r, t), (rest, u) = (rest, u), (left, _less(t, poly_product(q, u), p, ell))
        return [c * inverse(r[0], ell) % ell for c in t] if len(r) == 1 else []
    except NotAUnit:
        return []
