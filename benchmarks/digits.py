"""How many digits of the gains of designed controllers are safe, and how many are too few.

Run as ``python -m benchmarks.digits [DESIGN …] [PLANT …]``, where DESIGN is searched (the default),
a decentralized controller found with a small effort, or theorem, the exact one of the theorem; by
default for the plants of the gallery with at most 12 states.

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
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from mcexact import Aims, check, design_decentralized
from mcexact.errors import Impossible, LimitReached
from mcexact.model import gallery
from mcexact.synthesis.safe_digits import safe_digits

EFFORT = 2.0
MOST = 12
"""Digits that are tried."""
DESIGNS: dict[str, dict[str, Any]] = {
    "searched": {"arithmetic": "float", "aims": Aims(effort=EFFORT)},
    "theorem": {"arithmetic": "exact", "aims": Aims(effort=0)},
}
_MOST_STATES = 12


def row(name: str, design: str) -> str:
    """What is found for one plant, as a row of the table."""
    plant = gallery.load(name)
    try:
        made = design_decentralized(plant, **DESIGNS[design])
    except (Impossible, LimitReached) as refused:
        told = "none exists" if isinstance(refused, Impossible) else "none found"
        return f"| {name} | {plant.n} | {told} | | | | |"
    began = time.process_time()
    found = safe_digits(plant, made.controller, most=MOST)
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
    designs = [each for each in arguments if each in DESIGNS] or [*DESIGNS]
    asked = [each for each in arguments if each not in DESIGNS]
    small = [each for each in gallery.names() if gallery.load(each).n <= _MOST_STATES]
    for design in designs:
        print(f"\n## {design.capitalize()} controllers\n")
        print("| plant | n | states of the agents | entries | safe | fails | seconds |")
        print("| --- | --- | --- | --- | --- | --- | --- |")
        for name in asked or small:
            print(row(name, design), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
