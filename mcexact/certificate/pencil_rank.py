"""Certificate: the rank of P_s(λ) = [λI − A, B_{m−s}; C_s, 0] at every root λ of a polynomial."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix


@dataclass(frozen=True)
class PencilRankCertificate(Certificate):
    """P_s has the same rank r at every root of p.

    Attributes
    ----------
    subset : tuple of str
        s, in the order of the system.
    polynomial : Polynomial
        p, monic of degree at least 1.
    rank : int
        r.
    modulus : int
        ℓ ≥ 2: elimination over (Z/ℓ)[x]/(p) with unit pivots reaches r.
    kernel : PolynomialMatrix
        c × (c − r), c = n + the inputs of m−s: its rows ``pivots`` form the identity and
        P_s · kernel = 0 modulo p.
    pivots : tuple of int
        c − r rows of the kernel, strictly increasing.
    """

    kind: ClassVar[str] = "pencil_rank"

    subset: tuple[str, ...]
    polynomial: Polynomial
    rank: int
    modulus: int
    kernel: PolynomialMatrix
    pivots: tuple[int, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"subset": self.subset, "polynomial": self.polynomial, "rank": self.rank}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"modulus": self.modulus, "kernel": self.kernel, "pivots": self.pivots}
