"""Answer: the largest rank deficiency of P_s(λ) over all subsets s and all λ."""

from __future__ import annotations

from mcexact.answer.evidence import ShrunkSubspace
from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@answer("deficiency")
class Deficiency(Answer):
    """The largest n − rank P_s(λ) is ρ; on (A, B_i, C_{N_i}) it is the bound of Theorem 2.

    Attributes
    ----------
    deficiency : int
        ρ ≥ 0, which is 0 iff no mode is fixed.  If the neighbor graph is strongly connected and the
        plant is jointly controllable and observable, the extended system with n_i ≥ ρ for every
        agent has no fixed mode.
    modulus : int
        ℓ ≥ 2, modulo which the characteristic polynomials of A and A_F + B_0 C_0 are coprime.
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    B0, C0 : Matrix
        n × ρ and ρ × n.
    polynomial : Polynomial or None
        p, monic of degree at least 1, at whose roots the deficiency is ρ; None iff ρ = 0.
    subspace : ShrunkSubspace or None
        Of deficiency ρ for p; None iff ρ = 0.
    """

    deficiency: int = claim()
    modulus: int = witness()
    gains: tuple[Matrix, ...] = witness()
    B0: Matrix = witness()
    C0: Matrix = witness()
    polynomial: Polynomial | None = witness()
    subspace: ShrunkSubspace | None = witness()

    @property
    def channels(self) -> tuple[str, ...] | None:
        """The largest set s of channels with deficiency ρ; None if ρ = 0."""
        if self.subspace is None:
            return None
        return tuple(name for name in self.about.names if name not in self.subspace.channels_T)

    @property
    def total(self) -> int:
        """m ρ."""
        return self.about.m * self.deficiency
