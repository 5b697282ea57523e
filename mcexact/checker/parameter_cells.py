"""Boxes of parameters, cut into cells, and the plants within a cell; ``proofs/boxes.md``."""

from fractions import Fraction
from math import comb, lcm, prod

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
        budget.spend(100 * len(cell) + budget.fractions(4, budget.limbs_of(sum(cell, ()))))
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
    layers: list[list[Matrix]] = []
    for k, (rows, ncols) in enumerate(plant.tables):
        where = "A" if not k else f"channels[{(k - 1) // 2}].{'BC'[(k - 1) % 2]}"
        forms = [[_form(plant.terms(e), center, widths, where) for e in row] for row in rows]
        parts = range(len(cell) + 2)
        layers.append([_matrix([[form[i] for form in row] for row in forms], ncols) for i in parts])

    def system(part: int) -> System:
        A, *ports = (each[part] for each in layers)
        heard, words = plant.neighbors, plant.words
        return System(plant.time, plant.names, A, ports[0::2], ports[1::2], heard, words=words)

    middle, rest, *slopes = map(system, range(len(cell) + 2))
    return Box(**vars(middle), radii=rest, tied=tuple(slopes))


def _form(
    entry: Quotient, center: list[Fraction], widths: list[Fraction], where: str
) -> list[Fraction]:
    """The value f_0, the largest rest, and each f_k times its width, of f_0 + Σ f_k h_k + rest.

    With N/D in powers of h, f_0 = N_0/D_0, f_k = (N_k − f_0 D_k)/D_0, and D times the rest is
    N − (f_0 + Σ f_k h_k) D, whose terms are of degree 2 and more.
    """
    N, D = (_shifted(p, center) for p in entry)
    units = [tuple(int(i == k) for i in range(len(center))) for k in range(len(center))]
    zero = (0,) * len(center)
    moved = sum(abs(c) * prod(map(pow, widths, e)) for e, c in D.items() if e != zero)
    least = abs(D[zero]) - moved
    require(least > 0, "undefined", where, "a denominator may be 0 in the range")
    value = N.get(zero, Fraction(0)) / D[zero]
    slopes = [(N.get(u, Fraction(0)) - value * D.get(u, Fraction(0))) / D[zero] for u in units]
    rest = dict(N)
    for step, slope in zip([zero, *units], [value, *slopes], strict=True):
        for e, c in D.items():
            key = tuple(map(sum, zip(e, step, strict=True)))
            rest[key] = rest.get(key, Fraction(0)) - slope * c
    over = sum((abs(c) * prod(map(pow, widths, e)) for e, c in rest.items()), Fraction(0))
    return [value, over / least, *(f * w for f, w in zip(slopes, widths, strict=True))]


def _shifted(p: Terms, center: list[Fraction]) -> Terms:
    """The terms in powers of the differences from a center."""
    for k, c in enumerate(center):
        found: Terms = {}
        for e, factor in p.items():
            longest = (e[k] + 1) * budget.limbs_of([c]) + budget.limbs_of([factor]) + e[k]
            budget.spend(budget.fractions(4 * (e[k] + 1), longest))
            for j in range(e[k] + 1):
                key = (*e[:k], j, *e[k + 1 :])
                found[key] = found.get(key, Fraction(0)) + factor * comb(e[k], j) * c ** (e[k] - j)
        p = found
    return p


def _matrix(rows: list[list[Fraction]], ncols: int) -> Matrix:
    """A matrix of fractions."""
    entries = [x for row in rows for x in row]
    budget.spend(budget.fractions(2 * len(entries), 2 * budget.limbs_of(entries)))
    d = lcm(*(x.denominator for x in entries))
    return Matrix([[int(x * d) for x in row] for row in rows], ncols, d)


def ranges_text(plant: FunctionSystem) -> str:
    """The words with which a statement about all values in the ranges begins."""
    told = [f"of the parameter {t} from {low} to {high}" for t, (low, high) in plant.ranges.items()]
    return f"for all real values {' and '.join(told)}"
