"""Agents over graphs that vary, simulated step by step with messages really sent."""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

Column = list[Fraction]
Graph = Sequence[set[int]]


def times(M: Any, x: Sequence[Fraction]) -> Column:
    """The product of a matrix and a column."""
    rows = M.rows() if hasattr(M, "rows") else M
    return [
        sum((Fraction(a) * b for a, b in zip(row, x, strict=True)), Fraction(0)) for row in rows
    ]


def plus(*columns: Sequence[Fraction]) -> Column:
    """The sum of columns."""
    return [sum(entries, Fraction(0)) for entries in zip(*columns, strict=True)]


class Network:
    """A plant with agents whose programs take one step in each window.

    Parameters
    ----------
    plant : MultiChannelSystem
        In discrete time.
    agents : sequence of AgentProgram
        For the system of windows, over links with the delay 1.
    graphs : sequence of lists of sets
        The graphs of one period: ``graphs[t][i]`` is N_i at the steps t, t + T, ….
    window : int
        Q ≥ 2n.
    """

    def __init__(
        self, plant: Any, agents: Sequence[Any], graphs: Sequence[Graph], window: int
    ) -> None:
        self.plant, self.agents, self.graphs, self.window = plant, agents, graphs, window
        self.step = 0
        self.sent = [[[Fraction(0)] * agent.shared] for agent in agents]
        self.private = [[Fraction(0)] * agent.private for agent in agents]
        self.received: list[dict[int, Column]] = [{} for _ in agents]
        for i, heard in enumerate(self._union()):
            self.received[i] = {j: [Fraction(0)] * agents[j].shared for j in heard}

    def _union(self) -> list[set[int]]:
        return [set().union(*(graph[i] for graph in self.graphs)) for i in range(len(self.agents))]

    def _computed(self, i: int, label: str, y: Column, size: int) -> Column:
        """What the program of agent i gives, from what it has at the time."""
        program, agent = getattr(self.agents[i], label), self.agents[i]
        total = [Fraction(0)] * size
        for j, M in program.outputs.items():
            if j != i:
                raise LookupError("an agent uses outputs that were not sent to it")
            total = plus(total, times(M, y))
        for j, M in program.shared.items():
            if j == i:
                age = agent.hold.get(i, 0)
                value = self.sent[i][-1 - age] if age < len(self.sent[i]) else None
                value = [Fraction(0)] * agent.shared if value is None else value
            elif self.agents[j].hold.get(i, 0):
                raise LookupError("an agent holds what it sends")
            else:
                value = self.received[i][j]
            total = plus(total, times(M, value))
        if program.private is not None:
            total = plus(total, times(program.private, self.private[i]))
        return total

    def run(self, x: Column) -> Column:
        """One window, from the state at its beginning to that at its end."""
        plant, n = self.plant, self.plant.n
        measured: list[Column] = [[] for _ in self.agents]
        inputs: list[Column] = [[] for _ in self.agents]
        now: list[dict[int, Column]] = [{} for _ in self.agents]
        for t in range(self.window):
            for i, heard in enumerate(self.graphs[self.step % len(self.graphs)]):
                now[i] |= {j: self.sent[j][-1] for j in heard}
            driven = []
            for i in range(len(self.agents)):
                if t < n:
                    measured[i] += times(plant.C(i), x)
                if t == n - 1:
                    inputs[i] = self._computed(i, "input", measured[i], n * plant.p(i))
                k = t - (self.window - n)
                if k >= 0:
                    part = inputs[i][k * plant.p(i) : (k + 1) * plant.p(i)]
                    driven.append(times(plant.B(i), part))
            x = plus(times(plant.A, x), *driven)
            self.step += 1
        updates = [
            (
                self._computed(i, "shared_update", measured[i], agent.shared),
                self._computed(i, "private_update", measured[i], agent.private),
            )
            for i, agent in enumerate(self.agents)
        ]
        for i, (shared, private) in enumerate(updates):
            self.sent[i].append(shared)
            self.private[i] = private
        self.received = [{j: now[i][j] for j in old} for i, old in enumerate(self.received)]
        return x


def strongly_connected(graph: Graph) -> bool:
    """Whether every agent reaches every other one."""
    m = len(graph)
    for start in range(m):
        reached, new = {start}, {start}
        while new:
            new = {i for i in range(m) if graph[i] & reached} - reached
            reached |= new
        if len(reached) < m:
            return False
    return True


def drawn_graphs(rng: random.Random, m: int, period: int) -> list[list[set[int]]]:
    """The graphs of one period, whose union is strongly connected, each with few of its links."""
    while True:
        density = rng.choice((0.15, 0.3, 0.5))
        graphs = [
            [{j for j in range(m) if j == i or rng.random() < density} for i in range(m)]
            for _ in range(period)
        ]
        if strongly_connected([set().union(*(g[i] for g in graphs)) for i in range(m)]):
            return graphs


def drawn_matrices(rng: random.Random, n: int, m: int) -> Mapping[str, Any]:
    """A, B and C with small entries; often one agent drives what another one measures."""

    def entries(nrows: int, ncols: int, share: float) -> list[list[int]]:
        return [
            [rng.choice((1, -1, 2)) if rng.random() < share else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]

    return {
        "A": entries(n, n, 0.6),
        "B": [entries(n, 1, 0.25) for _ in range(m)],
        "C": [entries(1, n, 0.25) for _ in range(m)],
    }
