"""The fixed spectrum: the modes that no linear time-invariant decentralized feedback moves."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import cast

from mcexact.analysis.engine import (
    Decision,
    Obstruction,
    best_sequences,
    decide,
    evidence,
    located,
)
from mcexact.answer.evidence import KrylovSequence, RateInterval, RootDisc
from mcexact.answer.fixed_spectrum import (
    Completion,
    FixedFactor,
    FixedSpectrum,
    OneSequence,
    TwoPolynomials,
)
from mcexact.derived.modular_system import closed_loop, generator, lifted, lifted_gains
from mcexact.exact.location import StabilityRegion, Time
from mcexact.exact.modular import polynomial_residues, random_matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.model.system import MultiChannelSystem


def fixed_spectrum(system: MultiChannelSystem) -> FixedSpectrum:
    """Decide which modes no linear time-invariant decentralized feedback can move.

    Parameters
    ----------
    system : MultiChannelSystem
        A plant or a derived system.

    Notes
    -----
    Exact; no subset of channels is enumerated.  The certificate has one Krylov sequence of drawn
    gains and one channel, modulo a small prime, which bounds how much is fixed, and a shrunk
    subspace for each fixed factor.  Where no sequence proves this, because the transfer graph is
    not strongly connected or the channels reach a mode by Jordan chains, the certificate has gains
    F and a modulus ℓ such that χ_{A_F} is coprime modulo ℓ to χ_A without its fixed factors.
    Without fixed modes it takes O(n³), by products in floating point that are exact from 128
    states on.

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
    sequences = []
    for sequence in best_sequences(system):
        if sequence.degree == system.n:
            return _found(system, (), None, OneSequence(sequence, ()))
        sequences.append(sequence)
    rng = generator(system, "fixed_spectrum")
    decision = decide(system, rng)
    region = StabilityRegion(cast(Time, system.time))
    discs, rate = located(system.time, [o.polynomial for o in decision.obstructions])
    deciding = _deciding(sequences, decision, system.n)
    factors = tuple(
        _factor(system, decision, o, roots, region, deciding is not None)
        for o, roots in zip(decision.obstructions, discs, strict=True)
    )
    subspaces = tuple(evidence(system, o.subspace) for o in decision.obstructions)
    if deciding is not None:
        return _found(system, factors, rate, OneSequence(deciding, subspaces))
    moved = TwoPolynomials(
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        subspaces=subspaces,
        completion=_completion(decision, rng) if factors else None,
    )
    return _found(system, factors, rate, moved)


def _found(
    system: MultiChannelSystem,
    factors: tuple[FixedFactor, ...],
    rate: RateInterval | None,
    proof: OneSequence | TwoPolynomials,
) -> FixedSpectrum:
    return FixedSpectrum(
        system,
        polynomial=product(factor.polynomial for factor in factors),
        factors=factors,
        stabilizable=all(factor.stable for factor in factors),
        best_rate=rate,
        evidence=proof,
    )


def _deciding(
    sequences: Sequence[KrylovSequence], decision: Decision, n: int
) -> KrylovSequence | None:
    """The first sequence that leaves no more than the factors, with the ranks that they lose.

    Modulo its ℓ the factors are coprime, and none has a multiple root.
    """
    left = n - sum(o.polynomial.degree * o.subspace.deficiency for o in decision.obstructions)
    whole = product(o.polynomial for o in decision.obstructions)
    for sequence in sequences:
        ell = sequence.modulus
        if sequence.degree == left and all(c.denominator % ell for c in whole.coefficients):
            p = polynomial_residues(whole, ell)
            if p.gcd(polynomial_residues(whole.derivative(), ell)).degree == 0:
                return sequence
    return None


def _factor(
    system: MultiChannelSystem,
    decision: Decision,
    found: Obstruction,
    roots: tuple[RootDisc, ...],
    region: StabilityRegion,
    by_sequence: bool,
) -> FixedFactor:
    T = set(found.subspace.channels_T)
    p, at_most = found.polynomial, found.subspace.deficiency
    if not by_sequence:
        at_most = polynomial_residues(p, decision.closed.modulus).multiplicity_in(decision.closed)
    return FixedFactor(
        polynomial=p,
        multiplicity_in_A=found.multiplicity_in_A,
        multiplicity_at_most=at_most,
        channels=system.named(i for i in range(system.m) if i not in T),
        rank=system.n - found.subspace.deficiency,
        stable=region.contains_roots_of(p),
        roots=roots,
    )


def _completion(decision: Decision, rng: random.Random) -> Completion:
    """Compute B_0 (n × ρ) and C_0 (ρ × n); d columns and rows move the factors of deficiency d."""
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
            return Completion(lifted(B0), lifted(C0))
