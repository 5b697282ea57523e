"""Answer: the Smith form of P_s(x) = [xI − A, B_{m−s}; C_s, 0]."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from mcexact.answer.evidence import RootDisc
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import root_discs


@dataclass(frozen=True)
class InvariantZeros(Part):
    """An irreducible polynomial whose roots are invariant zeros, with discs around these.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible over Q.
    multiplicity : int
        The exponent of p in the product of all invariant polynomials.
    rank : int
        The rank of P_s at every root of p, below the normal rank.
    roots : tuple of RootDisc
        Disjoint discs, each with exactly one root of p.
    """

    polynomial: Polynomial
    multiplicity: int
    rank: int
    roots: tuple[RootDisc, ...]


@answer("complementary_subsystem")
class ComplementarySubsystem(Answer):
    """Properties of the complementary subsystem (C_s, A, B_{m−s}), from its pencil P_s(x).

    Attributes
    ----------
    subset : tuple of str
        s, nonempty and proper, in the order of the system.
    normal_rank : int
        The rank k of P_s over Q(x), at least n.
    invariant_polynomials : tuple of Polynomial
        The invariant polynomials of degree at least 1, each dividing the next; the others of the k
        are 1.  Their roots are the invariant zeros.
    remnant : Polynomial
        The product of the first n invariant polynomials: the greatest common divisor of the n × n
        minors of P_s.
    transfer_zero : bool
        Whether C_s (xI − A)⁻¹ B_{m−s} = 0.
    complete : bool
        Whether the transfer matrix is not 0 and rank P_s(λ) ≥ n for every λ.
    reachable : int
        The number of columns of X that span the controlled part.
    modulus : int
        ℓ ≥ 2, modulo which all ranks are reached.
    X, F, A1, S, B1, L, G, N : Matrix
        As in ``FORMAT.md``.
    """

    subset: tuple[str, ...] = claim()
    normal_rank: int = claim()
    invariant_polynomials: tuple[Polynomial, ...] = claim()
    remnant: Polynomial = claim()
    transfer_zero: bool = claim()
    complete: bool = claim()
    reachable: int = witness()
    modulus: int = witness()
    X: Matrix = witness()
    F: Matrix = witness()
    A1: Matrix = witness()
    S: Matrix = witness()
    B1: Matrix = witness()
    L: Matrix = witness()
    G: Matrix = witness()
    N: Matrix = witness()

    @cached_property
    @shown("invariant zeros")
    def zeros(self) -> tuple[InvariantZeros, ...]:
        """The irreducible factors of the invariant polynomials."""
        return tuple(
            InvariantZeros(
                polynomial=p,
                multiplicity=e,
                rank=self.normal_rank - sum(p.divides(f) for f in self.invariant_polynomials),
                roots=tuple(RootDisc(d.re, d.im, d.radius) for d in root_discs(p)),
            )
            for p, e in product(self.invariant_polynomials).factor()
        )
