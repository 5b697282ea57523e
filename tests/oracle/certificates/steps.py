"""Peaks after a step, by the exponential of the loop's matrix at very many times.

The loop with its set-points is not formed as the checker forms it: set-points are what maps of
agents do with signals from outside.  Peaks are computed in floating point, at 100 times in each
radian of the fastest mode, from the beginning until the slowest mode has fallen by e^−20, from
powers of one exponential: they are at most the true ones, up to rounding.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from flint import fmpq_mat
from scipy.linalg import expm

from .algebra import below, beside
from .constructions import subject_of
from .controllers import Loop, read_agents
from .performance import Disturbed, disturbed
from .reading import Undecided, demand, listed, rational, record
from .roots import inside
from .systems import System

MOST_TIMES, AT_ONCE = 4 * 10**6, 2000
PER_RADIAN, FALLEN = 100, 20.0


def step_peaks(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """Whether no peak that is seen exceeds its bound."""
    found = record(claim, "at", "inputs", "outputs")
    demand(found["at"] in ("inputs", "outputs", "setpoints"), "expected where steps enter")
    loop = disturbed(document)
    p, q = loop.U.nrows(), loop.Y.nrows()
    count = p if found["at"] == "inputs" else q
    tables = [
        [[rational(x) for x in listed(row, width)] for row in listed(found[key], count)]
        for key, width in (("inputs", p), ("outputs", q))
    ]
    demand(all(x >= 0 for table in tables for row in table for x in row), "expected none below 0")
    if not inside(loop.M.charpoly(), system.time, None):
        return False
    steps = document["subject"]
    plant = subject_of(document, len(steps) - 1)
    layout = Loop(plant, read_agents(plant, steps[-1]["controller"]))
    peaks = seen_peaks(*signals(loop, layout, found["at"]), system.time)
    bounds = np.array(
        [[float(int(x.p) / int(x.q)) for x in u + y] for u, y in zip(*tables, strict=True)]
    ).reshape(count, p + q)
    return bool(np.all(bounds >= peaks.T * (1 - 1e-9) - 1e-12 * np.max(peaks, initial=0.0)))


def signals(loop: Disturbed, layout: Loop, at: str) -> tuple[Any, Any, Any, Any]:
    """M, b, S and d of z' = M z + b, s = S z + d, in floating point."""
    p, q = loop.U.nrows(), loop.Y.nrows()
    if at == "inputs":
        b, through = loop.E, fmpq_mat(p, p)
    elif at == "outputs":
        b, through = loop.G, loop.K
    else:
        b, through = set_points(layout)
    S = below([loop.U, loop.Y], loop.M.nrows())
    d = below([through, fmpq_mat(q, b.ncols())], b.ncols())
    M, b, S, d = (_floats(X) for X in (loop.M, b, S, d))
    return M, b, S, d


def set_points(loop: Loop) -> tuple[fmpq_mat, fmpq_mat]:
    """What the set-points of all outputs do to the states, and to the inputs at once."""
    plant, agents = loop.system, loop.agents
    sizes = [C.nrows() for C in plant.C]

    def outside(i: int, label: str, nrows: int) -> fmpq_mat:
        parts = [fmpq_mat(nrows, size) for size in sizes]
        parts[i] = agents[i].maps[label].get(("reference", i), parts[i])
        return beside(parts, nrows)

    inputs = [outside(i, "input", B.ncols()) for i, B in enumerate(plant.B)]
    table = fmpq_mat(plant.n, sum(sizes))
    for B, u in zip(plant.B, inputs, strict=True):
        table = table + B * u
    rows = table.tolist()
    for (kind, i, age), size in list(loop.size.items())[1:]:
        fresh = not age and kind in ("shared", "private")
        entering = outside(i, f"{kind}_update", size) if fresh else fmpq_mat(size, sum(sizes))
        rows += entering.tolist()
    flat = [x for row in rows for x in row]
    return fmpq_mat(loop.total, sum(sizes), flat), below(inputs, sum(sizes))


def _floats(X: fmpq_mat) -> Any:
    values = [int(x.p) / int(x.q) for x in X.entries()]
    return np.array(values, dtype=float).reshape(X.nrows(), X.ncols())


def seen_peaks(M: Any, b: Any, S: Any, d: Any, time: str) -> Any:
    """The largest absolute value of each signal, a row, after each step, a column."""
    N, k = b.shape
    poles = np.linalg.eigvals(M)
    if time == "discrete":
        decay = -np.log(max(float(np.max(np.abs(poles), initial=0.0)), 1e-9))
        # a nilpotent part needs N instants
        span, times = 1.0, FALLEN / decay + N + 1
    else:
        decay = float(np.min(-poles.real, initial=1.0))
        span = 1 / (PER_RADIAN * max(float(np.max(np.abs(poles), initial=0.0)), 1e-3))
        times = FALLEN / decay / span
    if not times < MOST_TIMES:
        raise Undecided("so stiff a loop has too many times")
    whole = np.block([[M, b], [np.zeros((k, N)), np.eye(k) * (time == "discrete")]])
    E = whole if time == "discrete" else expm(span * whole)
    seen, rows = np.hstack([S, d]), []
    for _ in range(AT_ONCE):
        rows.append(seen)
        seen = seen @ E
    many, jump = np.stack(rows), np.linalg.matrix_power(E, AT_ONCE)
    state, peaks = np.vstack([np.zeros((N, k)), np.eye(k)]), np.zeros((len(S), k))
    for _ in range(int(times / AT_ONCE) + 1):
        peaks = np.maximum(peaks, np.max(np.abs(many @ state), axis=0, initial=0.0))
        state = jump @ state
    return peaks


JUDGES = {"step_peaks": step_peaks}
