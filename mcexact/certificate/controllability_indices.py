"""Certificate: the controllability index and the controllability (Brunovsky) indices."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix


@dataclass(frozen=True)
class ControllabilityIndicesCertificate(Certificate):
    """The ranks r_k of [B_T … A^{k−1}B_T], and the indices that follow from them.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    ranks : tuple of int
        r_1 < … < r_ν, the ranks until they stop growing; empty if B_T = 0 (ν = 0).
    index : int or None
        ν if r_ν = n, else None.
    indices : tuple of int
        κ_1 ≥ κ_2 ≥ …, the conjugate partition of r_1, r_2 − r_1, …
    modulus : int
        ℓ ≥ 2, modulo which the ranks are reached.
    annihilator : Matrix
        W, (n − r_1) × n, of full row rank: its first n − r_k rows annihilate the first k blocks.
    """

    kind: ClassVar[str] = "controllability_indices"

    channels: tuple[str, ...]
    ranks: tuple[int, ...]
    index: int | None
    indices: tuple[int, ...]
    modulus: int
    annihilator: Matrix

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "channels": self.channels,
            "ranks": self.ranks,
            "index": self.index,
            "indices": self.indices,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {"modulus": self.modulus, "annihilator": self.annihilator}
