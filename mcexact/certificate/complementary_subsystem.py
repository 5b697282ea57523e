"""Certificate: the Smith form of P_s(x) = [xI − A, B_{m−s}; C_s, 0], and what follows from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class ComplementarySubsystemCertificate(Certificate):
    """The invariant polynomials of P_s(x), the remnant polynomial, and whether s is complete.

    Attributes
    ----------
    subset : tuple of str
        s, nonempty and proper, in the order of the system.
    normal_rank : int
        The rank k of P_s over Q(x).
    invariant_polynomials : tuple of Polynomial
        Those of degree at least 1, each dividing the next; the others of the k are 1.  Their roots
        are the invariant zeros.
    remnant : Polynomial
        The product of the first n invariant polynomials.
    transfer_zero : bool
        Whether C_s (xI − A)⁻¹ B_{m−s} = 0.
    complete : bool
        Not so, and the remnant polynomial is 1.
    reachable : int
        The number of columns of X that span the controlled part.
    modulus : int
        ℓ ≥ 2 of every rank.
    evidence : mapping from names to Matrix
        The matrices X, F, A1, S, B1, L, G and N of ``FORMAT.md``.
    """

    kind: ClassVar[str] = "complementary_subsystem"

    subset: tuple[str, ...]
    normal_rank: int
    invariant_polynomials: tuple[Polynomial, ...]
    remnant: Polynomial
    transfer_zero: bool
    complete: bool
    reachable: int
    modulus: int
    evidence: dict[str, Matrix]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "subset": self.subset,
            "normal_rank": self.normal_rank,
            "invariant_polynomials": self.invariant_polynomials,
            "remnant": self.remnant,
            "transfer_zero": self.transfer_zero,
            "complete": self.complete,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"modulus": self.modulus, "reachable": self.reachable, **self.evidence}
