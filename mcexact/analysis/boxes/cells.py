"""Families of plants, boxes and ranges of parameters, and proofs about all of their members.

A family is a plant with radii, whose members are those of its box, or a plant with parameters,
whose members are the plants at all values within ranges.  `proofs` proves a property of all members
of either.  The caller says how `Members`, a box with or without generators, are proved; the family
is cut into such parts.

A box is one part.  Ranges are cut into cells, which have an interval for each parameter: a proof is
tried for the whole ranges first, and a cell without a proof is cut in half, in the parameter that
changes the entries most.  The plant in its middle is decided exactly: if it fails, the search ends
with these values.  So are those at the corners of the whole ranges before the first cut: properties
often fail at the ends, where a connection is 0, and cells beside such a corner are never proved.
The search also ends after a number of cells or cuts; then nothing is proved.

The members of a cell are fewer than those of a box with independent radii would be, since all
entries depend on the same parameters.  On a cell with the middle p0 and the half widths r an entry
is f(p0 + h) = f_0 + Σ f_k h_k + rest.  The slopes f_k r_k of all entries with respect to one
parameter form a generator, which is added with one factor from −1 to 1; the rest, of second order
in r, is within a radius of its own for each entry.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import reduce
from math import comb, prod
from typing import TypeVar

import numpy as np

from mcexact.analysis.boxes.pencils import Members, one_thread
from mcexact.answer.boxes import Cuts
from mcexact.errors import InputError, LimitReached, UsageError
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.exact.rational import rational_text
from mcexact.exact.rational_functions import FunctionMatrix, RationalFunction
from mcexact.model.parametric import ParametricSystem
from mcexact.model.radii import Radii
from mcexact.model.system import MultiChannelSystem

Family = MultiChannelSystem | ParametricSystem
"""A plant with radii, or a plant whose parameters have ranges."""
Cell = tuple[tuple[Fraction, Fraction], ...]
"""The least and the largest value of each parameter."""
Terms = Mapping[tuple[int, ...], Fraction]
P = TypeVar("P")

_CELLS, _DEEPEST = 64, 5
"""The most cells, and how often one is cut for each parameter."""
_MOST_CORNERS = 16
"""How many corners are decided of the whole ranges, and of a cell that is cut no more."""


def proofs(
    family: Family,
    evidence: Callable[[Members], P | None],
    fails: Callable[[MultiChannelSystem], bool],
    *,
    claim: str,
    failure: str,
) -> tuple[Cuts, tuple[P, ...]]:
    """Prove a property of all members of a family.

    Parameters
    ----------
    family : MultiChannelSystem or ParametricSystem
        A plant with radii, or a plant with parameters, each of which has a range with two ends.
    evidence : callable
        The evidence that the property holds for some members, or None.
    fails : callable
        Whether a plant certainly lacks the property.
    claim, failure : str
        Of a box what was to be proved, of a plant with parameters what fails, for the message.

    Returns
    -------
    cuts, parts : tuples
        For each node of the tree of cells, in preorder, the position of the parameter that is cut,
        or None for a proved cell; and the evidence about the cells, in the same order.  A box has
        one cell.

    Raises
    ------
    LimitReached
        If there is no proof.  For ranges the message names values at which a plant fails, if one
        was met.
    UsageError
        If a range has an end that is not known.
    """
    with one_thread():
        if isinstance(family, ParametricSystem):
            return _proofs_of_cells(family, evidence, fails, failure)
        part = evidence(Members.of(family))
    if part is None:
        raise LimitReached(f"no proof was found that {claim}")
    return (None,), (part,)


# Ranges: their bisection into cells.


def _proofs_of_cells(
    plant: ParametricSystem,
    evidence: Callable[[Members], P | None],
    fails: Callable[[MultiChannelSystem], bool],
    failure: str,
) -> tuple[Cuts, tuple[P, ...]]:
    """Cut the ranges until each cell is proved."""
    left, cuts, parts = [(whole_cell(plant), 0)], list[int | None](), list[P]()
    while left:
        cell, depth = left.pop()
        part = _evidence_of_cell(plant, cell, evidence)
        if part is not None:
            cuts.append(None)
            parts.append(part)
            continue
        middle = tuple(map(_middle, cell))
        _require_holds(plant, middle, fails, failure)
        last = len(parts) + len(left) + 2 > _CELLS or depth == _DEEPEST * len(cell)
        if last or not depth:
            for corner in itertools.islice(itertools.product(*cell), _MOST_CORNERS):
                _require_holds(plant, corner, fails, failure)
        if last:
            where = values_in_words(plant.parameters, middle)
            raise LimitReached(f"no proof was found near {where}; perhaps {failure} there")
        k = _widest(plant, cell)
        cuts.append(k)
        left += [(half, depth + 1) for half in halves(cell, k)[::-1]]
    return tuple(cuts), tuple(parts)


def _evidence_of_cell(
    plant: ParametricSystem, cell: Cell, evidence: Callable[[Members], P | None]
) -> P | None:
    """The evidence about a cell; None without it, also if a search reaches its limits."""
    try:
        return evidence(members_of_cell(plant, cell))
    except LimitReached:
        return None


def _require_holds(
    plant: ParametricSystem,
    values: tuple[Fraction, ...],
    fails: Callable[[MultiChannelSystem], bool],
    failure: str,
) -> None:
    """Raise `LimitReached` if the plant fails at some values, which is decided exactly."""
    where = values_in_words(plant.parameters, values)
    try:
        member = plant.at(dict(zip(plant.parameters, values, strict=True)))
    except InputError:
        raise LimitReached(f"an entry is undefined at {where}") from None
    if fails(member):
        raise LimitReached(f"{failure} at {where}")


def values_in_words(names: Sequence[str], values: Sequence[Fraction]) -> str:
    """Values of parameters in words.

    Examples
    --------
    >>> values_in_words(("a", "b"), (Fraction(1, 2), Fraction(3)))
    'a = 1/2, b = 3'
    """
    named = zip(names, values, strict=True)
    return ", ".join(f"{name} = {rational_text(x)}" for name, x in named)


def _middle(ends: tuple[Fraction, Fraction]) -> Fraction:
    return (ends[0] + ends[1]) / 2


def _widest(plant: ParametricSystem, cell: Cell) -> int:
    """The parameter that changes the entries most while the others stay at their middles."""

    def change(k: int) -> tuple[float, Fraction]:
        alone = tuple(ends if i == k else (_middle(ends),) * 2 for i, ends in enumerate(cell))
        low, high = cell[k]
        try:
            members = members_of_cell(plant, alone)
        except LimitReached:
            return np.inf, high - low
        center = members.system
        values = (center.A, *center.B, *center.C)
        total = 0.0
        for (_, D), M in zip(members.independent.matrices(), values, strict=True):
            size = np.linalg.norm(matrix_to_float(M))
            total += float(np.linalg.norm(matrix_to_float(D)) / (size or 1.0))
        return total, high - low

    return max(range(len(cell)), key=change)


def whole_cell(plant: ParametricSystem) -> Cell:
    """The ranges of all parameters.

    Raises
    ------
    UsageError
        If a range has an end that is not known.
    """
    cell = []
    for name, (low, high) in zip(plant.parameters, plant.ranges, strict=True):
        if low is None or high is None:
            raise UsageError(f"the parameter {name!r} needs a range with two ends")
        cell.append((low, high))
    return tuple(cell)


def halves(cell: Cell, k: int) -> tuple[Cell, Cell]:
    """The cell cut in the middle of one parameter, the lower half first."""
    low, high = cell[k]
    middle = (low + high) / 2
    first, second = ((*cell[:k], half, *cell[k + 1 :]) for half in ((low, middle), (middle, high)))
    return first, second


# The members of a cell.


def members_of_cell(plant: ParametricSystem, cell: Cell) -> Members:
    """Enclose the plants at all values of a cell.

    The nominal plant is that at the middle.  The radii are those of the rest of each entry, and
    each parameter has a generator: the slopes of all entries times the half width.

    Raises
    ------
    LimitReached
        If a denominator may be 0 in the cell.

    Examples
    --------
    >>> plant = ParametricSystem([["k^2"]], [[["k"]]], [[[1]]], parameters=["k"])
    >>> members = members_of_cell(plant, ((Fraction(1), Fraction(3)),))
    >>> members.system.A[0, 0], members.generators[0].A[0, 0], members.radii.A[0, 0]
    (Fraction(4, 1), Fraction(4, 1), Fraction(1, 1))
    """
    tables = [plant.A, *(c.B for c in plant.channels), *(c.C for c in plant.channels)]
    layers = [_layers(M, cell) for M in tables]

    def parts(k: int) -> tuple[Matrix, list[Matrix], list[Matrix]]:
        A, *ports = (each[k] for each in layers)
        return A, ports[: plant.m], ports[plant.m :]

    def system(k: int) -> MultiChannelSystem:
        return MultiChannelSystem(*parts(k), time=plant.time, names=plant.names)

    return Members(system(0), Radii(*parts(1)), tuple(system(k + 2) for k in range(len(cell))))


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
        terms: dict[tuple[int, ...], Fraction] = {}
        for e, c in p.items():
            for j in range(e[k] + 1):
                key = (*e[:k], j, *e[k + 1 :])
                term = c * comb(e[k], j) * center[k] ** (e[k] - j)
                terms[key] = terms.get(key, Fraction(0)) + term
        return terms

    return reduce(shifted, range(len(center)), p)
