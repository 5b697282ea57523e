"""Answer: the values of g at which [B, (M+gA)B, …] loses rank."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from mcexact.answer.evidence import RootDisc
from mcexact.answer.protocol import Answer, Part, answer, claim, witness
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational import as_fraction
from mcexact.exact.roots import real_root_intervals


@dataclass(frozen=True)
class ExceptionalFactor(Part):
    """A factor f, with a row that annihilates all blocks at every root g of f.

    Attributes
    ----------
    polynomial : Polynomial
        f, monic of degree at least 1.
    row : PolynomialMatrix
        1 × n, reduced modulo f, with row · [B, (M+gA)B, …] = 0 modulo f.
    pivot : int
        The position of an entry 1.
    """

    polynomial: Polynomial
    row: PolynomialMatrix
    pivot: int


@answer("exceptional_gains")
class ExceptionalSet(Answer):
    """The values of g for which the first blocks of [B, (M+gA)B, …] lose rank n.

    K(g) = [B, (M+gA)B, …, (M+gA)^{blocks−1}B] loses rank n at the roots of a polynomial alone.

    Attributes
    ----------
    M : Matrix
        n × n; A and B are those of the subject, all its channels taken together.
    blocks : int
        At least 1.
    polynomial : Polynomial
        In g, monic and squarefree: the exceptional g, complex ones included, are its roots.
    roots : tuple of RootDisc
        One for each root of the polynomial, with a real center if the root is real.
    modulus : int
        ℓ ≥ 2.
    factors : tuple of ExceptionalFactor
        Their product is the polynomial.
    compressions : tuple of two Matrix
        R and R', blocks·p × n: det(K(g) R), without the factors, and det(K(g) R') are coprime
        modulo ℓ.
    """

    M: Matrix = claim()
    blocks: int = claim()
    polynomial: Polynomial = claim()
    roots: tuple[RootDisc, ...] = claim()
    modulus: int = witness()
    factors: tuple[ExceptionalFactor, ...] = witness()
    compressions: tuple[Matrix, Matrix] = witness()

    @cached_property
    def real_roots(self) -> tuple[tuple[Fraction, Fraction], ...]:
        """Ascending disjoint intervals, each with one exceptional real g.

        The ends are equal if g is a short decimal.
        """
        return real_root_intervals(self.polynomial)

    def __contains__(self, g: Any) -> bool:
        """Whether a rational g is exceptional, exactly."""
        return self.polynomial(as_fraction(g)) == 0
