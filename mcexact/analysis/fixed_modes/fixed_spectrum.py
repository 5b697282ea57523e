"""The fixed spectrum: the modes that no linear time-invariant decentralized feedback moves."""

from __future__ import annotations

import random
from typing import cast

from mcexact.analysis.engine import Decision, Obstruction, decide, evidence, located
from mcexact.answer.evidence import RootDisc
from mcexact.answer.fixed_spectrum import Completion, FixedFactor, FixedSpectrum
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
    Exact; no subset of channels is enumerated.  The certificate has gains F and a modulus ℓ such
    that χ_{A_F} is coprime modulo ℓ to χ_A without its fixed factors, and a shrunk subspace for
    each of these.  Without fixed modes it takes two characteristic polynomials modulo a word-size
    prime, O(n³); by float64 products, exact modulo a smaller one, from 128 states on.

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
    return FixedSpectrum(
        system,
        polynomial=product(factor.polynomial for factor in factors),
        factors=factors,
        stabilizable=all(factor.stable for factor in factors),
        best_rate=rate,
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        subspaces=tuple(evidence(system, o.subspace) for o in decision.obstructions),
        completion=_completion(decision, rng) if factors else None,
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
