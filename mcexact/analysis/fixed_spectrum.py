"""The fixed spectrum: modes that no linear time-invariant decentralized feedback moves, and why."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import cast

from mcexact.analysis.modular_system import closed_loop, generator, lifted, lifted_gains
from mcexact.analysis.obstructions import Decision, Obstruction, decide
from mcexact.analysis.rate import located
from mcexact.analysis.shrunk_subspace import ExactSubspace
from mcexact.certificate.evidence import RateInterval, RootDisc, ShrunkSubspace
from mcexact.certificate.fixed_spectrum import FixedFactorClaim, FixedSpectrumCertificate
from mcexact.exact.location import StabilityRegion, Time
from mcexact.exact.matrix import Matrix
from mcexact.exact.modular import polynomial_residues, random_matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import canonical_document


@dataclass(frozen=True)
class FixedFactor:
    """An irreducible polynomial whose roots are fixed modes.

    Attributes
    ----------
    polynomial : Polynomial
        p, monic and irreducible over Q.
    multiplicity_in_A : int
        The exponent of p in χ_A.
    multiplicity_at_most : int
        The exponent of p in χ_{A_F} for the drawn F.  The multiplicity that no constant gains
        remove, the least such exponent, is at most this; drawn gains attain it but for an accident.
    channels : tuple of str
        s, the largest set of channels whose pencil P_s(λ) = [λI − A, B_{m−s}; C_s, 0] has the
        least rank.
    rank : int
        That rank, below n.
    roots : tuple of RootDisc
        Disjoint discs, each with exactly one root of p.
    stable : bool
        Whether every root lies in the stability region of the system's time domain.
    subspace : ShrunkSubspace
        The evidence.
    """

    polynomial: Polynomial
    multiplicity_in_A: int
    multiplicity_at_most: int
    channels: tuple[str, ...]
    rank: int
    roots: tuple[RootDisc, ...]
    stable: bool
    subspace: ShrunkSubspace


@dataclass(frozen=True)
class FixedSpectrum:
    """The modes that stay under every linear time-invariant decentralized feedback.

    That is u_i = F_i y_i with constant F_i, or with a dynamic controller of its own at each channel
    (Wang and Davison 1973).  Feedback that varies with time can move some of them; the gallery has
    an example, ``movable-by-periodic-gains``.

    Attributes
    ----------
    empty : bool
        Whether no mode is fixed.
    polynomial : Polynomial
        The product of the distinct factors, 1 if there is none.
    factors : tuple of FixedFactor
        Sorted by degree, then by coefficients.
    stabilizable : bool
        Whether every fixed mode lies in the stability region: then and only then some linear
        time-invariant decentralized feedback stabilizes the system.
    best_rate : RateInterval or None
        Encloses minus the largest real part (continuous time) or the largest modulus (discrete
        time) of the fixed modes; None if there is none.
    certificate : FixedSpectrumCertificate
    """

    empty: bool
    polynomial: Polynomial
    factors: tuple[FixedFactor, ...]
    stabilizable: bool
    best_rate: RateInterval | None
    certificate: FixedSpectrumCertificate

    def outside(self, region: StabilityRegion) -> tuple[FixedFactor, ...]:
        """The factors with a root outside a region: a design for this rate has to free them."""
        return tuple(f for f in self.factors if not region.contains_roots_of(f.polynomial))


def fixed_spectrum(system: MultiChannelSystem) -> FixedSpectrum:
    """Decide which modes no linear time-invariant decentralized feedback can move.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system.

    Notes
    -----
    Exact; no subset of channels is enumerated.  The certificate holds gains F and a modulus ℓ such
    that χ_{A_F} is coprime modulo ℓ to what is left of χ_A without the fixed factors, and a shrunk
    subspace for each of these.  Without fixed modes it takes two characteristic polynomials modulo
    a word-size prime, O(n³); by float64 products, exact modulo a smaller one, from 128 states on.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> A = [[1, 0, 0], [0, 1, 0], [0, 1, 1]]
    >>> B = [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]]
    >>> C = [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]]
    >>> [factor] = fixed_spectrum(MultiChannelSystem(A, B, C)).factors
    >>> str(factor.polynomial), factor.channels, factor.rank
    ('x - 1', ('2', '3'), 2)
    >>> fixed_spectrum(MultiChannelSystem([[1]], [[[1]]], [[[1]]])).empty
    True
    """
    rng = generator(system, "fixed_spectrum")
    decision = decide(system, rng)
    region = StabilityRegion(cast(Time, system.time))
    discs, rate = located(system.time, [o.polynomial for o in decision.obstructions])
    factors = tuple(
        _factor(system, decision, o, roots, region)
        for o, roots in zip(decision.obstructions, discs, strict=True)
    )
    polynomial = product(factor.polynomial for factor in factors)
    stabilizable = all(factor.stable for factor in factors)
    certificate = FixedSpectrumCertificate(
        system=canonical_document(system.plant),
        subject=system.subject,
        polynomial=polynomial,
        factors=tuple(_claim(factor) for factor in factors),
        stabilizable=stabilizable,
        best_rate=rate,
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        subspaces=tuple(factor.subspace for factor in factors),
        completion=_completion(decision, rng) if factors else None,
    )
    return FixedSpectrum(not factors, polynomial, factors, stabilizable, rate, certificate)


def evidence(system: MultiChannelSystem, subspace: ExactSubspace) -> ShrunkSubspace:
    """The certificate's form of a shrunk subspace."""
    return ShrunkSubspace(
        channels_T=system.named(subspace.channels_T),
        U=subspace.U,
        V=subspace.V,
        pivots=subspace.pivots,
    )


def _factor(
    system: MultiChannelSystem,
    decision: Decision,
    found: Obstruction,
    roots: tuple[RootDisc, ...],
    region: StabilityRegion,
) -> FixedFactor:
    T = set(found.subspace.channels_T)
    p = found.polynomial
    return FixedFactor(
        polynomial=p,
        multiplicity_in_A=found.multiplicity_in_A,
        multiplicity_at_most=polynomial_residues(p, decision.closed.modulus).multiplicity_in(
            decision.closed
        ),
        channels=system.named(i for i in range(system.m) if i not in T),
        rank=system.n - found.subspace.deficiency,
        roots=roots,
        stable=region.contains_roots_of(p),
        subspace=evidence(system, found.subspace),
    )


def _claim(factor: FixedFactor) -> FixedFactorClaim:
    return FixedFactorClaim(
        polynomial=factor.polynomial,
        multiplicity_in_A=factor.multiplicity_in_A,
        multiplicity_at_most=factor.multiplicity_at_most,
        channels=factor.channels,
        rank=factor.rank,
        stable=factor.stable,
        roots=factor.roots,
    )


def _completion(decision: Decision, rng: random.Random) -> tuple[Matrix, Matrix]:
    """B_0 (n × ρ) and C_0 (ρ × n); d columns and rows free the factors of deficiency d."""
    modular = decision.modular
    n, ell = modular.system.n, modular.modulus
    rho = max(o.subspace.deficiency for o in decision.obstructions)
    closed = closed_loop(modular, decision.gains)
    stuck: dict[int, Polynomial] = {}
    for o in decision.obstructions:
        d = o.subspace.deficiency
        stuck[d] = stuck.get(d, product([])) * o.polynomial
    while True:
        B0, C0 = random_matrix(n, rho, ell, rng), random_matrix(rho, n, ell, rng)
        for d, factors in stuck.items():
            cut = closed + B0.take(cols=range(d)) @ C0.take(rows=range(d))
            freed = cut.characteristic_polynomial().gcd(polynomial_residues(factors, ell))
            if freed.degree > 0:
                break
        else:
            return lifted(B0), lifted(C0)
