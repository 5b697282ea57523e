"""Sparse systems with a planted mode that no channel moves and one channel alone can see."""

from __future__ import annotations

import random
from collections.abc import Mapping

from mcexact.exact.matrix import Matrix
from mcexact.model.system import MultiChannelSystem

Entries = dict[tuple[int, int], int]


def planted(n: int, m: int, seed: int, mode: int = -3, scale: int = 1) -> MultiChannelSystem:
    """A system of n states with the fixed mode, T = {1}, and no other as a rule.

    With u = s e_i − e_j and v = e_k − e_l, A u = λ u, A v = λ v − B_1, and the other channels see
    neither u nor v; scale s.
    """
    rng = random.Random(seed)
    columns: list[dict[int, int]] = [{} for _ in range(n)]
    for a in range(n):
        for b in (a, (a + 1) % n, rng.randrange(n), rng.randrange(n)):
            columns[b][a] = columns[b].get(a, 0) + rng.choice((-1, 1)) * rng.randint(1, 9)
    B = [{rng.randrange(n): rng.randint(1, 9) for _ in range(3)} for _ in range(m)]
    C = [{rng.randrange(n): rng.randint(1, 9) for _ in range(3)} for _ in range(m)]
    i, j, k, ell = rng.sample(range(n), 4)
    columns[j] = _sum(columns[i], scale, {i: -mode * scale, j: mode})
    columns[ell] = _sum(columns[k], 1, {k: -mode, ell: mode}, B[0])
    for seen in C[1:]:
        for left, right, factor in ((i, j, scale), (k, ell, 1)):
            seen.pop(right, None)
            if left in seen:
                seen[right] = seen[left] * factor
    C[0][i], C[0][j] = 2, 0
    return MultiChannelSystem(
        _matrix(n, n, {(a, b): x for b, column in enumerate(columns) for a, x in column.items()}),
        [_matrix(n, 1, {(a, 0): x for a, x in column.items()}) for column in B],
        [_matrix(1, n, {(0, b): x for b, x in row.items()}) for row in C],
    )


def _sum(column: Mapping[int, int], factor: int, *others: Mapping[int, int]) -> dict[int, int]:
    found = {a: factor * x for a, x in column.items()}
    for other in others:
        for a, x in other.items():
            found[a] = found.get(a, 0) + x
    return found


def _matrix(nrows: int, ncols: int, entries: Entries) -> Matrix:
    return Matrix.from_entries((nrows, ncols), [(a, b, x) for (a, b), x in entries.items()])
