"""The transfer graph: which channel's inputs reach which channel's outputs."""

from __future__ import annotations

import random
from collections.abc import Sequence

from mcexact.analysis.invariant_subspace import InvariantSubspace, controllable_subspace
from mcexact.analysis.modular_system import ModularSystem, generator, residue_systems
from mcexact.answer.evidence import ZeroTransfer
from mcexact.answer.transfer_graph import TransferGraph
from mcexact.errors import InternalError
from mcexact.exact.modular import ModularMatrix
from mcexact.model.system import MultiChannelSystem

Arc = tuple[int, int]


def transfer_graph(system: MultiChannelSystem) -> TransferGraph:
    """Decide for every pair of channels whether C_i (xI − A)⁻¹ B_j ≠ 0.

    Parameters
    ----------
    system : MultiChannelSystem

    Notes
    -----
    Exact.  For an arc the certificate holds a k < n with C_i A^k B_j ≠ 0 modulo a prime; for the
    pairs that are no arcs it holds invariant subspaces that contain im B_j and lie in ker C_i, one
    for all j that reach the same channels.  One value of the transfer matrix modulo the prime says
    which arcs to look for.  O(n³) word operations, and O(n² p) for each power looked at.

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
        suspected = suspected_arcs(modular, rng)
        powers = witnessed_powers(modular, suspected)
        zeros = _zero_transfers(system, set(powers), rng)
        if zeros is not None:
            return _result(system, modular.modulus, powers, zeros)
    raise InternalError("the stream of primes is endless")


def _channel_of(ranges: Sequence[range]) -> list[int]:
    return [i for i, positions in enumerate(ranges) for _ in positions]


def _nonzero_blocks(modular: ModularSystem, G: ModularMatrix) -> set[Arc]:
    """The pairs (j, i) with a nonzero block (i, j) of a Σ q_i × Σ p_i matrix."""
    sources, targets = _channel_of(modular.inputs), _channel_of(modular.outputs)
    found: set[Arc] = set()
    for i, row in zip(targets, G.rows(), strict=True):
        found.update((j, i) for j, value in zip(sources, row, strict=True) if value)
    return found


def suspected_arcs(modular: ModularSystem, rng: random.Random) -> set[Arc]:
    """The pairs with C_i (zI − A)⁻¹ B_j ≠ 0 modulo ℓ at a drawn z."""
    n, ell = modular.system.n, modular.modulus
    if n == 0 or not modular.B.ncols or not modular.C.nrows:
        return set()
    while True:
        resolvent = ModularMatrix.scalar(n, rng.randrange(ell), ell) - modular.A
        inverse = resolvent.inverse()
        if inverse is not None:
            return _nonzero_blocks(modular, (modular.C @ inverse) @ modular.B)


def witnessed_powers(modular: ModularSystem, suspected: set[Arc]) -> dict[Arc, int]:
    """The least k with C_i A^k B_j ≠ 0 modulo ℓ, for every pair that has one below n."""
    found: dict[Arc, int] = {}
    if not suspected:
        return found
    moved = modular.B
    for k in range(modular.system.n):
        if k:
            moved = modular.A @ moved
        for arc in _nonzero_blocks(modular, modular.C @ moved):
            found.setdefault(arc, k)
        if suspected <= found.keys():
            break
    return found


def _zero_transfers(
    system: MultiChannelSystem, arcs: set[Arc], rng: random.Random
) -> list[tuple[tuple[int, ...], InvariantSubspace]] | None:
    """Invariant subspaces that prove every other pair to be no arc; None if one is an arc."""
    m = system.m
    groups: dict[tuple[int, ...], list[int]] = {}
    for j in range(m):
        unreached = tuple(i for i in range(m) if (j, i) not in arcs)
        if unreached:
            groups.setdefault(unreached, []).append(j)
    zeros = []
    for unreached, sources in groups.items():
        found = controllable_subspace(system.A, system.input_matrix(sources), rng)
        if not (system.output_matrix(unreached) @ found.X).is_zero():
            return None
        zeros.append((tuple(sources), found))
    return zeros


def zero_transfer(
    system: MultiChannelSystem, sources: Sequence[int], found: InvariantSubspace
) -> ZeroTransfer:
    """The certificate's form of an invariant subspace that contains im B_j for some channels."""
    return ZeroTransfer(channels_from=system.named(sources), X=found.X, pivots=found.pivots)


def strong_components(m: int, arcs: Sequence[Arc]) -> tuple[tuple[int, ...], ...]:
    """Strong components of a graph on 0 … m−1, each ascending, sorted by first member."""
    import networkx

    graph = networkx.DiGraph()
    graph.add_nodes_from(range(m))
    graph.add_edges_from(arcs)
    return tuple(sorted(tuple(sorted(c)) for c in networkx.strongly_connected_components(graph)))


def _result(
    system: MultiChannelSystem,
    modulus: int,
    powers: dict[Arc, int],
    zeros: list[tuple[tuple[int, ...], InvariantSubspace]],
) -> TransferGraph:
    arcs = sorted(powers)
    names = system.names
    components = tuple(system.named(c) for c in strong_components(system.m, arcs))
    return TransferGraph(
        system,
        arcs=tuple((names[j], names[i]) for j, i in arcs),
        components=components,
        strongly_connected=len(components) <= 1,
        modulus=modulus,
        powers=tuple(powers[arc] for arc in arcs),
        zeros=tuple(zero_transfer(system, sources, found) for sources, found in zeros),
    )
