"""How good are designs without a rate for the published plants?

Run as ``python -m benchmarks.gallery_designs [ROWS.jsonl] [PLANT …]``; by default all plants of the
gallery without feedthrough, each designed for as ``decentralized``, ``extended`` (over its own
links, or else over a ring) and ``setpoint``.  ROWS is a file: rows that it holds are printed and
not measured again.

A line holds the figures of `designed_rows`, or what the request was answered with, and the figures
of what is made by hand.  The last lines count the answers.
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
from benchmarks.designed_rows import answered, told
from benchmarks.kept_rows import Row, chosen, kept, measured
from mcexact import design_decentralized, design_extended, design_setpoint
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from mcexact.model.system import MultiChannelSystem

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


def _without_feedthrough() -> list[str]:
    """The plants of whose designs costs are known."""
    return [name for name in gallery.names() if gallery.load(name).D is None]


def row_of(name: str, structure: str) -> Row:
    """The row of a request; what is made by hand stands beside designs without communication."""
    plant = prepared(name, structure)
    hand = made_by_hand(plant) if structure == "decentralized" else {}
    return {**answered(DESIGNS[structure], plant), "by hand": hand}


def main(arguments: list[str]) -> int:
    """Design for all plants, or for some."""
    path, names = chosen(arguments, "gallery_designs")
    known, counts = kept(path), Counter[str]()
    for structure in DESIGNS:
        for name in names or _without_feedthrough():
            row = measured(path, f"{name} {structure}", partial(row_of, name, structure), known)
            counts[f"{structure}: {row['answer']}"] += 1
            hand = told_by_hand(row["by hand"])
            print(f"{row['name']} | {told(row)}, {row['seconds']} s | {hand}", flush=True)
    for what, count in sorted(counts.items()):
        print(f"{what}: {count}")
    PAGE.write_text(written(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
