"""The system that a claim is about, built from the plant by the constructions of ``FORMAT.md``."""

from .budget import spend
from .closed_loop import closed_loop
from .feedback import dual, error, feedback, full_output, integrators, merged, restricted
from .information_structure import arcs, augmented_outputs, extended, held, lifted
from .reading import Json, incomplete, items, malformed, require, shown
from .system import System

LINE = "line"
"""The construction that only plants with parameters have, and before all others."""
LISTED = (arcs, augmented_outputs, closed_loop, dual, error, extended, feedback, full_output)
CONSTRUCTIONS = {
    rule.__name__: rule for rule in (*LISTED, held, integrators, lifted, merged, restricted)
}


def read_subject(value: Json, plant: System, before: int = 0) -> System:
    """Apply the constructions in order, perhaps behind some that were applied already.

    Open: see ``proofs/OPEN.md``.
    """
    system = plant
    for k, step in enumerate(items(value, "subject"), before):
        place = f"subject[{k}]"
        if not isinstance(step, dict) or type(step.get("construction")) is not str:
            malformed(place, 'expected an object with the key "construction"')
        name = step["construction"]
        message = "a line needs a plant with parameters, and comes before all other constructions"
        require(name != LINE, "subject", place, message)
        if name not in CONSTRUCTIONS:
            incomplete("construction", place, f"{shown(name)} is not a construction known here")
        spend(1000 + 200 * system.m + len(system.words))
        parameters = {key: part for key, part in step.items() if key != "construction"}
        system = CONSTRUCTIONS[name](system, parameters, place)
    return system
