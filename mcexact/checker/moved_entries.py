"""Constructions that only put entries elsewhere, applied to plants with a parameter."""

from dataclasses import replace

from . import budget
from .arithmetic import Matrix
from .boxes import LOOP, system_of
from .function_loops import FunctionLoop
from .parametric_system import FunctionSystem, Table, one_parameter
from .reading import Json, incomplete, items, malformed
from .subject import CONSTRUCTIONS, read_subject
from .system import System

# fmt: off
MOVING = (
    "arcs", "augmented_outputs", "dual", "extended", "full_output", "integrators", "merged",
    "restricted",
)
# fmt: on
"""The others compute with entries, or need the delays of a neighbor graph."""
OF_SEVERAL = ("parametric_box_controllable", "parametric_box_fixed")
"""The kinds that are also about plants with several parameters."""


def moved(steps: Json, plant: FunctionSystem) -> FunctionSystem:
    """Apply constructions, which make a matrix of entries of the plant, of 0 and of 1.

    So they are applied to numbers in the places of the entries, 0 for 0 and else 2, 3, …, which
    tell from the result which entry stands where.  The plant has the neighbor graph without edges.

    Open: see ``proofs/OPEN.md``.
    """
    for k, step in enumerate(items(steps, "subject")):
        name = step.get("construction") if isinstance(step, dict) else None
        if type(name) is str and name in CONSTRUCTIONS and name not in MOVING:
            incomplete("construction", f"subject[{k}]", f"{name} does not apply to parameters")
    if not steps:
        return plant
    known = [plant.number(0), plant.number(1)]

    def numbered(table: Table) -> Matrix:
        rows, ncols = table
        budget.spend(budget.table(len(rows), ncols, 1))
        result = []
        for row in rows:
            result.append([len(known) + j if entry[0] else 0 for j, entry in enumerate(row)])
            known.extend(row)
        return Matrix(result, ncols)

    def entries(M: Matrix) -> Table:
        budget.spend(budget.table(M.nrows, M.ncols))
        return [[known[k] for k in row] for row in M.rows], M.ncols

    A, *ports = map(numbered, plant.tables)
    alone = [[i] for i in range(plant.m)]
    start = System(plant.time, plant.names, A, ports[0::2], ports[1::2], alone, words=plant.words)
    made = read_subject(steps, start)
    pairs = [M for pair in zip(made.B, made.C, strict=True) for M in pair]
    tables = [entries(M) for M in (made.A, *pairs)]
    return plant.remade(tables, names=made.names, neighbors=made.neighbors, words=made.words)


def looped(steps: Json, plant: FunctionSystem) -> FunctionSystem:
    """The same, where a closed loop may be the last construction.

    Its matrix depends on the values; its words, its controller and its states do not.
    """
    *before, last = items(steps, "subject") or [None]
    if not isinstance(last, dict) or last.get("construction") != LOOP:
        return moved(steps, plant)
    inside = moved(before, plant)
    A, *ports = (Matrix.zeros(len(rows), ncols) for rows, ncols in inside.tables)
    still = System(inside.time, inside.names, A, ports[0::2], ports[1::2], inside.neighbors)
    loop = read_subject([last], replace(still, words=inside.words))
    return FunctionLoop(
        time=inside.time,
        names=[],
        ranges=inside.ranges,
        tables=inside.tables,
        document=inside.document,
        words=loop.words,
        controller=loop.controller,
        ports=loop.ports,
        inside=inside,
        programs=last["controller"],
        states=loop.n,
    )


def constructed(steps: Json, plant: System | FunctionSystem) -> System | FunctionSystem:
    """What constructions make from a plant."""
    return moved(steps, plant) if isinstance(plant, FunctionSystem) else read_subject(steps, plant)


def subject_of(steps: Json, plant: System | FunctionSystem, kind: str) -> System | FunctionSystem:
    """The plant, or what constructions make from it, for a kind of claims."""
    parametric = isinstance(plant, FunctionSystem)
    if parametric != kind.startswith("parametric_"):
        message = "plants without parameters" if parametric else "plants with parameters"
        malformed("system", f"the kind {kind} is about {message}")
    if isinstance(plant, FunctionSystem):
        if kind == "parametric_box_stable":
            return looped(steps, plant)
        return moved(steps, plant if kind in OF_SEVERAL else one_parameter(plant))
    return system_of(steps, plant, kind)
