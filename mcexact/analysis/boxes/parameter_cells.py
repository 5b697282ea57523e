"""Boxes of parameters, cut into cells, and boxes around the plants of a cell.

On a cell with the middle p0 and the half widths r an entry is f(p0 + h) = f_0 + Σ f_k h_k + rest.
The slopes f_k r_k of all entries with respect to one parameter are added with the same factor from
−1 to 1; the rest, of second order in r, is within a radius of its own for each entry.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from math import comb, prod

from mcexact.errors import LimitReached, UsageError
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

Cell = tuple[tuple[Fraction, Fraction], ...]
"""The least and the largest value of each parameter."""
Terms = Mapping[tuple[int, ...], Fraction]


@dataclass(frozen=True)
class CellBox:
    """A box that contains the plants at all values of a cell.

    Attributes
    ----------
    system : MultiChannelSystem
        The plant at the middle.
    radii : Radii
        Of what is left of each entry.
    tied : tuple of MultiChannelSystem
        For each parameter the slopes of all entries times the half width.
    """

    system: MultiChannelSystem
    radii: Radii
    tied: tuple[MultiChannelSystem, ...]


def whole_cell(plant: ParametricSystem) -> Cell:
    """The ranges of all parameters.

    Raises
    ------
    UsageError
        If a range has an end that is not known.
    """
    found = []
    for name, (low, high) in zip(plant.parameters, plant.ranges, strict=True):
        if low is None or high is None:
            raise UsageError(f"the parameter {name!r} needs a range with two ends")
        found.append((low, high))
    return tuple(found)


def halves(cell: Cell, k: int) -> tuple[Cell, Cell]:
    """The cell cut in the middle of one parameter, the lower half first."""
    low, high = cell[k]
    middle = (low + high) / 2
    first, second = ((*cell[:k], half, *cell[k + 1 :]) for half in ((low, middle), (middle, high)))
    return first, second


def box_of_cell(plant: ParametricSystem, cell: Cell) -> CellBox:
    """Enclose the plants at all values of a cell.

    Raises
    ------
    LimitReached
        If a denominator may be 0 in the cell.

    Examples
    --------
    >>> plant = ParametricSystem([["k^2"]], [[["k"]]], [[[1]]], parameters=["k"])
    >>> found = box_of_cell(plant, ((Fraction(1), Fraction(3)),))
    >>> found.system.A[0, 0], found.tied[0].A[0, 0], found.radii.A[0, 0]
    (Fraction(4, 1), Fraction(4, 1), Fraction(1, 1))
    """
    tables = [plant.A, *(c.B for c in plant.channels), *(c.C for c in plant.channels)]
    layers = [_layers(M, cell) for M in tables]

    def parts(k: int) -> tuple[Matrix, list[Matrix], list[Matrix]]:
        A, *ports = (each[k] for each in layers)
        return A, ports[: plant.m], ports[plant.m :]

    def system(k: int) -> MultiChannelSystem:
        return MultiChannelSystem(*parts(k), time=plant.time, names=plant.names)

    return CellBox(system(0), Radii(*parts(1)), tuple(system(k + 2) for k in range(len(cell))))


def _layers(M: FunctionMatrix, cell: Cell) -> list[Matrix]:
    """The values, the radii of what is left, and the slopes times half widths."""
    forms = [[_form(entry, cell) for entry in row] for row in M.rows]
    return [
        Matrix.from_rows([[form[k] for form in row] for row in forms], ncols=M.ncols)
        for k in range(len(cell) + 2)
    ]


def _form(entry: RationalFunction, cell: Cell) -> list[Fraction]:
    """The value at the middle, the largest rest, and the slopes times half widths.

    With N/D in powers of h, f_0 = N_0/D_0, f_k = (N_k − f_0 D_k)/D_0, and D times the rest is
    N − (f_0 + Σ f_k h_k) D, whose terms are of degree 2 and more.
    """
    size = len(cell)
    center = [(low + high) / 2 for low, high in cell]
    widths = [(high - low) / 2 for low, high in cell]
    N, D = (_shifted(p, center) for p in entry.terms())
    zero = (0,) * size
    units = [tuple(int(i == k) for i in range(size)) for k in range(size)]

    def largest(p: Terms) -> Fraction:
        sizes = (abs(c) * prod(map(pow, widths, e)) for e, c in p.items())
        return sum(sizes, Fraction(0))

    bottom = D.get(zero, Fraction(0))
    least = 2 * abs(bottom) - largest(D)
    if least <= 0:
        raise LimitReached(f"the denominator of {entry} may be 0 in the range of its parameters")
    value = N.get(zero, Fraction(0)) / bottom
    slopes = [(N.get(u, Fraction(0)) - value * D.get(u, Fraction(0))) / bottom for u in units]
    rest = dict(N)
    for step, slope in zip([zero, *units], [value, *slopes], strict=True):
        for e, c in D.items():
            key = tuple(map(sum, zip(e, step, strict=True)))
            rest[key] = rest.get(key, Fraction(0)) - slope * c
    return [value, largest(rest) / least, *(f * w for f, w in zip(slopes, widths, strict=True))]


def _shifted(p: Terms, center: Sequence[Fraction]) -> Terms:
    """The terms in powers of the differences from a center."""

    def shifted(p: Terms, k: int) -> Terms:
        found: dict[tuple[int, ...], Fraction] = {}
        for e, c in p.items():
            for j in range(e[k] + 1):
                key = (*e[:k], j, *e[k + 1 :])
                moved = c * comb(e[k], j) * center[k] ** (e[k] - j)
                found[key] = found.get(key, Fraction(0)) + moved
        return found

    return reduce(shifted, range(len(center)), p)
