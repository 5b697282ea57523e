"""How good are designs without a rate for eight families of plants, of growing size?

Run as ``python -m benchmarks.families [ROWS.jsonl] [FAMILY …] [SIZE …]``; by default all families,
with about 10, 40 and 120 states, in continuous time and sampled, which makes 48 rows.  ROWS is a
file: rows that it holds are printed and not measured again.  A sampled plant is the rounded one:
its matrices are those of a zero-order hold, to six decimals.

A line holds the figures of `designed_rows`, or what the request was answered with, and the figures
of what is made by hand.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import inf
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from scipy.linalg import expm

from benchmarks.by_hand import made_by_hand, told_by_hand
from benchmarks.design_page import PAGE, written
from benchmarks.designed_rows import answered, told
from benchmarks.kept_rows import Row, chosen, kept, measured
from mcexact import design_decentralized, design_extended
from mcexact.exact.roots import is_discrete
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.optimum.figures import DISK

SIZES = (10, 40, 120)
_LONGER = 30.0
"""The seconds of a second search, where the first finds no controller, or only a poor one."""
_POOR = 3.0

Floats = np.ndarray
Parts = tuple[Floats, list[Floats], list[Floats]]


def unit(n: int, *places: int) -> Floats:
    """The columns of the identity at some places."""
    return np.eye(n)[:, list(places)]


def second_order(stiffness: Floats, damping: Floats) -> Floats:
    """The matrix of q'' = −K q − D q', with the state (q, q')."""
    n = len(stiffness)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness, -damping]])


def path(n: int) -> Floats:
    """The Laplacian of a path."""
    L = 2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    L[0, 0] = L[-1, -1] = 1.0
    return L


def chain(n: int) -> Parts:
    """Masses on springs in a row, hardly damped; agents push some masses and measure positions."""
    k = n // 2
    A = second_order(path(k) + 0.05 * np.eye(k), 0.02 * np.eye(k))
    held = np.linspace(0, k - 1, min(k, max(2, k // 3))).round().astype(int)
    return A, [unit(n, k + i) for i in held], [unit(n, i).T for i in held]


def heat(n: int) -> Parts:
    """A rod with a source of heat; agents heat and measure places of it."""
    A = -((n / 10) ** 2) * path(n) + 0.2 * np.eye(n)
    held = [int(part * n) for part in (0.1, 0.3, 0.6, 0.9)]
    return A, [unit(n, i) * n / 10 for i in held], [unit(n, i).T for i in held]


def power(n: int) -> Parts:
    """Swing equations with governors on a ring; agents measure angle and frequency."""
    m = n // 3
    A = np.zeros((3 * m, 3 * m))
    for i in range(m):
        a = 3 * i
        A[a, a + 1] = 1.0
        A[a + 1, [a + 1, a + 2]] = -0.2, 1.0
        A[a + 2, [a + 1, a + 2]] = -0.5, -2.0
        for j in ((i - 1) % m, (i + 1) % m):
            A[a + 1, 3 * j] += 0.4 + 0.1 * (i % 3)
            A[a + 1, a] -= 0.4 + 0.1 * (i % 3)
    inputs = [2 * unit(3 * m, 3 * i + 2) for i in range(m)]
    return A, inputs, [unit(3 * m, 3 * i, 3 * i + 1).T for i in range(m)]


def formation(n: int) -> Parts:
    """Vehicles on a line that measure the distance to the one before; the first its position."""
    m = n // 2
    A, C = second_order(np.zeros((m, m)), np.zeros((m, m))), []
    for i in range(m):
        seen = unit(2 * m, i).T - (unit(2 * m, i - 1).T if i else 0.0)
        C.append(seen)
    return A, [unit(2 * m, m + i) for i in range(m)], C


def platoon(n: int) -> Parts:
    """Vehicles with a gap, a speed and an actuator each; agents measure gap and speed."""
    m = n // 3
    A = np.zeros((3 * m, 3 * m))
    for i in range(m):
        a = 3 * i
        A[a, a + 1] = -1.0
        if i:
            A[a, a - 2] = 1.0
        A[a + 1, a + 2] = 1.0
        A[a + 2, a + 2] = -2.0
    inputs = [2 * unit(3 * m, 3 * i + 2) for i in range(m)]
    return A, inputs, [unit(3 * m, 3 * i, 3 * i + 1).T for i in range(m)]


def areas(n: int) -> Parts:
    """Power areas with frequency, turbine, governor and tie line, each measured; in a row."""
    m = n // 4
    A = np.zeros((4 * m, 4 * m))
    for i in range(m):
        a = 4 * i
        A[a : a + 3, a : a + 3] = [[-0.1, 0.6, 0.0], [0.0, -3.0, 3.0], [-2.0, 0.0, -8.0]]
        A[a, a + 3] = -0.6
        A[a + 3, a] = 0.5 * ((i > 0) + (i < m - 1)) + 0.05
        for j in {i - 1, i + 1} & set(range(m)):
            A[a + 3, 4 * j] = -0.5
        A[a + 3, a + 3] = -0.01
    inputs = [8 * unit(4 * m, 4 * i + 2) for i in range(m)]
    return A, inputs, [unit(4 * m, *range(4 * i, 4 * i + 4)).T for i in range(m)]


def pendula(n: int) -> Parts:
    """Inverted pendula coupled by springs in a row; agents measure their own angles."""
    m = n // 2
    A = second_order(0.2 * path(m) - np.eye(m), 0.05 * np.eye(m))
    return A, [unit(2 * m, m + i) for i in range(m)], [unit(2 * m, i).T for i in range(m)]


def building(n: int) -> Parts:
    """Storeys on columns; actuators between some storeys, with the drift and its rate measured."""
    k = n // 2
    K = path(k) * 4.0
    K[0, 0] += 4.0
    A = second_order(K, 0.01 * K)
    held = np.linspace(0, k - 1, max(2, k // 5)).round().astype(int)
    inputs, outputs = [], []
    for i in held:
        drift = unit(k, i) - (unit(k, i - 1) if i else 0.0)
        none = np.zeros((1, k))
        inputs.append(np.vstack([none.T, drift]))
        outputs.append(np.vstack([np.hstack([drift.T, none]), np.hstack([none, drift.T])]))
    return A, inputs, outputs


@dataclass(frozen=True)
class Kind:
    """A family: its plants, the time between samples, and the kind of controller."""

    made: Callable[[int], Parts]
    step: float
    structure: str = "decentralized"


FAMILIES = {
    "chain": Kind(chain, 0.5),
    "heat": Kind(heat, 0.2),
    "power": Kind(power, 0.2),
    "formation": Kind(formation, 0.2, "extended"),
    "platoon": Kind(platoon, 0.2),
    "areas": Kind(areas, 0.1),
    "pendula": Kind(pendula, 0.1),
    "building": Kind(building, 0.1),
}


def plant(kind: Kind, n: int, time: str) -> MultiChannelSystem:
    """A plant of a family, whose agents are in a row and hear the next ones."""
    A, B, C = kind.made(n)
    m = len(B)
    if is_discrete(time):
        both = np.hstack(B)
        held = np.zeros((len(A) + both.shape[1],) * 2)
        held[: len(A)] = np.hstack([A, both]) * kind.step
        held = expm(held).round(6)
        A, both = held[: len(A), : len(A)], held[: len(A), len(A) :]
        B = np.split(both, np.cumsum([each.shape[1] for each in B])[:-1], axis=1)
    names = [str(i + 1) for i in range(m)]
    heard = {a: [names[j] for j in (i - 1, i + 1) if 0 <= j < m] for i, a in enumerate(names)}
    found = MultiChannelSystem.from_float(A, B, C, time=time, rounding="decimal", names=names)
    return found.with_neighbors(NeighborGraph.from_names(names, heard))


def is_poor(row: Row) -> bool:
    """Whether there is no controller, or one without the disk margin or three times too dear."""
    if row["answer"] == "limit":
        return True
    fragile, dear = (row.get("disk") or 0.0) < DISK, (row.get("ratio") or inf) > _POOR
    return bool(row["answer"] == "designed" and (fragile or dear))


def row_of(kind: Kind, n: int, domain: str) -> Row:
    """The row of a plant of a family."""
    system = plant(kind, n, domain)
    function: Any = design_extended if kind.structure == "extended" else design_decentralized
    found = answered(function, system)
    if is_poor(found):
        again = answered(function, system, _LONGER)
        seconds = round(found["seconds"] + again["seconds"], 1)
        better = found if again["answer"] == "limit" else again
        found = {**better, "seconds": seconds}
    return {**found, "by hand": made_by_hand(system)}


def main(arguments: list[str]) -> int:
    """Design for all plants, or for some."""
    path, wanted = chosen(arguments, "families")
    sizes = [int(each) for each in wanted if each.isdigit()] or SIZES
    names = [each for each in wanted if each in FAMILIES] or list(FAMILIES)
    known = kept(path)
    for n in sizes:
        for name in names:
            for domain in ("continuous", "discrete"):
                make = partial(row_of, FAMILIES[name], n, domain)
                row = measured(path, f"{name} {n} {domain}", make, known)
                hand = told_by_hand(row["by hand"])
                print(f"{row['name']} | {told(row)}, {row['seconds']} s | {hand}", flush=True)
    PAGE.write_text(written(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
