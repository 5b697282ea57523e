"""Certificate: whether all eigenvalues of a matrix lie within a rate or a radius."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix


@dataclass(frozen=True)
class PolynomialMethod:
    """The checker recomputes the characteristic polynomial over Q and places its roots exactly."""

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``."""
        return {"method": "polynomial"}


@dataclass(frozen=True)
class LyapunovBlock:
    """A Lyapunov matrix of one diagonal block D, k × k, proposed in floating point.

    Its numbers depend on the processor and on the versions of numpy and scipy; they are verified
    exactly.

    Attributes
    ----------
    P : Matrix
        Symmetric.
    R, R2 : Matrix
        RᵀPR and −R2ᵀ(DᵀP + PD + 2·bound·P)R2 (discrete time: R2ᵀ(bound²P − DᵀPD)R2) are strictly
        diagonally dominant with positive diagonal.
    """

    P: Matrix
    R: Matrix
    R2: Matrix

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"size": len(self.P.numerators), "P": self.P, "R": self.R, "R2": self.R2}


@dataclass(frozen=True)
class Transformation:
    """M T = T Δ, T nonsingular modulo ℓ and Δ block upper triangular."""

    T: Matrix
    Delta: Matrix
    modulus: int

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"T": self.T, "Delta": self.Delta, "modulus": self.modulus}


@dataclass(frozen=True)
class LyapunovMethod:
    """One Lyapunov matrix for each diagonal block, after a transformation if there is one."""

    transformation: Transformation | None
    blocks: tuple[LyapunovBlock, ...]

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {
            "method": "lyapunov",
            "transformation": self.transformation,
            "blocks": self.blocks,
        }


@dataclass(frozen=True)
class InstabilityMethod:
    """A P whose derivative along the loop is negative, and a v with vᵀPv ≤ 0.

    Attributes
    ----------
    P, R2 : Matrix
        As in `LyapunovBlock`, for the whole matrix.
    v : Matrix
        One column, not 0.
    """

    P: Matrix
    R2: Matrix
    v: Matrix

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"method": "instability", "P": self.P, "R2": self.R2, "v": self.v}


@dataclass(frozen=True)
class StabilityCertificate(Certificate):
    """All eigenvalues of the subject's A meet the bound, or not all of them do.

    Attributes
    ----------
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None: 0 or 1.
    stable : bool
    evidence : PolynomialMethod, LyapunovMethod or InstabilityMethod
    """

    kind: ClassVar[str] = "stability"

    bound: Fraction | None
    stable: bool
    evidence: PolynomialMethod | LyapunovMethod | InstabilityMethod

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"bound": self.bound, "stable": self.stable}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return self.evidence.document()
