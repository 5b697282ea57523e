"""Loops of plants with parameters, and boxes around what is within a cell; ``proofs/boxes.md``."""

from collections.abc import Iterator
from dataclasses import dataclass

from .boxes import Box
from .closed_loop import closed_loop
from .parameter_cells import Cell, box_of_cell, cells_of
from .parametric_system import FunctionSystem
from .reading import Json, fields, items


@dataclass(frozen=True, kw_only=True)
class FunctionLoop(FunctionSystem):
    """The closed loop of ``inside`` with a controller, of so many states; the tables are its."""

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
