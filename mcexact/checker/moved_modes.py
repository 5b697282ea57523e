"""Proofs that gains move all modes but those named, for all values of a parameter but some."""

from collections.abc import Sequence
from fractions import Fraction
from functools import reduce

from . import evidence, layered, reading
from .arithmetic import Polynomial, coprime, exponent, poly_modulo
from .parametric_system import Layers, ParametricSystem
from .reading import Json, items, require
from .resultants import integer_resultant, residues, resultant
from .two_variables import Bivariate, characteristic, divide, modulo, read, without


class MovedModes:
    """ψ_0 and ψ_1, what is left of det(xI − A) and det(xI − A_F), and det(xI − A_G) modulo ℓ.

    F and G are gains; what is left is without the powers of generic polynomials p.
    """

    def __init__(
        self, gains: Json, number: Json, P: list[Bivariate], system: ParametricSystem
    ) -> None:
        self.ell, self.P = evidence.modulus(number, "witness.modulus"), P
        first, second = items(gains, "witness.gains", 2)
        chis = characteristic(system.A), characteristic(_closed(first, system))
        self.psi, self.moved = (reduce(without, P, chi) for chi in chis)
        self.chi_G = characteristic(_closed(second, system), self.ell)

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
        common = resultant(residues(f, self.ell), g, self.ell)
        good = coprime(poly_modulo(q, self.ell), common, self.ell)
        require(good, "common_factor", place, "more modes may be fixed, or be generic")

    def require_no_other(self, values: Sequence[Polynomial], moduli: list[int]) -> None:
        """Stop unless every other t is no root of Res(ψ_0, ψ_1), or none of Res(ψ_0, χ_G).

        The first one is computed over Z, and divided by every value as often as it goes.

        Theorem ``arithmetic.no_common_root``.  Open: see ``proofs/OPEN.md``.
        """
        rest: Polynomial = [*integer_resultant(self.psi, self.moved, moduli)]
        require(bool(rest), "product", "witness.gains", "the first resultant is zero")
        for q in values:
            rest = exponent(q, rest)[1]
        # monic: a coefficient that only ℓ makes vanish could hide a common root
        rest = [Fraction(c) / rest[-1] for c in rest]
        # det(xI - A_G) undivided: over Q and modulo ℓ different powers of p could divide it
        other = resultant(residues(self.psi, self.ell), self.chi_G, self.ell)
        good = coprime(poly_modulo(rest, self.ell), other, self.ell)
        require(good, "common_factor", "witness", "other values may be exceptional")


def _closed(value: Json, system: ParametricSystem) -> Layers:
    """A + Σ B_i F_i C_i."""
    shapes = [(B[0].ncols, C[0].nrows) for B, C in zip(system.B, system.C, strict=True)]
    F = reading.matrices(value, "witness.gains", shapes)
    result = system.A
    for B_i, F_i, C_i in zip(system.B, F, system.C, strict=True):
        moved = layered.product(layered.product(B_i, [F_i.times(-1)]), C_i)
        result = layered.difference(result, moved)
    return result
