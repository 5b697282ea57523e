"""Kind ``parametric_box_fixed``: no mode is fixed at any value; ``proofs/boxes.md``."""

from . import box_fixed
from .parameter_cells import box_of_cell, cells_of, ranges_text
from .parametric_system import FunctionSystem
from .reading import Json, fields, items
from .region import no_fixed_mode


def check(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_fixed`` for a box around the plants of each cell.

    Theorem ``boxes.regular_not_fixed``.
    """
    cuts, parts = fields(witness, "witness", "cuts", "parts")
    cells = cells_of(cuts, "witness.cuts", plant)
    for cell, part in zip(cells, items(parts, "witness.parts", len(cells)), strict=True):
        box_fixed.check(claim, part, box_of_cell(plant, cell))


def statement(claim: Json, plant: FunctionSystem) -> str:
    """What no plant within the ranges has."""
    return f"{ranges_text(plant)}, there is {no_fixed_mode(claim['bound'], plant)}"
