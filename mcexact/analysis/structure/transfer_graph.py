"""The transfer graph, in which an edge j → i means that u_j affects y_i."""

from __future__ import annotations

import random

from mcexact.analysis.engine import (
    Edge,
    strong_components,
    suspected_edges,
    witnessed_powers,
    zero_transfer,
)
from mcexact.answer.transfer_graph import TransferGraph
from mcexact.derived.modular_system import generator, residue_systems
from mcexact.errors import InternalError
from mcexact.exact.invariant_subspace import InvariantSubspace, controllable_subspace
from mcexact.model.system import MultiChannelSystem


def transfer_graph(system: MultiChannelSystem) -> TransferGraph:
    """Decide for every pair of channels whether C_i (xI − A)⁻¹ B_j ≠ 0.

    Parameters
    ----------
    system : MultiChannelSystem

    Notes
    -----
    Exact.  For an edge the certificate has a k < n with C_i A^k B_j ≠ 0 modulo a prime.  For the
    other pairs it has invariant subspaces that contain im B_j and lie in ker C_i, one for all j
    that reach the same channels.  One value of the transfer matrix modulo the prime determines the
    edges to be proved.  O(n³) word operations, and O(n² p) for each power looked at.

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
    rng = generator(system, "transfer_graph")
    for modular in residue_systems(system, rng):
        suspected = suspected_edges(modular, rng)
        powers = witnessed_powers(modular, suspected)
        zeros = _zero_transfers(system, set(powers), rng)
        if zeros is not None:
            return _result(system, modular.modulus, powers, zeros)
    raise InternalError("the stream of primes is endless")


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
