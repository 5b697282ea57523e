"""How good are the controllers of the ladder on the published plants, without a rate?

Run as ``python -m benchmarks.gallery_designs [ROWS.jsonl] [PLANT …]``; by default all plants of the
gallery, each designed for as ``decentralized``, ``extended`` (over its own links, or else over a
ring) and ``setpoint``.  ROWS is a file: rows that it holds are printed and not measured again.

A line holds the rate that was chosen and the figures as in `families`, or what the request was
answered with, and the figures of what is made by hand.  The last lines count the answers.
"""

from __future__ import annotations

import os
import sys
from collections import Counter
from functools import partial
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from benchmarks.by_hand import made_by_hand, told_by_hand
from benchmarks.design_page import PAGE, written
from benchmarks.families import figures_row, told
from benchmarks.kept_rows import Row, chosen, kept, measured
from mcexact import Aims, design_decentralized, design_extended, design_setpoint
from mcexact.errors import Impossible, LimitReached, OutOfReach
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import assess
from mcexact.synthesis.networks import integrated_plant

EFFORT = 10.0
"""Seconds for each search: a grid of 111 rows ends within the hour."""
DESIGNS: dict[str, Any] = {
    "decentralized": design_decentralized,
    "extended": design_extended,
    "setpoint": design_setpoint,
}


def prepared(name: str, structure: str) -> MultiChannelSystem:
    """The plant, with a ring of links where agents have to receive something."""
    plant = gallery.load(name)
    if structure == "extended" and plant.neighbors is None:
        return plant.with_neighbors(NeighborGraph.ring(plant.names))
    return plant


def answered(name: str, structure: str) -> Row:
    """What the request is answered with, and what is made by hand."""
    plant = prepared(name, structure)
    try:
        made = DESIGNS[structure](plant, arithmetic="float", aims=Aims(effort=EFFORT))
    except Impossible as refused:
        return {"answer": "refused", "told": str(refused), "by hand": {}}
    except OutOfReach as far:
        return {"answer": "out of reach", "told": str(far), "by hand": {}}
    except LimitReached as limit:
        return {"answer": "limit", "told": str(limit), "by hand": {}}
    found, seen = figures_row(made), assess(made)
    about = plant
    if structure == "setpoint":
        # That of the search counts the integrals.
        found["peak"], about = seen.figures.peak, integrated_plant(plant)
        if found.get("central"):
            found["central"].pop("peak")
    hand = made_by_hand(about, (found.get("central") or {}).get("cost"))
    return {
        **found,
        made.region.word: str(made.region.edge),
        "install": seen.install,
        "verdict": seen.verdict,
        "step peak": seen.step_peak,
        "by hand": hand,
    }


def main(arguments: list[str]) -> int:
    """Design for all plants, or for some."""
    path, names = chosen(arguments, "gallery_designs")
    known, counts = kept(path), Counter[str]()
    for name in names or gallery.names():
        for structure in DESIGNS:
            row = measured(path, f"{name} {structure}", partial(answered, name, structure), known)
            counts[f"{structure}: {row['answer']}"] += 1
            asked = row.get("rate") or row.get("radius") or ""
            line = f"{row['name']}, {asked} | {told(row)}, {row['seconds']} s"
            line += f" | {row.get('verdict', '')} | {told_by_hand(row['by hand'])}"
            print(line, flush=True)
    for what, count in sorted(counts.items()):
        print(f"{what}: {count}")
    PAGE.write_text(written(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
