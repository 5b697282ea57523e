"""Answer: the subspace that a set of channels controls, and the uncontrollable modes."""

from __future__ import annotations

from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.errors import UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial


@answer("controllability")
class JointControllability(Answer):
    """The controllable subspace of a set T of channels; for observability, of the dual system.

    The controllable subspace of (A, B_T) has dimension d; W of n − d rows annihilates it.

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
    modulus : int
        ℓ ≥ 2, modulo which the rank d is reached.
    annihilator : Matrix
        W, (n − d) × n: its columns ``pivots`` form the identity, WA = (WA)[:, pivots] W, WB_T = 0.
    pivots : tuple of int
        n − d columns of W, strictly increasing.
    """

    channels: tuple[str, ...] = claim()
    dimension: int = claim()
    controllable: bool = claim()
    uncontrollable_polynomial: Polynomial = claim()
    modulus: int = witness()
    annihilator: Matrix = witness()
    pivots: tuple[int, ...] = witness()

    @property
    def observable(self) -> bool:
        """Whether (C_T, A) is observable, for an answer about the dual system.

        Raises
        ------
        UsageError
            If the answer is not about a dual system.
        """
        if not self.subject or self.subject[-1]["construction"] != "dual":
            raise UsageError("this answer is about controllability: ask .controllable")
        return self.controllable
