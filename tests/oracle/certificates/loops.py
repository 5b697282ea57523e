"""Eigenvalues of the matrix of a subject, and the loop of a distributed observer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from flint import fmpq, fmpq_mat

from .algebra import identity
from .constructions import subject_of
from .controllers import Loop, read_agents
from .reading import demand, polynomial, rational, record, truth
from .roots import damped, inside
from .systems import System


def bound_of(value: Any, time: str) -> fmpq | None:
    """A rate of at least 0, or a radius above 0 and at most 1."""
    if value is None:
        return None
    bound = rational(value)
    demand(bound >= 0 if time == "continuous" else 0 < bound <= 1, "expected a bound")
    return bound


def stability(claim: Any, witness: Any, system: System) -> bool:
    """Where the roots of χ_A are."""
    found = record(claim, "bound", "stable", optional=("damping", "largest_modulus"))
    bound, p = bound_of(found["bound"], system.time), system.A.charpoly()
    held = inside(p, system.time, bound)
    if len(found) > 2:
        demand(system.time == "continuous", "expected limits in continuous time alone")
    if "damping" in found:
        zeta = rational(found["damping"])
        demand(0 < zeta < 1, "expected a damping ratio")
        held = held and damped(p, zeta)
    if "largest_modulus" in found:
        most = rational(found["largest_modulus"])
        demand(most > 0, "expected a modulus")
        held = held and inside(p, "discrete", most)
    return truth(found["stable"]) is held


def closed_loop_spectrum(claim: Any, witness: Any, system: System) -> bool:
    """χ_A."""
    found = record(claim, "polynomial")
    return bool(polynomial(found["polynomial"], monic=True) == system.A.charpoly())


def distributed_observer(claim: Any, document: Mapping[str, Any], system: System) -> bool:
    """The loop in the coordinates x, e_i = x_i − x and z_i."""
    found = record(claim, "feedback", "error", "bound")
    steps = document["subject"]
    demand(bool(steps) and steps[-1].get("construction") == "closed_loop", "expected a loop")
    plant = subject_of(document, len(steps) - 1)
    n, total = plant.n, system.n
    agents = read_agents(plant, steps[-1]["controller"])
    layout = Loop(plant, agents)
    if any(agent.shared != n for agent in agents):
        return False
    if any(steps and size for (_, _, steps), size in layout.size.items()):
        return False  # messages are under way
    T, back = identity(total), identity(total)
    for i in range(plant.m):
        for k in range(n):
            T[layout.start["shared", i, 0] + k, k] = -1
            back[layout.start["shared", i, 0] + k, k] = 1
    moved = (T * system.A * back).tolist()
    if any(v != 0 for row in moved[n:] for v in row[:n]):
        return False
    feedback = fmpq_mat(n, n, [v for row in moved[:n] for v in row[:n]]).charpoly()
    size = total - n
    error = fmpq_mat(size, size, [v for row in moved[n:] for v in row[n:]]).charpoly()
    bound = bound_of(found["bound"], system.time)
    given = [polynomial(found[key], monic=True) for key in ("feedback", "error")]
    if given != [feedback, error]:
        return False
    return bound is None or all(inside(p, system.time, bound) for p in given)


JUDGES = {
    "closed_loop_spectrum": closed_loop_spectrum,
    "distributed_observer": distributed_observer,
    "stability": stability,
}
"""The judge of each kind."""
