"""Certificate: the values of g at which [B, (M+gA)B, …] loses rank."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from mcexact.answer.evidence import RootDisc
from mcexact.certificate import Certificate
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.polynomial_matrix import PolynomialMatrix


@dataclass(frozen=True)
class ExceptionalFactor:
    """At every root g of f a row annihilates all blocks.

    Attributes
    ----------
    polynomial : Polynomial
        f, monic of degree at least 1.
    row : PolynomialMatrix
        1 × n, reduced modulo f, with row · [B, (M+gA)B, …] = 0 modulo f.
    pivot : int
        The place of an entry 1.
    """

    polynomial: Polynomial
    row: PolynomialMatrix
    pivot: int

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"polynomial": self.polynomial, "row": self.row, "pivot": self.pivot}


@dataclass(frozen=True)
class ExceptionalGainsCertificate(Certificate):
    """K(g) = [B, (M+gA)B, …, (M+gA)^{blocks−1}B] loses rank n at the roots of a polynomial alone.

    Attributes
    ----------
    M : Matrix
        n × n; A and B are those of the subject, all its channels taken together.
    blocks : int
        At least 1.
    polynomial : Polynomial
        Monic and squarefree.
    roots : tuple of RootDisc
        One for each root of the polynomial, its center real where the root is.
    modulus : int
        ℓ ≥ 2.
    factors : tuple of ExceptionalFactor
        Their product is the polynomial.
    compressions : tuple of two Matrix
        R and R', blocks·p × n: det(K(g) R), without the factors, and det(K(g) R') are coprime
        modulo ℓ.
    """

    kind: ClassVar[str] = "exceptional_gains"

    M: Matrix
    blocks: int
    polynomial: Polynomial
    roots: tuple[RootDisc, ...]
    modulus: int
    factors: tuple[ExceptionalFactor, ...]
    compressions: tuple[Matrix, Matrix]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        return {
            "M": self.M,
            "blocks": self.blocks,
            "polynomial": self.polynomial,
            "roots": self.roots,
        }

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        return {
            "modulus": self.modulus,
            "factors": self.factors,
            "compressions": self.compressions,
        }
