"""Ranges of parameters, cut into cells, and the box around each.

A cell has an interval for each parameter.  `proofs_of_cells` tries to prove a property for the box
around the plants of the whole ranges, and cuts a cell in half, in the parameter that changes the
entries most, until each cell is proved.  Where a cell is not proved, the plant at its middle is
decided exactly: if it fails, the search ends with these values.  It also ends after a number of
cells or cuts; then nothing is proved.

The box of a cell is tighter than independent radii would be, since all entries depend on the same
parameters.  On a cell with the middle p0 and the half widths r an entry is f(p0 + h) = f_0 +
Σ f_k h_k + rest.  The slopes f_k r_k of all entries with respect to one parameter form a matrix,
which is added with one factor from −1 to 1 (the field ``tied``); the rest, of second order in r, is
within a radius of its own for each entry.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from math import comb, prod
from typing import TypeVar

import numpy as np

from mcexact.analysis.boxes.pencils import independent, one_thread
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.exact.rational import rational_text
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

# Cells of the ranges, and boxes around the plants of a cell.

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
        The radii of the rest of each entry.
    tied : tuple of MultiChannelSystem
        For each parameter the slopes of all entries times the half width, which may be added to
        ``system`` with one factor from −1 to 1.
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
    """The values at the middle, the radii of the rests, and the slopes times half widths."""
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


# The bisection of the ranges.

P = TypeVar("P")
_CELLS, _DEEPEST = 64, 5
"""The most cells, and how often one is cut for each parameter."""
_MOST_CORNERS = 16
"""How many corners are decided of a cell that is cut no more."""


def proofs_of_cells(
    plant: ParametricSystem,
    proved: Callable[[CellBox], P | None],
    failing: Callable[[MultiChannelSystem], bool],
    said: str,
) -> tuple[tuple[int | None, ...], tuple[P, ...]]:
    """Cut the ranges until each cell is proved.

    Parameters
    ----------
    plant : ParametricSystem
    proved : callable
        The proof for a box around the plants of a cell, or None.
    failing : callable
        Whether a plant certainly lacks the property.
    said : str
        The failure in words, for the message.

    Returns
    -------
    cuts, parts : tuples
        For each node of the tree of cells, in preorder, the position of the parameter that is cut,
        or None for a proved cell; and the proofs of the cells, in the same order.

    Raises
    ------
    LimitReached
        If a cell is not proved; the message names values at which a plant fails, if it does.
    UsageError
        If a range has an end that is not known.
    """
    left, cuts, parts = [(whole_cell(plant), 0)], list[int | None](), list[P]()
    with one_thread():
        while left:
            cell, depth = left.pop()
            found = _proof(plant, cell, proved)
            if found is not None:
                cuts.append(None)
                parts.append(found)
                continue
            middle = tuple(map(_middle, cell))
            _require_holds(plant, middle, failing, said)
            if len(parts) + len(left) + 2 > _CELLS or depth == _DEEPEST * len(cell):
                for corner in itertools.islice(itertools.product(*cell), _MOST_CORNERS):
                    _require_holds(plant, corner, failing, said)
                where = values_in_words(plant.parameters, middle)
                raise LimitReached(f"no proof was found near {where}; perhaps {said} there")
            k = _widest(plant, cell)
            cuts.append(k)
            left += [(half, depth + 1) for half in halves(cell, k)[::-1]]
    return tuple(cuts), tuple(parts)


def _require_holds(
    plant: ParametricSystem,
    values: tuple[Fraction, ...],
    failing: Callable[[MultiChannelSystem], bool],
    said: str,
) -> None:
    """Raise `LimitReached` if the plant fails at some values, which is decided exactly."""
    where = values_in_words(plant.parameters, values)
    try:
        member = plant.at(dict(zip(plant.parameters, values, strict=True)))
    except InputError:
        raise LimitReached(f"an entry is undefined at {where}") from None
    if failing(member):
        raise LimitReached(f"{said} at {where}")


def values_in_words(names: Sequence[str], values: Sequence[Fraction]) -> str:
    """Values of parameters in words.

    Examples
    --------
    >>> values_in_words(("a", "b"), (Fraction(1, 2), Fraction(3)))
    'a = 1/2, b = 3'
    """
    named = zip(names, values, strict=True)
    return ", ".join(f"{name} = {rational_text(x)}" for name, x in named)


def _proof(plant: ParametricSystem, cell: Cell, proved: Callable[[CellBox], P | None]) -> P | None:
    """The proof for a cell, if there is one."""
    try:
        return proved(box_of_cell(plant, cell))
    except LimitReached:
        return None


def _middle(ends: tuple[Fraction, Fraction]) -> Fraction:
    return (ends[0] + ends[1]) / 2


def _widest(plant: ParametricSystem, cell: Cell) -> int:
    """The parameter that changes the entries most while the others stay at their middles."""

    def moves(k: int) -> tuple[float, Fraction]:
        alone = tuple(ends if i == k else (_middle(ends),) * 2 for i, ends in enumerate(cell))
        low, high = cell[k]
        try:
            box = box_of_cell(plant, alone)
        except LimitReached:
            return np.inf, high - low
        free = independent(box.radii, box.tied)
        values = (box.system.A, *box.system.B, *box.system.C)
        parts = zip(free.matrices(), values, strict=True)
        total = 0.0
        for (_, D), M in parts:
            size = np.linalg.norm(matrix_to_float(M))
            total += float(np.linalg.norm(matrix_to_float(D)) / (size or 1.0))
        return total, high - low

    return max(range(len(cell)), key=moves)
