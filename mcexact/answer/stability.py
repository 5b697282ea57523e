"""Answer: whether all eigenvalues of a matrix meet a rate or a radius."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Literal

from mcexact.answer.protocol import LEFT_OUT, Answer, Part, answer, claim, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.roots import StabilityRegion


@dataclass(frozen=True)
class PolynomialMethod(Part):
    """The checker recomputes the characteristic polynomial over Q and locates its roots exactly."""

    method: Literal["polynomial"] = "polynomial"


@dataclass(frozen=True)
class LyapunovForm(Part):
    """A Lyapunov matrix for a limit besides the rate, of a matrix that is made from a block.

    Attributes
    ----------
    P, R, R2 : Matrix
        As in `LyapunovBlock`.
    """

    P: Matrix
    R: Matrix
    R2: Matrix


@dataclass(frozen=True)
class LyapunovBlock(Part):
    """A Lyapunov matrix of one diagonal block D, k × k, proposed in floating point.

    The numbers depend on the processor and on the versions of numpy and scipy, and are verified
    exactly.

    Attributes
    ----------
    size : int
        k.
    P : Matrix
        Symmetric.
    R, R2 : Matrix
        RᵀPR and −R2ᵀ(DᵀP + PD + 2·bound·P)R2 (discrete time: R2ᵀ(bound²P − DᵀPD)R2) are strictly
        diagonally dominant with positive diagonal.
    damping : LyapunovForm or None
        Of the 2k × 2k matrix `lifted`, in continuous time and without a rate.
    largest_modulus : LyapunovForm or None
        Of D, in discrete time and for the largest modulus.
    """

    size: int
    P: Matrix
    R: Matrix
    R2: Matrix
    damping: LyapunovForm | None = field(default=None, kw_only=True, metadata=LEFT_OUT)
    largest_modulus: LyapunovForm | None = field(default=None, kw_only=True, metadata=LEFT_OUT)


@dataclass(frozen=True)
class Transformation(Part):
    """M T = T Δ, T nonsingular modulo ℓ and Δ block upper triangular."""

    T: Matrix
    Delta: Matrix
    modulus: int


@dataclass(frozen=True)
class LyapunovMethod(Part):
    """One Lyapunov matrix for each diagonal block, after a transformation if there is one."""

    transformation: Transformation | None
    blocks: tuple[LyapunovBlock, ...]
    method: Literal["lyapunov"] = "lyapunov"


@dataclass(frozen=True)
class InstabilityMethod(Part):
    """A P whose derivative along the loop is negative, and a v with vᵀPv ≤ 0.

    Attributes
    ----------
    P, R2 : Matrix
        As in `LyapunovBlock`, for the whole matrix.
    v : Matrix
        One column, not 0.
    side : str or None
        ``"bound"``, ``"damping"`` or ``"largest_modulus"``: what is violated, if there are limits.
    """

    P: Matrix
    R2: Matrix
    v: Matrix
    side: str | None = field(default=None, kw_only=True, metadata=LEFT_OUT)
    method: Literal["instability"] = "instability"


@answer("stability")
class StabilityVerdict(Answer):
    """Whether every eigenvalue of the matrix A of a system, usually a loop, lies in a region.

    Attributes
    ----------
    bound : Fraction or None
        A rate ≥ 0 (continuous time) or a radius in (0, 1] (discrete time); None means 0 or 1.
    stable : bool
    damping, largest_modulus : Fraction or None
        Limits in continuous time: −Re λ > damping·|λ|, |λ| < largest_modulus.
    evidence : PolynomialMethod, LyapunovMethod or InstabilityMethod
    """

    bound: Fraction | None = claim()
    stable: bool = claim()
    damping: Fraction | None = claim(optional=True)
    largest_modulus: Fraction | None = claim(optional=True)
    evidence: PolynomialMethod | LyapunovMethod | InstabilityMethod = witness(whole=True)

    @property
    def region(self) -> StabilityRegion:
        """The region in which the eigenvalues should lie."""
        return StabilityRegion(self.about.time, self.bound, self.damping, self.largest_modulus)

    @property
    def blocks(self) -> tuple[int, ...]:
        """The sizes of the separately decided diagonal blocks, or the size of the loop."""
        if isinstance(self.evidence, LyapunovMethod):
            return tuple(block.size for block in self.evidence.blocks)
        return (self.about.n,)

    @property
    def method(self) -> str:
        """The method that decided: ``"polynomial"``, ``"lyapunov"`` or ``"instability"``."""
        return self.evidence.method
