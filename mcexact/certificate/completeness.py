"""Certificate: whether the transfer graph is strongly connected and no mode is fixed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.answer.evidence import ShrunkSubspace, ZeroTransfer
from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class FreedomWitness:
    """Evidence for yes: gains that leave no mode of A in place, and arcs that connect all channels.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2 of every congruence.
    gains : tuple of Matrix
        F_i, p_i × q_i: χ_A and χ_{A_F} are coprime modulo ℓ.
    arcs : tuple of (str, str, int)
        (j, i, k) with C_i A^k B_j ≠ 0 modulo ℓ, sorted by (from, to), enough of them to make the
        graph strongly connected.
    """

    modulus: int
    gains: tuple[Matrix, ...]
    arcs: tuple[tuple[str, str, int], ...]

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"modulus": self.modulus, "gains": self.gains, "arcs": self.arcs}


@dataclass(frozen=True)
class FixedModeWitness:
    """Evidence for no: a polynomial whose roots are fixed modes.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic of degree at least 1.
    subspace : ShrunkSubspace
        Of deficiency at least 1 for p.
    """

    polynomial: Polynomial
    subspace: ShrunkSubspace

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"polynomial": self.polynomial, "subspace": self.subspace}


@dataclass(frozen=True)
class CutWitness:
    """Evidence for no: a nonempty proper set of channels that reaches no channel outside it.

    Attributes
    ----------
    zero : ZeroTransfer
        From that set to its complement.
    """

    zero: ZeroTransfer

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"zero": self.zero}


@dataclass(frozen=True)
class CompletenessCertificate(Certificate):
    """The system is complete (its spectrum is freely assignable through any one channel), or not.

    Attributes
    ----------
    complete : bool
    evidence : FreedomWitness, FixedModeWitness or CutWitness
        The first for yes, one of the others for no.
    """

    kind: ClassVar[str] = "completeness"

    complete: bool
    evidence: FreedomWitness | FixedModeWitness | CutWitness

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {"complete": self.complete}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return self.evidence.document()
