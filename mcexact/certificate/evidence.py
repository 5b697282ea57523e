"""Evidence that several kinds of certificate share, and what every certificate is made of.

Matrices and polynomials are recognized by their attributes alone, so that this package needs
nothing else: a matrix has ``numerators`` over one ``denominator``, a polynomial matrix
``coefficients`` over one ``denominator``, a polynomial ``coefficients`` that are Fractions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, Protocol

Document = Mapping[str, Any]
"""A JSON object made of plain data."""


class MatrixLike(Protocol):
    """A rational matrix: rows of integers over one denominator ≥ 1."""

    @property
    def numerators(self) -> Sequence[Sequence[int]]: ...

    @property
    def denominator(self) -> int: ...


class PolynomialMatrixLike(Protocol):
    """A matrix of polynomials Σ_k x^k E_k / d: integer matrices E_0, E_1, … over one d ≥ 1."""

    @property
    def coefficients(self) -> Sequence[Sequence[Sequence[int]]]: ...

    @property
    def denominator(self) -> int: ...


class PolynomialLike(Protocol):
    """A polynomial over Q: its coefficients, constant term first, the last one not 0."""

    @property
    def coefficients(self) -> Sequence[Fraction]: ...


@dataclass(frozen=True)
class Certificate:
    """A statement about a system, with the evidence for it.

    Attributes
    ----------
    system : mapping
        The user's plant, as the canonical object of ``FORMAT.md``.
    subject : tuple of mappings
        The constructions that lead from the plant to the system the claim is about, in order.
    """

    kind: ClassVar[str] = ""

    system: Document
    subject: tuple[Document, ...]

    def claim(self) -> dict[str, Any]:
        """The statement, as the keys of the kind's ``claim``."""
        raise NotImplementedError

    def witness(self) -> dict[str, Any]:
        """The evidence, as the keys of the kind's ``witness``."""
        raise NotImplementedError


@dataclass(frozen=True)
class ShrunkSubspace:
    """(xI − A) U = B_T V and C_i U = 0 for i outside T, modulo p, with more columns than rank B_T.

    Attributes
    ----------
    channels_T : tuple of str
        The names of the channels in T, in the order of the system.
    U : PolynomialMatrixLike
        n × u; its rows ``pivots`` form the identity.
    V : PolynomialMatrixLike
        p_T × u, p_T the number of inputs of T.
    pivots : tuple of int
        u rows of U, strictly increasing.
    """

    channels_T: tuple[str, ...]
    U: PolynomialMatrixLike
    V: PolynomialMatrixLike
    pivots: tuple[int, ...]

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {
            "channels_T": self.channels_T,
            "U": self.U,
            "V": self.V,
            "pivots": self.pivots,
        }


@dataclass(frozen=True)
class ZeroTransfer:
    """An invariant subspace im X that contains im B_j for the channels of a set.

    Attributes
    ----------
    channels_from : tuple of str
        The names of these channels, in the order of the system.
    X : MatrixLike
        n × k; its rows ``pivots`` form the identity.
    pivots : tuple of int
        k rows of X, strictly increasing.
    """

    channels_from: tuple[str, ...]
    X: MatrixLike
    pivots: tuple[int, ...]

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``, its values still exact objects."""
        return {"from": self.channels_from, "X": self.X, "pivots": self.pivots}


@dataclass(frozen=True)
class RootDisc:
    """A disc |x − (re + i·im)| ≤ radius, its numbers decimal strings without exponent."""

    re: str
    im: str
    radius: str

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``."""
        return {"re": self.re, "im": self.im, "radius": self.radius}


@dataclass(frozen=True)
class RateInterval:
    """An interval [lower, upper] that holds a best rate, its ends decimal strings."""

    lower: str
    upper: str

    def document(self) -> dict[str, Any]:
        """The object of ``FORMAT.md``."""
        return {"lower": self.lower, "upper": self.upper}
