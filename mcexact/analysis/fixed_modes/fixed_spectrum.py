"""The fixed spectrum: the modes that no linear time-invariant decentralized feedback moves."""

from __future__ import annotations

import random
from typing import cast, overload

from mcexact.analysis.engine import (
    MODULI,
    Decision,
    Obstruction,
    bounded_blocks,
    completed_blocks,
    decide,
    evidence,
    fixed_subspaces,
    located,
    modes_left,
    parametric_fixed_spectrum,
)
from mcexact.answer.evidence import Block, RateInterval, RootDisc, ShrunkSubspace
from mcexact.answer.fixed_spectrum import (
    ByBlocks,
    Completion,
    FixedFactor,
    FixedSpectrum,
    TwoPolynomials,
)
from mcexact.answer.parametric_fixed_spectrum import ParametricFixedSpectrum
from mcexact.derived.modular import closed_loop, generator, lifted, lifted_gains
from mcexact.errors import InputError, LimitReached
from mcexact.exact.krylov import stays_sparse
from mcexact.exact.modular import polynomial_residues, random_matrix
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import StabilityRegion, Time
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

# Up to this size dense matrices are searched, which finds Jordan chains as well.
_DENSE = 500
# Blocks of so many states are decided densely, one after the other.
_SMALL_BLOCK = 500
# The subspaces of more fixed modes are not looked for by sparse products.
_MOST_MODES = 64


@overload
def fixed_spectrum(system: MultiChannelSystem) -> FixedSpectrum: ...


@overload
def fixed_spectrum(system: ParametricSystem) -> ParametricFixedSpectrum: ...


def fixed_spectrum(
    system: MultiChannelSystem | ParametricSystem,
) -> FixedSpectrum | ParametricFixedSpectrum:
    """Decide which modes no linear time-invariant decentralized feedback can move.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        A plant or a derived system; or a plant with one parameter, for all of whose values the
        question is decided (`ParametricFixedSpectrum`).

    Notes
    -----
    Exact; no subset of channels is enumerated.  In large sparse systems the factors are found by
    products with sparse matrices, and how often they occur in χ_A is left open.  The certificate
    splits the states into blocks that share no gain.  For each it has one Krylov sequence of drawn
    gains and one channel, modulo a small prime, which bounds how much is fixed; for each fixed
    factor it has a shrunk subspace.
    Where the blocks leave more than the factors, because a mode is fixed by Jordan chains, the
    certificate has gains F and a modulus ℓ such that χ_{A_F} is coprime modulo ℓ to χ_A without
    its fixed factors.  Without fixed modes it takes O(n³), by products in floating point that are
    exact from 128 states on.

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
    if isinstance(system, ParametricSystem):
        return parametric_fixed_spectrum(system)
    InputError.require(system, MultiChannelSystem, "system")
    blocks = bounded_blocks(system)
    if not modes_left(blocks):
        return _found(system, (), None, ByBlocks(blocks, None, ()))
    if _is_large_and_sparse(system):
        blocks = _with_small_blocks_completed(system, blocks)
        if not modes_left(blocks):
            return _found(system, (), None, ByBlocks(blocks, None, ()))
        found = _by_sparse_search(system, blocks)
        if found is not None:
            return found
    rng = generator(system, "fixed_spectrum")
    decision = decide(system, rng)
    region = StabilityRegion(cast(Time, system.time))
    discs, rate = located(system.time, [o.polynomial for o in decision.obstructions])
    subspaces = tuple(evidence(system, o.subspace) for o in decision.obstructions)
    by_blocks = _by_blocks(system, blocks, decision, subspaces)
    factors = tuple(
        _factor(system, decision, o, roots, region, by_blocks is not None)
        for o, roots in zip(decision.obstructions, discs, strict=True)
    )
    if by_blocks is not None:
        return _found(system, factors, rate, by_blocks)
    moved = TwoPolynomials(
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        subspaces=subspaces,
        completion=_completion(decision, rng) if factors else None,
    )
    return _found(system, factors, rate, moved)


def _is_large_and_sparse(system: MultiChannelSystem) -> bool:
    channels = system.channels
    return system.n > _DENSE and stays_sparse(
        system.A, [c.B for c in channels], [c.C for c in channels]
    )


def _with_small_blocks_completed(
    system: MultiChannelSystem, blocks: tuple[Block, ...]
) -> tuple[Block, ...]:
    """The same blocks with two polynomials where no mode is fixed, if they are small."""
    short = [block for block in blocks if modes_left([block])]
    if len(blocks) < 2 or max(len(block.states) for block in short) > _SMALL_BLOCK:
        return blocks
    return completed_blocks(system, blocks)


def _by_sparse_search(
    system: MultiChannelSystem, blocks: tuple[Block, ...]
) -> FixedSpectrum | None:
    """The fixed spectrum by products with sparse matrices, without χ_A; None if it is not found."""
    if modes_left(blocks) > _MOST_MODES:
        return None
    try:
        found = fixed_subspaces(system)
    except LimitReached:
        return None
    ell = _separating(product(p for p, _ in found), MODULI[-1])
    fixed = sum(p.degree * space.deficiency for p, space in found)
    if modes_left(blocks) != fixed or ell is None:
        return None
    region = StabilityRegion(cast(Time, system.time))
    discs, rate = located(system.time, [p for p, _ in found])
    factors = tuple(
        FixedFactor(
            polynomial=p,
            multiplicity_in_A=None,
            multiplicity_at_most=space.deficiency,
            channels=system.named(i for i in range(system.m) if i not in set(space.channels_T)),
            rank=system.n - space.deficiency,
            stable=region.contains_roots_of(p),
            roots=roots,
        )
        for (p, space), roots in zip(found, discs, strict=True)
    )
    spaces = tuple(evidence(system, space) for _, space in found)
    return _found(system, factors, rate, ByBlocks(blocks, ell, spaces))


def _found(
    system: MultiChannelSystem,
    factors: tuple[FixedFactor, ...],
    rate: RateInterval | None,
    proof: ByBlocks | TwoPolynomials,
) -> FixedSpectrum:
    return FixedSpectrum(
        system,
        polynomial=product(factor.polynomial for factor in factors),
        factors=factors,
        stabilizable=all(factor.stable for factor in factors),
        best_rate=rate,
        evidence=proof,
    )


def _by_blocks(
    system: MultiChannelSystem,
    blocks: tuple[Block, ...],
    decision: Decision,
    subspaces: tuple[ShrunkSubspace, ...],
) -> ByBlocks | None:
    """The proof by blocks, if they leave no more than the factors with the ranks that they lose."""
    found = decision.obstructions
    fixed = sum(o.polynomial.degree * o.subspace.deficiency for o in found)
    if modes_left(blocks) > fixed and len(blocks) > 1:
        blocks = completed_blocks(system, blocks)
    if modes_left(blocks) > fixed:
        return None
    if not found:
        return ByBlocks(blocks, None, ())
    ell = _separating(product(o.polynomial for o in found), decision.modular.modulus)
    return None if ell is None else ByBlocks(blocks, ell, subspaces)


def _separating(whole: Polynomial, last: int) -> int | None:
    """A prime modulo which a product of different factors has no multiple root."""
    for ell in (*MODULI, last):
        if all(c.denominator % ell for c in whole.coefficients):
            p = polynomial_residues(whole, ell)
            if p.gcd(polynomial_residues(whole.derivative(), ell)).degree == 0:
                return ell
    return None


def _factor(
    system: MultiChannelSystem,
    decision: Decision,
    found: Obstruction,
    roots: tuple[RootDisc, ...],
    region: StabilityRegion,
    by_blocks: bool,
) -> FixedFactor:
    T = set(found.subspace.channels_T)
    p, at_most = found.polynomial, found.subspace.deficiency
    if not by_blocks:
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
