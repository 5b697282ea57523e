"""The transfer graph, in which an edge j → i means that u_j affects y_i."""

from __future__ import annotations

import random
from typing import overload

from mcexact.analysis.engine import (
    Edge,
    ParametricTransferGraph,
    edge_modulus,
    is_large_and_sparse,
    parametric_transfer_graph,
    reachable_pairs,
    sparse_powers,
    strong_components,
    suspected_edges,
    witnessed_powers,
    zero_transfer,
)
from mcexact.answer.transfer_graph import TransferGraph
from mcexact.derived.modular import generator, residue_systems
from mcexact.errors import InputError, InternalError
from mcexact.exact.krylov import InvariantSubspace, controllable_subspace
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem


@overload
def transfer_graph(system: MultiChannelSystem) -> TransferGraph: ...


@overload
def transfer_graph(system: ParametricSystem) -> ParametricTransferGraph: ...


def transfer_graph(
    system: MultiChannelSystem | ParametricSystem,
) -> TransferGraph | ParametricTransferGraph:
    """Decide for every pair of channels whether C_i (xI − A)⁻¹ B_j ≠ 0.

    Parameters
    ----------
    system : MultiChannelSystem or ParametricSystem
        For a plant with one parameter the answer says at which values which edges vanish
        (`ParametricTransferGraph`).

    Notes
    -----
    Exact.  For an edge the certificate has a k < n with C_i A^k B_j ≠ 0 modulo a prime.  Pairs that
    no path connects in the structure of the matrices are no edges.  For all others, and for small
    systems for all pairs, it has invariant subspaces that contain im B_j and lie in ker C_i, one
    for all j that reach the same channels.  One value of the transfer matrix modulo the prime
    determines the edges to be proved.  O(n³) word operations, and O(n² p) for each power looked at.

    Examples
    --------
    >>> from mcexact import MultiChannelSystem
    >>> B, C = [[[1], [0]], [[0], [1]]], [[[1, 0]], [[0, 1]]]
    >>> system = MultiChannelSystem([[0, 0], [1, 0]], B, C)
    >>> graph = transfer_graph(system)
    >>> graph.arcs
    (('1', '1'), ('1', '2'), ('2', '2'))
    >>> graph.strongly_connected
    False
    """
    if isinstance(system, ParametricSystem):
        return parametric_transfer_graph(system)
    InputError.require(system, MultiChannelSystem, "system")
    if is_large_and_sparse(system):
        found = _by_structure(system)
        if found is not None:
            return found
    rng = generator(system, "transfer_graph")
    for modular in residue_systems(system, rng):
        suspected = suspected_edges(modular, rng)
        powers = witnessed_powers(modular, suspected)
        zeros = _zero_transfers(system, set(powers), rng)
        if zeros is not None:
            return _result(system, modular.modulus, powers, zeros)
    raise InternalError("the stream of primes is endless")


def _by_structure(system: MultiChannelSystem) -> TransferGraph | None:
    """The graph by paths, if there is an edge for each pair that a path connects."""
    ell, paths = edge_modulus(system), reachable_pairs(system)
    if ell is None:
        return None
    powers = sparse_powers(system, ell, lambda found: bool((found | ~paths).all()))
    if ((powers < 0) & paths).any():
        return None
    edges = [(int(j), int(i)) for j, i in zip(*paths.nonzero(), strict=True)]
    return _result(system, ell, {edge: int(powers[edge]) for edge in edges}, [])


def _zero_transfers(
    system: MultiChannelSystem, edges: set[Edge], rng: random.Random
) -> list[tuple[tuple[int, ...], InvariantSubspace]] | None:
    """Invariant subspaces that prove that no other pair is an edge; None if one is."""
    m = system.m
    groups: dict[tuple[int, ...], list[int]] = {}
    for j in range(m):
        unreached = tuple(i for i in range(m) if (j, i) not in edges)
        if unreached:
            groups.setdefault(unreached, []).append(j)
    zeros = []
    for unreached, sources in groups.items():
        found = controllable_subspace(system.A, system.input_matrix(sources), rng)
        if not (system.output_matrix(unreached) @ found.X).is_zero():
            return None
        zeros.append((tuple(sources), found))
    return zeros


def _result(
    system: MultiChannelSystem,
    modulus: int,
    powers: dict[Edge, int],
    zeros: list[tuple[tuple[int, ...], InvariantSubspace]],
) -> TransferGraph:
    edges = sorted(powers)
    names = system.names
    components = tuple(system.named(c) for c in strong_components(system.m, edges))
    return TransferGraph(
        system,
        arcs=tuple((names[j], names[i]) for j, i in edges),
        components=components,
        strongly_connected=len(components) <= 1,
        modulus=modulus,
        powers=tuple(powers[edge] for edge in edges),
        zeros=tuple(zero_transfer(system, sources, found) for sources, found in zeros),
    )
