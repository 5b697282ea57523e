"""Distributed observers put together from drawn gains: their errors evolve by themselves."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

from flint import fmpq_mat

from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.systems import System

from .plants import Document, drawn_plant, entries
from .subjects import text_of

PRIMES = (1000003, 2147483647, 1000000007, 998244353, 2305843009213693951, 4294967291, 4294967279)


def _rows(M: fmpq_mat) -> list[list[int | str]]:
    return [[text_of(v) for v in row] for row in M.tolist()]


def _drawn(rng: random.Random, nrows: int, ncols: int) -> fmpq_mat:
    rows = entries(rng, nrows, ncols, 0.6, (1, -1, 2))
    return fmpq_mat(nrows, ncols, [int(v) for row in rows for v in row])


def observer_program(rng: random.Random, system: System, extra: int = 0) -> Document:
    """Programs x_i' = (A + Σ B_j F_j) x_i + K_i (C_i x_i − y_i) + Σ H_ij (x_i − x_j) + G_i z_i.

    u_i = F_i x_i, and z_i is driven by C_i x_i − y_i and by itself.  With ``extra`` every agent
    shares more entries, which stay 0.
    """
    n = system.n

    def padded(M: fmpq_mat, nrows: int, ncols: int) -> list[Any]:
        rows = [row + [0] * (ncols - len(row)) for row in _rows(M)]
        return rows + [[0] * ncols for _ in range(nrows - len(rows))]

    F = [_drawn(rng, B.ncols(), n) for B in system.B]
    loop = system.A
    for B, gain in zip(system.B, F, strict=True):
        loop = loop + B * gain
    agents = []
    for i, name in enumerate(system.names):
        senders = [j for j in (system.neighborhoods or [])[i] if j != i]
        K, k = _drawn(rng, n, system.C[i].nrows()), rng.choice((0, 0, 1))
        own: Any = loop + K * system.C[i]
        others: dict[str, Any] = {}
        for j in senders:
            H = _drawn(rng, n, n)
            own = own + H
            others[system.names[j]] = padded(-H, n + extra, n + extra)
        L = _drawn(rng, k, system.C[i].nrows())
        agents.append(
            {
                "name": name,
                "shared": n + extra,
                "private": k,
                "shared_update": {
                    "outputs": {name: padded(-K, n + extra, K.ncols())},
                    "shared": {name: padded(own, n + extra, n + extra), **others},
                    "private": padded(_drawn(rng, n, k), n + extra, k),
                },
                "private_update": {
                    "outputs": {name: _rows(-L)},
                    "shared": {name: padded(L * system.C[i], k, n + extra)},
                    "private": _rows(_drawn(rng, k, k)),
                },
                "input": {"shared": {name: padded(F[i], F[i].nrows(), n + extra)}},
            }
        )
    return {"time": system.time, "agents": agents}


def drawn_observer(
    rng: random.Random, plant: Document | None = None, extra: int = 0
) -> Document | None:
    """A true certificate; the claim comes from the matrices in the coordinates of the errors."""
    if plant is None:
        plant = drawn_plant(rng, graph=True, most=2)
        plant.pop("delays", None)
    system = subject_of({"system": plant, "subject": []})
    return observer_certificate(plant, observer_program(rng, system, extra))


def late_observer(rng: random.Random) -> Document:
    """An observer whose agent 1 uses an output of agent 2, always 0, one step late."""
    ports = [([[1]], [[1]]), ([[1]], [[0]])]
    plant = {
        "time": "discrete",
        "A": [[rng.choice((0, 1))]],
        "channels": [
            {"name": name, "B": B, "C": C} for name, (B, C) in zip("12", ports, strict=True)
        ],
        "neighbors": {"1": ["2"], "2": []},
        "delays": {"1": {"2": 1}},
    }
    system = subject_of({"system": {**plant, "delays": {}}, "subject": []})
    program = observer_program(rng, system)
    update = program["agents"][0]["shared_update"]
    update["shared"].pop("2")
    update["outputs"]["2"] = [[1]]
    # without the neighbor's estimate, that of agent 1 is a copy of the plant and a correction
    program["agents"][0]["shared_update"]["shared"]["1"] = program["agents"][1]["shared_update"][
        "shared"
    ]["2"]
    for agent in program["agents"]:
        agent["shared_update"]["outputs"].pop(agent["name"])
    return observer_certificate(plant, program)


def observer_certificate(plant: Document, controller: Document) -> Document:
    """The certificate of a loop in the coordinates of the errors, whether or not they separate."""
    system = subject_of({"system": plant, "subject": []})
    steps = [{"construction": "closed_loop", "controller": controller}]
    loop = subject_of({"system": plant, "subject": steps})
    n, starts, position = system.n, [], system.n
    for agent in steps[0]["controller"]["agents"]:  # type: ignore[index]
        starts.append(position)
        position += agent["shared"] + agent["private"]
    rows = loop.A.tolist()
    # adding the columns of every x_i to those of x, and subtracting the rows of x from those of x_i
    for row in rows:
        for start in starts:
            for k in range(n):
                row[k] += row[start + k]
    for start in starts:
        for k in range(n):
            rows[start + k] = [a - b for a, b in zip(rows[start + k], rows[k], strict=True)]
    size = loop.n - n
    claim = {
        "feedback": _monic(fmpq_mat(n, n, [v for row in rows[:n] for v in row[:n]])),
        "error": _monic(fmpq_mat(size, size, [v for row in rows[n:] for v in row[n:]])),
        "bound": None,
    }
    return {
        "format": "mcexact-certificate/1",
        "kind": "distributed_observer",
        "system": plant,
        "subject": steps,
        "claim": claim,
        "witness": {"moduli": moduli(rows)},
    }


def _monic(M: fmpq_mat) -> list[Any]:
    return [text_of(c) for c in M.charpoly().coeffs()]


def moduli(rows: list[list[Any]]) -> list[int]:
    """As many primes as the bound of the format asks for, and a little more."""
    bound = Fraction(2)
    for row in rows:
        entries = [Fraction(int(v.p), int(v.q)) for v in row]
        denominator = 1
        for value in entries:
            denominator *= value.denominator
        bound *= denominator * (1 + sum(abs(v) for v in entries))
    chosen, product = [], 1
    for prime in PRIMES:
        chosen.append(prime)
        product *= prime
        if product > 4 * bound:
            break
    return chosen
