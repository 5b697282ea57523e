"""Proofs that no more is fixed than the factors named; ``proofs/krylov.md``, ``evidence.md``."""

from collections.abc import Mapping

from . import arithmetic, blocks, evidence, krylov, reading
from .arithmetic import Polynomial
from .budget import counted
from .characteristic_polynomial import characteristic_polynomial
from .reading import Json, fields, require
from .system import System

Loss = tuple[Polynomial, int]
"""A factor, and the rank that is lost at its roots."""


def by_blocks(witness: Json) -> bool:
    """Whether the evidence is block by block, and not two characteristic polynomials of all."""
    return isinstance(witness, Mapping) and "blocks" in witness


class Blocks:
    """The blocks leave so many modes that may be fixed; the others move, whatever these are."""

    def __init__(self, value: Json, place: str, system: System, number: Json = None) -> None:
        self.place, self.number = f"{place}.blocks", number
        parts = blocks.split(value, self.place, system)
        self.left = sum(_left(proof, where, part) for where, part, proof in counted(parts))

    @property
    def ell(self) -> int:
        """The modulus for factors."""
        return evidence.modulus(self.number, "witness.modulus")

    def multiplicity(self, p: Polynomial, loss: int) -> int:
        """How often a factor occurs; stop if it may have multiple roots."""
        derivative = [k * c for k, c in enumerate(p)][1:]
        evidence.require_coprime(p, derivative, self.ell, "a factor and its derivative")
        return loss

    def require_no_more(self, losses: list[Loss]) -> None:
        """Stop unless the factors, as often as they lose rank, are all that is left.

        Theorems ``fixed_bound.bounded_absence``, ``fixed_bound.bounded_rule``,
        ``fixed_bound.bounded_fixed``, ``fixed_bound.bounded_rank``.
        """
        if not losses:
            require(self.number is None, "claim", "witness.modulus", "expected null: no factors")
        more = self.left - sum(loss * (len(p) - 1) for p, loss in losses)
        require(more == 0, "degree", self.place, f"{more} more modes may be fixed")


def _left(proof: Json, place: str, block: System) -> int:
    """The most degrees of a common divisor of det(xI − A_F) for all F, by the evidence of a block.

    Theorems ``fixed_bound.nothing_bounded``, ``fixed_bound.coprime_bounded``.
    """
    if proof is None:
        return block.n
    if isinstance(proof, Mapping) and "channel" in proof:
        return krylov.unmoved_degree(proof, place, block)
    gains, number = fields(proof, place, "gains", "modulus")
    TwoPolynomials(gains, number, place, block).require_moved([])
    return 0


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
