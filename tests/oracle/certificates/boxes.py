"""The kinds about boxes: a member for which the claim is false refutes it.

No finite number of members proves such a claim.  Some vertices and some members inside are decided
exactly, each like any other system.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from flint import fmpq, fmpq_mat

from . import algebra
from .constructions import built
from .controllers import MAPS, read_agents
from .loops import bound_of
from .modes import fixed_modes
from .reading import demand, listed, positions, record
from .roots import inside
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
    radii = record(claim, "bound", "gain_radii")["gain_radii"]
    return _all_inside(claim, members(document, radii), system.time)


def stable_in_ranges(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """At all values every eigenvalue lies in the region."""
    radii = record(claim, "bound", "gain_radii")["gain_radii"]
    return _all_inside(claim, members_in_ranges(document, radii), system.time)


def _all_inside(claim: Any, systems: Iterator[System], time: str) -> bool:
    bound = bound_of(claim["bound"], time)
    return all(inside(each.A.charpoly(), time, bound) for each in systems)
