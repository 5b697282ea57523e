"""Completeness: a strongly connected transfer graph and no fixed mode."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import overload

from mcexact.analysis.engine import (
    Edge,
    ParametricCompleteness,
    decide,
    edge_modulus,
    is_connected,
    is_large_and_sparse,
    parametric_completeness,
    sparse_powers,
    suspected_edges,
    witnessed_powers,
    zero_transfer,
)
from mcexact.analysis.fixed_modes.fixed_spectrum import fixed_spectrum
from mcexact.answer.completeness import (
    BlocksWitness,
    Completeness,
    CutWitness,
    Evidence,
    FixedModeWitness,
    FreedomWitness,
)
from mcexact.answer.fixed_spectrum import ByBlocks, FixedSpectrum
from mcexact.derived.modular import ModularSystem, generator, lifted_gains, residue_systems
from mcexact.errors import InputError, InternalError
from mcexact.exact.krylov import controllable_subspace
from mcexact.exact.matrix import Matrix
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

Freedom = ByBlocks | tuple[Matrix, ...]
"""The proof that no mode is fixed: by blocks, or gains that move every mode."""


@overload
def completeness(
    system: MultiChannelSystem, *, spectrum: FixedSpectrum | None = None
) -> Completeness: ...


@overload
def completeness(system: ParametricSystem) -> ParametricCompleteness: ...


def completeness(
    system: MultiChannelSystem | ParametricSystem, *, spectrum: FixedSpectrum | None = None
) -> Completeness | ParametricCompleteness:
    """Decide whether a system is complete.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answer says whether it is complete for almost every
        value, and for which values it is not (`ParametricCompleteness`).
    spectrum : FixedSpectrum, optional
        ``fixed_spectrum(system)`` of a plant without parameters, if it is known already.

    Notes
    -----
    Exact.  The certificate for yes proves that no mode is fixed, and has edges that connect all
    channels.  The certificate for no has a shrunk subspace for one fixed mode, or a set of channels
    whose inputs do not affect the outputs of the others.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> I = [[1, 0], [0, 1]]
    >>> apart = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]])
    >>> completeness(apart).complete
    False
    >>> ring = MultiChannelSystem(I, [[[1], [0]], [[0], [1]]], [[[0, 1]], [[1, 0]]])
    >>> completeness(ring).complete
    True
    >>> completeness(MultiChannelSystem([], [[], []], [[], []])).complete
    False
    """
    known = FixedSpectrum.known(spectrum, system, "spectrum")
    if isinstance(system, ParametricSystem):
        return parametric_completeness(system)
    InputError.require(system, MultiChannelSystem, "system")
    spectrum = fixed_spectrum(system) if known is None else known
    rng = generator(system, "completeness")
    evidence = _evidence(system, spectrum, rng)
    complete = isinstance(evidence, BlocksWitness | FreedomWitness)
    return Completeness(system, complete=complete, evidence=evidence)


def _evidence(system: MultiChannelSystem, spectrum: FixedSpectrum, rng: random.Random) -> Evidence:
    if not spectrum.empty:
        return FixedModeWitness(spectrum.factors[0].polynomial, spectrum.evidence.subspaces[0])
    if isinstance(spectrum.evidence, ByBlocks) and is_large_and_sparse(system):
        connected = _connected_by_structure(system, spectrum.evidence)
        if connected is not None:
            return connected
    # Some edges vanish by accident, perhaps modulo one prime for all draws.
    for modular, proof in _freedom(system, spectrum, rng):
        suspected = suspected_edges(modular, rng)
        closed = _closed_set(system.m, suspected)
        if closed is None:
            return _connected(modular, proof, _connecting_edges(system.m, suspected))
        found = controllable_subspace(system.A, system.input_matrix(closed), rng)
        rest = [i for i in range(system.m) if i not in closed]
        if (system.output_matrix(rest) @ found.X).is_zero():
            return CutWitness(zero_transfer(system, closed, found))
    raise InternalError("the stream of primes is endless")


def _connected_by_structure(system: MultiChannelSystem, proof: ByBlocks) -> Evidence | None:
    """Edges of the least powers that connect all channels of a large sparse system, if any do."""
    ell = edge_modulus(system)
    if ell is None:
        return None
    powers, names = sparse_powers(system, ell, is_connected), system.names
    if not is_connected(powers >= 0):
        return None
    edges = {(int(j), int(i)) for j, i in zip(*(powers >= 0).nonzero(), strict=True)}
    chosen = sorted(_connecting_edges(system.m, edges))
    arcs = tuple((names[j], names[i], int(powers[j, i])) for j, i in chosen)
    return BlocksWitness(proof.blocks, ell, arcs)


def _connected(modular: ModularSystem, proof: Freedom, chosen: set[Edge]) -> Evidence:
    """The evidence for yes, with edges that connect all channels."""
    powers, names = witnessed_powers(modular, chosen), modular.system.names
    arcs = tuple((names[j], names[i], powers[j, i]) for j, i in sorted(chosen))
    if isinstance(proof, ByBlocks):
        return BlocksWitness(proof.blocks, modular.modulus, arcs)
    return FreedomWitness(modular.modulus, proof, arcs)


def _freedom(
    system: MultiChannelSystem, spectrum: FixedSpectrum, rng: random.Random
) -> Iterator[tuple[ModularSystem, Freedom]]:
    """Yield systems modulo primes for the edges, each with a proof that nothing is fixed.

    Gains are proved to move every mode modulo the prime of their own.
    """
    if isinstance(spectrum.evidence, ByBlocks):
        for modular in residue_systems(system, rng):
            yield modular, spectrum.evidence
        return
    yield ModularSystem(system, spectrum.evidence.modulus), spectrum.evidence.gains
    while True:
        decision = decide(system, rng)
        yield decision.modular, lifted_gains(decision.modular, decision.gains)


def _reached(m: int, start: int, edges: set[Edge]) -> list[Edge]:
    """Edges of a tree from ``start`` to every node that it reaches, nearest first."""
    successors: list[list[int]] = [[] for _ in range(m)]
    for j, i in sorted(edges):
        successors[j].append(i)
    seen, level, tree = {start}, [start], []
    while level:
        following = []
        for j in level:
            for i in successors[j]:
                if i not in seen:
                    seen.add(i)
                    following.append(i)
                    tree.append((j, i))
        level = following
    return tree


def _closed_set(m: int, edges: set[Edge]) -> tuple[int, ...] | None:
    """A smallest nonempty proper set of nodes that some node reaches and no edge leaves, if any."""
    sets = []
    for start in range(m):
        reached = {start, *(i for _, i in _reached(m, start, edges))}
        if len(reached) < m:
            sets.append(tuple(sorted(reached)))
    return min(sets, key=lambda s: (len(s), s), default=None)


def _connecting_edges(m: int, edges: set[Edge]) -> set[Edge]:
    """At most 2(m − 1) edges of a strongly connected graph that keep it so."""
    if m < 2:
        return set()
    backwards = _reached(m, 0, {(i, j) for j, i in edges})
    return set(_reached(m, 0, edges)) | {(j, i) for i, j in backwards}
