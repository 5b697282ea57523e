"""Constructions ``lifted`` and ``held``: extended systems with delays, in discrete time."""

from dataclasses import replace

from .arithmetic import Matrix, beside, stack
from .budget import spend, table
from .information_structure import neighbors_of, read_dimensions, read_shares, shared
from .reading import Json, fields, require
from .statement import prefixed
from .system import System


def lifted(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section V-A: x, then for each j the x_j(t), …, x_j(t−d_j), y_j(t−1), …, y_j(t−d_j).

    Open: see ``proofs/OPEN.md``.
    """
    share, sizes = read_shares(system, step, place)
    what = f"the extended system with delays, lifted, sharing {shared(system, share, sizes)}"
    return _delayed(system, sizes, place, what, share == "outputs+states", hold=False)


def held(system: System, step: dict[str, Json], place: str) -> System:
    """Paper, section V-B: x, then for each j the x_j(t), …, x_j(t−d_j); all receive x_j(t−d_j).

    Open: see ``proofs/OPEN.md``.
    """
    (listed,) = fields(step, place, "dimensions")
    sizes = read_dimensions(system, listed, place)
    given = shared(system, "states", sizes)
    what = f"the extended system with delays, held, sharing {given}"
    return _delayed(system, sizes, place, what, with_outputs=False, hold=True)


def _delayed(
    system: System, sizes: list[int], place: str, what: str, with_outputs: bool, hold: bool
) -> System:
    """Shift registers behind the plant; x(j, δ) and y(j, δ) read what is δ steps old."""
    require(system.time == "discrete", "subject", place, "expected a plant in discrete time")
    N, n, m = neighbors_of(system, place), system.n, system.m
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
    return replace(system, A=stack(rows, total), B=B, C=C, words=prefixed(what, system))
