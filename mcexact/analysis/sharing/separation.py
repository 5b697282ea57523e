"""The separation step of allocations: violated subsets, and their exact cuts."""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence

from mcexact.analysis.engine import (
    CoveringCut,
    decide,
    evidence,
    exact_subspace,
    free_blocks,
    obstruction_modulo,
    strong_components,
    suspected_edges,
    witnessed_powers,
)
from mcexact.answer.covering import Absence, BlocksAbsence, DeficiencyCut
from mcexact.derived.constructions import dual
from mcexact.derived.modular import ModularSystem, drawn_gains, lifted_gains, residue_systems
from mcexact.errors import InternalError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.modular import polynomial_residues
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

Channels = tuple[int, ...]


def violating_factors(
    system: MultiChannelSystem, region: StabilityRegion | None
) -> tuple[Polynomial, ...]:
    """The irreducible factors of det(xI − A) with a root outside the region; all if it is None.

    Parameters
    ----------
    system : MultiChannelSystem
    region : StabilityRegion or None
        The modes outside of it must not be fixed.

    Examples
    --------
    >>> system = MultiChannelSystem([[1, 0], [0, -1]], [[[1], [1]]], [[[1, 1]]])
    >>> [str(p) for p in violating_factors(system, StabilityRegion("continuous"))]
    ['x - 1']
    """
    factors = [p for p, _ in characteristic_polynomial(system.A).factor()]
    return tuple(p for p in factors if region is None or not region.contains_roots_of(p))


def boundary(graph: NeighborGraph, s: Sequence[int]) -> frozenset[int]:
    """N_s∖s, the agents outside s whose messages agents in s receive.

    The extended system has a fixed mode unless, for every s, the dimensions of their shared
    sub-states sum up to at least the deficiency of P_s.

    Examples
    --------
    >>> ring = NeighborGraph.ring(["1", "2", "3"])
    >>> boundary(ring, [0]), boundary(ring, [0, 1, 2])
    (frozenset({1}), frozenset())
    """
    return frozenset(graph.union(s)) - frozenset(s)


def complement(m: int, channels: Sequence[int]) -> Channels:
    """The complement of a set of channels."""
    listed = set(channels)
    return tuple(i for i in range(m) if i not in listed)


def least_minimizers(
    system: MultiChannelSystem, p: Polynomial, rng: random.Random
) -> Iterator[Channels]:
    """The least T with rank P_s(λ) least and below n, s its complement, prime after prime.

    Yields nothing iff no root of p is fixed.  Each T is correct for all but finitely many primes,
    so that results must be checked exactly.
    """
    for modular in residue_systems(system, rng):
        roots = polynomial_residues(p, modular.modulus).roots()
        if roots:
            found = obstruction_modulo(modular, drawn_gains(modular, rng), min(roots))
            if found is None:
                return
            yield found.channels_T


def _extreme_minimizers(
    system: MultiChannelSystem, p: Polynomial, rng: random.Random
) -> Iterator[tuple[Channels, Channels]]:
    """The least and the greatest T with rank P_s(λ) least and below n, prime after prime.

    The pencil of the dual system for s is the transpose of that of the system for the complement
    of s, so the greatest T is the complement of the dual's least one.
    """
    other = least_minimizers(dual(system), p, rng)
    for T in least_minimizers(system, p, rng):
        yield T, complement(system.m, next(other, ()))


def violated_subsets(
    base: MultiChannelSystem,
    extended: MultiChannelSystem,
    factors: Sequence[Polynomial],
    dimensions: Sequence[int],
    graph: NeighborGraph,
    rng: random.Random,
) -> list[CoveringCut]:
    """Subsets s with Σ n_i over N_s∖s below the deficiency of P_s; empty iff there is none.

    Parameters
    ----------
    base : MultiChannelSystem
        The system with the pencils P_s: the plant, or the plant with augmented outputs.
    extended : MultiChannelSystem
        The extended system with these dimensions.
    factors : sequence of Polynomial
        Irreducible factors of det(xI − A): the modes that count.
    dimensions : sequence of m int
    graph : NeighborGraph
    rng : random.Random
    """
    found: list[CoveringCut] = []
    for p in factors:
        for pair in _extreme_minimizers(extended, p, rng):
            here = []
            for T in dict.fromkeys(pair):
                s = complement(base.m, T)
                subspace, around = exact_subspace(base, T, p), boundary(graph, s)
                if subspace and sum(dimensions[i] for i in around) < subspace.deficiency:
                    lost, shrunk = subspace.deficiency, evidence(base, subspace)
                    cut = DeficiencyCut(base.named(s), p, lost, shrunk)
                    here.append(CoveringCut(around, lost, cut))
            if here:
                found += here
                break
    return found


def absence(
    system: MultiChannelSystem,
    region: StabilityRegion | None,
    rng: random.Random,
    *,
    connected: bool = False,
) -> BlocksAbsence | Absence:
    """Prove that no mode outside a region is fixed and, on request, that the graph is connected.

    Parameters
    ----------
    system : MultiChannelSystem
        The extended system, or another one of which earlier cuts have removed the fixed modes.
    region : StabilityRegion or None
        Modes inside of it may be fixed; with None no mode may be.
    rng : random.Random
    connected : bool
        Whether to prove also that the transfer graph is strongly connected.

    Raises
    ------
    InternalError
        If some mode outside the region is fixed, or the transfer graph is not connected.
    """
    blocks = free_blocks(system)
    if blocks is not None:
        if not connected:
            return BlocksAbsence(blocks)
        modular = next(residue_systems(system, rng))
        return BlocksAbsence(blocks, modular.modulus, _connecting_edges(modular, rng))
    decision = decide(system, rng)
    allowed = tuple((o.polynomial, o.multiplicity_in_A) for o in decision.obstructions)
    if any(region is None or not region.contains_roots_of(p) for p, _ in allowed):
        raise InternalError("a fixed mode was left after the last cut")
    return Absence(
        gains=lifted_gains(decision.modular, decision.gains),
        modulus=decision.modular.modulus,
        allowed=allowed,
        arcs=_connecting_edges(decision.modular, rng) if connected else None,
    )


def _connecting_edges(
    modular: ModularSystem, rng: random.Random
) -> tuple[tuple[str, str, int], ...]:
    """Edges with a nonzero Markov parameter modulo ℓ, which make the graph strongly connected."""
    system = modular.system
    powers = witnessed_powers(modular, suspected_edges(modular, rng))
    if len(strong_components(system.m, sorted(powers))) > 1:
        raise InternalError("the extended transfer graph is not strongly connected")
    names = system.names
    return tuple((names[j], names[i], k) for (j, i), k in sorted(powers.items()))
