"""Plants that no time-invariant decentralized control stabilizes, and loops run step by step.

`planted` puts a mode λ outside the unit disk where the first channel alone acts on it and the last
one alone observes it.  What the last channel measures returns through a chain of links, each with a
transfer function that is 0 at λ: so λ is fixed, and no component of the transfer graph is left out
of the cycle.  `blocked` has one link with zeros at λ and −λ, through which gains of period 2 move
nothing either.  `period_by_hand` runs agents on lists of numbers.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from mcexact.model.system import MultiChannelSystem

MODES = ("11/10", "6/5", "13/10", "3/2", "-11/10", "-6/5", "-7/5")
POLES = ("0", "1/2", "-1/2", "1/4", "3/4", "-3/4", "8/5", "-5/4")


def planted(seed: int, channels: int = 2) -> tuple[MultiChannelSystem, Fraction]:
    """A plant in drawn coordinates, and its fixed mode."""
    rng = random.Random(seed)
    mode = Fraction(rng.choice(MODES))
    diagonal, links = [mode], []
    for _ in range(channels - 1):
        poles = [Fraction(pole) for pole in rng.sample(POLES, rng.randint(2, 3))]
        c = [Fraction(rng.choice((1, -1, 2))) for _ in poles]
        b = [Fraction(rng.choice((1, -1, 2, 3))) for _ in poles]
        others = list(zip(b, c, poles, strict=True))[:-1]
        rest = sum((x * y / (mode - pole) for x, y, pole in others), Fraction(0))
        b[-1] = -rest * (mode - poles[-1]) / c[-1]
        links.append((len(diagonal), b, c))
        diagonal += poles
    n = len(diagonal)
    B = [[[Fraction(0)] for _ in range(n)] for _ in range(channels)]
    C = [[[Fraction(0)] * n] for _ in range(channels)]
    B[0][0][0], C[-1][0][0] = Fraction(rng.choice((1, -1, 2))), Fraction(rng.choice((1, -1, 2)))
    for k, (start, b, c) in enumerate(links):
        for j, (entry_b, entry_c) in enumerate(zip(b, c, strict=True), start):
            B[k + 1][j][0], C[k][0][j] = entry_b, entry_c
    A = [[diagonal[i] if i == j else Fraction(0) for j in range(n)] for i in range(n)]
    for _ in range(n):
        i, j = rng.sample(range(n), 2)
        _change_coordinates(A, B, C, i, j, rng.choice((1, -1)))
    return MultiChannelSystem(A, B, C, time="discrete"), mode


def _change_coordinates(A: Any, B: Any, C: Any, i: int, j: int, factor: int) -> None:
    """x_i + factor x_j in place of x_i."""
    for M in (A, *B):
        M[i] = [x + factor * y for x, y in zip(M[i], M[j], strict=True)]
    for M in (A, *C):
        for row in M:
            row[j] -= factor * row[i]


def blocked(mode: str = "11/10") -> MultiChannelSystem:
    """One link with zeros at ±11/10: what it does to a signal λ^t (−1)^t is 0, too."""
    A = [[mode, 0, 0, 0], [0, 0, 0, 0], [0, 0, "1/2", 0], [0, 0, 0, "-1/2"]]
    B = [[[1], [0], [0], [0]], [[0], [-1], ["48/121"], ["48/121"]]]
    C = [[[0, 1, 1, 1]], [[1, 0, 0, 0]]]
    return MultiChannelSystem(A, B, C, time="discrete")


Rows = Sequence[Sequence[Fraction]]


def applied(M: Rows, x: Sequence[Fraction]) -> list[Fraction]:
    """M x."""
    return [sum((a * b for a, b in zip(row, x, strict=True)), Fraction(0)) for row in M]


def period_by_hand(
    system: MultiChannelSystem, phases: Sequence[Any], start: Sequence[Fraction], first: int = 0
) -> list[list[Fraction]]:
    """The states (x, z_1, …, z_m) before each step of a period, and after it.

    Parameters
    ----------
    phases : sequence
        The objects of a file of a periodic controller.
    start : sequence of Fraction
    first : int
        The step of the period in which the run begins.
    """
    sizes = [agent["private"] for agent in phases[0]["agents"]]
    x, rest, z = list(start[: system.n]), list(start[system.n :]), list[list[Fraction]]()
    for size in sizes:
        z.append(rest[:size])
        rest = rest[size:]
    states = [list(start)]
    for t in range(len(phases)):
        agents = phases[(first + t) % len(phases)]["agents"]
        after, later = applied(system.A.rows(), x), []
        for i, agent in enumerate(agents):
            y = applied(system.C(i).rows(), x)
            u = _map(agent["input"], agent["name"], y, z[i], system.p(i))
            later.append(_map(agent["private_update"], agent["name"], y, z[i], sizes[i]))
            added = applied(system.B(i).rows(), u)
            after = [a + b for a, b in zip(after, added, strict=True)]
        x, z = after, later
        states.append([*x, *(entry for each in z for entry in each)])
    return states


def _map(parts: Any, name: str, y: list[Fraction], z: list[Fraction], size: int) -> list[Fraction]:
    """What one map of an agent gives."""
    result = [Fraction(0)] * size
    for table, signal in ((parts.get("outputs", {}).get(name), y), (parts.get("private"), z)):
        if table is not None:
            rows = [[Fraction(entry) for entry in row] for row in table]
            result = [a + b for a, b in zip(result, applied(rows, signal), strict=True)]
    return result


def monodromy_by_hand(
    system: MultiChannelSystem, phases: Sequence[Any], first: int = 0
) -> list[list[Fraction]]:
    """The matrix of a period, whose columns are the states after it from unit vectors."""
    total = system.n + sum(agent["private"] for agent in phases[0]["agents"])
    columns = []
    for k in range(total):
        start = [Fraction(int(j == k)) for j in range(total)]
        columns.append(period_by_hand(system, phases, start, first)[-1])
    return [list(row) for row in zip(*columns, strict=True)]
