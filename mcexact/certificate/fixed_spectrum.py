"""Certificate: the fixed spectrum, where it lies, and which rate it leaves within reach."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from .evidence import (
    Certificate,
    MatrixLike,
    PolynomialLike,
    RateInterval,
    RootDisc,
    ShrunkSubspace,
)


@dataclass(frozen=True)
class FixedFactorClaim:
    """What is claimed about one factor p of the fixed spectrum.

    Attributes
    ----------
    polynomial : PolynomialLike
        p, monic of degree at least 1.
    multiplicity_in_A : int
        The exponent of p in the characteristic polynomial of A.
    multiplicity_at_most : int
        The exponent of p in the characteristic polynomial of the witness's closed loop: the
        multiplicity of p that no constant gains remove is at most this.
    channels : tuple of str
        s, a set of channels whose pencil P_s has the least rank at the roots of p.
    rank : int
        That rank, below n.
    stable : bool
        Whether all roots of p lie in the stability region of the system's time domain.
    roots : tuple of RootDisc
        Disjoint discs, one for each root.
    """

    polynomial: PolynomialLike
    multiplicity_in_A: int
    multiplicity_at_most: int
    channels: tuple[str, ...]
    rank: int
    stable: bool
    roots: tuple[RootDisc, ...]

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {
            "polynomial": self.polynomial,
            "multiplicity_in_A": self.multiplicity_in_A,
            "multiplicity_at_most": self.multiplicity_at_most,
            "channels": self.channels,
            "rank": self.rank,
            "stable": self.stable,
            "roots": self.roots,
        }


@dataclass(frozen=True)
class FixedSpectrumCertificate(Certificate):
    """The fixed modes are exactly the roots of ``polynomial``.

    Attributes
    ----------
    polynomial : PolynomialLike
        The product of the distinct factors; 1 if nothing is fixed.
    factors : tuple of FixedFactorClaim
    stabilizable : bool
        Whether every factor is stable: then and only then some linear time-invariant decentralized
        control stabilizes the system.
    best_rate : RateInterval or None
        Encloses minus the largest real part (continuous time) or the largest modulus (discrete
        time) of the fixed modes; None if there is none.
    gains : tuple of MatrixLike
        F_i, p_i × q_i, one for each channel.
    modulus : int
        ℓ ≥ 2, modulo which the rest of χ_A is coprime to χ_{A_F}.
    subspaces : tuple of ShrunkSubspace
        One for each factor, of deficiency n − rank.
    completion : (MatrixLike, MatrixLike) or None
        B_0 (n × ρ) and C_0 (ρ × n): with d columns and rows they bound the deficiency of a factor
        by d.  None if there is no factor.
    """

    kind: ClassVar[str] = "fixed_spectrum"

    polynomial: PolynomialLike
    factors: tuple[FixedFactorClaim, ...]
    stabilizable: bool
    best_rate: RateInterval | None
    gains: tuple[MatrixLike, ...]
    modulus: int
    subspaces: tuple[ShrunkSubspace, ...]
    completion: tuple[MatrixLike, MatrixLike] | None

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "polynomial": self.polynomial,
            "factors": self.factors,
            "stabilizable": self.stabilizable,
            "best_rate": self.best_rate,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        completion = None
        if self.completion is not None:
            completion = {"B0": self.completion[0], "C0": self.completion[1]}
        return {
            "gains": self.gains,
            "modulus": self.modulus,
            "subspaces": self.subspaces,
            "completion": completion,
        }
