"""Kind ``parametric_box_stable``: loops are stable at all values; ``proofs/boxes.md``."""

from . import box_stable
from .function_loops import boxes_of_cells
from .parameter_cells import ranges_text
from .parametric_system import FunctionSystem
from .reading import Json


def check(claim: Json, witness: Json, plant: FunctionSystem) -> None:
    """Check the claim of the kind ``box_stable`` for a box around the plants of each cell.

    Theorems ``box_stable.tied_stable_continuous``, ``box_stable.tied_stable_discrete``.
    """
    for box, part in boxes_of_cells(witness, plant):
        box_stable.check(claim, part, box)


def statement(claim: Json, plant: FunctionSystem) -> str:
    """Where all eigenvalues lie."""
    return box_stable.lie_inside(claim, plant, ranges_text(plant))
