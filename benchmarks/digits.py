"""How many digits of the gains of designed controllers are safe, and how many are too few.

Run as ``python -m benchmarks.digits [DESIGN …] [PLANT …] [FOLDER]``, with a folder of further
system files.  DESIGN is one of

``searched``  a decentralized controller found with a small effort
``theorem``   the exact one of the theorem
``extended``  one found with a small effort, whose agents send each other what they share over the
              links of the plant, or else over a ring
``setpoint``  the same for set-points, with integrators

by default all: searched and theorem for the plants of the gallery with at most 12 states, and the
others for a few of them.

Each row asks for stability alone:

- safe: the fewest significant digits with which every controller is stable whose entries are
  rounded up or down, in any combination, which a certificate proves for a box of controllers;
- fails: the most digits with which a rounding up or down was found whose loop is not stable,
  decided exactly.

Writes a table in Markdown to the standard output.  Seconds are those of the processor.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from mcexact import (
    check,
    design_decentralized,
    design_extended,
    design_setpoint,
    gallery,
    load_system,
)
from mcexact.designs import Aims, Design
from mcexact.errors import Impossible, LimitReached
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.certify import safe_digits

EFFORT = 2.0
MOST = 12
"""Digits that are tried."""
_MOST_STATES = 12


def extended(plant: MultiChannelSystem) -> Design:
    """A controller of agents that send each other what they share."""
    ring = NeighborGraph.ring(plant.names)
    linked = plant if plant.neighbors is not None else plant.with_neighbors(ring)
    return design_extended(linked, arithmetic="float", aims=Aims(effort=EFFORT))


DESIGNS: dict[str, Callable[[MultiChannelSystem], Design]] = {
    "searched": partial(design_decentralized, arithmetic="float", aims=Aims(effort=EFFORT)),
    "theorem": partial(design_decentralized, arithmetic="exact", aims=Aims(effort=0)),
    "extended": extended,
    "setpoint": partial(design_setpoint, arithmetic="float", aims=Aims(effort=EFFORT)),
}
_FEW = {
    "extended": ["quadruple-tank-pminus", "compleib-dis5", "compleib-ac1"],
    "setpoint": ["quadruple-tank-pminus", "compleib-dis5", "compleib-ac1"],
}


def row(name: str, plant: MultiChannelSystem, design: str) -> str:
    """What is found for one plant, as a row of the table."""
    try:
        made = DESIGNS[design](plant)
    except (Impossible, LimitReached) as refused:
        told = "none exists" if isinstance(refused, Impossible) else "none found"
        return f"| {name} | {plant.n} | {told} | | | | |"
    began = time.process_time()
    loop = made.loop.closed
    found = safe_digits(loop.given, loop.controller, loop.graph, most=MOST)
    seconds = time.process_time() - began
    if found.proof is not None:
        assert check(found.proof).valid
    if found.refutation is not None:
        assert check(found.refutation).valid and not found.refutation.stable
    entries = sum(1 for M in made.controller.matrices() for _ in M.nonzero())
    safe = f"> {MOST}" if found.safe is None else found.safe
    unsafe = "–" if found.unsafe is None else found.unsafe
    return f"| {name} | {plant.n} | {made.order} | {entries} | {safe} | {unsafe} | {seconds:.1f} |"


def main(arguments: list[str]) -> None:
    """Print the rows of the plants asked for."""
    folders = [Path(each) for each in arguments if Path(each).is_dir()]
    designs = [each for each in arguments if each in DESIGNS] or [*DESIGNS]
    plants = {each: gallery(each) for each in gallery()}
    small = [name for name, plant in plants.items() if plant.n <= _MOST_STATES]
    plants |= {file.stem: load_system(file) for each in folders for file in each.glob("*.json")}
    asked = [each for each in arguments if each not in DESIGNS and not Path(each).is_dir()]
    for design in designs:
        print(f"\n## {design.capitalize()} controllers\n")
        print("| plant | n | states of the agents | entries | safe | fails | seconds |")
        print("| --- | --- | --- | --- | --- | --- | --- |")
        for name in asked or _FEW.get(design, small):
            print(row(name, plants[name], design), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
