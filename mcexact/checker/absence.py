"""Proofs that no more is fixed than the factors named; ``proofs/krylov.md``, ``evidence.md``."""

from collections.abc import Mapping

from . import arithmetic, evidence, krylov, reading
from .arithmetic import Polynomial
from .characteristic_polynomial import characteristic_polynomial
from .reading import Json, fields, require
from .system import System

Loss = tuple[Polynomial, int]
"""A factor, and the rank that is lost at its roots."""


def by_sequence(witness: Json) -> bool:
    """Whether the evidence is one sequence, and not two characteristic polynomials."""
    return isinstance(witness, Mapping) and "sequence" in witness


class OneSequence:
    """One channel moves all but n − L of the n modes, whatever these are."""

    def __init__(self, value: Json, place: str, system: System) -> None:
        self.place = f"{place}.sequence"
        self.left, self.ell = krylov.unmoved_degree(value, self.place, system)

    def multiplicity(self, p: Polynomial, loss: int) -> int:
        """How often a factor occurs; stop if it may have multiple roots."""
        derivative = [k * c for k, c in enumerate(p)][1:]
        evidence.require_coprime(p, derivative, self.ell, "a factor and its derivative")
        return loss

    def require_no_more(self, losses: list[Loss]) -> None:
        """Stop unless the factors, as often as they lose rank, are all that is left.

        Theorems ``krylov.krylov_absence``, ``krylov.krylov_rule``, ``krylov.krylov_fixed``,
        ``krylov.krylov_rank``.
        """
        more = self.left - sum(loss * (len(p) - 1) for p, loss in losses)
        require(more == 0, "degree", self.place, f"{more} more modes may be fixed")


class TwoPolynomials:
    """Gains move all that is left of det(xI − A)."""

    def __init__(self, gains: Json, number: Json, place: str, system: System) -> None:
        self.ell, self.A = evidence.modulus(number, f"{place}.modulus"), system.A
        F = evidence.read_gains(gains, f"{place}.gains", system)
        self.A_F = evidence.closed_loop(system, F)
        self.chi_F = characteristic_polynomial(self.A_F, self.ell)

    def multiplicity(self, p: Polynomial, loss: int) -> int:
        """How often a factor occurs in det(xI − A_F) modulo ℓ, and so at most in all of them.

        Theorem ``fixed_spectrum.multiplicity_at_most``.
        """
        return arithmetic.exponent(arithmetic.poly_modulo(p, self.ell), self.chi_F, self.ell)[0]

    def require_moved(self, rest: Polynomial) -> None:
        """Stop unless det(xI − A) without some factors, or if there are none, has no fixed root.

        Theorems ``fixed_spectrum.absence``, ``fixed_spectrum.absence_all``.
        """
        rest = rest or characteristic_polynomial(self.A, self.ell)
        what = "det(xI - A) without the factors named and det(xI - A_F)"
        evidence.require_coprime(rest, self.chi_F, self.ell, what)

    def require_ranks(self, completion: Json, losses: list[Loss]) -> None:
        """Stop unless A_F + B_0 C_0, with d columns and rows, has no root of a p that loses d.

        Theorems ``fixed_spectrum.completion``, ``fixed_spectrum.rank_exact``.
        """
        left, right = fields(completion, "witness.completion", "B0", "C0")
        rho, n = max(loss for _, loss in losses), self.A.nrows
        B0 = reading.matrix(left, "witness.completion.B0", n, rho)
        C0 = reading.matrix(right, "witness.completion.C0", rho, n)
        for p, d in losses:
            completed = self.A_F + B0.take(cols=range(d)) @ C0.take(range(d))
            chi = characteristic_polynomial(completed, self.ell)
            evidence.require_coprime(p, chi, self.ell, "a factor, and det(xI - A_F - B0 C0),")
