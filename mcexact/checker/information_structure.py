"""Constructions ``augmented_outputs``, ``arcs``, ``extended``, ``lifted`` and ``held``."""

from .arithmetic import Matrix, beside, diagonal, stack
from .budget import spend, table
from .evidence import outputs
from .reading import Json, fields, integer, items, require, string
from .statement import by_channel, canonical_json, edge_set, prefixed, suffixed
from .system import System

SHARED = {"outputs+states": "outputs and sub-states", "states": "sub-states"}


def neighbors_of(system: System, place: str) -> list[list[int]]:
    """The sets N_i; the system must have a neighbor graph."""
    message = "the system has no neighbor graph"
    require(system.neighbors is not None, "subject", place, message)
    return system.neighbors or []


def augmented_outputs(system: System, step: dict[str, Json], place: str) -> System:
    """C_i becomes C_{N_i}.

    Open: see ``proofs/OPEN.md``.
    """
    fields(step, place)
    N = neighbors_of(system, place)
    C = [outputs(system, N_i) for N_i in N]
    return suffixed(system, "with the outputs of neighbors measured by each agent", C=C)


def arcs(system: System, step: dict[str, Json], place: str) -> System:
    """j joins N_i for each added edge [j, i].

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "added")
    spend(40 * sum(map(len, neighbors_of(system, place))) + 100 * system.m)
    sets, added = [set(N_i) for N_i in neighbors_of(system, place)], []
    for arc in items(listed, place):
        j, i = (system.place_of(end, place) for end in items(arc, place, 2))
        require(j not in sets[i], "subject", place, "the edge is there already")
        sets[i].add(j)
        added.append((j, i))
    named = edge_set((system.names[j], system.names[i]) for j, i in sorted(added))
    words = f"with the links {named} added to its neighbor graph"
    return suffixed(system, words, neighbors=[sorted(N_i) for N_i in sets])


def read_shares(system: System, step: dict[str, Json], place: str) -> tuple[str, list[int]]:
    """Read which signals are shared, and the dimensions n_i of the sub-states."""
    share, listed = fields(step, place, "share", "dimensions")
    return string(share, place, *SHARED), read_dimensions(system, listed, place)


def read_dimensions(system: System, value: Json, place: str) -> list[int]:
    """The dimensions n_i, one for each agent."""
    return [integer(size, place) for size in items(value, place, system.m)]


def shared(system: System, share: str, sizes: list[int]) -> str:
    """What agents share, and in how many dimensions."""
    return f"{SHARED[share]} of dimensions {canonical_json(by_channel(system, sizes))}"


def extended(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section IV-C: state (x, x_1, …, x_m); x_i' or x_i(t+1) is an input of agent i.

    Open: see ``proofs/OPEN.md``.
    """
    (share, sizes), N = read_shares(system, step, place), neighbors_of(system, place)
    total = sum(sizes)
    E = [Matrix.unit_rows(total, sum(sizes[:i]), size) for i, size in enumerate(sizes)]
    B = [diagonal(B_i, E_i.T) for B_i, E_i in zip(system.B, E, strict=True)]
    own = [outputs(system, N_i if share == "outputs+states" else [i]) for i, N_i in enumerate(N)]
    heard = [stack([E[j] for j in N_i], total) for N_i in N]
    C = [diagonal(C_i, E_N) for C_i, E_N in zip(own, heard, strict=True)]
    A = diagonal(system.A, Matrix.zeros(total, total))
    words = f"the extended system without delays sharing {shared(system, share, sizes)}"
    return prefixed(words, system, A=A, B=B, C=C)


def lifted(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section V-A: x, then for each j the x_j(t), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j).

    Open: see ``proofs/OPEN.md``.
    """
    return _delayed(system, *read_shares(system, step, place), place, hold=False)


def held(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section V-B: x, then for each j the x_j(t), …, x_j(t−d_j); all receive x_j(t−d_j).

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "dimensions")
    return _delayed(system, "states", read_dimensions(system, listed, place), place, hold=True)


def _delayed(system: System, share: str, sizes: list[int], place: str, hold: bool) -> System:
    """Shift registers behind the plant; x(j, δ) and y(j, δ) read what is δ steps old."""
    require(system.time == "discrete", "subject", place, "expected a plant in discrete time")
    N, n, m, with_outputs = neighbors_of(system, place), system.n, system.m, share != "states"
    d = [max([system.delays.get((i, j), 0) for i in range(m)]) for j in range(m)]
    q = [C_j.nrows if with_outputs else 0 for C_j in system.C]
    widths = [(d[j] + 1) * sizes[j] + d[j] * q[j] for j in range(m)]
    spend(500 * sum(d) + table(n + sum(widths), n + sum(widths)) + m * m)
    total, starts = n + sum(widths), [n + sum(widths[:j]) for j in range(m)]
    plant = Matrix.unit_rows(total, 0, n)

    def x(j: int, delta: int) -> Matrix:
        return Matrix.unit_rows(total, starts[j] + delta * sizes[j], sizes[j])

    def y(j: int, delta: int) -> Matrix:
        if not delta:
            return system.C[j] @ plant
        first = starts[j] + (d[j] + 1) * sizes[j] + (delta - 1) * q[j]
        return Matrix.unit_rows(total, first, q[j])

    rows, B, C = [system.A @ plant], [], []
    for j in range(m):
        rows += [Matrix.zeros(sizes[j], total), *(x(j, delta) for delta in range(d[j]))]
        rows += [y(j, delta) for delta in range(d[j]) if with_outputs]
        B.append(beside([plant.T @ system.B[j], x(j, 0).T], total))
        waits = [(k, d[k] if hold else system.delays.get((j, k), 0)) for k in N[j]]
        late = sorted(waits, key=lambda wait: wait[1] > 0)  # signals without delay come first
        own = [y(*wait) for wait in late] if with_outputs else [y(j, 0)]
        C.append(stack([*own, *(x(*wait) for wait in waits)], total))
    form = f"{'held' if hold else 'lifted'}, sharing {shared(system, share, sizes)}"
    words = f"the extended system with delays, {form}"
    return prefixed(words, system, A=stack(rows, total), B=B, C=C)
