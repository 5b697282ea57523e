"""Certificate: how the characteristic polynomial of A_F splits over the strong components."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.certificate.transfer_graph import TransferGraphCertificate
from mcexact.exact.matrix import Matrix


@dataclass(frozen=True)
class MinimalRealization:
    """A minimal realization of C_c (xI − A)⁻¹ B_c: the subspace im X, reduced by the rows of W.

    Attributes
    ----------
    X : Matrix
        n × a, im X the smallest A-invariant subspace that contains im B_c.
    pivots : tuple of int
        a rows of X that form the identity.
    W : Matrix
        d × a, W A_x = Â W and C_c X = Ĉ W.
    columns : tuple of int
        d columns of W that form the identity.
    """

    X: Matrix
    pivots: tuple[int, ...]
    W: Matrix
    columns: tuple[int, ...]

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"X": self.X, "pivots": self.pivots, "W": self.W, "columns": self.columns}


@dataclass(frozen=True)
class AssignabilityCertificate(Certificate):
    """det(xI − A_F) is one fixed polynomial times one polynomial for each strong component.

    Attributes
    ----------
    blocks : tuple of (tuple of str, int)
        The strong components of the transfer graph, and the degree of the polynomial of each.
    fixed_degree : int
        The degree of the polynomial that does not depend on F.
    modulus : int
        ℓ ≥ 2, modulo which the realizations are controllable and observable.
    transfer_graph : TransferGraphCertificate
        Of the same system.
    realizations : tuple of MinimalRealization
        One for each block.
    """

    kind: ClassVar[str] = "assignability"

    blocks: tuple[tuple[tuple[str, ...], int], ...]
    fixed_degree: int
    modulus: int
    transfer_graph: TransferGraphCertificate
    realizations: tuple[MinimalRealization, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        blocks = [{"channels": c, "dimension": d} for c, d in self.blocks]
        return {"blocks": blocks, "fixed_degree": self.fixed_degree}

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        graph = self.transfer_graph
        return {
            "modulus": self.modulus,
            "transfer_graph": {"claim": graph.claim(), "witness": graph.witness()},
            "realizations": self.realizations,
        }
