"""Answer: the fixed spectrum, its location, and the best rate that it allows."""

from __future__ import annotations

from dataclasses import dataclass

from mcexact.answer.evidence import Block, RateInterval, RootDisc, ShrunkSubspace
from mcexact.answer.protocol import Answer, Part, answer, claim, shown, witness
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion


@dataclass(frozen=True)
class FixedFactor(Part):
    """An irreducible polynomial whose roots are fixed modes.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible over Q.
    multiplicity_in_A : int or None
        The exponent of p in χ_A; None for large sparse systems, whose χ_A is not computed.
    multiplicity_at_most : int
        A bound for the multiplicity of p as a fixed factor, which is the least exponent of p in
        χ_{A_F} over all constant gains: the multiplicity itself if the evidence is by blocks, else
        the exponent for the drawn F, which is nearly always equal.
    channels : tuple of str
        s, the largest set of channels whose pencil P_s(λ) = [λI − A, B_{m−s}; C_s, 0] has the
        least rank.
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


@dataclass(frozen=True)
class Completion(Part):
    """B_0 (n × ρ) and C_0 (ρ × n), whose first d columns and rows bound a deficiency by d."""

    B0: Matrix
    C0: Matrix


@dataclass(frozen=True)
class ByBlocks(Part):
    """Evidence block by block: no more is fixed than the factors, n − rank times each.

    Attributes
    ----------
    blocks : tuple of Block
        They leave as many modes as the degrees of the factors, each taken n − rank times.
    modulus : int or None
        ℓ ≥ 2, modulo which no two factors have a common root and none has a multiple one; None if
        there is no factor.
    subspaces : tuple of ShrunkSubspace
        One for each factor, of deficiency n − rank.
    """

    blocks: tuple[Block, ...]
    modulus: int | None
    subspaces: tuple[ShrunkSubspace, ...]


@dataclass(frozen=True)
class TwoPolynomials(Part):
    """Evidence by two characteristic polynomials: gains move all that is no factor.

    Attributes
    ----------
    gains : tuple of Matrix
        F_i, p_i × q_i, one for each channel.
    modulus : int
        ℓ ≥ 2, modulo which the rest of χ_A is coprime to χ_{A_F}.
    subspaces : tuple of ShrunkSubspace
        One for each factor, of deficiency n − rank.
    completion : Completion or None
        None if there is no factor.
    """

    gains: tuple[Matrix, ...]
    modulus: int
    subspaces: tuple[ShrunkSubspace, ...]
    completion: Completion | None


@answer("fixed_spectrum")
class FixedSpectrum(Answer):
    """The modes that are fixed under all linear time-invariant decentralized feedback.

    That is u_i = F_i y_i with constant F_i, or with a dynamic controller of its own at each channel
    (Wang and Davison 1973).  Feedback that varies with time can move some of them; the gallery has
    an example, ``movable-by-periodic-gains``.

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
        The second where the blocks leave more than the factors.
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
