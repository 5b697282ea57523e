"""Kind ``parametric_box_fixed``: no mode is fixed at any value; ``proofs/boxes.md``."""

from . import box_fixed
from .function_loops import boxes_of_cells
from .parameter_cells import ranges_text
from .parametric_system import FunctionSystem
from .reading import Json
from .region import no_fixed_mode


def check(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_fixed`` for a box around the plants of each cell.

    Theorem ``boxes.regular_not_fixed``.
    """
    for box, part in boxes_of_cells(witness, plant):
        box_fixed.check(claim, part, box)


def statement(claim: Json, plant: FunctionSystem) -> str:
    """What no plant within the ranges has."""
    return f"{ranges_text(plant)}, there is {no_fixed_mode(claim['bound'], plant)}"
