"""Certificate: what a set of channels controls, and what it does not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class ControllabilityCertificate(Certificate):
    """The controllable subspace of (A, B_T) has dimension d; W of n − d rows annihilates it.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    dimension : int
        d = dim ⟨A | B_T⟩.
    controllable : bool
        Whether d = n.
    uncontrollable_polynomial : Polynomial
        Monic, of degree n − d: the characteristic polynomial of A on the quotient.
    modulus : int
        ℓ ≥ 2, modulo which the rank d is reached.
    annihilator : Matrix
        W, (n − d) × n: its columns ``pivots`` form the identity, WA = (WA)[:, pivots] W, WB_T = 0.
    pivots : tuple of int
        n − d columns of W, strictly increasing.
    """

    kind: ClassVar[str] = "controllability"

    channels: tuple[str, ...]
    dimension: int
    controllable: bool
    uncontrollable_polynomial: Polynomial
    modulus: int
    annihilator: Matrix
    pivots: tuple[int, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "channels": self.channels,
            "dimension": self.dimension,
            "controllable": self.controllable,
            "uncontrollable_polynomial": self.uncontrollable_polynomial,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {
            "modulus": self.modulus,
            "annihilator": self.annihilator,
            "pivots": self.pivots,
        }
