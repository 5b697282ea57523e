"""Kind ``parametric_box_controllable``: channels control at all values; ``proofs/boxes.md``."""

from . import box_controllable
from .function_loops import boxes_of_cells
from .parameter_cells import ranges_text
from .parametric_system import FunctionSystem
from .reading import Json


def check(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_controllable`` for a box around the plants of each cell.

    Theorem ``joint_controllability.controllable_hautus``.
    """
    for box, part in boxes_of_cells(witness, plant):
        box_controllable.check(claim, part, box)


def statement(claim: Json, plant: FunctionSystem) -> str:
    """What the channels control."""
    return box_controllable.controls(claim, plant, ranges_text(plant))
