"""The kinds about boxes: a member for which the claim is false refutes it.

No finite number of members proves such a claim.  Some vertices and some members inside are decided
exactly, each like any other system.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from flint import fmpq, fmpq_mat

from . import algebra
from .algebra import below, beside, selection
from .constructions import built
from .controllers import MAPS, read_agents
from .loops import bound_of
from .modes import fixed_modes
from .performance import disturbed_loop
from .reading import demand, listed, positions, rational, record
from .roots import inside
from .sampling import sharpened
from .several_parameters import read_several
from .systems import System, read_plant

VERTICES, INNER = 5, 2
"""The numbers of members besides the center."""
Shares = Iterator[fmpq]
"""For one entry after the other, the part of the radius that is added, from −1 to 1."""


def shares() -> Iterator[Shares]:
    """The center, vertices, and members inside, the same ones every time."""
    rng = random.Random(11)
    yield iter(lambda: fmpq(0), None)
    for _ in range(VERTICES):
        yield iter(lambda: fmpq(rng.choice((-1, 1))), None)
    for _ in range(INNER):
        yield iter(lambda: fmpq(rng.randint(-8, 8), 8), None)


def moved(M: fmpq_mat, radii: fmpq_mat, parts: Shares) -> fmpq_mat:
    """A matrix whose entries are within their radii."""
    pairs = zip(M.entries(), radii.entries(), strict=True)
    return fmpq_mat(M.nrows(), M.ncols(), [x + r * next(parts) if r != 0 else x for x, r in pairs])


def member(plant: System, parts: Shares) -> System:
    """A plant of the box."""
    if plant.radii is None:
        return plant
    A, B, C = plant.radii
    return replace(
        plant,
        A=moved(plant.A, A, parts),
        B=tuple(moved(M, D, parts) for M, D in zip(plant.B, B, strict=True)),
        C=tuple(moved(M, D, parts) for M, D in zip(plant.C, C, strict=True)),
        radii=None,
    )


def members(document: Mapping[str, Any], gain_radii: Any = None) -> Iterator[System]:
    """The subjects of some members."""
    plant, steps = read_plant(document["system"]), listed(document["subject"])
    for parts in shares():
        yield with_gains(member(plant, parts), steps, gain_radii, parts)


def with_gains(plant: System, steps: Sequence[Any], radii: Any, parts: Shares) -> System:
    """The subject of a plant, with gains of its controller within their radii, if there are any."""
    steps = sharpened(steps)
    if radii is None:
        return built(plant, steps)
    named = [step.get("construction") for step in steps[-1:]]
    demand(named == ["closed_loop"], "expected a closed loop")
    system = built(plant, steps[:-1])
    controller = moved_controller(system, steps[-1]["controller"], radii, parts)
    return built(system, [{**steps[-1], "controller": controller}])


def moved_controller(system: System, controller: Any, radii: Any, parts: Shares) -> Any:
    """A controller whose gains are within their radii."""
    found = []
    given = zip(read_agents(system, controller), read_agents(system, radii), strict=True)
    for (agent, around), name in zip(given, system.names, strict=True):
        sizes = (agent.shared, agent.private, agent.hold) == (
            around.shared,
            around.private,
            around.hold,
        )
        demand(sizes, "expected agents of the same sizes")
        document: dict[str, Any] = {"name": name, "shared": agent.shared, "private": agent.private}
        document["hold"] = {system.names[i]: steps for i, steps in agent.hold.items()}
        for label in MAPS:
            maps, widths = agent.maps[label], around.maps[label]
            made: dict[str, Any] = {}
            for kind, j in {**maps, **widths}:
                known = maps.get((kind, j), widths.get((kind, j)))
                zero = fmpq_mat(known.nrows(), known.ncols())
                D = widths.get((kind, j), zero)
                demand(all(r >= 0 for r in D.entries()), "expected radii from 0 on")
                rows = written(moved(maps.get((kind, j), zero), D, parts))
                if kind in ("private", "reference"):
                    made[kind] = rows
                else:
                    made.setdefault(kind, {})[system.names[j]] = rows
            document[label] = made
        found.append(document)
    return {"time": system.time, "agents": found}


def written(M: fmpq_mat) -> Any:
    """A matrix of a controller."""
    if not M.nrows():
        return {"shape": [0, M.ncols()], "entries": []}
    return [[int(v.p) if v.q == 1 else str(v) for v in row] for row in M.tolist()]


def members_in_ranges(document: Mapping[str, Any], gain_radii: Any = None) -> Iterator[System]:
    """The subjects at some values within the ranges of parameters."""
    plant, steps = read_several(document["system"]), listed(document["subject"])
    for values in plant.points():
        for parts in [*shares()][: 1 if gain_radii is None else None]:
            yield with_gains(plant.at(values), steps, gain_radii, parts)


def fixed(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """No member has a fixed mode outside of the region."""
    return _none_fixed(claim, members(document), system.time)


def fixed_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At no values is a mode fixed outside of the region."""
    return _none_fixed(claim, members_in_ranges(document), system.time)


def _none_fixed(claim: Any, systems: Iterator[System], time: str) -> bool:
    given = record(claim, "bound")["bound"]
    bound = bound_of(given, time)
    return not any(
        given is None or not inside(mode.polynomial, time, bound)
        for each in systems
        for mode in fixed_modes(each)
    )


def controllable(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The channels leave no member an uncontrollable mode outside of the region."""
    return _all_controlled(claim, members(document), system)


def controllable_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At no values do the channels leave an uncontrollable mode outside of the region."""
    return _all_controlled(claim, members_in_ranges(document), system)


def _all_controlled(claim: Any, systems: Iterator[System], system: System) -> bool:
    found = record(claim, "channels", "bound")
    T, bound = positions(found["channels"], system.names), bound_of(found["bound"], system.time)
    for each in systems:
        K = algebra.krylov(each.A, each.inputs(T), each.n)
        uncontrolled = algebra.quotient_polynomial(each.A, K)
        if uncontrolled.degree() > 0 and (
            found["bound"] is None or not inside(uncontrolled, each.time, bound)
        ):
            return False
    return True


def stable(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """Every eigenvalue of every member lies in the region."""
    optional = ["disk"] if isinstance(claim, Mapping) and "disk" in claim else []
    found = record(claim, "bound", "gain_radii", *optional)
    radii = found["gain_radii"]
    if not _all_inside(claim, members(document, radii), system.time):
        return False
    return not optional or _all_multiplied(claim, found["disk"], document, system.time)


def _all_multiplied(claim: Any, disk: Any, document: Mapping[str, Any], time: str) -> bool:
    """Whether loops of members are in the region with one port multiplied, at some δ each."""
    given = record(disk, "at", "margin")
    demand(given["at"] in ("inputs", "outputs"), "expected inputs or outputs")
    alpha, bound = rational(given["margin"]), bound_of(claim["bound"], time)
    demand(0 < alpha < 2, "expected a margin above 0, below 2")
    plant, steps = read_plant(document["system"]), listed(document["subject"])
    demand(bool(steps) and steps[-1].get("construction") == "closed_loop", "expected a loop")
    ports = None
    for parts in shares():
        system = built(member(plant, parts), steps[:-1])
        controller = steps[-1]["controller"]
        if claim["gain_radii"] is not None:
            controller = moved_controller(system, controller, claim["gain_radii"], parts)
        loop = disturbed_loop(system, read_agents(system, controller))
        X, Y = (loop.E, loop.U) if given["at"] == "inputs" else (loop.G, loop.Y)
        ports = Y.nrows()
        for k in range(ports):
            enter = X * selection(ports, [k]).transpose()
            leave = selection(ports, [k]) * Y
            for delta in worst_numbers((loop.M, enter, leave), alpha, bound, time):
                if not inside(multiplied(loop.M, enter * leave, delta).charpoly(), time, bound):
                    return False
    demand(bool(ports), "expected a port")
    return True


def multiplied(M: fmpq_mat, product: fmpq_mat, delta: tuple[fmpq, fmpq]) -> fmpq_mat:
    """[Re, −Im; Im, Re] of M + (f − 1)EU, f = (1 + δ/2)/(1 − δ/2): its eigenvalues, and conjugates.

    f − 1 = δ/(1 − δ/2).
    """
    a, b = delta
    real, imaginary = 1 - a / 2, -b / 2
    size = real * real + imaginary * imaginary
    re, im = (a * real + b * imaginary) / size, (b * real - a * imaginary) / size
    top = beside([M + re * product, -im * product], M.nrows())
    bottom = beside([im * product, M + re * product], M.nrows())
    return below([top, bottom], 2 * M.nrows())


def worst_numbers(
    loop: tuple[fmpq_mat, fmpq_mat, fmpq_mat], alpha: fmpq, bound: fmpq | None, time: str
) -> list[tuple[fmpq, fmpq]]:
    """Numbers with |δ| = α: those that bring an eigenvalue nearest to the border, and some others.

    δ (T(λ) + 1/2) = 1 puts the eigenvalue λ there; where |T + 1/2| is largest at a point of the
    border, the δ of its direction is the worst one.
    """
    M, E, U = (
        np.array([[int(x.p) / int(x.q) for x in row] for row in each.tolist()], dtype=complex)
        for each in loop
    )
    n = len(M)
    edge = int(time == "discrete") if bound is None else int(bound.p) / int(bound.q)
    if time == "discrete":
        points = edge * np.exp(1j * np.linspace(0, np.pi, 400))
    else:
        values = np.abs(np.linalg.eigvals(M)) if n else np.ones(1)
        top = max(float(values.max(initial=1.0)), 1e-3)
        points = -edge + 1j * np.concatenate([[0], values, np.geomspace(top / 1e4, 100 * top, 400)])
    gains = []
    for z in points:
        try:
            T = (U @ np.linalg.solve(z * np.eye(n) - M, E))[0, 0] if n else 0.0
        except np.linalg.LinAlgError:
            continue
        gains.append(T + 0.5)
    worst = sorted(gains, key=abs)[-2:]
    angles = [-np.angle(gain) for gain in worst] + [0.0, np.pi, np.pi / 2]
    return [_on_circle(alpha, float(angle)) for angle in angles]


def _on_circle(alpha: fmpq, angle: float) -> tuple[fmpq, fmpq]:
    """A rational point of the circle with this radius, near an angle."""
    if abs(abs(angle) - np.pi) < 1e-6:
        return -alpha, fmpq(0)
    t = fmpq(round(np.tan(angle / 2) * 10**6), 10**6)
    return alpha * (1 - t * t) / (1 + t * t), alpha * 2 * t / (1 + t * t)


def stable_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At all values every eigenvalue lies in the region."""
    radii = record(claim, "bound", "gain_radii")["gain_radii"]
    return _all_inside(claim, members_in_ranges(document, radii), system.time)


def _all_inside(claim: Any, systems: Iterator[System], time: str) -> bool:
    bound = bound_of(claim["bound"], time)
    return all(inside(each.A.charpoly(), time, bound) for each in systems)
