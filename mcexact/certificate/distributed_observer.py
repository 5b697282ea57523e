"""Certificate: the loop of a distributed observer separates, and both parts have known spectra."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class DistributedObserverCertificate(Certificate):
    """In the coordinates (x, e_1, z_1, …), e_i = x_i − x, the loop is [M_F, *; 0, M_E].

    Attributes
    ----------
    feedback : Polynomial
        The characteristic polynomial of M_F = A + Σ B_i F_i, of degree n.
    error : Polynomial
        The characteristic polynomial of M_E, the matrix of the error system.
    bound : Fraction or None
        A certified rate (every real part is below −bound) or radius (every modulus is below it).
    moduli : tuple of int
        As in ``closed_loop_spectrum``, enough for both polynomials.
    """

    kind: ClassVar[str] = "distributed_observer"

    feedback: Polynomial
    error: Polynomial
    bound: Fraction | None
    moduli: tuple[int, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"feedback": self.feedback, "error": self.error, "bound": self.bound}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"moduli": self.moduli}
