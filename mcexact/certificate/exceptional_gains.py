"""Certificate: the values of g at which [B, (M+gA)B, …] loses rank."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from .evidence import Certificate, MatrixLike, PolynomialLike, PolynomialMatrixLike, RootDisc


@dataclass(frozen=True)
class ExceptionalFactor:
    """At every root g of f a row annihilates all blocks.

    Attributes
    ----------
    polynomial : PolynomialLike
        f, monic of degree at least 1.
    row : PolynomialMatrixLike
        1 × n, reduced modulo f, with row · [B, (M+gA)B, …] = 0 modulo f.
    pivot : int
        The place of an entry 1.
    """

    polynomial: PolynomialLike
    row: PolynomialMatrixLike
    pivot: int

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"polynomial": self.polynomial, "row": self.row, "pivot": self.pivot}


@dataclass(frozen=True)
class ExceptionalGainsCertificate(Certificate):
    """K(g) = [B, (M+gA)B, …, (M+gA)^{blocks−1}B] loses rank n at the roots of a polynomial alone.

    Attributes
    ----------
    M : MatrixLike
        n × n; A and B are those of the subject, all its channels taken together.
    blocks : int
        At least 1.
    polynomial : PolynomialLike
        Monic and squarefree.
    roots : tuple of RootDisc
        One for each root of the polynomial, its center real where the root is.
    modulus : int
        ℓ ≥ 2.
    factors : tuple of ExceptionalFactor
        Their product is the polynomial.
    compressions : tuple of two MatrixLike
        R and R', blocks·p × n: det(K(g) R), without the factors, and det(K(g) R') are coprime
        modulo ℓ.
    """

    kind: ClassVar[str] = "exceptional_gains"

    M: MatrixLike
    blocks: int
    polynomial: PolynomialLike
    roots: tuple[RootDisc, ...]
    modulus: int
    factors: tuple[ExceptionalFactor, ...]
    compressions: tuple[MatrixLike, MatrixLike]

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
