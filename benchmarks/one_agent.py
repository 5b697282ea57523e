"""What does the same search find for one agent that has all outputs and all inputs?

Run as ``python -m benchmarks.one_agent [ROWS.jsonl] [ROW …]``; by default for all exceptions of
``DESIGNS.md`` whose cost, margins, damping or box is the exception.  A row says what one controller
for all agents reaches that is asked for in the same way: where it is no better, the plant is the
reason, and not what the agents do not know.  A search, not a proof.
"""

from __future__ import annotations

import os
import sys
from functools import partial
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from benchmarks.design_page import PAGE, is_open, written
from benchmarks.designed_rows import answered, told
from benchmarks.families import FAMILIES, plant
from benchmarks.gallery_designs import DESIGNS, prepared
from benchmarks.kept_rows import ROWS, Row, chosen, kept, measured
from mcexact.model.system import MultiChannelSystem


def requested(name: str) -> tuple[Any, MultiChannelSystem]:
    """The ``design_…`` function and the plant of a row, for one agent."""
    *plant_name, last = name.split()
    if plant_name[0] in FAMILIES:
        family, size = plant_name
        function: Any = DESIGNS["decentralized"]
        several = plant(FAMILIES[family], int(size), last)
    else:
        function = DESIGNS["setpoint" if last == "setpoint" else "decentralized"]
        several = prepared(plant_name[0], last)
    B, C = [several.input_matrix()], [several.output_matrix()]
    return function, MultiChannelSystem(several.A, B, C, time=several.time)


def row_of(name: str) -> Row:
    """The row of a request for one agent."""
    return answered(*requested(name))


def main(arguments: list[str]) -> int:
    """Design for one agent in place of several, for all exceptions or for some."""
    path, names = chosen(arguments, "one_agent")
    known = kept(path)
    rows = kept(ROWS / "gallery_designs.jsonl") | kept(ROWS / "families.jsonl")
    for name in names or [name for name, row in rows.items() if is_open(row)]:
        row = measured(path, name, partial(row_of, name), known)
        print(f"{row['name']} | {told(row)}, {row['seconds']} s", flush=True)
    PAGE.write_text(written(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
