"""Construction ``closed_loop``: the plant and the programs of its agents, as one matrix."""

from itertools import accumulate

from .arithmetic import Matrix, stack
from .budget import spend, table
from .controller import MAPS, read_controller
from .reading import Json, fields, require
from .statement import canonical_json, digest_of, prefixed, with_digest
from .system import System

STATES = (("x", "shared"), ("z", "private"))
Signal = tuple[str, int, int]
"""(signal, j, age): signal is "X" for the plant's state, "x", "y" or "z" for x_j, y_j, z_j."""
Terms = list[tuple[Signal, Matrix]]
"""The signals that a map uses, with their coefficients."""


def closed_loop(system: System, step: dict[str, Json], place: str) -> System:
    """State (x, x_1, z_1, x_2, …), then for each j the x_j(t−1), …, y_j(t−1), … that are in use.

    Open: see ``proofs/OPEN.md``.
    """
    (given,) = fields(step, place, "controller")
    controller, m = read_controller(given, place, system), system.m
    agents = controller["agents"]
    fits = controller["time"] == system.time and [a["name"] for a in agents] == system.names
    require(fits, "subject", place, "expected a controller for these agents and this time")
    width = {what: [agent[key] for agent in agents] for what, key in STATES}
    width |= {"X": [system.n], "y": [C_j.nrows for C_j in system.C]}
    terms = [_terms(system, agents, i, place) for i in range(m)]
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
    A, blocks, text = stack(rows, total), tuple(widths[: 2 * m + 1]), canonical_json(controller)
    words = f"the closed loop with the controller with {with_digest(text)}"
    alone = System(system.time, [], A, [], [], words=system.words)
    return prefixed(words, alone, blocks=blocks, controller=digest_of(text))


def _terms(system: System, agents: list[Json], i: int, place: str) -> list[Terms]:
    """The signals that the three maps of agent i use, with their coefficients."""
    N_i, result = system.neighbors[i] if system.neighbors else [i], []
    for label in MAPS:
        used, found = agents[i].get(label, {}), []
        for what, key in (("x", "shared"), ("y", "outputs")):
            for name, M in used.get(key, {}).items():
                j = system.names.index(name)
                steps = agents[j].get("hold", {}).get(system.names[i], 0)
                age = system.delays.get((i, j), 0) + steps * (what == "x")
                right = j in N_i and (not age or system.time == "discrete")
                message = f"agent {i + 1} does not get this from {j + 1}"
                require(right, "subject", f"{place}.{label}", message)
                found.append(((what, j, age), M))
        if "private" in used:
            found.append((("z", i, 0), used["private"]))
        result.append(found)
    return result
