"""Kind ``exceptional_gains``: where [B, (M+gA)B, …] loses rank; ``proofs/exceptional_gains.md``."""

from fractions import Fraction
from functools import reduce

from . import budget, evidence, reading, root_discs
from .arithmetic import Matrix, Polynomial, exponent, poly_product, stripped
from .characteristic_polynomial import characteristic_polynomial
from .reading import Json, fields, integer, items, matrix, require
from .statement import canonical_json, polynomial_text, with_digest
from .system import System


def check(claim: Json, witness: Json, system: System) -> None:
    """Check a row at every root of each factor, and two determinants without other common roots.

    Theorems ``exceptional_gains.exceptional_lost``, ``exceptional_gains.exceptional_kept``.
    """
    rows, number, p, discs = fields(claim, "claim", "M", "blocks", "polynomial", "roots")
    modulus, listed, drawn = fields(witness, "witness", "modulus", "factors", "compressions")
    n, blocks = system.n, integer(number, "claim.blocks", 1)
    require(blocks <= max(n, 1), "blocks", "claim.blocks", f"expected at most {n}")
    M, B = matrix(rows, "claim.M", n, n), evidence.inputs(system, range(system.m))
    ell, parts = evidence.modulus(modulus, "witness.modulus"), (system.A, M, B, blocks)
    whole = reading.polynomial(p, "claim.polynomial")
    found = root_discs.root_discs(discs, "claim.roots", whole)
    root_discs.require_real_or_not(found, "claim.roots")
    place = "witness.factors"
    factors = [_lost_at(entry, place, *parts) for entry in items(listed, place)]
    require(reduce(poly_product, factors, [Fraction(1)]) == whole, "product", "claim", "no product")
    R = reading.matrices(drawn, "witness.compressions", [(blocks * B.ncols, n)] * 2)
    first, second = (_determinant(system.A, M, B, part, blocks) for part in R)
    require(any(first), "product", "witness.compressions", "the first determinant is zero")
    first = reduce(lambda left, f: exponent(f, left)[1], factors, first)
    # monic: a coefficient that only ℓ makes vanish could hide a common root
    first = [c / first[-1] for c in first]
    evidence.require_coprime(first, second, ell, "the rest of det(K R) and det(K R')")


def statement(claim: Json, system: System) -> str:
    """For which g the blocks lose rank."""
    n, k = system.n, claim["blocks"]
    M = canonical_json(matrix(claim["M"], "claim.M", n, n))
    discs = root_discs.disc_set(claim["roots"])
    return (
        f"the first {k} blocks of [B, (M + gA) B, (M + gA)^2 B, ...], B the inputs of all channels "
        f"and M the matrix with {with_digest(M)}, have rank below {n} exactly where g is a root of "
        f"{polynomial_text(claim['polynomial'])}; its roots are simple and lie one in each of the "
        f"discs {discs}, real ones where the disc is centered on the real axis, and only there"
    )


def _lost_at(value: Json, place: str, A: Matrix, M: Matrix, B: Matrix, blocks: int) -> Polynomial:
    """A factor f; a row with an entry 1 annihilates all blocks modulo f."""
    p, row, pivot = fields(value, place, "polynomial", "row", "pivot")
    f = reading.polynomial(p, f"{place}.polynomial", 1)
    w = reading.polynomial_matrix(row, f"{place}.row", 1, A.nrows, len(f) - 1)
    pivots = reading.positions([pivot], f"{place}.pivot", A.nrows)
    evidence.require_identity([layer.T for layer in w], pivots, f"{place}.pivot")
    for _ in budget.counted(range(blocks)):
        gone = all((layer @ B).is_zero() for layer in w)
        require(gone, "identity", f"{place}.row", "it does not annihilate every block")
        moved = [Matrix.zeros(1, A.nrows), *(layer @ A for layer in w)]
        terms = zip(w, moved, f, strict=False)
        w = [layer @ M + shifted - moved[-1].times(c) for layer, shifted, c in terms]
    return f


def _determinant(A: Matrix, M: Matrix, B: Matrix, R: Matrix, blocks: int) -> Polynomial:
    """det([B, (M+gA)B, …] R), through its values at 0, 1, … (Newton).

    Theorem ``interpolation.determinant_by_values``.
    """
    result, basis = Polynomial(), [Fraction(1)]
    for g in budget.counted(range(A.nrows * (blocks - 1) + 1)):
        total = Matrix.zeros(A.nrows, A.nrows)
        for k in reversed(range(0, R.nrows, B.ncols or 1)):
            total = B @ R.take(range(k, k + B.ncols)) + (M + A.times(g)) @ total
        wanted = (-1) ** A.nrows * characteristic_polynomial(total)[0]
        longest = budget.limbs_of((wanted, *result, *basis))
        longest += g.bit_length() * len(basis) // budget.LIMB
        budget.spend(budget.fractions(8 * len(basis), longest))
        now, room = (sum(c * g**k for k, c in enumerate(p)) for p in (result, basis))
        slope = (wanted - now) / room
        result = [a + slope * b for a, b in zip([*result, Fraction(0)], basis, strict=True)]
        basis = poly_product(basis, [Fraction(-g), Fraction(1)])
    return stripped(result)
