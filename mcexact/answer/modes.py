"""Fixed modes: the answers about them.

`FixedSpectrum` has all fixed modes, where they lie, and the best rate that they allow.  Its
evidence has two forms: `TwoPolynomials` compares the characteristic polynomials of A and of one
closed loop, and `ByBlocks` bounds the number of fixed modes for each block of states, without the
characteristic polynomial of A, for large systems with few nonzero entries.

`Completeness` says whether no mode is fixed and the transfer graph is strongly connected, with
evidence for yes or for no.  `PencilRank` is the rank of one pencil at the roots of a polynomial.
`Assignability` says how the characteristic polynomial of every loop splits over the strong
components.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from mcexact.answer.evidence import (
    Block,
    KrylovSequence,
    RateInterval,
    RootDisc,
    Subspace,
    ZeroTransfer,
)
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.answer.structure import TransferGraph
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion

# Answer: the fixed spectrum, its location, and the best rate that it allows.


@dataclass(frozen=True)
class FixedFactor(Part):
    """An irreducible polynomial whose roots are fixed modes.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible over Q.
    multiplicity_in_A : int or None
        The exponent of p in χ_A; None for large systems, where its check would take longest.
    multiplicity_at_most : int
        A bound for the multiplicity of p as a fixed factor, which is the least exponent of p in
        χ_{A_F} over all constant gains: the multiplicity itself if the evidence is by blocks, else
        the exponent for the drawn F, which is nearly always equal.
    channels : tuple of str
        s, a set of channels whose pencil P_s(λ) = [λI − A, B_{m−s}; C_s, 0] has the least rank:
        the largest one; or with a subspace of some states the largest one among those whose
        channels measure nothing that these states drive.
    rank : int
        That rank, below n.
    stable : bool
        Whether every root lies in the stability region of the system's time domain.
    roots : tuple of RootDisc
        Disjoint discs, each with exactly one root of p.
    """

    polynomial: Polynomial
    multiplicity_in_A: int | None
    multiplicity_at_most: int
    channels: tuple[str, ...]
    rank: int
    stable: bool
    roots: tuple[RootDisc, ...]

    def sympy_roots(self) -> list[Any]:
        """Return the roots as exact numbers of sympy: of degree 2 in radicals, else ``CRootOf``.

        Examples
        --------
        >>> from mcexact import fixed_spectrum, gallery
        >>> fixed_spectrum(gallery("hidden-triple-mode")).factors[0].sympy_roots()
        [1]
        """
        found: list[Any] = self.polynomial.to_sympy().all_roots()
        return found


@dataclass(frozen=True)
class Completion(Part):
    """B_0 (n × ρ) and C_0 (ρ × n), whose first d columns and rows bound a deficiency by d."""

    B0: Matrix
    C0: Matrix


@dataclass(frozen=True)
class ByBlocks(Part):
    """Evidence by blocks of states: only the factors are fixed, each at most n − rank times.

    Attributes
    ----------
    blocks : tuple of Block
        The modes that may be fixed by them are as many as the factors have, each n − rank times.
    modulus : int or None
        ℓ ≥ 2, modulo which no two factors have a common root and none has a multiple one; None if
        there is no factor.
    subspaces : tuple of Subspace
        One for each factor, of deficiency n − rank.
    """

    blocks: tuple[Block, ...]
    modulus: int | None
    subspaces: tuple[Subspace, ...]


@dataclass(frozen=True)
class TwoPolynomials(Part):
    """Evidence by two characteristic polynomials: gains move every root of no factor.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    modulus : int
        ℓ ≥ 2, modulo which the rest of χ_A is coprime to χ_{A_F}.
    subspaces : tuple of Subspace
        One for each factor, of deficiency n − rank.
    completion : Completion or None
        None if there is no factor.
    """

    gains: tuple[Matrix, ...]
    modulus: int
    subspaces: tuple[Subspace, ...]
    completion: Completion | None


@answer("fixed_spectrum")
class FixedSpectrum(Answer):
    """The modes that are fixed under all linear time-invariant decentralized feedback.

    That is u_i = F_i y_i with constant F_i, or with a dynamic controller of its own at each channel
    (Wang and Davison 1973).  Feedback that varies with time can move some of them: not those that
    are also fixed modes of the plant with its strong components `merged`.

    Attributes
    ----------
    polynomial : Polynomial
        The product of the distinct factors, whose roots are the fixed modes; 1 if there are none.
    factors : tuple of FixedFactor
        Sorted by degree, then by coefficients.
    stabilizable : bool
        Whether every fixed mode lies in the stability region: then and only then some linear
        time-invariant decentralized feedback stabilizes the system.
    best_rate : RateInterval or None
        Encloses minus the largest real part (continuous time) or the largest modulus (discrete
        time) of the fixed modes; None if there is none.
    evidence : ByBlocks or TwoPolynomials
        The second where the bound by blocks exceeds the degrees of the factors.
    """

    polynomial: Polynomial = claim()
    factors: tuple[FixedFactor, ...] = claim()
    stabilizable: bool = claim()
    best_rate: RateInterval | None = claim()
    evidence: ByBlocks | TwoPolynomials = witness(whole=True)

    @property
    @shown("nothing is fixed")
    def empty(self) -> bool:
        """Whether no mode is fixed."""
        return not self.factors

    def outside(self, region: StabilityRegion) -> tuple[FixedFactor, ...]:
        """Return the factors with a root outside a region, which prevent a design for it.

        Examples
        --------
        >>> from mcexact import MultiChannelSystem, fixed_spectrum
        >>> spectrum = fixed_spectrum(MultiChannelSystem([[-1]], [[[0]]], [[[1]]]))
        >>> spectrum.outside(StabilityRegion("continuous"))
        ()
        >>> [str(f.polynomial) for f in spectrum.outside(StabilityRegion("continuous", 2))]
        ['x + 1']
        """
        return tuple(f for f in self.factors if not region.contains_roots_of(f.polynomial))


# Answer: the rank of P_s(λ) = [λI − A, B_{m−s}; C_s, 0] at every root λ of a polynomial.


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


# Answer: whether the transfer graph is strongly connected and no mode is fixed.


@dataclass(frozen=True)
class FreedomWitness(Part):
    """Evidence for yes: gains that move every mode of A, and edges that connect all channels.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which all conditions hold.
    gains : tuple of Matrix
        F_i, p_i × q_i: χ_A and χ_{A_F} are coprime modulo ℓ.
    arcs : tuple of (str, str, int)
        Edges (j, i, k) with C_i A^k B_j ≠ 0 modulo ℓ, sorted by (from, to), which make the graph
        strongly connected.
    """

    modulus: int
    gains: tuple[Matrix, ...]
    arcs: tuple[tuple[str, str, int], ...]


@dataclass(frozen=True)
class BlocksWitness(Part):
    """Evidence for yes: blocks that leave no mode, and edges that connect all channels.

    Attributes
    ----------
    blocks : tuple of Block
        One block, unless there are no states.
    modulus : int
        ℓ ≥ 2, for the edges.
    arcs : tuple of (str, str, int)
        As in `FreedomWitness`.
    """

    blocks: tuple[Block, ...]
    modulus: int
    arcs: tuple[tuple[str, str, int], ...]


@dataclass(frozen=True)
class FixedModeWitness(Part):
    """Evidence for no: a polynomial whose roots are fixed modes.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic of degree at least 1.
    subspace : Subspace
        Of deficiency at least 1 for p.
    """

    polynomial: Polynomial
    subspace: Subspace


@dataclass(frozen=True)
class CutWitness(Part):
    """Evidence for no: a nonempty proper set of channels without transfer to the others.

    Attributes
    ----------
    zero : ZeroTransfer
        From that set to its complement.
    """

    zero: ZeroTransfer


@dataclass(frozen=True)
class PathCutWitness(Part):
    """Evidence for no: a nonempty proper set of channels from which no path leads to another one.

    Attributes
    ----------
    sources : tuple of str
        The channels, under the key ``from``.
    """

    sources: tuple[str, ...] = field(metadata={"key": "from"})


Evidence = BlocksWitness | FreedomWitness | FixedModeWitness | CutWitness | PathCutWitness


@answer("completeness")
class Completeness(Answer):
    """Whether the system is complete: no fixed mode, and a strongly connected transfer graph.

    Attributes
    ----------
    complete : bool
        Whether the transfer graph is strongly connected and the fixed spectrum is empty, with all
        subsets of channels included.  For n ≥ 1 this holds if and only if some F makes the system
        controllable and observable through every single channel.  For n = 0 every F does, but a
        system with several channels is not complete, since no channel affects another.
    evidence : BlocksWitness, FreedomWitness, FixedModeWitness, CutWitness or PathCutWitness
        One of the first two for yes, one of the others for no.
    """

    complete: bool = claim()
    evidence: Evidence = witness(whole=True)


# Answer: how the characteristic polynomial of A_F splits over the strong components.


@dataclass(frozen=True)
class Degree(Part):
    """The McMillan degree of C_c (xI − A)⁻¹ B_c, from above and from below.

    With A, B and C of the states P, the realization on ker W / im U has the same transfer matrix,
    and |P| less the rows of W and the columns of U as its dimension.

    Attributes
    ----------
    states : tuple of int, or None
        P: no path from the inputs of c to its outputs leaves these states; None for all.
    annihilator : Matrix
        W: its columns ``pivots`` form the identity, WA = (WA)[:, pivots] W, WB = 0.
    pivots : tuple of int
    kernel : Matrix
        U', whose columns ``kernel_pivots`` form the identity: AU = UY, CU = 0 and WU = 0.
    kernel_pivots : tuple of int
    sequence : KrylovSequence or None
        Of all channels of c as one channel, of the same degree as the realization; None if it is 0.
    """

    states: tuple[int, ...] | None
    annihilator: Matrix
    pivots: tuple[int, ...]
    kernel: Matrix
    kernel_pivots: tuple[int, ...]
    sequence: KrylovSequence | None

    @property
    def number(self) -> int:
        """The McMillan degree."""
        return 0 if self.sequence is None else self.sequence.degree


@dataclass(frozen=True)
class OrderedComponents(Part):
    """Evidence that the blocks are the strong components of the transfer graph.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2.
    arcs : tuple of (str, str, int)
        Edges (from, to, k) with C_i A^k B_j ≠ 0 modulo ℓ, k < n, which connect each component.
    order : tuple of int
        The positions of the blocks, so that no edge leads from a later block to an earlier one.
    zeros : tuple of ZeroTransfer
        That no edge does, where a path does.
    """

    modulus: int
    arcs: tuple[tuple[str, str, int], ...]
    order: tuple[int, ...]
    zeros: tuple[ZeroTransfer, ...]


@dataclass(frozen=True)
class ByDegrees(Part):
    """Evidence by one sequence for each strong component.

    Attributes
    ----------
    components : OrderedComponents
    degrees : tuple of Degree
        One for each block.
    """

    components: OrderedComponents
    degrees: tuple[Degree, ...]


@dataclass(frozen=True)
class MinimalRealization(Part):
    """A minimal realization of C_c (xI − A)⁻¹ B_c: the subspace im X, reduced by the rows of W.

    Attributes
    ----------
    X : Matrix
        n × a, im X the smallest A-invariant subspace that contains im B_c.
    pivots : tuple of int
        a rows of X that form the identity.
    W : Matrix
        d × a, W A_x = Â W and C_c X = Ĉ W.
    columns : tuple of int
        d columns of W that form the identity.
    """

    X: Matrix
    pivots: tuple[int, ...]
    W: Matrix
    columns: tuple[int, ...]


@dataclass(frozen=True)
class ByRealizations(Part):
    """Evidence of certificates written by earlier versions, which is read only.

    Attributes
    ----------
    modulus : int
        ℓ ≥ 2, modulo which the realizations are controllable and observable.
    transfer_graph : TransferGraph
        The transfer graph of the same system.
    realizations : tuple of MinimalRealization
        One for each block.
    """

    modulus: int
    transfer_graph: TransferGraph
    realizations: tuple[MinimalRealization, ...]


@dataclass(frozen=True)
class SpectrumBlock(Part):
    """A strong component of the transfer graph and its part of the spectrum.

    Attributes
    ----------
    channels : tuple of str
        c.
    dimension : int
        The number of eigenvalues, a symmetric set, that depend on the gains of c and on no others:
        the McMillan degree of C_c (xI − A)⁻¹ B_c.
    """

    brief = ("channels", "dimension")

    channels: tuple[str, ...]
    dimension: int


@answer("assignability")
class Assignability(Answer):
    """det(xI − A_F) is one fixed polynomial times one polynomial for each strong component.

    Attributes
    ----------
    blocks : tuple of SpectrumBlock
        One for each strong component.  Without fixed modes each can be assigned independently:
        together with the states of its controllers, to every symmetric set of that size, which
        contains a real number if the size is odd.
    fixed_degree : int
        The number of eigenvalues, with multiplicity, that belong to no block and depend on no gain;
        0 if no mode is fixed.
    evidence : ByDegrees or ByRealizations
        That the blocks are the strong components, and the degrees of all blocks.
    """

    blocks: tuple[SpectrumBlock, ...] = claim()
    fixed_degree: int = claim()
    evidence: ByDegrees | ByRealizations = witness(whole=True)

    @property
    def undivided(self) -> bool:
        """Whether at most one block has a dimension above 0.

        If no mode is fixed either, and only then, dynamic linear time-invariant channel controllers
        can assign every symmetric spectrum.
        """
        return sum(block.dimension > 0 for block in self.blocks) <= 1
