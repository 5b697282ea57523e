"""Construction ``closed_loop``: the plant and the programs of its agents, as one matrix."""

from .arithmetic import Matrix, stack
from .budget import spend, table
from .controller import MAPS, read_controller
from .reading import Json, fields, require
from .statement import canonical_json, channel_set, digest_of, prefixed, with_digest
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
    programs = programs_of(system, agents, place)
    order = signals_of(system, agents, programs)
    reads = rows_that_read(order)
    x = reads["X", 0, 0]
    reads |= {("y", j, 0): C_j @ x for j, C_j in enumerate(system.C)}
    inputs = [mapped(programs[i][2], reads, B_i.ncols, x.ncols) for i, B_i in enumerate(system.B)]
    A = stack(rows_of_states(system, programs, order, reads, inputs), x.ncols)
    blocks, text = tuple(width for _, width in order[: 2 * m + 1]), canonical_json(controller)
    words = f"the closed loop with the controller with {with_digest(text)}"
    alone = System(system.time, [], A, [], [], words=system.words)
    own = f"{system.n} of the controlled system and {A.nrows - system.n} added by the controller"
    ports = f"{own} of the channels {channel_set(system.names)}"
    return prefixed(words, alone, blocks=blocks, ports=ports, controller=digest_of(text))


def programs_of(system: System, agents: list[Json], place: str) -> list[list[Terms]]:
    """The signals that the three maps of each agent use."""
    return [_terms(system, agents, i, place) for i in range(system.m)]


def signals_of(
    system: System, agents: list[Json], programs: list[list[Terms]]
) -> list[tuple[Signal, int]]:
    """The signals that make up the state of the loop, with their widths."""
    m = system.m
    width = {what: [agent[key] for agent in agents] for what, key in STATES}
    width |= {"X": [system.n], "y": [C_j.nrows for C_j in system.C]}
    used = {signal for maps in programs for found in maps for signal, _ in found}
    spend(30 * m * len(used))
    order: list[Signal] = [("X", 0, 0), *((what, j, 0) for j in range(m) for what in "xz")]
    for what, j in ((what, j) for j in range(m) for what in "xy"):
        oldest = max((age for w, k, age in used if (w, k) == (what, j)), default=0)
        spend(500 * oldest)
        order += [(what, j, age + 1) for age in range(oldest)]
    return [((what, j, age), width[what][j]) for what, j, age in order]


def rows_that_read(order: list[tuple[Signal, int]]) -> dict[Signal, Matrix]:
    """For each signal, the matrix that takes it out of all of them."""
    total, start, reads = sum(width for _, width in order), 0, {}
    spend(table(total, total))
    for signal, width in order:
        reads[signal] = Matrix.unit_rows(total, start, width)
        start += width
    return reads


def mapped(terms: Terms, reads: dict[Signal, Matrix], nrows: int, ncols: int) -> Matrix:
    """What a map computes of all signals."""
    return sum((M @ reads[signal] for signal, M in terms), Matrix.zeros(nrows, ncols))


def rows_of_states(
    system: System,
    programs: list[list[Terms]],
    order: list[tuple[Signal, int]],
    reads: dict[Signal, Matrix],
    inputs: list[Matrix],
    one: int = 1,
) -> list[Matrix]:
    """What follows on each signal of the state; ``inputs`` are the u_i in terms of all signals.

    A message follows on the younger one ``one`` times: with 0, only what is uncertain is left.
    """
    x = reads["X", 0, 0]
    rows = [sum((B_i @ u_i for B_i, u_i in zip(system.B, inputs, strict=True)), system.A @ x)]
    for (what, j, age), width in order[1:]:
        if age:
            rows.append(reads[what, j, age - 1].times(one))
        else:
            rows.append(mapped(programs[j]["xz".index(what)], reads, width, x.ncols))
    return rows


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
