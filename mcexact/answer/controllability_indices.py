"""Answer: the controllability index and the controllability (Brunovsky) indices."""

from __future__ import annotations

from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.exact.matrix import Matrix


@answer("controllability_indices")
class ControllabilityIndices(Answer):
    """The ranks r_k of [B_T … A^{k−1}B_T], and the resulting indices.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    ranks : tuple of int
        r_1 < … < r_ν, the ranks until they stop growing; empty if B_T = 0 (ν = 0).
    index : int or None
        The controllability index: ν if r_ν = n, else None.
    indices : tuple of int
        The controllability (Brunovsky) indices κ_1 ≥ κ_2 ≥ …, the conjugate partition of
        r_1, r_2 − r_1, …; they sum to r_ν.
    modulus : int
        ℓ ≥ 2, modulo which the ranks are reached.
    annihilator : Matrix
        W, (n − r_1) × n, of full row rank: its first n − r_k rows annihilate the first k blocks.
    """

    channels: tuple[str, ...] = claim()
    ranks: tuple[int, ...] = claim()
    index: int | None = claim()
    indices: tuple[int, ...] = claim()
    modulus: int = witness()
    annihilator: Matrix = witness()
