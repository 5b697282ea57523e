"""Kind ``parametric_box_controllable``: channels control at all values; ``proofs/boxes.md``."""

from . import box_controllable
from .parameter_cells import box_of_cell, cells_of, ranges_text
from .parametric_system import FunctionSystem
from .reading import Json, fields, items


def check(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_controllable`` for a box around the plants of each cell.

    Theorem ``joint_controllability.controllable_hautus``.
    """
    cuts, parts = fields(witness, "witness", "cuts", "parts")
    cells = cells_of(cuts, "witness.cuts", plant)
    for cell, part in zip(cells, items(parts, "witness.parts", len(cells)), strict=True):
        box_controllable.check(claim, part, box_of_cell(plant, cell))


def statement(claim: Json, plant: FunctionSystem) -> str:
    """What the channels control."""
    return box_controllable.controls(claim, plant, ranges_text(plant))
