"""Answer: the rank of P_s(λ) = [λI − A, B_{m−s}; C_s, 0] at every root λ of a polynomial."""

from __future__ import annotations

from mcexact.answer.protocol import Answer, answer, claim, witness
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.polynomial import Polynomial


@answer("pencil_rank")
class PencilRank(Answer):
    """P_s has the same rank r at every root of p.

    Attributes
    ----------
    subset : tuple of str
        s, in the order of the system.
    polynomial : Polynomial
        p, monic and irreducible over Q.
    rank : int
        r; if r < n, the roots of p are fixed modes because of s.
    modulus : int
        ℓ ≥ 2: elimination over (Z/ℓ)[x]/(p) with unit pivots reaches r.
    kernel : PolynomialMatrix
        c × (c − r), c = n + the inputs of m−s: its rows ``pivots`` form the identity and
        P_s · kernel = 0 modulo p.
    pivots : tuple of int
        c − r rows of the kernel, strictly increasing.
    """

    subset: tuple[str, ...] = claim()
    polynomial: Polynomial = claim()
    rank: int = claim()
    modulus: int = witness()
    kernel: PolynomialMatrix = witness()
    pivots: tuple[int, ...] = witness()

    @property
    def deficiency(self) -> int:
        """max(0, n − rank)."""
        return max(0, self.about.n - self.rank)
