"""Proofs that gains move all modes but those named, for all values of a parameter but some."""

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

from . import budget, evidence, layered, reading
from .arithmetic import Polynomial, coprime, exponent, poly_divide, poly_modulo, poly_product
from .parametric_system import Layers, ParametricSystem
from .reading import Json, fields, items, require
from .resultants import degree_bound, integer_resultant, residues, resultant
from .two_variables import Bivariate, characteristic, difference, divide, modulo, read, without


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

        The first one is divided by powers of values that divide it over Q, not modulo ℓ alone.  Its
        leading coefficient is a unit: one that only ℓ makes vanish could hide a common root.

        Theorem ``arithmetic.no_common_root``.  Open: see ``proofs/OPEN.md``.
        """
        listed = items(common, "witness.common", 0 if moduli else None)
        rest = self._exact(values, moduli) if moduli else self._modular(values, listed)
        # det(xI - A_G) undivided: over Q and modulo ℓ different powers of p could divide it
        other = resultant(residues(self.psi, self.ell), self.chi_G, self.ell)
        # this order, in which Euclid's algorithm inverts the leading coefficient of the rest
        good = coprime(other, rest, self.ell)
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
        return poly_divide(first, known, ell)[0]


def _closed(value: Json, system: ParametricSystem) -> Layers:
    """A + Σ B_i F_i C_i."""
    shapes = [(B[0].ncols, C[0].nrows) for B, C in zip(system.B, system.C, strict=True)]
    F = reading.matrices(value, "witness.gains", shapes)
    result = system.A
    for B_i, F_i, C_i in zip(system.B, F, system.C, strict=True):
        moved = layered.product(layered.product(B_i, [F_i.times(-1)]), C_i)
        result = layered.difference(result, moved)
    return result
