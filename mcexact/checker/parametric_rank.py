"""Kind ``parametric_rank``: the rank of a matrix of polynomials for all values of a parameter."""

from fractions import Fraction

from . import evidence, layered
from .arithmetic import Polynomial, coprime, exponent, poly_modulo
from .budget import counted
from .named_matrices import named_matrix, named_text
from .parameter_values import REAL, listed_value, roots_text, values_left_out, where_text
from .parametric_system import Layers, ParametricSystem
from .reading import Json, fields, integer, items, matrices, positions, require
from .two_variables import determinant
from .zero_blocks import polynomial_layers, require_multiple

WITNESS = ("kernel", "rows", "columns", "modulus", "compressions", "exceptional", "undefined")


def check(claim: Json, witness: Json, system: ParametricSystem) -> None:
    """Check kernels, and two minors without common roots but those of the values named.

    Theorems ``parametric_rank.rank_at_most``, ``parametric_rank.rank_at_root``,
    ``parametric_rank.rank_at_least``, ``parametric_rank.rank_kept``.  Open: see ``proofs/OPEN.md``.
    """
    keys = ("matrix", "rank", "exceptional", "outside")
    name, size, listed, left_out = fields(claim, "claim", *keys)
    kernel, above, beside, number, drawn, local, poles = fields(witness, "witness", *WITNESS)
    M, r = named_matrix(name, system), integer(size, "claim.rank")
    nrows, ncols = M[0].nrows, M[0].ncols
    require(r <= min(nrows, ncols), "rank", "claim.rank", f"it has {nrows} rows, {ncols} columns")
    if r < min(nrows, ncols):
        _require_kernel(kernel, "witness.kernel", M, r)
    else:
        require(kernel is None, "claim", "witness.kernel", "expected null where the rank is full")
    rows = positions(above, "witness.rows", nrows)
    columns = positions(beside, "witness.columns", ncols)
    require(len(rows) == len(columns) == r, "rank", "witness.rows", f"expected {r} of both")
    ell = evidence.modulus(number, "witness.modulus")
    X, Y = matrices(drawn, "witness.compressions", [(r, nrows), (ncols, r)])
    compressed = layered.product(layered.product([X], M), [Y])
    values = []
    proofs = items(local, "witness.exceptional", len(items(listed, "claim.exceptional")))
    for k, proof in enumerate(counted(proofs)):
        place = f"claim.exceptional[{k}]"
        value, discs, rank = fields(listed[k], place, "value", "roots", "rank")
        values.append(listed_value(value, discs, place, system))
        least = integer(rank, f"{place}.rank")
        require(least < r, "claim", f"{place}.rank", f"expected less than {r}")
        _require_kernel(proof, f"witness.exceptional[{k}]", M, least, values[-1])
        corner = [layer.take(range(least), range(least)) for layer in compressed]
        reached = coprime(poly_modulo(values[-1], ell), determinant(corner, ell), ell)
        require(reached, "common_factor", place, "the rank may be less there")
    values += values_left_out(left_out, poles, system)
    rest = determinant([layer.take(rows, columns) for layer in M])
    require(bool(rest), "product", "witness.rows", "the minor is zero")
    for q in values:
        rest = exponent(q, rest)[1]
    # monic: a coefficient that only ℓ makes vanish could hide a common root
    rest = [Fraction(c) / rest[-1] for c in rest]
    apart = coprime(poly_modulo(rest, ell), determinant(compressed, ell), ell)
    require(apart, "common_factor", "witness", "the rank may be less at other values")


def _require_kernel(
    value: Json, place: str, M: Layers, rank: int, q: Polynomial | None = None
) -> None:
    """Stop unless M N = 0, modulo q if it is given, for an N of full rank that leaves ``rank``."""
    given, listed = fields(value, place, "columns", "pivots")
    ncols = M[0].ncols
    pivots = positions(listed, f"{place}.pivots", ncols)
    require(len(pivots) == ncols - rank, "rank", place, f"expected {ncols - rank} columns")
    N = polynomial_layers(given, f"{place}.columns", ncols, len(pivots), q)
    require_multiple([layer.take(pivots) for layer in N], len(pivots), f"{place}.pivots", q)
    gone = layered.is_zero(layered.product(M, N, q))
    require(gone, "identity", place, "the matrix does not annihilate it")


def statement(claim: Json, system: ParametricSystem) -> str:
    """The rank, and where it is less."""
    named = named_text(claim["matrix"], system)
    start = f"{where_text(claim, system)}, {named} has rank exactly {claim['rank']}"
    texts = [
        f"rank exactly {entry['rank']} at {roots_text(entry, system.parameter)}, {REAL}"
        for entry in claim["exceptional"]
    ]
    return "; but ".join([start, *texts])
