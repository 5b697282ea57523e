"""Constructions of plants with parameters: those that only put entries elsewhere, and lines."""

from dataclasses import replace
from fractions import Fraction
from typing import Any

from . import budget
from .arithmetic import Matrix, Polynomial, poly_product, stripped
from .boxes import LOOP, system_of
from .common_factors import Terms
from .expressions import PARAMETER, Function, in_lowest_terms
from .function_loops import FunctionLoop
from .parametric_system import (
    FunctionSystem,
    ParametricSystem,
    Table,
    cleared_tables,
    least_denominator,
    one_parameter,
)
from .reading import Json, fields, incomplete, items, malformed, rational, require, string
from .statement import polynomial_text
from .subject import CONSTRUCTIONS, LINE, read_subject
from .system import System

# fmt: off
MOVING = (
    "arcs", "augmented_outputs", "dual", "extended", "full_output", "integrators", "merged",
    "restricted",
)
# fmt: on
"""The others compute with entries, or need the delays of a neighbor graph."""
ENDS = ("point", "direction")
"""The keys of a line: a and b by parameter."""
OF_SEVERAL = ("parametric_box_controllable", "parametric_box_fixed")
"""The kinds that are also about plants with several parameters."""


def moved(steps: Json, plant: FunctionSystem) -> FunctionSystem:
    """Apply constructions, which make a matrix of entries of the plant, of 0 and of 1.

    So they are applied to numbers in the places of the entries, 0 for 0 and else 2, 3, …, which
    tell from the result which entry stands where.  The plant has the neighbor graph without edges.

    A line comes before all of them, and its system is then what they are applied to.

    Open: see ``proofs/OPEN.md``.
    """
    for k, step in enumerate(items(steps, "subject")):
        name = step.get("construction") if isinstance(step, dict) else None
        if type(name) is str and name in CONSTRUCTIONS and name not in (*MOVING, LINE):
            incomplete("construction", f"subject[{k}]", f"{name} does not apply to parameters")
    first, before = (steps or [None])[0], 0
    if isinstance(first, dict) and first.get("construction") == LINE:
        plant, steps, before = along_line(plant, first, "subject[0]"), steps[1:], 1
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
    made = read_subject(steps, start, before)
    pairs = [M for pair in zip(made.B, made.C, strict=True) for M in pair]
    tables = [entries(M) for M in (made.A, *pairs)]
    return plant.remade(tables, names=made.names, neighbors=made.neighbors, words=made.words)


def along_line(plant: FunctionSystem, step: dict[str, Json], place: str) -> ParametricSystem:
    """The plant on a line through the space of its parameters, each a + b s, for every s.

    It keeps the poles of the plant, also where numerators vanish with them.

    Open: see ``proofs/OPEN.md``.
    """
    _, letter, point, direction = fields(step, place, "construction", "parameter", *ENDS)
    known, inside = tuple(plant.ranges), f"{place}.parameter"
    s = string(letter, inside)
    if not PARAMETER.fullmatch(s) or s == "x" or s in known:
        malformed(inside, "expected the name of a parameter that the plant does not have")
    a, b = (
        [rational(c, f"{place}.{key}") for c in fields(value, f"{place}.{key}", *known)]
        for key, value in zip(ENDS, (point, direction), strict=True)
    )
    require(any(b), "subject", f"{place}.direction", "expected a direction that is not 0")
    lines = [stripped([start, slope]) for start, slope in zip(a, b, strict=True)]
    powers = [Powers(line) for line in lines]

    def bottom_of(entry: Any) -> Polynomial:
        below = restricted_to(plant.terms(entry)[1], powers)
        require(bool(below), "subject", place, "an entry of the plant is undefined on all of it")
        return below

    tables, poles = list[Table](), list[Polynomial]()
    for rows, ncols in plant.tables:
        below = [[bottom_of(entry) for entry in row] for row in rows]
        different = dict.fromkeys(tuple(bottom) for row in below for bottom in row)
        poles.append(least_denominator([*map(list, different)]))
        pairs = [
            [*zip(row, bottoms, strict=True)] for row, bottoms in zip(rows, below, strict=True)
        ]
        tables.append(([[_entry(plant, *pair, powers) for pair in row] for row in pairs], ncols))
    texts = (polynomial_text(line, s) for line in lines)
    named = ", ".join(f"{name} = {text}" for name, text in zip(known, texts, strict=True))
    parts = cleared_tables(tables) | {"poles": poles}
    return ParametricSystem(
        time=plant.time,
        names=plant.names,
        ranges={s: (None, None)},
        document=plant.document,
        words=f"{plant.words} along the line {named}",
        parameter=s,
        range=(None, None),
        **parts,
    )


class Powers:
    """The powers of a polynomial, each made once."""

    def __init__(self, p: Polynomial) -> None:
        self.known = [[Fraction(1)], p]

    def __getitem__(self, k: int) -> Polynomial:
        while len(self.known) <= k:
            last, p = self.known[-1], self.known[1]
            self.known.append(poly_product(last, p) if p else [])
        return self.known[k]


def restricted_to(p: Terms, powers: list[Powers]) -> Polynomial:
    """A polynomial in the parameters where each of them is a polynomial."""
    total: Polynomial = []
    for exponents, c in budget.counted([*p.items()]):
        budget.spend(100 + 10 * len(exponents))
        term = [c]
        for each, e in zip(powers, exponents, strict=True):
            if e:
                term = poly_product(term, each[e]) if term and each[e] else []
        longest = budget.limbs_of(total) + budget.limbs_of(term)
        budget.spend(budget.fractions(len(term) + 1, longest))
        total += [Fraction(0)] * (len(term) - len(total))
        for k, value in enumerate(term):
            total[k] += value
    return stripped(total)


def _entry(plant: FunctionSystem, entry: Any, bottom: Polynomial, powers: list[Powers]) -> Function:
    """An entry on a line, over the denominator that it has there."""
    return in_lowest_terms(restricted_to(plant.terms(entry)[0], powers), bottom)


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
        made = moved(steps, plant)
        return made if kind in OF_SEVERAL else one_parameter(made)
    return system_of(steps, plant, kind)
