"""The loop of a plant and the programs of its agents, as a system without channels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

from flint import fmpq, fmpq_mat

from .reading import demand, integer, listed, record, text, typed
from .systems import System

MAPS = ("shared_update", "private_update", "input")


@dataclass
class Agent:
    """One program: x_i and z_i, the maps that update them and set u_i, and what it holds."""

    shared: int
    private: int
    maps: dict[str, dict[tuple[str, int], fmpq_mat]] = field(default_factory=dict)
    hold: dict[int, int] = field(default_factory=dict)


def read_agents(system: System, value: Any) -> list[Agent]:
    """The programs of a controller for a plant, all matrices with their shapes."""
    found = record(value, "time", "agents")
    demand(bool(found["agents"]), "expected at least one agent")
    demand(found["time"] == system.time, "expected the time of the plant")
    documents = [
        record(a, "name", "shared", "private", *MAPS, optional=("hold",))
        for a in listed(found["agents"], system.m)
    ]
    demand(tuple(text(a["name"]) for a in documents) == system.names, "expected an agent a channel")
    agents = [Agent(integer(a["shared"], 0), integer(a["private"], 0)) for a in documents]
    for i, (agent, document) in enumerate(zip(agents, documents, strict=True)):
        sizes = (agent.shared, agent.private, system.B[i].ncols())
        for label, size in zip(MAPS, sizes, strict=True):
            agent.maps[label] = _read_map(system, agents, i, document[label], size)
        for receiver, steps in _by_name(document.get("hold", {}), system.names).items():
            agent.hold[receiver] = integer(steps, 0)
    return agents


def _read_map(
    system: System, agents: Sequence[Agent], i: int, value: Any, nrows: int
) -> dict[tuple[str, int], fmpq_mat]:
    found = record(value, optional=("outputs", "shared", "private", "reference"))
    neighborhood = (system.neighborhoods or [(k,) for k in range(system.m)])[i]
    parts: dict[tuple[str, int], fmpq_mat] = {}
    for kind in ("outputs", "shared"):
        for j, M in _by_name(found.get(kind, {}), system.names).items():
            width = system.C[j].nrows() if kind == "outputs" else agents[j].shared
            parts[kind, j] = sparse(M, nrows, width)
    if "private" in found:
        parts["private", i] = sparse(found["private"], nrows, agents[i].private)
    if "reference" in found:
        parts["reference", i] = sparse(found["reference"], nrows, system.C[i].nrows())
    # Who does not act on a signal does not use it.
    parts = {signal: M for signal, M in parts.items() if any(M.entries())}
    demand(all(j in neighborhood for _, j in parts), "expected signals of neighbors")
    return parts


def _by_name(value: Any, names: Sequence[str]) -> dict[int, Any]:
    demand(isinstance(value, Mapping), "expected an object with names of agents")
    demand(set(value) <= set(names), "expected names of agents")
    return {list(names).index(name): part for name, part in value.items()}


def sparse(value: Any, nrows: int, ncols: int) -> fmpq_mat:
    """A matrix of a controller file: rows, or a shape and entries [i, j, value]."""
    result = fmpq_mat(nrows, ncols)
    if isinstance(value, Mapping):
        found = record(value, "shape", "entries")
        demand([integer(v, 0) for v in listed(found["shape"], 2)] == [nrows, ncols], "shape")
        seen = set()
        for i, j, entry in (listed(e, 3) for e in listed(found["entries"])):
            demand(0 <= integer(i) < nrows and 0 <= integer(j) < ncols, "expected a position")
            demand((i, j) not in seen, "expected every entry once")
            seen.add((i, j))
            result[i, j] = typed(entry)
        return result
    for i, row in enumerate(listed(value, nrows)):
        for j, entry in enumerate(listed(row, ncols)):
            result[i, j] = typed(entry)
    return result


Signal = tuple[str, int, int]


class Loop:
    """The whole state, signal by signal, and the rows that say what each becomes."""

    def __init__(self, system: System, agents: Sequence[Agent]) -> None:
        self.system, self.agents = system, agents
        self.start: dict[Signal, int] = {}
        self.size: dict[Signal, int] = {}
        self.total = 0
        self._place(("plant", 0, 0), system.n)
        for i, agent in enumerate(agents):
            self._place(("shared", i, 0), agent.shared)
            self._place(("private", i, 0), agent.private)
        for j in range(system.m):
            for kind in ("shared", "outputs"):
                width = agents[j].shared if kind == "shared" else system.C[j].nrows()
                used = [
                    self.age(kind, j, i)
                    for i, agent in enumerate(agents)
                    for parts in agent.maps.values()
                    if (kind, j) in parts
                ]
                for steps in range(1, max(used, default=0) + 1):
                    self._place((kind, j, steps), width)

    def _place(self, signal: Signal, size: int) -> None:
        self.start[signal], self.size[signal] = self.total, size
        self.total += size

    def age(self, kind: str, j: int, i: int) -> int:
        """How old the signal of j is when i uses it."""
        held = self.agents[j].hold.get(i, 0) if kind == "shared" else 0
        return self.system.delays.get((i, j), 0) + held

    def signal(self, signal: Signal) -> fmpq_mat:
        """A signal as rows over the whole state."""
        kind, j, steps = signal
        if (kind, steps) == ("outputs", 0) and self.system.D is not None:
            before = sum(C.nrows() for C in self.system.C[:j])
            rows = self.at_once.tolist()[before : before + self.system.C[j].nrows()]
            return fmpq_mat(len(rows), self.total, [v for row in rows for v in row])
        if (kind, steps) == ("outputs", 0):
            C, width = self.system.C[j].tolist(), self.total
            rows = [[*row, *[fmpq(0)] * (width - len(row))] for row in C]
            return fmpq_mat(len(rows), width, [v for row in rows for v in row])
        first, size = self.start[signal], self.size[signal]
        return fmpq_mat(
            size,
            self.total,
            [int(k == first + i) for i in range(size) for k in range(self.total)],
        )

    @cached_property
    def at_once(self) -> fmpq_mat:
        """All outputs of a plant with feedthrough: y = C x + D (K y + …), solved for y."""
        system, D = self.system, self.system.D
        q, p, m = ([M.nrows() for M in system.C], [M.ncols() for M in system.B], system.m)
        K, rest = fmpq_mat(sum(p), sum(q)), []
        for i, agent in enumerate(self.agents):
            maps = agent.maps["input"]
            now = {("outputs", j) for j in range(m) if self.age("outputs", j, i) == 0}
            for _, j in now & maps.keys():
                for a in range(p[i]):
                    for b in range(q[j]):
                        K[sum(p[:i]) + a, sum(q[:j]) + b] = maps["outputs", j][a, b]
            later = {signal: M for signal, M in maps.items() if signal not in now}
            own = replace(agent, maps={**agent.maps, "input": later})
            agents = [own if k == i else other for k, other in enumerate(self.agents)]
            rest += Loop(system, agents)._over(self).computed(i, "input", p[i]).tolist()
        x = self.signal(("plant", 0, 0))
        known = system.outputs() * x
        known += D * fmpq_mat(sum(p), self.total, [v for row in rest for v in row])
        inner = -(D * K)
        for k in range(sum(q)):
            inner[k, k] = inner[k, k] + 1
        demand(inner.det() != 0, "expected a loop that is well posed")
        return inner.inv() * known

    def _over(self, other: Loop) -> Loop:
        """The same maps, over the state of another loop."""
        self.start, self.size, self.total = other.start, other.size, other.total
        return self

    def computed(self, i: int, label: str, nrows: int) -> fmpq_mat:
        """What a map of agent i gives, as rows over the whole state."""
        result = fmpq_mat(nrows, self.total)
        for (kind, j), M in self.agents[i].maps[label].items():
            if kind == "reference":
                continue  # a set-point is an input from outside, not a part of the loop
            steps = 0 if kind == "private" else self.age(kind, j, i)
            demand(steps == 0 or self.system.time == "discrete", "a delay in continuous time")
            result = result + M * self.signal((kind, j, steps))
        return result

    def matrix(self) -> fmpq_mat:
        """What every part of the state becomes."""
        plant = self.system.A * self.signal(("plant", 0, 0))
        for i, B in enumerate(self.system.B):
            plant = plant + B * self.computed(i, "input", B.ncols())
        rows = plant.tolist()
        for signal, size in list(self.size.items())[1:]:
            kind, i, steps = signal
            if steps:
                rows += self.signal((kind, i, steps - 1)).tolist()
            else:
                rows += self.computed(i, f"{kind}_update", size).tolist()
        return fmpq_mat(self.total, self.total, [v for row in rows for v in row])


def closed_loop(system: System, value: Any) -> System:
    """No channels; A is the matrix of the whole loop."""
    loop = Loop(system, read_agents(system, value))
    return System(system.time, loop.matrix(), (), (), ())
