"""Structural fixed modes by their definition, and by enumeration of all permutations.

A pattern says where the entries of A, B_i and C_i may differ from 0, and whose outputs each agent
feeds back.  `drawn_fixed_polynomial` fills it with numbers modulo a large prime and computes what
all loops have in common; `least_at_zero` and `without_feedback` look at every permutation and at
every path.  Nothing here imports the package.
"""

from __future__ import annotations

import itertools
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

PRIME = 2**61 - 1
Table = list[list[int]]


@dataclass(frozen=True)
class Pattern:
    """Where entries may differ from 0: A is n × n, B_i n × p_i, C_i q_i × n, as 0 or 1.

    ``used[i]`` are the channels whose outputs agent i feeds back.
    """

    A: Table
    B: list[Table]
    C: list[Table]
    used: list[list[int]]

    @property
    def n(self) -> int:
        """The number of states."""
        return len(self.A)

    @property
    def m(self) -> int:
        """The number of channels."""
        return len(self.B)

    def width(self, i: int) -> int:
        """The number of inputs of a channel."""
        return len(self.B[i][0]) if self.n else 0

    def places(self) -> Iterator[tuple[str | tuple[str, int, int], ...]]:
        """The edges of the digraph of states, inputs and outputs: from one node to another."""
        for a, b in itertools.product(range(self.n), repeat=2):
            if self.A[a][b]:
                yield ("x", 0, b), ("x", 0, a)
        for i in range(self.m):
            for a, k in itertools.product(range(self.n), range(self.width(i))):
                if self.B[i][a][k]:
                    yield ("u", i, k), ("x", 0, a)
            for k, b in itertools.product(range(len(self.C[i])), range(self.n)):
                if self.C[i][k][b]:
                    yield ("x", 0, b), ("y", i, k)
            for j in self.used[i]:
                for k, r in itertools.product(range(self.width(i)), range(len(self.C[j]))):
                    yield ("y", j, r), ("u", i, k)

    def nodes(self) -> list[tuple[str, int, int]]:
        """All states, inputs and outputs."""
        inputs = [("u", i, k) for i in range(self.m) for k in range(self.width(i))]
        outputs = [("y", i, k) for i in range(self.m) for k in range(len(self.C[i]))]
        return [*(("x", 0, a) for a in range(self.n)), *inputs, *outputs]


def drawn_pattern(rng: random.Random, states: int = 4, channels: int = 3) -> Pattern:
    """At most so many states and channels, and 8 nodes, often with fixed modes.

    In half of them one state is the only one that drives others and is driven by others, so that
    disjoint cycles seldom cover all.
    """
    while True:
        found = _drawn(rng, rng.randint(1, states), rng.randint(1, channels))
        if len(found.nodes()) <= 8:
            return found


def _drawn(rng: random.Random, n: int, m: int) -> Pattern:
    density, ports = rng.choice([0.15, 0.3, 0.5]), rng.choice([0.2, 0.4])

    def table(rows: int, columns: int, part: float) -> Table:
        return [[int(rng.random() < part) for _ in range(columns)] for _ in range(rows)]

    p, q = ([rng.choice([0, 1, 1, 1, 2]) for _ in range(m)] for _ in range(2))
    linked = rng.random() < 0.3
    used = [[j for j in range(m) if i == j or (linked and rng.random() < 0.3)] for i in range(m)]
    A = table(n, n, density)
    if rng.random() < 0.5:
        A = [[int(a == 0 or b == 0) * (a != b) for b in range(n)] for a in range(n)]
    return Pattern(
        A,
        [table(n, p[i], ports) for i in range(m)],
        [table(q[i], n, ports) for i in range(m)],
        used,
    )


def without_feedback(pattern: Pattern) -> list[int]:
    """The states on no closed path through an input and an output."""
    nodes, edges = pattern.nodes(), set(pattern.places())
    reached = {(a, b): (a, b) in edges for a, b in itertools.product(nodes, repeat=2)}
    for k, a, b in itertools.product(nodes, repeat=3):
        reached[a, b] = reached[a, b] or (reached[a, k] and reached[k, b])
    inputs = [node for node in nodes if node[0] == "u"]
    return [
        a
        for a in range(pattern.n)
        if not any(reached[("x", 0, a), u] and reached[u, ("x", 0, a)] for u in inputs)
    ]


def least_at_zero(pattern: Pattern) -> int:
    """How many states with feedback disjoint cycles leave out at least, over all permutations."""
    apart = without_feedback(pattern)
    left = [node for node in pattern.nodes() if node[0] != "x" or node[2] not in apart]
    edges, best = set(pattern.places()), len(left)
    for order in itertools.permutations(left):
        out = [a for a, b in zip(left, order, strict=True) if a == b and (a, a) not in edges]
        if all(a == b or (b, a) in edges for a, b in zip(left, order, strict=True)):
            best = min(best, sum(node[0] == "x" for node in out))
    return best


def drawn_fixed_polynomial(rng: random.Random, pattern: Pattern) -> tuple[list[int], list[int]]:
    """What det(xI − A − Σ B_i F_ij C_j) has in common for drawn F_ij, and det(xI − A_UU) x^z.

    Both have drawn numbers at the places of the pattern, modulo a prime.
    """
    A, *_ = tables = [_filled(rng, M) for M in (pattern.A, *pattern.B, *pattern.C)]
    B, C = tables[1 : pattern.m + 1], tables[pattern.m + 1 :]
    common: list[int] = []
    for _ in range(pattern.n + 2):
        loop = [row[:] for row in A]
        for i in range(pattern.m):
            for j in pattern.used[i]:
                ones = [[1] * len(C[j]) for _ in range(pattern.width(i))]
                step = _product(B[i], _product(_filled(rng, ones), C[j], pattern.n), pattern.n)
                loop = [
                    [x + y for x, y in zip(*rows, strict=True)]
                    for rows in zip(loop, step, strict=True)
                ]
        common = _divisor(common, characteristic(loop))
    U = without_feedback(pattern)
    own = characteristic([[A[a][b] for b in U] for a in U])
    return common, [0] * least_at_zero(pattern) + own


def _filled(rng: random.Random, M: Table) -> Table:
    return [[rng.randrange(1, PRIME) if place else 0 for place in row] for row in M]


def _product(M: Table, N: Table, columns: int) -> Table:
    return [
        [sum(x * N[k][j] for k, x in enumerate(row)) % PRIME for j in range(columns)] for row in M
    ]


def characteristic(M: Table) -> list[int]:
    """det(xI − M) modulo the prime, by Faddeev and LeVerrier, constant term first."""
    n = len(M)
    found, N = [1], [[0] * n for _ in range(n)]
    for k in range(1, n + 1):
        N = _product(M, N, n)
        for a in range(n):
            N[a][a] += found[-1]
        trace = sum(_product(M, N, n)[a][a] for a in range(n))
        found.append(-trace * pow(k, -1, PRIME) % PRIME)
    return found[::-1]


def _divisor(f: Sequence[int], g: Sequence[int]) -> list[int]:
    """The monic greatest common divisor modulo the prime; () stands for 0."""
    a, b = list(f), list(g)
    while b:
        inverse = pow(b[-1], -1, PRIME)
        while len(a) >= len(b):
            factor, shift = a[-1] * inverse % PRIME, len(a) - len(b)
            for k, x in enumerate(b):
                a[shift + k] = (a[shift + k] - factor * x) % PRIME
            while a and not a[-1]:
                a.pop()
        a, b = b, a
    return [x * pow(a[-1], -1, PRIME) % PRIME for x in a]
