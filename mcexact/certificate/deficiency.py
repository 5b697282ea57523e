"""Certificate: the largest rank that P_s(λ) lacks, over all subsets s and all λ."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.answer.evidence import ShrunkSubspace
from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class DeficiencyCertificate(Certificate):
    """The largest n − rank P_s(λ) is ρ; on (A, B_i, C_{N_i}) it is the bound of Theorem 2.

    Attributes
    ----------
    deficiency : int
        ρ ≥ 0.
    modulus : int
        ℓ ≥ 2, modulo which the characteristic polynomials of A and A_F + B_0 C_0 are coprime.
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    B0, C0 : Matrix
        n × ρ and ρ × n.
    polynomial : Polynomial or None
        p, monic of degree at least 1, at whose roots ρ is reached; None iff ρ = 0.
    subspace : ShrunkSubspace or None
        Of deficiency ρ for p; None iff ρ = 0.
    """

    kind: ClassVar[str] = "deficiency"

    deficiency: int
    modulus: int
    gains: tuple[Matrix, ...]
    B0: Matrix
    C0: Matrix
    polynomial: Polynomial | None
    subspace: ShrunkSubspace | None

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"deficiency": self.deficiency}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {
            "modulus": self.modulus,
            "gains": self.gains,
            "B0": self.B0,
            "C0": self.C0,
            "polynomial": self.polynomial,
            "subspace": self.subspace,
        }
