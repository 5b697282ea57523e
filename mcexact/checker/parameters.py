"""Kinds about all values of a parameter.

The claims hold for every complex value of the parameter t at which all entries are defined, except
for values that the claim leaves out because none of them is real and in the assumed range.

``parametric_fixed_spectrum`` names the modes that are fixed for almost all t, and the exceptional
values at which more are.  A zero block W (xI − A) U = 0 proves that a mode is fixed.  Gains E, F
and G prove that nothing else is: the resultant of what is left of det(xI − A_E) and
det(xI − A_F) vanishes only at values that are then settled one by one (`MovedModes`).

``parametric_rank`` names the rank of a matrix of polynomials and the values at which it is less.
Matrices that it annihilates bound the rank from above, two minors without other common roots bound
it from below.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

from . import bivariate
from .bivariate import (
    Bivariate,
    characteristic,
    degree_bound,
    determinant,
    difference,
    divide,
    integer_resultant,
    modulo,
    named_matrix,
    named_text,
    read,
    read_coefficients,
    residues,
    resultant,
    text,
    without,
)
from .core import budget, evidence, reading
from .core.arithmetic import (
    Matrix,
    Polynomial,
    coprime,
    exponent,
    inverse,
    poly_divide,
    poly_modulo,
    poly_product,
)
from .core.budget import counted
from .core.reading import Json, fields, integer, items, matrices, names, positions, require
from .core.roots import disc_set, require_real_or_not, root_discs
from .core.system import FIXED, PENCIL, channel_set, polynomial_text
from .parametric_system import Layers, ParametricSystem, Range, common_divisor

# Values of a parameter in claims: where nothing is claimed, and their words.

REAL = "real ones where the disc is centered on the real axis, and only there"


def listed_value(value: Json, discs: Json, place: str, system: ParametricSystem) -> Polynomial:
    """A polynomial q of degree at least 1, with discs that tell its real roots from the others.

    At its roots all entries of the plant are defined.
    """
    where = f"{place}.value"
    q = reading.polynomial(value, where, 1)
    defined = all(len(common_divisor(q, delta)) == 1 for delta in system.poles)
    require(defined, "pole", where, "an entry of the plant is undefined there")
    require_real_or_not(root_discs(discs, f"{place}.roots", q), place)
    return q


def values_left_out(outside: Json, poles: Json, system: ParametricSystem) -> list[Polynomial]:
    """The values of which nothing is claimed.

    Those of the claim have no root in the range that is assumed; where those of the witness vanish,
    an entry is undefined.

    Open: see ``proofs/OPEN.md``.
    """
    polynomials = []
    low, high = system.range
    for k, entry in enumerate(items(outside, "claim.outside")):
        place = f"claim.outside[{k}]"
        value, listed = fields(entry, place, "value", "roots")
        polynomials.append(reading.polynomial(value, f"{place}.value", 1))
        for re, im, radius in root_discs(listed, f"{place}.roots", polynomials[-1]):
            left = low is not None and re + radius < low
            right = high is not None and re - radius > high
            apart = left or right or abs(im) > radius
            require(apart, "range", place, "a root may be in the range")
    denominator = reduce(poly_product, system.poles)
    for k, entry in enumerate(items(poles, "witness.undefined")):
        place = f"witness.undefined[{k}]"
        polynomials.append(reading.polynomial(entry, place, 1))
        gone = not poly_divide(denominator, polynomials[-1])[1]
        require(gone, "pole", place, "it divides no denominator of the plant")
    return polynomials


def where_text(claim: Json, system: ParametricSystem) -> str:
    """The values that a claim is about."""
    t = system.parameter
    where = f"for every complex value of the parameter {t} at which all entries of the plant are "
    where += "defined"
    if claim["outside"]:
        roots = ", ".join(roots_text(entry, t) for entry in claim["outside"])
        where += f", except at {roots}, none of which is real and between {ends_text(system)}"
    return where


def ends_text(system: ParametricSystem) -> str:
    """The least and the largest value of the parameter."""
    return ends_of(system.range)


def ends_of(bounds: Range) -> str:
    """The ends of a range."""
    low, high = bounds
    return f"{'-infinity' if low is None else low} and {'infinity' if high is None else high}"


def roots_text(entry: Json, t: str) -> str:
    """The roots of a value, and where they are."""
    value, discs = polynomial_text(entry["value"], t), disc_set(entry["roots"])
    return f"the roots of {value}, one in each of the discs {discs}"


# Proofs that gains move all modes but those named, for all values of a parameter but some.


class MovedModes:
    """ψ_0 and ψ_1, what is left of det(xI − A_E) and det(xI − A_F), and det(xI − A_G) modulo ℓ.

    E, F and G are gains; what is left is without the powers of generic polynomials p.
    """

    def __init__(
        self, gains: Json, number: Json, P: list[Bivariate], system: ParametricSystem
    ) -> None:
        self.ell, self.P = evidence.modulus(number, "witness.modulus"), P
        E, F, G = (_closed(value, system) for value in items(gains, "witness.gains", 3))
        self.psi, self.moved = (reduce(without, P, characteristic(loop)) for loop in (E, F))
        self.chi_G = characteristic(G, self.ell)

    def require_complete(
        self, q: Polynomial, modes: list[Bivariate], divisors: Json, place: str
    ) -> None:
        """Stop unless at the roots of q no mode is fixed but roots of a p, and of these modes.

        ψ_0 modulo q, divided by the modes, by divisors of these and of the p, has no common root
        with det(xI − A_G) at any root of q modulo ℓ.
        """
        known = [modulo(p, q) for p in self.P] + modes
        left = modulo(self.psi, q)
        parts = [read(g, place, q) for g in items(divisors, place)]
        for g in [*modes, *parts]:
            divides = any(not divide(p, g, q)[1] for p in known)
            require(divides, "divisor", place, "it divides no polynomial of fixed modes")
            left = without(left, g, q)
        self._require_apart(q, left, self.chi_G, place)

    def require_new(self, q: Polynomial, mode: Bivariate, place: str) -> None:
        """Stop unless no root of a mode is a root of a generic p, at any root of q."""
        for p in self.P:
            self._require_apart(q, mode, residues(modulo(p, q), self.ell), place)

    def _require_apart(self, q: Polynomial, f: Bivariate, g: list[list[int]], place: str) -> None:
        """Stop unless the resultant of f and g has no root of q modulo ℓ."""
        bottom = poly_modulo(q, self.ell)
        reduced = [poly_divide(c, bottom, self.ell)[1] for c in g]
        common = resultant(residues(f, self.ell), reduced, self.ell)
        good = coprime(bottom, common, self.ell)
        require(good, "common_factor", place, "more modes may be fixed, or be generic")

    def require_no_other(
        self, values: Sequence[Polynomial], common: Json, moduli: list[int]
    ) -> None:
        """Stop unless every other t is no root of Res(ψ_0, ψ_1), or none of Res(ψ_0, χ_G).

        The first one is divided by powers of values that divide it over Q, not modulo ℓ alone, and
        is monic: a leading coefficient that only ℓ makes vanish could hide a common root.

        Theorem ``arithmetic.no_common_root``.  Open: see ``proofs/OPEN.md``.
        """
        listed = items(common, "witness.common", 0 if moduli else None)
        rest = self._exact(values, moduli) if moduli else self._modular(values, listed)
        # det(xI - A_G) undivided: over Q and modulo ℓ different powers of p could divide it
        other = resultant(residues(self.psi, self.ell), self.chi_G, self.ell)
        good = coprime(rest, other, self.ell)
        require(good, "common_factor", "witness", "other values may be exceptional")

    def _exact(self, values: Sequence[Polynomial], moduli: list[int]) -> Polynomial:
        """The resultant over Z, divided by every value as often as it goes, monic, modulo ℓ."""
        rest: Polynomial = [*integer_resultant(self.psi, self.moved, moduli)]
        require(bool(rest), "product", "witness.gains", "the first resultant is zero")
        for q in values:
            rest = exponent(q, rest)[1]
        return poly_modulo([Fraction(c) / rest[-1] for c in rest], self.ell)

    def _modular(self, values: Sequence[Polynomial], common: list[Json]) -> Polynomial:
        """The resultant modulo ℓ, divided by q^d for divisors of degree d of ψ_0 and ψ_1 modulo q.

        The q are pairwise coprime, so the product of all q^d divides the resultant over Q.  Its
        degree is the largest possible one, so none is lost modulo ℓ.
        """
        ell, known = self.ell, [1]
        for k, entry in enumerate(budget.counted(common)):
            place = f"witness.common[{k}]"
            value, divisor = fields(entry, place, "value", "divisor")
            q = reading.polynomial(value, f"{place}.value", 1)
            require(q in values, "claim", place, "no such value is named")
            h = read(divisor, f"{place}.divisor", q)
            divides = not any(divide(modulo(f, q), h, q)[1] for f in (self.psi, self.moved))
            require(divides, "divisor", place, "it does not divide what is left")
            bottom = poly_modulo(q, ell)
            new = coprime(bottom, known, ell)
            require(new, "common_factor", place, "values have a common root modulo the modulus")
            for _ in h[1:]:
                known = [c % ell for c in poly_product(known, bottom)]
        first = resultant(residues(self.psi, ell), residues(self.moved, ell), ell)
        most = degree_bound(self.psi, difference(self.moved, self.psi))
        require(len(first) > most, "degree", "witness.gains", f"expected a degree of {most}")
        rest = poly_divide(first, known, ell)[0]
        unit = inverse(rest[-1], ell)
        return [c * unit % ell for c in rest]


def _closed(value: Json, system: ParametricSystem) -> Layers:
    """A + Σ B_i F_i C_i."""
    shapes = [(B[0].ncols, C[0].nrows) for B, C in zip(system.B, system.C, strict=True)]
    F = reading.matrices(value, "witness.gains", shapes)
    result = system.A
    for B_i, F_i, C_i in zip(system.B, F, system.C, strict=True):
        fed = bivariate.product(bivariate.product(B_i, [F_i.times(-1)]), C_i)
        result = bivariate.layered_difference(result, fed)
    return result


# Zero blocks, which prove that modes of a system with a parameter are fixed.


def zero_block(
    value: Json, place: str, system: ParametricSystem, p: Bivariate, q: Polynomial | None = None
) -> list[int]:
    """Check W (xI − A) U = 0 modulo p and q, W B_T = 0 and C_i U = 0 outside T; return T.

    W has a rows and U has u columns, independent, and a + u > n: the rows ``row_pivots`` of U and
    the columns ``column_pivots`` of W are c(t) times an identity matrix, with c = 1 modulo q, or
    c ≠ 0 where there is no q.

    Theorems ``zero_blocks.zero_block_det``, ``zero_blocks.zero_block_pivots``,
    ``zero_blocks.zero_block_fixed``, ``zero_blocks.zero_block_pencil``.
    """
    keys = ("channels_T", "U", "W", "row_pivots", "column_pivots")
    chosen, layers, listed, rows, columns = fields(value, place, *keys)
    T, n = names(chosen, f"{place}.channels_T", system.names), system.n
    above = positions(rows, f"{place}.row_pivots", n)
    beside = positions(columns, f"{place}.column_pivots", n)
    require(len(above) + len(beside) > n, "rank", place, "the zero block is too small")
    parts = items(layers, f"{place}.U", len(p) - 1)
    U = [polynomial_layers(part, f"{place}.U", n, len(above), q) for part in parts]
    W = polynomial_layers(listed, f"{place}.W", len(beside), n, q)
    pivots = [[layer.take(above) for layer in part] for part in U]
    require_multiple(pivots[0], len(above), f"{place}.row_pivots", q)
    outside = all(bivariate.is_zero(part) for part in pivots[1:])
    require(outside, "pivots", place, "a pivot row depends on x")
    chosen_columns = [layer.T.take(beside) for layer in W]
    require_multiple(chosen_columns, len(beside), f"{place}.column_pivots", q)
    for i in T:
        unmoved = bivariate.is_zero(bivariate.product(W, system.B[i], q))
        require(unmoved, "identity", place, f"W B_i is not zero for channel number {i + 1}")
    for i in system.others(T):
        unseen = all(bivariate.is_zero(bivariate.product(system.C[i], part, q)) for part in U)
        require(unseen, "identity", place, f"C_i U is not zero for channel number {i + 1}")
    WA = bivariate.product(W, system.A, q)
    WU = [bivariate.product(W, part, q) for part in U]
    shifted: list[Layers] = [[Matrix.zeros(len(beside), len(above))], *WU[:-1]]
    for before, part, c in zip(shifted, U, p, strict=False):
        # x^(deg p) = −Σ c x^k modulo p
        folded = bivariate.product(WU[-1], _scalar(c, len(above)), q)
        left = bivariate.layered_difference(before, bivariate.product(WA, part, q))
        vanishes = bivariate.is_zero(bivariate.layered_difference(left, folded))
        require(vanishes, "identity", place, "W (xI - A) U is not zero modulo p")
    return T


def polynomial_layers(
    value: Json, place: str, nrows: int, ncols: int, q: Polynomial | None
) -> Layers:
    """A matrix of polynomials in t, reduced modulo q."""
    _, coefficients = fields(value, place, "denominator", "coefficients")
    most = len(items(coefficients, place)) if q is None else len(q) - 1
    return reading.polynomial_matrix(value, place, nrows, ncols, most)


def _scalar(c: Polynomial, size: int) -> Layers:
    """c(t) times an identity matrix."""
    identity = Matrix.unit_rows(size, 0, size)
    return [identity.times(entry) for entry in c] or [Matrix.zeros(size, size)]


def require_multiple(block: Sequence[Matrix], size: int, place: str, q: Polynomial | None) -> None:
    """Stop unless a block is c(t) times an identity matrix, c = 1 with q, c ≠ 0 without."""
    identity = Matrix.unit_rows(size, 0, size)
    factors = [layer.times(0) if not size else identity.times(_corner(layer)) for layer in block]
    same = bivariate.is_zero(bivariate.layered_difference(list(block), factors))
    corner = [_corner(layer) for layer in block] if size else [1]
    good = any(corner) if q is None else corner[0] == 1 and not any(corner[1:])
    require(same and good, "pivots", place, "expected a multiple of an identity matrix there")


def _corner(layer: Matrix) -> Fraction:
    """The first entry."""
    return Fraction(layer.rows[0][0], layer.denominator)


# Kind ``parametric_fixed_spectrum``: all fixed modes for all values of a parameter.

WITNESS = (
    "gains", "modulus", "moduli", "common", "generic", "exceptional", "settled", "undefined"
)  # fmt: skip


def check_parametric_fixed_spectrum(claim: Json, witness: Json, system: ParametricSystem) -> None:
    """Check a zero block for every mode, and that no other value and no other mode is left.

    Open: see ``proofs/OPEN.md``.
    """
    whole, listed, left_out = fields(claim, "claim", "generic", "exceptional", "outside")
    drawn, number, numbers, common, blocks, local, rest, poles = fields(
        witness, "witness", *WITNESS
    )
    P = [read(p, f"claim.generic[{k}]") for k, p in enumerate(items(whole, "claim.generic"))]
    for k, block in enumerate(counted(items(blocks, "witness.generic", len(P)))):
        zero_block(block, f"witness.generic[{k}]", system, P[k])
    moved, values = MovedModes(drawn, number, P, system), []
    proofs = items(local, "witness.exceptional", len(items(listed, "claim.exceptional")))
    for k, proof in enumerate(counted(proofs)):
        values.append(_exceptional(listed[k], proof, f"exceptional[{k}]", moved, system))
    for k, entry in enumerate(counted(items(rest, "witness.settled"))):
        place = f"witness.settled[{k}]"
        value, divisors = fields(entry, place, "value", "divisors")
        values.append(reading.polynomial(value, f"{place}.value", 1))
        moved.require_complete(values[-1], [], divisors, f"{place}.divisors")
    values += values_left_out(left_out, poles, system)
    moduli = [evidence.modulus(ell, "witness.moduli") for ell in items(numbers, "witness.moduli")]
    moved.require_no_other(values, common, moduli)


def _exceptional(
    entry: Json, proof: Json, where: str, moved: MovedModes, system: ParametricSystem
) -> Polynomial:
    """A value q, at whose roots the modes listed are fixed, and no others but generic ones."""
    place, inside = f"claim.{where}", f"witness.{where}"
    value, discs, listed = fields(entry, place, "value", "roots", "modes")
    blocks, divisors = fields(proof, inside, "modes", "divisors")
    q = listed_value(value, discs, place, system)
    count, modes = len(items(listed, f"{place}.modes")), []
    require(count > 0, "claim", f"{place}.modes", "expected at least one mode")
    for k, block in enumerate(items(blocks, f"{inside}.modes", count)):
        p, names = fields(listed[k], f"{place}.modes[{k}]", "polynomial", "channels")
        s = reading.names(names, f"{place}.modes[{k}].channels", system.names)
        modes.append(read(p, f"{place}.modes[{k}].polynomial", q))
        T = zero_block(block, f"{inside}.modes[{k}]", system, modes[-1], q)
        right = s == system.others(T)
        require(right, "claim", f"{place}.modes[{k}]", "T is not the complement of s")
        moved.require_new(q, modes[-1], f"{place}.modes[{k}]")
    moved.require_complete(q, modes, divisors, f"{inside}.divisors")
    return q


def parametric_fixed_spectrum_statement(claim: Json, system: ParametricSystem) -> str:
    """The fixed modes for every value of the parameter."""
    t, delta = system.parameter, polynomial_text(system.scale, system.parameter)
    scaled = "" if delta == "1" else f", multiplied by {delta},"
    where, fixed = where_text(claim, system), f"the modes that are {FIXED}{scaled} are the roots x"
    listed = [(roots_text(each, t), _modes_text(each, t)) for each in claim["exceptional"]]
    if not claim["generic"]:
        texts = [f"but at {roots}, {REAL}, {fixed} of {modes}" for roots, modes in listed]
        return "; ".join([f"{where}, no mode is {FIXED}", *texts])
    always = ", ".join(text(read_coefficients(p), t) for p in claim["generic"])
    texts = [f"at {roots}, {REAL}, and there also those of {modes}" for roots, modes in listed]
    return "; ".join([f"{where}, {fixed} of {always}", *texts, "no others"])


def _modes_text(entry: Json, t: str) -> str:
    """The modes that are fixed at the roots of a value besides the generic ones."""
    return " and ".join(
        f"{text(read_coefficients(mode['polynomial']), t)}, where {PENCIL} with the matrix A, the "
        f"matrix C of the outputs of {channel_set(mode['channels'])} and the matrix B of the "
        "inputs of the others loses rank"
        for mode in entry["modes"]
    )


# Kind ``parametric_rank``: the rank of a matrix of polynomials for all values of a parameter.

RANK_WITNESS = ("kernel", "rows", "columns", "modulus", "compressions", "exceptional", "undefined")


def check_parametric_rank(claim: Json, witness: Json, system: ParametricSystem) -> None:
    """Check kernels, and two minors without common roots but those of the values named.

    Theorems ``parametric_rank.rank_at_most``, ``parametric_rank.rank_at_root``,
    ``parametric_rank.rank_at_least``, ``parametric_rank.rank_kept``.  Open: see ``proofs/OPEN.md``.
    """
    keys = ("matrix", "rank", "exceptional", "outside")
    name, size, listed, left_out = fields(claim, "claim", *keys)
    kernel, above, beside, number, drawn, local, poles = fields(witness, "witness", *RANK_WITNESS)
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
    compressed = bivariate.product(bivariate.product([X], M), [Y])
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
    """Stop unless M N = 0, modulo q if any, for an N of full rank that leaves ``rank``."""
    columns, listed = fields(value, place, "columns", "pivots")
    ncols = M[0].ncols
    pivots = positions(listed, f"{place}.pivots", ncols)
    require(len(pivots) == ncols - rank, "rank", place, f"expected {ncols - rank} columns")
    N = polynomial_layers(columns, f"{place}.columns", ncols, len(pivots), q)
    require_multiple([layer.take(pivots) for layer in N], len(pivots), f"{place}.pivots", q)
    gone = bivariate.is_zero(bivariate.product(M, N, q))
    require(gone, "identity", place, "the matrix does not annihilate it")


def parametric_rank_statement(claim: Json, system: ParametricSystem) -> str:
    """The rank, and where it is less."""
    named = named_text(claim["matrix"], system)
    start = f"{where_text(claim, system)}, {named} has rank exactly {claim['rank']}"
    texts = [
        f"rank exactly {entry['rank']} at {roots_text(entry, system.parameter)}, {REAL}"
        for entry in claim["exceptional"]
    ]
    return "; but ".join([start, *texts])
