"""Answer: the subspace that a set of channels controls, and the uncontrollable modes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar

from mcexact.answer.evidence import Block
from mcexact.answer.protocol import Answer, Part, answer, claim, is_about_dual, witness
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@dataclass(frozen=True)
class ByRank(Part):
    """Evidence by a rank: d vectors of [B_T, AB_T, …] are independent modulo ℓ.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which the rank d is reached.
    annihilator : Matrix
        W, (n − d) × n: its columns ``pivots`` form the identity, WA = (WA)[:, pivots] W, WB_T = 0.
    pivots : tuple of int
        n − d columns of W, strictly increasing.
    """

    modulus: int
    annihilator: Matrix
    pivots: tuple[int, ...]


@dataclass(frozen=True)
class ByBlocks(Part):
    """Evidence block by block: feedback of the channels T alone moves all but n − d modes.

    Modes that T does not control stay under every feedback, whatever the channels measure.

    Attributes
    ----------
    blocks : tuple of Block
        Of the system with the channels T alone; they leave n − d modes.
    measured : tuple of tuple of int, or None
        For each channel of T the states that it measures in that system; None if these are its own
        outputs.
    annihilator : Matrix
    pivots : tuple of int
        As in `ByRank`.
    """

    blocks: tuple[Block, ...]
    measured: tuple[tuple[int, ...], ...] | None
    annihilator: Matrix
    pivots: tuple[int, ...]


@answer("controllability")
class JointControllability(Answer):
    """The controllable subspace of a set T of channels; for observability, of the dual system.

    The controllable subspace of (A, B_T) has dimension d.

    Attributes
    ----------
    channels : tuple of str
        T, in the order of the system.
    dimension : int
        d = dim ⟨A | B_T⟩.
    controllable : bool
        Whether d = n: ⟨A | B_T⟩ is the whole state space.
    uncontrollable_polynomial : Polynomial
        Monic, of degree n − d: the characteristic polynomial of A on the quotient by ⟨A | B_T⟩.
        Its roots are the modes that T does not control.
    evidence : ByRank or ByBlocks
        The second for large systems, where such blocks are found.
    """

    dual_keys: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "controllable": "observable",
            "uncontrollable_polynomial": "unobservable_polynomial",
        }
    )

    channels: tuple[str, ...] = claim()
    dimension: int = claim()
    controllable: bool = claim()
    uncontrollable_polynomial: Polynomial = claim()
    evidence: ByRank | ByBlocks = witness(whole=True)

    @property
    def observable(self) -> bool:
        """Whether (C_T, A) is observable, for an answer about the dual system.

        Raises
        ------
        UsageError
            If the answer is not about a dual system.
        """
        if not is_about_dual(self.subject):
            raise UsageError("this answer is about controllability: ask .controllable")
        return self.controllable
