"""Certificate: the characteristic polynomial of a closed loop, coefficient by coefficient."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class ClosedLoopSpectrumCertificate(Certificate):
    """The characteristic polynomial of the subject's A is the given one.

    Attributes
    ----------
    polynomial : Polynomial
        Monic, of degree n.
    moduli : tuple of int
        Pairwise coprime, modulo each of which the polynomials agree; their product exceeds twice a
        bound on the coefficients.
    """

    kind: ClassVar[str] = "closed_loop_spectrum"

    polynomial: Polynomial
    moduli: tuple[int, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"polynomial": self.polynomial}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"moduli": self.moduli}
