"""The transfer graph modulo a prime, and subspaces that prove the absence of edges."""

from __future__ import annotations

import random
from collections.abc import Sequence

from mcexact.answer.evidence import ZeroTransfer
from mcexact.derived.modular import ModularSystem
from mcexact.exact.krylov import InvariantSubspace
from mcexact.exact.modular import ModularMatrix
from mcexact.model.system import MultiChannelSystem

Edge = tuple[int, int]


def _channel_of(ranges: Sequence[range]) -> list[int]:
    return [i for i, positions in enumerate(ranges) for _ in positions]


def _nonzero_blocks(modular: ModularSystem, G: ModularMatrix) -> set[Edge]:
    """The pairs (j, i) with a nonzero block (i, j) of a Σ q_i × Σ p_i matrix."""
    sources, targets = _channel_of(modular.inputs), _channel_of(modular.outputs)
    found: set[Edge] = set()
    for i, row in zip(targets, G.rows(), strict=True):
        found.update((j, i) for j, value in zip(sources, row, strict=True) if value)
    return found


def suspected_edges(modular: ModularSystem, rng: random.Random) -> set[Edge]:
    """The pairs (j, i) with C_i (zI − A)⁻¹ B_j ≠ 0 modulo ℓ at a drawn z.

    Parameters
    ----------
    modular : ModularSystem
        The system modulo a prime ℓ.
    rng : random.Random
        Draws z again until zI − A is invertible modulo ℓ.

    Notes
    -----
    Each pair is an edge of the transfer graph over Q.  An edge is missed if its transfer matrix
    vanishes modulo ℓ at z, so a pair that is missing proves nothing.
    """
    n, ell = modular.system.n, modular.modulus
    if n == 0 or not modular.B.ncols or not modular.C.nrows:
        return set()
    while True:
        resolvent = ModularMatrix.scalar(n, rng.randrange(ell), ell) - modular.A
        inverse = resolvent.inverse()
        if inverse is not None:
            return _nonzero_blocks(modular, (modular.C @ inverse) @ modular.B)


def witnessed_powers(modular: ModularSystem, suspected: set[Edge]) -> dict[Edge, int]:
    """The least k with C_i A^k B_j ≠ 0 modulo ℓ, for every pair (j, i) that has one below n.

    Parameters
    ----------
    modular : ModularSystem
    suspected : set of (int, int)
        The search ends as soon as each of these pairs has its k; other pairs found are kept.

    Notes
    -----
    The rational C_i A^k B_j is then not 0 either, so k proves the edge j → i.
    """
    found: dict[Edge, int] = {}
    if not suspected:
        return found
    moved = modular.B
    for k in range(modular.system.n):
        if k:
            moved = modular.A @ moved
        for edge in _nonzero_blocks(modular, modular.C @ moved):
            found.setdefault(edge, k)
        if suspected <= found.keys():
            break
    return found


def zero_transfer(
    system: MultiChannelSystem, sources: Sequence[int], found: InvariantSubspace
) -> ZeroTransfer:
    """Make the evidence of an invariant subspace that contains im B_j for some channels."""
    return ZeroTransfer(channels_from=system.named(sources), X=found.X, pivots=found.pivots)


def strong_components(m: int, edges: Sequence[Edge]) -> tuple[tuple[int, ...], ...]:
    """Strong components of a graph on 0 … m−1, each ascending, sorted by first member.

    Parameters
    ----------
    m : int
    edges : sequence of (int, int)
        (j, i) is the edge j → i.

    Examples
    --------
    >>> strong_components(3, [(0, 1), (1, 0), (1, 2)])
    ((0, 1), (2,))
    """
    import networkx

    graph = networkx.DiGraph()
    graph.add_nodes_from(range(m))
    graph.add_edges_from(edges)
    return tuple(sorted(tuple(sorted(c)) for c in networkx.strongly_connected_components(graph)))
