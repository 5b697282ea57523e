"""Ranges of parameters cut into cells, and constructions for plants with parameters.

A claim about all values in ranges is checked cell by cell.  The certificate lists the cuts;
`cells_of` repeats them, and stops unless every cell is accounted for.  `box_of_cell` encloses the
plants at all values of a cell in a box around the plant at the middle: the linear part in each
parameter is common to all entries (``tied``), and the rest of each entry is within its radius.

Constructions apply to rational functions in two ways.  Those that only place entries, zeros and
ones are applied to numbers that stand for the entries (`rearranged`), so that each construction is
written once, for numbers.  A line through the space of the parameters is substituted into the
entries (`along_line`).  Other constructions are refused as INCOMPLETE.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import chain, count
from math import comb, lcm, prod
from operator import add
from typing import Any

from .constructions import CONSTRUCTIONS, LINE, closed_loop, read_subject
from .core import budget
from .core.arithmetic import Matrix, Polynomial, poly_product, stripped
from .core.reading import (
    Json,
    fields,
    incomplete,
    integer,
    items,
    malformed,
    rational,
    require,
    string,
)
from .core.system import System, polynomial_text
from .discs import LOOP, Box, system_of
from .parametric_system import (
    PARAMETER,
    Function,
    FunctionSystem,
    ParametricSystem,
    Quotient,
    Table,
    Terms,
    cleared_tables,
    in_lowest_terms,
    least_denominator,
    one_parameter,
)

# Cells of the ranges, and boxes around the plants at their values; ``proofs/boxes.md``.

Cell = list[tuple[Fraction, Fraction]]
"""The least and the largest value of each parameter."""
Exponents = tuple[int, ...]
ZERO = Fraction(0)


def cells_of(cuts: Json, place: str, plant: FunctionSystem) -> list[Cell]:
    """The leaves of the bisection tree that the cuts describe; their union is the ranges."""
    whole: Cell = []
    for name, (low, high) in plant.ranges.items():
        if low is None or high is None:
            malformed(f"parameters.{name}.range", "expected two ends")
        whole.append((low, high))
    left, leaves = [whole], []
    for k, cut in enumerate(items(cuts, place)):
        require(bool(left), "cuts", f"{place}[{k}]", "no cell is left")
        cell = left.pop()
        budget.spend(100 * len(cell) + budget.fractions(4, budget.limbs_of([*chain(*cell)])))
        if cut is None:
            leaves.append(cell)
            continue
        if integer(cut, f"{place}[{k}]") >= len(cell):
            malformed(f"{place}[{k}]", f"expected null or a position below {len(cell)}")
        low, high = cell[cut]
        middle = (low + high) / 2
        left += [[*cell[:cut], half, *cell[cut + 1 :]] for half in ((middle, high), (low, middle))]
    require(not left, "cuts", place, f"{len(left)} cells are left")
    return leaves


def box_of_cell(plant: FunctionSystem, cell: Cell) -> Box:
    """A box that contains the plant at all values of a cell.

    Its values are those at the middle; the slopes of all entries with respect to one parameter are
    tied, and the rest of each entry is within its radius.

    Open: see ``proofs/OPEN.md``.
    """
    center = [(low + high) / 2 for low, high in cell]
    widths = [(high - low) / 2 for low, high in cell]
    units = _units(len(cell))
    layers: list[list[Matrix]] = []
    for k, (rows, ncols) in enumerate(plant.tables):
        where = "A" if not k else f"channels[{(k - 1) // 2}].{'BC'[(k - 1) % 2]}"
        forms = [[_form(plant.terms(e), center, widths, units, where) for e in row] for row in rows]
        parts = range(len(cell) + 2)
        layers.append([_matrix([[form[i] for form in row] for row in forms], ncols) for i in parts])

    def system(part: int) -> System:
        A, *ports = (each[part] for each in layers)
        heard, words = plant.neighbors, plant.words
        return System(plant.time, plant.names, A, ports[0::2], ports[1::2], heard, words=words)

    middle, rest, *slopes = map(system, range(len(cell) + 2))
    return Box(**vars(middle), radii=rest, tied=tuple(slopes))


def _units(number: int) -> list[Exponents]:
    """The exponents of the parameters themselves."""
    budget.spend(budget.table(number, number))
    return [tuple(int(i == k) for i in range(number)) for k in range(number)]


def _form(
    entry: Quotient,
    center: list[Fraction],
    widths: list[Fraction],
    units: list[Exponents],
    where: str,
) -> list[Fraction]:
    """The value f_0, the largest rest, and each f_k times its width, of f_0 + Σ f_k h_k + rest.

    With N/D in powers of h, f_0 = N_0/D_0, f_k = (N_k − f_0 D_k)/D_0, and D times the rest is
    N − (f_0 + Σ f_k h_k) D, whose terms are of degree 2 and more.
    """
    N, D = (_shifted(p, center) for p in entry)
    zero = (0,) * len(center)
    least = 2 * abs(D[zero]) - _largest(D, widths)
    require(least > 0, "undefined", where, "a denominator may be 0 in the range")
    longest = budget.limbs_of([*N.values(), *D.values()])
    budget.spend(budget.fractions(3 * len(center), 3 * longest))
    value = N.get(zero, ZERO) / D[zero]
    slopes = [N.get(u, ZERO) - (value * D[u] if u in D else ZERO) for u in units]
    slopes = [slope / D[zero] if slope else ZERO for slope in slopes]
    rest = dict(N)
    for step, slope in zip([zero, *units], [value, *slopes], strict=True):
        if slope:
            budget.spend(budget.fractions(len(D) * (len(center) // 4 + 4), 4 * longest))
            for e, c in D.items():
                key = tuple(map(add, e, step))
                rest[key] = rest.get(key, ZERO) - slope * c
    over = _largest(rest, widths) / least
    budget.spend(budget.fractions(len(center) + 1, longest + budget.limbs_of([*widths, over])))
    return [value, over, *(f * w if f else ZERO for f, w in zip(slopes, widths, strict=True))]


def _largest(p: Terms, widths: list[Fraction]) -> Fraction:
    """The sum of the largest absolute values of all terms."""
    turns = sum(map(sum, p)) + len(p) * (len(widths) // 4 + 2)
    highest = max(map(sum, p), default=0)
    longest = highest * budget.limbs_of(widths) + budget.limbs_of(list(p.values()))
    budget.spend(budget.fractions(turns, longest))
    parts = (
        abs(c) * prod(w**k for w, k in zip(widths, e, strict=True) if k) for e, c in p.items() if c
    )
    return sum(parts, ZERO)


def _shifted(p: Terms, center: list[Fraction]) -> Terms:
    """The terms in powers of the differences from a center."""
    for k, c in enumerate(center):
        terms: Terms = {}
        budget.spend(20 * len(p))
        if not any(e[k] for e in p):
            continue
        for e, factor in p.items():
            longest = (e[k] + 1) * budget.limbs_of([c]) + budget.limbs_of([factor]) + e[k]
            budget.spend(budget.fractions((4 + len(e) // 8) * (e[k] + 1), longest))
            for j in range(e[k] + 1):
                key = (*e[:k], j, *e[k + 1 :])
                terms[key] = terms.get(key, Fraction(0)) + factor * comb(e[k], j) * c ** (e[k] - j)
        p = terms
    return p


def _matrix(rows: list[list[Fraction]], ncols: int) -> Matrix:
    """A matrix of fractions."""
    entries = [x for row in rows for x in row]
    longest, different = budget.limbs_of(entries), {x.denominator for x in entries}
    whole = sum(budget.limbs([d]) for d in different)
    budget.spend(budget.fractions(len(different), whole))
    budget.build(len(rows), ncols, longest, min(whole, longest * len(different)))
    d = lcm(*different)
    return Matrix([[x.numerator * (d // x.denominator) for x in row] for row in rows], ncols, d)


def ranges_text(plant: FunctionSystem) -> str:
    """The words with which a statement about all values in the ranges begins."""
    ranges = [
        f"of the parameter {t} from {low} to {high}" for t, (low, high) in plant.ranges.items()
    ]
    return f"for all real values {' and '.join(ranges)}"


# Closed loops at the values of a cell; ``proofs/boxes.md``.


@dataclass(frozen=True, kw_only=True)
class FunctionLoop(FunctionSystem):
    """The closed loop of ``inside`` with a controller; it has the tables of ``inside``."""

    inside: FunctionSystem
    programs: Json
    states: int

    @property
    def n(self) -> int:
        """The number of states."""
        return self.states


def members_of_cell(plant: FunctionSystem, cell: Cell) -> Box:
    """A box that contains the plant, or its loop, at all values of a cell.

    Open: see ``proofs/OPEN.md``.
    """
    if not isinstance(plant, FunctionLoop):
        return box_of_cell(plant, cell)
    box, programs = box_of_cell(plant.inside, cell), plant.programs
    loop = closed_loop(box, {"controller": programs}, "subject")
    return Box(**vars(loop), plant=box, programs=programs)


def boxes_of_cells(witness: Json, plant: FunctionSystem) -> Iterator[tuple[Box, Json]]:
    """For each cell a box that contains the plants at its values, and the evidence about it."""
    cuts, parts = fields(witness, "witness", "cuts", "parts")
    cells = cells_of(cuts, "witness.cuts", plant)
    for cell, part in zip(cells, items(parts, "witness.parts", len(cells)), strict=True):
        yield members_of_cell(plant, cell), part


# Constructions of plants with parameters: those that only place entries, and lines.

# fmt: off
REARRANGING = (
    "arcs", "augmented_outputs", "dual", "extended", "full_output", "integrators", "merged",
    "restricted",
)
# fmt: on
"""The others compute with entries, or need the delays of a neighbor graph."""
ENDS = ("point", "direction")
"""The keys of a line: a and b by parameter."""
OF_SEVERAL = ("parametric_box_controllable", "parametric_box_fixed")
"""The kinds that are also about plants with several parameters."""


def rearranged(steps: Json, plant: FunctionSystem) -> FunctionSystem:
    """Apply constructions, which make a matrix of entries of the plant, of 0 and of 1.

    So they are applied to numbers in the places of the entries, 0 for 0 and else 2k, 2k + 2, …,
    which tell from the result which entry stands where: with k the number of all entries and more,
    sums and products of such numbers, and those with 1 added, are none of them.  The plant has the
    neighbor graph without edges.

    A line comes before all of them, and its system is then what they are applied to.

    Open: see ``proofs/OPEN.md``.
    """
    for k, step in enumerate(items(steps, "subject")):
        name = step.get("construction") if isinstance(step, dict) else None
        if type(name) is str and name in CONSTRUCTIONS and name not in (*REARRANGING, LINE):
            incomplete("construction", f"subject[{k}]", f"{name} does not apply to parameters")
    first, before = (steps or [None])[0], 0
    if isinstance(first, dict) and first.get("construction") == LINE:
        plant, steps, before = along_line(plant, first, "subject[0]"), steps[1:], 1
    if not steps:
        return plant
    known = {0: plant.number(0), 1: plant.number(1)}
    numbers = count(2 * sum(len(rows) * ncols + 1 for rows, ncols in plant.tables), 2)

    def number_of(entry: Quotient) -> int:
        if not entry[0]:
            return 0
        known[number := next(numbers)] = entry
        return number

    def numbered(table: Table) -> Matrix:
        rows, ncols = table
        budget.spend(budget.table(len(rows), ncols, 1))
        return Matrix([[number_of(entry) for entry in row] for row in rows], ncols)

    def entries(M: Matrix) -> Table:
        budget.spend(budget.table(M.nrows, M.ncols))
        if M.denominator != 1 or not all(k in known for row in M.rows for k in row):
            incomplete("construction", "subject", "it does not only place entries elsewhere")
        return [[known[k] for k in row] for row in M.rows], M.ncols

    A, *ports = map(numbered, plant.tables)
    alone = [[i] for i in range(plant.m)]
    start = System(plant.time, plant.names, A, ports[0::2], ports[1::2], alone, words=plant.words)
    subject = read_subject(steps, start, before)
    pairs = [M for pair in zip(subject.B, subject.C, strict=True) for M in pair]
    tables = [entries(M) for M in (subject.A, *pairs)]
    return plant.remade(
        tables, names=subject.names, neighbors=subject.neighbors, words=subject.words
    )


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
    """As `rearranged`, but a closed loop may be the last construction.

    Its matrix depends on the values; its words, its controller and its states do not.
    """
    *before, last = items(steps, "subject") or [None]
    if not isinstance(last, dict) or last.get("construction") != LOOP:
        return rearranged(steps, plant)
    inside = rearranged(before, plant)
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
    return (
        rearranged(steps, plant)
        if isinstance(plant, FunctionSystem)
        else read_subject(steps, plant)
    )


def subject_of(steps: Json, plant: System | FunctionSystem, kind: str) -> System | FunctionSystem:
    """The plant, or what constructions make from it, for a kind of claims."""
    parametric = isinstance(plant, FunctionSystem)
    if parametric != kind.startswith("parametric_"):
        message = "plants without parameters" if parametric else "plants with parameters"
        malformed("system", f"the kind {kind} is about {message}")
    if isinstance(plant, FunctionSystem):
        if kind == "parametric_box_stable":
            return looped(steps, plant)
        subject = rearranged(steps, plant)
        return subject if kind in OF_SEVERAL else one_parameter(subject)
    return system_of(steps, plant, kind)
