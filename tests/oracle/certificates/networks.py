"""Shared sub-states over links with delays: the systems of the paper's sections V-A and V-B."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from flint import fmpq, fmpq_mat

from .reading import demand
from .systems import System

Signal = tuple[str, int, int]
"""Whether a state or an output is meant, of which agent, and from how many steps ago."""


class Layout:
    """Positions of signals in a state, and the matrices that follow from who becomes what."""

    def __init__(self, system: System, signals: Sequence[tuple[Signal, int]]) -> None:
        self.system, self.start, self.size = system, {}, {}
        total = system.n
        for signal, size in signals:
            self.start[signal], self.size[signal] = total, size
            total += size
        self.total = total

    def rows(self, signal: Signal) -> list[list[fmpq]]:
        """A signal as rows over the state; an output of this step is C_j x."""
        if signal not in self.start:
            kind, j, steps = signal
            demand((kind, steps) == ("y", 0), "no such signal")
            zeros = [fmpq(0)] * (self.total - self.system.n)
            return [[*row, *zeros] for row in self.system.C[j].tolist()]
        first = self.start[signal]
        return [
            [fmpq(int(k == first + i)) for k in range(self.total)] for i in range(self.size[signal])
        ]

    def built(
        self, sizes: Sequence[int], received: Sequence[Sequence[Signal]]
    ) -> tuple[fmpq_mat, tuple[fmpq_mat, ...], tuple[fmpq_mat, ...]]:
        """A, B_i and C_i: x_i(t) is set by an input, everything older shifts."""
        n, total = self.system.n, self.total
        rows = [[*row, *[fmpq(0)] * (total - n)] for row in self.system.A.tolist()]
        for (kind, j, steps), size in self.size.items():
            new = kind == "x" and steps == 0
            rows += (
                [[fmpq(0)] * total for _ in range(size)] if new else self.rows((kind, j, steps - 1))
            )
        A = fmpq_mat(total, total, [v for row in rows for v in row])
        B, C = [], []
        for i, size in enumerate(sizes):
            own, p = self.system.B[i].tolist(), self.system.B[i].ncols()
            first = self.start["x", i, 0]
            entries = [
                own[r][c] if r < n and c < p else int(c >= p and r == first + c - p)
                for r in range(total)
                for c in range(p + size)
            ]
            B.append(fmpq_mat(total, p + size, entries))
            outputs = [row for signal in received[i] for row in self.rows(signal)]
            C.append(fmpq_mat(len(outputs), total, [v for row in outputs for v in row]))
        return A, tuple(B), tuple(C)


def longest(system: System) -> list[int]:
    """d_j, the largest d_ij over the followers i of j."""
    return [
        max((d for (_, sender), d in system.delays.items() if sender == j), default=0)
        for j in range(system.m)
    ]


def lifted(system: System, sizes: Sequence[int], outputs: bool) -> System:
    """Section V-A, with or without the outputs of neighbors."""
    graph, m = system.graph(), system.m
    demand(system.time == "discrete", "expected discrete time")
    signals: list[tuple[Signal, int]] = []
    for j, d in enumerate(longest(system)):
        signals += [(("x", j, k), sizes[j]) for k in range(d + 1)]
        if outputs:
            signals += [(("y", j, k), system.C[j].nrows()) for k in range(1, d + 1)]
    received: list[list[Signal]] = []
    for i in range(m):
        late = {j: system.delays.get((i, j), 0) for j in graph[i]}
        if outputs:
            first: list[Signal] = [("y", j, 0) for j in graph[i] if not late[j]]
            first += [("y", j, late[j]) for j in graph[i] if late[j]]
        else:
            first = [("y", i, 0)]
        received.append(first + [("x", j, late[j]) for j in graph[i]])
    A, B, C = Layout(system, signals).built(sizes, received)
    return replace(system, A=A, B=B, C=C)


def held(system: System, sizes: Sequence[int]) -> System:
    """Section V-B: every x_j is used by all as old as its slowest follower receives it."""
    graph = system.graph()
    demand(system.time == "discrete", "expected discrete time")
    late = longest(system)
    signals: list[tuple[Signal, int]] = [
        (("x", j, k), sizes[j]) for j, d in enumerate(late) for k in range(d + 1)
    ]
    received: list[list[Signal]] = [
        [("y", i, 0), *(("x", j, late[j]) for j in graph[i])] for i in range(system.m)
    ]
    A, B, C = Layout(system, signals).built(sizes, received)
    return replace(system, A=A, B=B, C=C)
