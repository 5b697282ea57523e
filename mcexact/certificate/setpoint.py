"""Certificate: whether integrators behind all outputs leave the plant controllable."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from .evidence import Certificate, MatrixLike, PolynomialMatrixLike


@dataclass(frozen=True)
class SetpointCertificate(Certificate):
    """S = [A, B; C, 0] (discrete time: A − I) has rank r, of n + Σ q_i rows.

    Attributes
    ----------
    solvable : bool
        Whether r = n + Σ q_i.
    rank : int
        r.
    invariant_zero : bool or None
        Whether the pencil has full rank elsewhere; None where S has full rank.
    modulus : int
        ℓ ≥ 2, modulo which the ranks are reached.
    left : MatrixLike
        W, (n + Σ q_i − r) × (n + Σ q_i), W S = 0; its columns ``pivots`` form the identity.
    pivots : tuple of int
    point : int or None
        Where the pencil has full rank modulo ℓ, for an invariant zero.
    normal : PolynomialMatrixLike or None
        A nonzero row that annihilates the pencil identically, where there is no such point.
    """

    kind: ClassVar[str] = "setpoint"

    solvable: bool
    rank: int
    invariant_zero: bool | None
    modulus: int
    left: MatrixLike
    pivots: tuple[int, ...]
    point: int | None
    normal: PolynomialMatrixLike | None

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "solvable": self.solvable,
            "rank": self.rank,
            "invariant_zero": self.invariant_zero,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {
            "modulus": self.modulus,
            "left": self.left,
            "pivots": self.pivots,
            "point": self.point,
            "normal": self.normal,
        }
