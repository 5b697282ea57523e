"""Closed loops: characteristic polynomials by sympy, eigenvalues to fifty digits."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from typing import Any

from mcexact.analysis.stability.stability import certify_stability, matrix_system
from mcexact.answer import codec
from mcexact.exact.location import StabilityRegion
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.model.controller import AgentProgram, Controller, LinearMap
from mcexact.model.loop import closed_loop
from mcexact.model.neighbor_graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Proposal, certify
from mcexact.synthesis.observer.observer import design_observer
from tests.checker.mutations import Document, Registration
from tests.checker.oracles.subjects import coefficients_of, subject_of
from tests.oracle import enumeration


def _drawn(rng: random.Random, nrows: int, ncols: int) -> Matrix:
    entries = (0, 1, -1, 2, Fraction(-1, 2))
    return Matrix.from_rows(
        [[rng.choice(entries) for _ in range(ncols)] for _ in range(nrows)], ncols=ncols
    )


def _plant(rng: random.Random) -> MultiChannelSystem:
    """One or two states, two agents that hear each other, delays in discrete time."""
    n, time = rng.randint(1, 2), rng.choice(["continuous", "discrete"])
    graph = NeighborGraph(("1", "2"), [[1], [0]], [(0, 1, 1)] if time == "discrete" else [])
    B, C = [_drawn(rng, n, 1) for _ in "12"], [_drawn(rng, 1, n) for _ in "12"]
    return MultiChannelSystem(_drawn(rng, n, n), B, C, time=time, neighbors=graph)


def _loop(rng: random.Random) -> tuple[MultiChannelSystem, Controller]:
    system = _plant(rng)
    agents = []
    for i in range(2):
        maps = [
            LinearMap(
                {0: _drawn(rng, 1, 1), 1: _drawn(rng, 1, 1)}, {1 - i: _drawn(rng, 1, 1)}
            ).without_zeros()
            for _ in range(3)
        ]
        agents.append(AgentProgram(system.names[i], 1, i, maps[0], *_fitted(maps[1:], i)))
    return system, Controller(system.time, "", tuple(agents))


def _fitted(maps: list[LinearMap], private: int) -> list[LinearMap]:
    """The private update is empty where there is no private state."""
    return [maps[0] if private else LinearMap(), maps[1]]


def draw_spectrum(seed: int) -> Document:
    """The spectrum of a small loop, delays and private states included."""
    system, controller = _loop(random.Random(seed))
    M = closed_loop(system, controller).matrix
    p = enumeration.characteristic_polynomial([list(row) for row in M.rows()])
    proposal = Proposal(controller, (Polynomial(p),))
    made = certify(system, proposal, StabilityRegion(system.time))
    document: Document = json.loads(codec.encode(made.proof))
    return document


def confirms_spectrum(document: Document) -> bool:
    """The characteristic polynomial by sympy."""
    rows = [list(row) for row in subject_of(document).A.rows()]
    found = enumeration.characteristic_polynomial(rows)
    return coefficients_of(document["claim"]["polynomial"]) == found


def draw_stability(seed: int) -> Document | None:
    """A small matrix, stable or not, by all methods in turn."""
    rng = random.Random(seed)
    time = rng.choice(["continuous", "discrete"])
    n = rng.randint(1, 3)
    shift = Matrix.identity(n) * Fraction(-2 if time == "continuous" else 1, 8) * 4
    M = _drawn(rng, n, n) * Fraction(1, 4) + shift * rng.choice([0, 1, 1])
    bound = rng.choice([None, Fraction(1, 4), Fraction(1, 2)])
    method = "lyapunov" if seed % 3 else "polynomial"
    try:
        found = certify_stability(
            matrix_system(M, time), StabilityRegion(time, bound), method=method
        )  # type: ignore[arg-type]
    except ValueError:
        return None
    document: Document = json.loads(codec.encode(found))
    return document


def confirms_stability(document: Document) -> bool:
    """The characteristic polynomial, placed by the package's own exact tests."""
    system, claim = subject_of(document), document["claim"]
    rows = [list(row) for row in system.A.rows()]
    p = Polynomial(enumeration.characteristic_polynomial(rows))
    inside = StabilityRegion.of(system.time, bound=claim["bound"]).contains_roots_of(p)
    return claim["stable"] is inside


def draw_observer(seed: int) -> Document | None:
    """An observer of one state by two agents."""
    if seed % 5:
        return None
    rng = random.Random(seed)
    time = rng.choice(["continuous", "discrete"])
    graph = NeighborGraph(("1", "2"), [[1], [0]])
    ports = [[[rng.choice([1, 2])]] for _ in range(4)]
    plant = MultiChannelSystem(
        [[rng.randint(0, 2)]], ports[:2], ports[2:], time=time, neighbors=graph
    )
    roots = ["-1", "-2", "-3"] if time == "continuous" else ["0", "1/2", "1/3"]
    spectrum = {"feedback": roots[:1], "error": roots}
    made = design_observer(plant, spectrum=spectrum)
    document: Document = json.loads(codec.encode(made.loop.proof))
    return document if document["kind"] == "distributed_observer" else None


def confirms_observer(document: Document) -> bool:
    """Coordinates changed by a matrix that is written down, then sympy."""
    system, claim = subject_of(document), document["claim"]
    (step,) = document["subject"]
    n = len(document["system"]["A"])
    starts, position = [], n
    for agent in step["controller"]["agents"]:
        if agent["shared"] != n:
            return False
        starts.append(position)
        position += agent["shared"] + agent["private"]
    if position != system.n:
        return False
    T = [[Fraction(int(i == j)) for j in range(system.n)] for i in range(system.n)]
    back = [list(row) for row in T]
    for start in starts:
        for i in range(n):
            T[start + i][i] -= 1
            back[start + i][i] += 1
    rows = [list(row) for row in system.A.rows()]
    moved = enumeration.product(enumeration.product(T, rows), back)
    if any(any(row[:n]) for row in moved[n:]):
        return False
    polynomials = []
    for key, block in (
        ("feedback", [row[:n] for row in moved[:n]]),
        ("error", [row[n:] for row in moved[n:]]),
    ):
        found = enumeration.characteristic_polynomial(block)
        if coefficients_of(claim[key]) != found:
            return False
        polynomials.append(Polynomial(found))
    return claim["bound"] is None or _within(claim["bound"], system.time, polynomials)


def _within(bound: Any, time: str, polynomials: list[Polynomial]) -> bool:
    value = Fraction(bound)
    region = StabilityRegion(time, None if time == "continuous" and value == 0 else value)
    return all(region.contains_roots_of(p) for p in polynomials)


KINDS = {
    "closed_loop_spectrum": Registration(draw_spectrum, confirms_spectrum),
    "distributed_observer": Registration(draw_observer, confirms_observer),
    "stability": Registration(draw_stability, confirms_stability),
}
