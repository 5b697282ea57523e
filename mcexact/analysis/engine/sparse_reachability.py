"""The transfer graph of large sparse systems, by products with sparse matrices modulo a prime.

Where no path leads from the inputs of a channel to the outputs of another, no transfer does, and
the structure of the matrices is the evidence.  Where one does, a Markov parameter that is not 0
modulo a prime is an edge; all columns of A^k B are computed at once, for one k after the other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from mcexact.errors import LimitReached
from mcexact.exact.krylov import SparseLoop, reduce
from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Flags = npt.NDArray[np.bool_]
    Integers = npt.NDArray[np.int64]

# Modulo small primes the checker adds up whole rows as long integers, a byte for each column.
_MODULI = (31, 61, 53)
# Up to this size the evidence is what dense matrices give.
_SMALL = 128
# The numbers of a table A^k B, in single precision, and the products of all of them.
_MOST_NUMBERS = 2**28
_MOST_PRODUCTS = 2**38


def is_large_and_sparse(system: MultiChannelSystem) -> bool:
    """Whether the structure of the matrices is looked at first."""
    return system.n > _SMALL and system.A.is_sparse


def is_connected(edges: Flags) -> bool:
    """Whether a graph, an entry for each edge, is strongly connected."""
    from scipy.sparse.csgraph import connected_components

    return len(edges) < 2 or connected_components(edges, connection="strong")[0] == 1


def edge_modulus(system: MultiChannelSystem) -> int | None:
    """A small prime that divides no denominator, for which all sums are exact, if there is one."""
    parts = [system.A, *(M for c in system.channels for M in (c.B, c.C))]
    longest = max((_longest_row(M) for M in parts), default=0)
    usable = (
        ell
        for ell in _MODULI
        if longest * (ell // 2 + 3) ** 2 < 2**24 and all(M.denominator % ell for M in parts)
    )
    return next(usable, None)


def _longest_row(M: Matrix) -> int:
    return max(Counter(i for i, _, _ in M.nonzero()).values(), default=0)


def reachable_pairs(system: MultiChannelSystem) -> Flags:
    """Whether a path leads from an input of j to an output of i: row j, column i."""
    import numpy as np

    reached, m = _reached(system), system.m
    found = np.zeros((m, m), dtype=np.bool_)
    for i, channel in enumerate(system.channels):
        mask = 0
        for b in {b for _, b, _ in channel.C.nonzero()}:
            mask |= reached[b]
        sources = np.frombuffer(mask.to_bytes(m // 8 + 1, "little"), dtype=np.uint8)
        found[:, i] = np.unpackbits(sources, bitorder="little")[:m]
    return found


def _reached(system: MultiChannelSystem) -> list[int]:
    """For each state the channels that drive it, over any path, as bits."""
    reached = [0] * system.n
    for j, channel in enumerate(system.channels):
        for a, _, _ in channel.B.nonzero():
            reached[a] |= 1 << j
    arcs = [(a, b) for a, b, _ in system.A.nonzero() if a != b]
    before: list[int] = []
    while reached != before:
        before = list(reached)
        for a, b in arcs:
            reached[a] |= reached[b]
        arcs.reverse()
    return reached


def sparse_powers(
    system: MultiChannelSystem, ell: int, enough: Callable[[Flags], bool]
) -> Integers:
    """The least k with C_i A^k B_j ≠ 0 modulo ℓ in row j and column i, −1 where none is found.

    Parameters
    ----------
    system : MultiChannelSystem
    ell : int
        One of the moduli of `edge_modulus`.
    enough : function
        Takes the pairs found so far, each time that there are more, and ends the search.

    Raises
    ------
    LimitReached
        If the tables are too large.
    """
    import numpy as np

    channels, n = system.channels, system.n
    loop = SparseLoop(system.A, [c.B for c in channels], [c.C for c in channels], ell)
    width = loop.inputs[-1]
    if n * width > _MOST_NUMBERS:
        raise LimitReached(f"{n} states and {width} inputs have too many Markov parameters")
    V = loop.B.toarray().astype(np.float32)
    A, seen = loop.A.astype(np.float32), _seen(loop)
    found = np.full((system.m, system.m), -1, dtype=np.int64)
    most = _MOST_PRODUCTS // max(loop.A.nnz * width + n, 1)
    for k in range(min(n, most + 1)):
        if k:
            V = reduce(A @ V, ell)
        new = seen(V) & (found < 0)
        if new.any():
            found[new] = k
            if enough(found >= 0):
                break
    return found


def _seen(loop: SparseLoop) -> Callable[[Any], Flags]:
    """A function that tells for A^k B which channels j act (rows) on which channels i (columns)."""
    import numpy as np

    C = loop.C.astype(np.float32)
    outputs, inputs = _members(loop.outputs), _members(loop.inputs)

    def seen(V: Any) -> Flags:
        nonzero = (reduce(C @ V, loop.ell) % loop.ell != 0).astype(np.float32)
        found: Flags = (outputs @ nonzero @ inputs.T).T > 0
        return found

    return seen


def _members(offsets: list[int]) -> Any:
    """A row for each channel, 1 in the columns of its inputs or outputs."""
    import numpy as np
    import scipy.sparse as sp

    owners = np.repeat(np.arange(len(offsets) - 1), np.diff(offsets))
    shape = len(offsets) - 1, len(owners)
    return sp.csr_array((np.ones(len(owners), np.float32), (owners, np.arange(len(owners)))), shape)
