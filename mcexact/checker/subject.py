"""The system that a claim is about, built from the plant by the constructions of ``FORMAT.md``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from .arithmetic import Matrix, block, diagonal
from .evidence import closed_loop, outputs, read_gains, stacked
from .reading import (
    fields,
    incomplete,
    integer,
    items,
    malformed,
    matrices,
    names,
    require,
    string,
)
from .system import System

Construction = Callable[[System, dict[str, Any], str], System]


def read_subject(value: Any, plant: System) -> System:
    """Apply the constructions in order."""
    system = plant
    for k, step in enumerate(items(value, "subject")):
        place = f"subject[{k}]"
        if not isinstance(step, dict) or type(step.get("construction")) is not str:
            malformed(place, 'expected an object with the key "construction"')
        name = step["construction"]
        if name not in CONSTRUCTIONS:
            incomplete("construction", place, f"the construction {name[:40]!a} is not known")
        rest = {key: part for key, part in step.items() if key != "construction"}
        system = CONSTRUCTIONS[name](system, rest, place)
    return system


def neighbors_of(system: System, place: str) -> list[list[int]]:
    """The sets N_i; the system must have a neighbor graph."""
    if system.neighbors is None:
        require(False, "subject", place, f"{system.words} has no neighbor graph")
    return system.neighbors or []


def unit_rows(n: int, start: int, size: int) -> Matrix:
    """[0 I 0]: rows ``start`` … ``start + size − 1`` of the n × n identity."""
    return Matrix([[int(j == start + i) for j in range(n)] for i in range(size)], n)


def augmented_outputs(system: System, step: dict[str, Any], place: str) -> System:
    """C_i becomes C_{N_i}."""
    fields(step, place)
    C = [outputs(system, N_i) for N_i in neighbors_of(system, place)]
    return replace(system, C=C, words=f"{system.words} with neighbors' outputs shared")


def dual(system: System, step: dict[str, Any], place: str) -> System:
    """A', (C_i)', (B_i)'; no neighbor graph."""
    fields(step, place)
    B, C = [M.T for M in system.C], [M.T for M in system.B]
    words = f"the dual of {system.words}"
    return System(system.time, system.names, system.A.T, B, C, words=words)


def feedback(system: System, step: dict[str, Any], place: str) -> System:
    """A_F instead of A."""
    (listed,) = fields(step, place, "gains")
    F = read_gains(listed, f"{place}.gains", system)
    words = f"{system.words} under the decentralized gains given"
    return replace(system, A=closed_loop(system, F), words=words)


def full_output(system: System, step: dict[str, Any], place: str) -> System:
    """C_q becomes the identity."""
    (name,) = fields(step, place, "channel")
    (q,) = names([name], f"{place}.channel", system.names)
    C = [Matrix.identity(system.n) if i == q else M for i, M in enumerate(system.C)]
    return replace(
        system, C=C, words=f"{system.words} with the whole state seen by channel {q + 1}"
    )


def arcs(system: System, step: dict[str, Any], place: str) -> System:
    """j joins N_i for each added arc [j, i]."""
    (listed,) = fields(step, place, "added")
    sets = [set(N_i) for N_i in neighbors_of(system, place)]
    for k, arc in enumerate(items(listed, f"{place}.added")):
        where = f"{place}.added[{k}]"
        j, i = (names([end], where, system.names)[0] for end in items(arc, where, 2))
        require(j not in sets[i], "subject", where, "the arc is there already")
        sets[i].add(j)
    words = f"{system.words} with {len(listed)} arcs added to its neighbor graph"
    return replace(system, neighbors=[sorted(N_i) for N_i in sets], words=words)


def _shares(system: System, step: dict[str, Any], place: str) -> tuple[bool, list[int]]:
    share, listed = fields(step, place, "share", "dimensions")
    string(share, f"{place}.share", "outputs+states", "states")
    return share == "outputs+states", _dimensions(system, listed, f"{place}.dimensions")


def _dimensions(system: System, value: Any, place: str) -> list[int]:
    return [integer(size, place) for size in items(value, place, system.m)]


def _extension_words(system: System, sizes: list[int], shared: str, kind: str) -> str:
    return f"the {kind} of {system.words} sharing {shared} with dimensions {tuple(sizes)}"


def extended(system: System, step: dict[str, Any], place: str) -> System:
    """Paper, section IV-C: state (x, x_1, …, x_m), every x_i' (or x_i(t+1)) an input of agent i."""
    with_outputs, sizes = _shares(system, step, place)
    N, starts, total = neighbors_of(system, place), _starts(sizes), sum(sizes)
    E = [unit_rows(total, start, size) for start, size in zip(starts, sizes, strict=True)]
    shared = "outputs and sub-states" if with_outputs else "sub-states"
    return System(
        system.time,
        system.names,
        diagonal([system.A, Matrix.zeros(total, total)]),
        [diagonal([B, E[i].T]) for i, B in enumerate(system.B)],
        [
            diagonal(
                [
                    outputs(system, N[i] if with_outputs else [i]),
                    stacked([E[j].T for j in N[i]], total).T,
                ]
            )
            for i in range(system.m)
        ],
        words=_extension_words(system, sizes, shared, "extended system"),
    )


def _starts(sizes: list[int]) -> list[int]:
    return [sum(sizes[:i]) for i in range(len(sizes))]


def longest_delays(system: System) -> list[int]:
    """d_j, the largest d_ij over those who hear j."""
    waits = system.delays
    return [max((d for (_, s), d in waits.items() if s == j), default=0) for j in range(system.m)]


def lifted(system: System, step: dict[str, Any], place: str) -> System:
    """Paper, section V-A: x, then for each j the x_j(t), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j)."""
    with_outputs, sizes = _shares(system, step, place)
    shared = "outputs and sub-states" if with_outputs else "sub-states"
    words = _extension_words(system, sizes, shared, "lifted extended system with delays")
    return _delayed(system, sizes, place, words, with_outputs, hold=False)


def held(system: System, step: dict[str, Any], place: str) -> System:
    """Paper, section V-B: x, then for each j the x_j(t), …, x_j(t−d_j); all see x_j(t−d_j)."""
    (listed,) = fields(step, place, "dimensions")
    sizes = _dimensions(system, listed, f"{place}.dimensions")
    words = _extension_words(system, sizes, "held sub-states", "extended system with delays")
    return _delayed(system, sizes, place, words, with_outputs=False, hold=True)


def _delayed(
    system: System, sizes: list[int], place: str, words: str, with_outputs: bool, hold: bool
) -> System:
    """Shift registers behind the plant: ``x_at(j, δ)`` and ``y_at(j, δ)`` read what is δ old."""
    require(system.time == "discrete", "subject", place, "delays need discrete time")
    N, d, n = neighbors_of(system, place), longest_delays(system), system.n
    q = [C.nrows if with_outputs else 0 for C in system.C]
    widths = [(d[j] + 1) * sizes[j] + d[j] * q[j] for j in range(system.m)]
    total = n + sum(widths)
    starts = [n + start for start in _starts(widths)]

    def x_at(j: int, delta: int) -> Matrix:
        return unit_rows(total, starts[j] + delta * sizes[j], sizes[j])

    def y_at(j: int, delta: int) -> Matrix:
        if not delta:
            C = system.C[j]
            return block([[C, Matrix.zeros(C.nrows, total - n)]])
        return unit_rows(total, starts[j] + (d[j] + 1) * sizes[j] + (delta - 1) * q[j], q[j])

    rows = [block([[system.A, Matrix.zeros(n, total - n)]])]
    C = []
    for j in range(system.m):
        rows.append(Matrix.zeros(sizes[j], total))
        rows += [x_at(j, delta) for delta in range(d[j])]
        rows += [y_at(j, delta) for delta in range(d[j])] if with_outputs else []
        waits = [(k, d[k] if hold else system.delays.get((j, k), 0)) for k in N[j]]
        seen = [(k, w) for k, w in waits if not w] + [(k, w) for k, w in waits if w]
        own = [y_at(k, w) for k, w in seen] if with_outputs else [y_at(j, 0)]
        C.append(_above([*own, *(x_at(k, w) for k, w in waits)], total))
    B = [
        block(
            [
                [
                    _above(
                        [system.B[j], Matrix.zeros(total - n, system.B[j].ncols)], system.B[j].ncols
                    ),
                    x_at(j, 0).T,
                ]
            ]
        )
        for j in range(system.m)
    ]
    return System(system.time, system.names, _above(rows, total), B, C, words=words)


def _above(parts: list[Matrix], ncols: int) -> Matrix:
    return block([[part] for part in [Matrix.zeros(0, ncols), *parts]])


def integrators(system: System, step: dict[str, Any], place: str) -> System:
    """Paper, section III: w' = y or w(t+1) = w + y behind the outputs, i sees its w_i."""
    fields(step, place)
    q = [C.nrows for C in system.C]
    total, keep = sum(q), int(system.time == "discrete")
    C, start = outputs(system, range(system.m)), _starts(q)
    kept = Matrix([[keep * int(i == j) for j in range(total)] for i in range(total)], total)
    A = block([[system.A, Matrix.zeros(system.n, total)], [C, kept]])
    B = [_above([M, Matrix.zeros(total, M.ncols)], M.ncols) for M in system.B]
    seen = [unit_rows(system.n + total, system.n + start[i], q[i]) for i in range(system.m)]
    words = f"{system.words} with integrators of its outputs"
    return replace(system, A=A, B=B, C=seen, words=words)


def error(system: System, step: dict[str, Any], place: str) -> System:
    """Paper, section II: errors e_i of the m estimates, I⊗(A + ΣB_jF_j) − Q, Q_ij = B_jF_j."""
    (listed,) = fields(step, place, "gains")
    n, m, N = system.n, system.m, neighbors_of(system, place)
    F = matrices(listed, f"{place}.gains", [(B.ncols, n) for B in system.B])
    Q = [B @ F_i for B, F_i in zip(system.B, F, strict=True)]
    closed = sum(Q, system.A)
    grid = [[(closed if i == j else Matrix.zeros(n, n)) - Q[j] for j in range(m)] for i in range(m)]
    e = [unit_rows(n * m, i * n, n) for i in range(m)]
    C = [
        _above([system.C[i] @ e[i], *(e[i] - e[j] for j in N[i] if j != i)], n * m)
        for i in range(m)
    ]
    words = f"the open-loop error system of {system.words} under the state feedback given"
    return System(system.time, system.names, block(grid), [e_i.T for e_i in e], C, words=words)


CONSTRUCTIONS: dict[str, Construction] = {
    "augmented_outputs": augmented_outputs,
    "dual": dual,
    "feedback": feedback,
    "full_output": full_output,
    "arcs": arcs,
    "extended": extended,
    "lifted": lifted,
    "held": held,
    "integrators": integrators,
    "error": error,
}
