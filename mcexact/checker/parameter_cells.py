"""Boxes of parameters, cut into cells, and the plants within a cell; ``proofs/boxes.md``."""

from fractions import Fraction
from itertools import chain
from math import comb, lcm, prod
from operator import add

from . import budget
from .arithmetic import Matrix
from .boxes import Box
from .common_factors import Terms
from .parametric_system import FunctionSystem
from .reading import Json, integer, items, malformed, require
from .several_parameters import Quotient
from .system import System

Cell = list[tuple[Fraction, Fraction]]
"""The least and the largest value of each parameter."""
Exponents = tuple[int, ...]
ZERO = Fraction(0)


def cells_of(cuts: Json, place: str, plant: FunctionSystem) -> list[Cell]:
    """The cells that remain where cells are cut in half, which cover the ranges."""
    whole: Cell = []
    for name, (low, high) in plant.ranges.items():
        if low is None or high is None:
            malformed(f"parameters.{name}.range", "expected two ends")
        whole.append((low, high))
    left, found = [whole], []
    for k, cut in enumerate(items(cuts, place)):
        require(bool(left), "cuts", f"{place}[{k}]", "no cell is left")
        cell = left.pop()
        budget.spend(100 * len(cell) + budget.fractions(4, budget.limbs_of([*chain(*cell)])))
        if cut is None:
            found.append(cell)
            continue
        if integer(cut, f"{place}[{k}]") >= len(cell):
            malformed(f"{place}[{k}]", f"expected null or a position below {len(cell)}")
        low, high = cell[cut]
        middle = (low + high) / 2
        left += [[*cell[:cut], half, *cell[cut + 1 :]] for half in ((middle, high), (low, middle))]
    require(not left, "cuts", place, f"{len(left)} cells are left")
    return found


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
        found: Terms = {}
        budget.spend(20 * len(p))
        if not any(e[k] for e in p):
            continue
        for e, factor in p.items():
            longest = (e[k] + 1) * budget.limbs_of([c]) + budget.limbs_of([factor]) + e[k]
            budget.spend(budget.fractions((4 + len(e) // 8) * (e[k] + 1), longest))
            for j in range(e[k] + 1):
                key = (*e[:k], j, *e[k + 1 :])
                found[key] = found.get(key, Fraction(0)) + factor * comb(e[k], j) * c ** (e[k] - j)
        p = found
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
    told = [f"of the parameter {t} from {low} to {high}" for t, (low, high) in plant.ranges.items()]
    return f"for all real values {' and '.join(told)}"
