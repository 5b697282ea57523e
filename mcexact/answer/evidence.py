"""Evidence of several kinds of answers."""

from __future__ import annotations

from dataclasses import dataclass, field

from mcexact.answer.protocol import Part
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial_matrix import PolynomialMatrix


@dataclass(frozen=True)
class ShrunkSubspace(Part):
    """(xI − A) U = B_T V and C_i U = 0 for i outside T, modulo p, with more columns than rank B_T.

    Attributes
    ----------
    channels_T : tuple of str
        The names of the channels in T, in the order of the system.
    U : PolynomialMatrix
        n × u; its rows ``pivots`` form the identity.
    V : PolynomialMatrix
        p_T × u, p_T the number of inputs of T.
    pivots : tuple of int
        u rows of U, strictly increasing.
    """

    channels_T: tuple[str, ...]
    U: PolynomialMatrix
    V: PolynomialMatrix
    pivots: tuple[int, ...]


@dataclass(frozen=True)
class ZeroTransfer(Part):
    """An invariant subspace im X that contains im B_j for the channels of a set.

    Attributes
    ----------
    channels_from : tuple of str
        The names of these channels, in the order of the system.
    X : Matrix
        n × k; its rows ``pivots`` form the identity.
    pivots : tuple of int
        k rows of X, strictly increasing.
    """

    channels_from: tuple[str, ...] = field(metadata={"key": "from"})
    X: Matrix
    pivots: tuple[int, ...]


@dataclass(frozen=True)
class RootDisc(Part):
    """A disc |x − (re + i·im)| ≤ radius, with decimal strings without exponents."""

    brief = ("re", "im", "radius")

    re: str
    im: str
    radius: str


@dataclass(frozen=True)
class RateInterval(Part):
    """An interval [lower, upper] that contains a best rate, with decimal strings as ends."""

    brief = ("lower", "upper")

    lower: str
    upper: str
