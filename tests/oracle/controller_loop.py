"""The matrix of a closed loop, from the text of a controller file alone, by entries.

It shares nothing with the package but the file format: plain JSON, Fractions, nested lists.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

Rows = list[list[Fraction]]


def rows_of(value: Any) -> Rows:
    """A matrix of a file: a list of rows, or an object that lists its entries."""
    if isinstance(value, dict):
        r, c = value["shape"]
        table = [[Fraction(0)] * c for _ in range(r)]
        for i, j, entry in value["entries"]:
            table[i][j] = Fraction(entry)
        return table
    return [[Fraction(entry) for entry in row] for row in value]


class _Ledger:
    """Positions of the parts of the state, and the rows that say what each becomes."""

    def __init__(self) -> None:
        self.start: dict[tuple[Any, ...], int] = {}
        self.size: dict[tuple[Any, ...], int] = {}
        self.total = 0

    def place(self, key: tuple[Any, ...], size: int) -> None:
        self.start[key], self.size[key] = self.total, size
        self.total += size


def loop_rows(system: Mapping[str, Any], text: str) -> Rows:
    """The matrix of the loop; state (x, x_1, z_1, …, x_m, z_m), then delayed x_j and y_j.

    Parameters
    ----------
    system : mapping
        A system file, parsed.
    text : str
        A controller file.
    """
    agents = json.loads(text)["agents"]
    names = [agent["name"] for agent in agents]
    channels = {channel["name"]: channel for channel in system["channels"]}
    A = rows_of(system["A"])
    B = {name: rows_of(channels[name]["B"]) for name in names}
    C = {name: rows_of(channels[name]["C"]) for name in names}
    delays = system.get("delays", {})
    hold = {agent["name"]: agent.get("hold", {}) for agent in agents}

    def age(kind: str, j: str, i: str) -> int:
        link = delays.get(i, {}).get(j, 0)
        return int(link + (hold[j].get(i, 0) if kind == "shared" else 0))

    ledger = _Ledger()
    ledger.place(("plant",), len(A))
    for agent in agents:
        ledger.place(("shared", agent["name"], 0), agent["shared"])
        ledger.place(("private", agent["name"]), agent["private"])
    for sender in agents:
        j = sender["name"]
        for kind, size in (("shared", sender["shared"]), ("outputs", len(C[j]))):
            ages = [
                age(kind, j, agent["name"])
                for agent in agents
                for label in ("shared_update", "private_update", "input")
                if j in agent[label].get(kind, {})
            ]
            for steps in range(1, max(ages, default=0) + 1):
                ledger.place((kind, j, steps), size)
    total = ledger.total

    def read(kind: str, j: str, steps: int) -> Rows:
        """The signal as rows over the whole state."""
        if kind == "outputs" and not steps:
            return [row + [Fraction(0)] * (total - len(row)) for row in C[j]]
        return unit((kind, j, steps))

    def unit(key: tuple[Any, ...]) -> Rows:
        start, size = ledger.start[key], ledger.size[key]
        return [[Fraction(int(k == start + i)) for k in range(total)] for i in range(size)]

    def times(M: Rows, rows: Rows) -> Rows:
        return [
            [sum((m * rows[k][c] for k, m in enumerate(row)), Fraction(0)) for c in range(total)]
            for row in M
        ]

    def add(a: Rows, b: Rows) -> Rows:
        return [[x + y for x, y in zip(r, s, strict=True)] for r, s in zip(a, b, strict=True)]

    def computed(agent: Mapping[str, Any], label: str, nrows: int) -> Rows:
        name, program = agent["name"], agent[label]
        result = [[Fraction(0)] * total for _ in range(nrows)]
        for kind in ("outputs", "shared"):
            for j, M in program.get(kind, {}).items():
                result = add(result, times(rows_of(M), read(kind, j, age(kind, j, name))))
        if "private" in program:
            result = add(result, times(rows_of(program["private"]), unit(("private", name))))
        return result

    plant = times(A, unit(("plant",)))
    for agent in agents:
        name = agent["name"]
        if B[name]:
            plant = add(plant, times(B[name], computed(agent, "input", len(B[name][0]))))
    matrix = plant
    for agent in agents:
        matrix = matrix + computed(agent, "shared_update", agent["shared"])
        matrix = matrix + computed(agent, "private_update", agent["private"])
    for key in list(ledger.start)[1 + 2 * len(agents) :]:
        kind, j, steps = key
        matrix = matrix + read(kind, j, steps - 1)
    return matrix


def applied(matrix: Rows, state: list[Fraction]) -> list[Fraction]:
    """The product of a matrix and a column."""
    return [sum((a * x for a, x in zip(row, state, strict=True)), Fraction(0)) for row in matrix]
