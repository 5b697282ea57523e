"""Ranges of parameters, cut in half until each cell is proved."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import TypeVar

import numpy as np

from mcexact.analysis.boxes.float_pencils import independent
from mcexact.analysis.boxes.one_thread import one_thread
from mcexact.analysis.boxes.parameter_cells import Cell, CellBox, box_of_cell, halves, whole_cell
from mcexact.errors import InputError, LimitReached
from mcexact.exact.matrix import matrix_to_float
from mcexact.exact.rational import rational_text
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system import MultiChannelSystem

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
        Whether a plant certainly fails.
    said : str
        What fails then, in words.

    Returns
    -------
    cuts, parts : tuples
        How they are cut, and the proofs.

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
    """Refuse values at which the plant fails, which is decided exactly."""
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
    """The parameter that moves the entries most, if it is anywhere in the cell and no other is."""

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
