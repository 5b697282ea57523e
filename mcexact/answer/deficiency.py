"""Answer: the largest rank deficiency of P_s(λ) over all subsets s and all λ."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.answer.evidence import Block, ShrunkSubspace
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class ByCompletion(Part):
    """Evidence by a loop completed with ρ columns and rows, which moves every mode.

    Attributes
    ----------
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

    modulus: int
    gains: tuple[Matrix, ...]
    B0: Matrix
    C0: Matrix
    polynomial: Polynomial | None
    subspace: ShrunkSubspace | None

    @property
    def worst(self) -> tuple[Polynomial, ShrunkSubspace] | None:
        """A factor of the largest deficiency, with its subspace."""
        if self.polynomial is None or self.subspace is None:
            return None
        return self.polynomial, self.subspace


@dataclass(frozen=True)
class RankLoss(Part):
    """A fixed factor, with the rank that pencils lose at its roots.

    Attributes
    ----------
    polynomial : Polynomial
    deficiency : int
    subspace : ShrunkSubspace
        Of this deficiency.
    """

    polynomial: Polynomial
    deficiency: int
    subspace: ShrunkSubspace


@dataclass(frozen=True)
class ByBlocks(Part):
    """Evidence block by block: no more is fixed than the factors, as often as they lose rank.

    Attributes
    ----------
    blocks : tuple of Block
    modulus : int or None
        As in the evidence of a fixed spectrum by blocks.
    losses : tuple of RankLoss
        All factors; ρ is the largest of their deficiencies.
    """

    blocks: tuple[Block, ...]
    modulus: int | None
    losses: tuple[RankLoss, ...]

    @property
    def worst(self) -> tuple[Polynomial, ShrunkSubspace] | None:
        """A factor of the largest deficiency, with its subspace."""
        largest = max(self.losses, key=lambda loss: loss.deficiency, default=None)
        return None if largest is None else (largest.polynomial, largest.subspace)


@answer("deficiency")
class Deficiency(Answer):
    """The largest n − rank P_s(λ) is ρ; on (A, B_i, C_{N_i}) it is the bound of Theorem 2.

    Attributes
    ----------
    deficiency : int
        ρ ≥ 0, which is 0 iff no mode is fixed.  If the neighbor graph is strongly connected and the
        plant is jointly controllable and observable, the extended system with n_i ≥ ρ for every
        agent has no fixed mode.
    evidence : ByCompletion or ByBlocks
        The second for large systems, where the blocks leave no more than the factors.
    """

    deficiency: int = claim()
    evidence: ByCompletion | ByBlocks = witness(whole=True)

    @property
    def polynomial(self) -> Polynomial | None:
        """A polynomial at whose roots the deficiency is ρ; None if ρ = 0."""
        worst = self.evidence.worst
        return None if worst is None else worst[0]

    @property
    def channels(self) -> tuple[str, ...] | None:
        """The largest set s of channels with deficiency ρ; None if ρ = 0."""
        worst = self.evidence.worst
        if worst is None:
            return None
        return tuple(name for name in self.about.names if name not in worst[1].channels_T)

    @property
    def total(self) -> int:
        """m ρ."""
        return self.about.m * self.deficiency
