"""Paths from inputs to outputs through entries that are not 0; ``proofs/transfer_graph.md``."""

from collections.abc import Iterable

from .budget import spend
from .sparse import entries_of
from .system import System


def without_path(system: System, pairs: Iterable[tuple[int, int]]) -> set[tuple[int, int]]:
    """Those pairs (j, i) for which no path leads from an input of j to an output of i.

    The states on the paths from j hold what j drives, A does not leave them, and C_i is 0 there.

    Theorem ``transfer_graph.closed_states_no_arc``.
    """
    reached = [0] * system.n  # sets of channels, as bits
    for j, B in enumerate(system.B):
        for a, _, _ in entries_of(B):
            reached[a] |= 1 << j
    arcs = entries_of(system.A)
    before: list[int] = []
    while reached != before:
        spend(40 * (len(arcs) + system.n) + (len(arcs) + system.n) * system.m // 100)
        before = list(reached)
        for a, b, _ in arcs:
            reached[a] |= reached[b]
        arcs = arcs[::-1]
    seen = [0] * system.m
    for i, C in enumerate(system.C):
        for _, b, _ in entries_of(C):
            seen[i] |= reached[b]
    return {(j, i) for j, i in pairs if not seen[i] >> j & 1}
