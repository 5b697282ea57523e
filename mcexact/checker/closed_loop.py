"""Construction ``closed_loop``: the plant and the programs of its agents, as one matrix."""

from __future__ import annotations

from itertools import accumulate
from typing import Any

from .arithmetic import Matrix, stack
from .budget import spend, table
from .reading import fields, integer, items, require
from .system import System, read_matrix

MAPS = ("shared_update", "private_update", "input")
USED = ("shared", "outputs", "private", "reference")
Signal = tuple[str, int, int]
"""(signal, j, age): signal is "X" for the plant's state, "x", "y" or "z" for x_j, y_j, z_j."""


def closed_loop(system: System, step: dict[str, Any], place: str) -> System:
    """State (x, x_1, z_1, x_2, …), then for each j the x_j(t−1), …, y_j(t−1), … that are in use.

    Open: see ``proofs/OPEN.md``.
    """
    time, listed = fields(*fields(step, place, "controller"), place, "time", "agents")
    agents, m = items(listed, place, system.m), system.m
    width = {"X": [system.n], "x": [0] * m, "y": [C_j.nrows for C_j in system.C], "z": [0] * m}
    for j, agent in enumerate(agents):
        name, *sizes = fields(agent, place, "name", "shared", "private", *MAPS, optional=("hold",))
        fits = time == system.time and name == system.names[j]
        require(fits, "subject", place, "expected a controller for these agents and this time")
        width["x"][j], width["z"][j] = integer(sizes[0], place), integer(sizes[1], place)
    terms = [_terms(system, agents, i, width, place) for i in range(m)]
    used = {signal for maps in terms for found in maps for signal, _ in found}
    spend(30 * m * len(used))
    order: list[Signal] = [("X", 0, 0), *((what, j, 0) for j in range(m) for what in "xz")]
    for what, j in ((what, j) for j in range(m) for what in "xy"):
        oldest = max((age for w, k, age in used if (w, k) == (what, j)), default=0)
        spend(500 * oldest)
        order += [(what, j, age + 1) for age in range(oldest)]
    widths = [width[what][j] for what, j, _ in order]
    total, starts = sum(widths), accumulate(widths, initial=0)
    spend(table(total, total))
    reads = {s: Matrix.unit_rows(total, *part) for s, *part in zip(order, starts, widths)}  # noqa: B905
    reads |= {("y", j, 0): C_j @ reads["X", 0, 0] for j, C_j in enumerate(system.C)}

    def computed(i: int, k: int, nrows: int) -> Matrix:
        return sum((M @ reads[s] for s, M in terms[i][k]), Matrix.zeros(nrows, total))

    rows = [system.A @ reads["X", 0, 0]]
    for i, B_i in enumerate(system.B):
        rows[0] += B_i @ computed(i, 2, B_i.ncols)
        rows += [computed(i, 0, width["x"][i]), computed(i, 1, width["z"][i])]
    rows += [reads[what, j, age - 1] for what, j, age in order if age]
    words, A = f"the closed loop of {system.words} and the controller given", stack(rows, total)
    return System(time, [], A, [], [], words=words, blocks=tuple(widths[: 2 * m + 1]))


def _terms(
    system: System, agents: list[Any], i: int, width: dict[str, list[int]], place: str
) -> list[list[tuple[Signal, Matrix]]]:
    """The signals that the three maps of agent i use, with their coefficients."""
    N_i, result = system.neighbors[i] if system.neighbors else [i], []
    for label, nrows in zip(MAPS, (width["x"][i], width["z"][i], system.B[i].ncols), strict=True):
        where, found = f"{place}.{label}", []
        shared, outputs, z, reference = fields(agents[i][label], where, optional=USED)
        for what, given in (("x", shared), ("y", outputs)):
            for j, M in _by_agent(given, where, system):
                steps = dict(_by_agent(agents[j].get("hold"), where, system)).get(i, 0)
                age = system.delays.get((i, j), 0) + integer(steps, where) * (what == "x")
                right = j in N_i and (not age or system.time == "discrete")
                require(right, "subject", where, f"agent {i + 1} does not get this from {j + 1}")
                found.append(((what, j, age), read_matrix(M, where, nrows, width[what][j])))
        for what, M in (part for part in (("z", z), ("y", reference)) if part[1] is not None):
            found.append(((what, i, 0), read_matrix(M, where, nrows, width[what][i])))
        result.append(found if reference is None else found[:-1])
    return result


def _by_agent(value: Any, place: str, system: System) -> list[tuple[int, Any]]:
    given = fields({} if value is None else value, place, optional=tuple(system.names))
    return [(j, entry) for j, entry in enumerate(given) if entry is not None]
