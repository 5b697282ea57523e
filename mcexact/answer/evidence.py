"""Evidence that several kinds of answers have."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from mcexact.answer.protocol import Part
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.plot.eigenvalues import eigenvalues

# Evidence about fixed modes, transfer, roots, and boxes.


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
class DualSubspace(Part):
    """A shrunk subspace of the dual system (A', C_i', B_i'): rows W with W (xI − A) = Z C_s.

    Where fewer outputs of s than inputs of T are independent, it is the smaller proof.

    Attributes
    ----------
    channels_T : tuple of str
        T, the channels that are not in the set of the dual system.
    dual : ShrunkSubspace
        Of the dual system, with U = W' and V = Z', and s in place of T.
    """

    channels_T: tuple[str, ...]
    dual: ShrunkSubspace


@dataclass(frozen=True)
class LocalSubspace(Part):
    """A shrunk subspace of the system of some states, on which nothing acts that they drive.

    Attributes
    ----------
    channels_T : tuple of str
        T of the whole system, in its order: the channels in T of the subspace, those that measure
        other states that the states drive, along A and through channels, and those that measure the
        states and drive none of them.
    states : tuple of int
        Increasing.
    subspace : ShrunkSubspace or DualSubspace
        Of the system of the states, with the channels that measure some of them and drive some.
    """

    channels_T: tuple[str, ...]
    states: tuple[int, ...]
    subspace: ShrunkSubspace | DualSubspace


Subspace = ShrunkSubspace | DualSubspace | LocalSubspace
"""What proves that a pencil loses rank."""


@dataclass(frozen=True)
class ZeroBlock(Part):
    """W (xI − A) U = 0, W B_T = 0 and C_i U = 0 for i outside T, modulo p and perhaps q.

    Attributes
    ----------
    channels_T : tuple of str
        The names of the channels in T, in the order of the system.
    U : tuple of PolynomialMatrix
        The coefficients of the powers of x below deg p, n × u polynomial matrices in t.
    W : PolynomialMatrix
        a × n, in t; a + u > n.
    row_pivots, column_pivots : tuple of int
        Rows of U, and columns of W, that form multiples of identity matrices.
    """

    channels_T: tuple[str, ...]
    U: tuple[PolynomialMatrix, ...]
    W: PolynomialMatrix
    row_pivots: tuple[int, ...]
    column_pivots: tuple[int, ...]


@dataclass(frozen=True)
class KrylovSequence(Part):
    """The numbers s_k = y C_q A_F^k B_q x modulo ℓ, by their least recurrence d, of degree L.

    A common divisor of det(xI − A_F) over all F has a degree of at most n − L.  If L = n, no mode
    is fixed.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2.
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    channel : str
        The name of channel q.
    inputs, outputs : tuple of int
        x, p_q residues, and y, q_q residues.
    recurrence : tuple of int
        d = Σ d_j x^j, monic: Σ_j d_j s_{k+j} = 0.
    cofactors : (tuple of int, tuple of int)
        a and e with a·num + e·d = 1, num the polynomial part of d·Σ s_k x^{−k−1}.
    """

    modulus: int
    gains: tuple[Matrix, ...]
    channel: str
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    recurrence: tuple[int, ...]
    cofactors: tuple[tuple[int, ...], tuple[int, ...]]

    @property
    def degree(self) -> int:
        """L, the degree of the recurrence."""
        return len(self.recurrence) - 1


@dataclass(frozen=True)
class CoprimePolynomials(Part):
    """Gains with which det(xI − A) and det(xI − A_F) are coprime modulo ℓ: no mode is fixed.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    modulus : int
        ℓ ≥ 2.
    """

    gains: tuple[Matrix, ...]
    modulus: int


@dataclass(frozen=True)
class Block(Part):
    """Some states, and how many of their modes may be fixed.

    Attributes
    ----------
    states : tuple of int
        Increasing.  No arc leads from them to a later block of the list: A_ab = 0 for a state b of
        this block and a state a of a later one, and so are the rows a of B_i or the columns b of
        C_i for every channel.
    evidence : KrylovSequence, CoprimePolynomials or None
        About the system of these states and of the channels with a row of B_i and a column of C_i
        that are not 0 there.  None if all their modes may be fixed.
    """

    states: tuple[int, ...]
    evidence: KrylovSequence | CoprimePolynomials | None


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

    def to_sympy(self) -> Any:
        """The real numbers in the disc, as an ``Interval`` of sympy; empty if there are none.

        Examples
        --------
        >>> RootDisc("1.5", "0", "0.25").to_sympy()
        Interval(5/4, 7/4)
        >>> RootDisc("0", "1", "0.25").to_sympy()
        EmptySet
        """
        import sympy

        re, im, radius = map(sympy.Rational, (self.re, self.im, self.radius))
        if abs(im) > radius:
            return sympy.S.EmptySet
        half = radius if not im else sympy.sqrt(radius**2 - im**2)
        return sympy.Interval(re - half, re + half)


@dataclass(frozen=True)
class RateInterval(Part):
    """An interval [lower, upper] that contains a best rate, with decimal strings as ends."""

    brief = ("lower", "upper")

    lower: str
    upper: str


@dataclass(frozen=True)
class ComplexMatrix(Part):
    """A matrix of complex numbers (re + i·im) / denominator, by integers.

    Attributes
    ----------
    denominator : int
    re, im : tuple of tuples of int
        Rows.
    """

    denominator: int
    re: tuple[tuple[int, ...], ...]
    im: tuple[tuple[int, ...], ...]


@dataclass(frozen=True)
class ExteriorDiscs(Part):
    """Discs that contain every eigenvalue of A, or of A_F, of every member of a box.

    Attributes
    ----------
    F : tuple of Matrix or None
        F_i, p_i × q_i, one for each channel; None for A itself.
    Y, T : ComplexMatrix
        Y(λI − A_F)T is strictly diagonally dominant for every member, unless λ is in a disc.
    discs : tuple of RootDisc
        One for each row; they may overlap.
    """

    F: tuple[Matrix, ...] | None
    Y: ComplexMatrix
    T: ComplexMatrix
    discs: tuple[RootDisc, ...]


@dataclass(frozen=True)
class InverseFrame(Part):
    """V, approximately (cE − Z)⁻¹ for a pencil λE − Z, and weights w > 0 of the rows.

    It proves that the pencil is regular for |λ − c| ≤ ρ and all Z within radii D, wherever
    Σ_j |I − V(cE − Z)|_ij w_j + (|V|Dw)_i + ρ(|V|Ew)_i < w_i in every row i.
    Where ports are multiplied by numbers, w has the weights of the pencil of each port.
    """

    V: ComplexMatrix
    w: tuple[int, ...] | tuple[tuple[int, ...], ...]


Cover = tuple[tuple[int | None, ...], ...]
"""For each exterior disc, in preorder: the position of a frame, or None for a cut into four."""


# Evidence for the optimum of a covering program: it suffices, and cuts exclude anything smaller.

Tree = Sequence[Mapping[str, Any]]
"""The nodes of a branch tree in preorder, as plain data and Fractions, as in ``FORMAT.md``."""


@dataclass(frozen=True)
class Absence(Part):
    """Evidence that no mode outside the region is fixed and, if claimed, of a connected graph.

    Attributes
    ----------
    gains : tuple of Matrix
        F̄_i of the system of the claim.
    modulus : int
        ℓ ≥ 2.
    allowed : tuple of (Polynomial, int)
        Factors p inside the region, with their exponents in the characteristic polynomial.
    arcs : tuple of (str, str, int), or None
        (j, i, k) with C̄_i Ā^k B̄_j ≠ 0 modulo ℓ.
    """

    gains: tuple[Matrix, ...]
    modulus: int
    allowed: tuple[tuple[Polynomial, int], ...] = ()
    arcs: tuple[tuple[str, str, int], ...] | None = None


@dataclass(frozen=True)
class BlocksAbsence(Part):
    """Evidence that no mode is fixed and, if claimed, of a connected graph.

    Attributes
    ----------
    blocks : tuple of Block
        Of the system of the claim; they leave no mode.
    modulus : int or None
        ℓ ≥ 2, for the edges; None if there are none.
    arcs : tuple of (str, str, int), or None
        (j, i, k) with C̄_i Ā^k B̄_j ≠ 0 modulo ℓ.
    """

    blocks: tuple[Block, ...]
    modulus: int | None = None
    arcs: tuple[tuple[str, str, int], ...] | None = None


@dataclass(frozen=True)
class DeficiencyCut(Part):
    """Σ n_i over N_s∖s is at least the deficiency of P_s at every root of p.

    Attributes
    ----------
    subset : tuple of str
        The names of s.
    polynomial : Polynomial
        p, monic, not inside the region.
    deficiency : int
        d ≥ 1.
    subspace : Subspace
        Of deficiency d for p, with T the complement of s.
    """

    subset: tuple[str, ...]
    polynomial: Polynomial
    deficiency: int
    subspace: Subspace


@dataclass(frozen=True)
class ConnectivityCut(Part):
    """No input outside s acts on an output in s, so that Σ n_i over N_s∖s is at least 1.

    Attributes
    ----------
    subset : tuple of str
        The names of s, nonempty and proper.
    zero : ZeroTransfer
        From the complement of s to s.
    """

    subset: tuple[str, ...]
    zero: ZeroTransfer


@dataclass(frozen=True)
class LinkCut(Part):
    """Evidence that one of the links j → i with i ∉ T and S_j U ≠ 0 must be added.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic, not inside the region.
    subspace : ShrunkSubspace
        For p, in the system over the given neighbor graph.
    """

    polynomial: Polynomial
    subspace: ShrunkSubspace


# The spectrum of a matrix, with every eigenvalue enclosed.


@dataclass(frozen=True)
class LoopSpectrum:
    """The eigenvalues of a closed loop.

    Attributes
    ----------
    time : {"continuous", "discrete"}
    polynomial : Polynomial
        The characteristic polynomial.
    discs : tuple of RootDisc
        One around each distinct eigenvalue.
    stable : bool
        Whether all lie in the stability region, decided on the polynomial.
    rate : RateInterval or None
        Encloses minus the largest real part (continuous time) or the largest modulus (discrete
        time); None if there are no eigenvalues.
    """

    time: str
    polynomial: Polynomial
    discs: tuple[RootDisc, ...]
    stable: bool
    rate: RateInterval | None

    def plot(self, ax: Any = None) -> Any:
        """Draw the eigenvalues with their multiplicities; see `mcexact.plot.eigenvalues`."""
        return eigenvalues(self, ax, time=self.time)
