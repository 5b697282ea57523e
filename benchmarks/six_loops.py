"""What the proofs of cost and margins of six loops have, and what they take to find and to check.

Run as ``python -m benchmarks.six_loops [PLANT …]``; writes ``LOOPS.md`` if all are measured.  The
plants are in ``loops/``, with controllers that ``mcexact design decentralized`` found.  Every proof
is sought, however large it is: the cost, the bound for every linear
time-invariant controller, and the disk margin of every input and output by itself.

Times are seconds of the processor.  `AIMS` are what the method was designed for, measured on a
prototype with controllers of its own; a figure above twice its aim is marked in the table.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from benchmarks.kept_rows import machine
from mcexact import check, load_controller, load_system
from mcexact.analysis.in_units import cost_bound, disk_margin, loop_cost
from mcexact.analysis.performance import Side
from mcexact.answer.performance import DiskMargin, LoopCost
from mcexact.answer.protocol import Answer, encode
from mcexact.exact.matrix import to_float
from mcexact.model.loop import closed_loop

PAGE, LOOPS = Path(__file__).with_name("LOOPS.md"), Path(__file__).with_name("loops")
SIDES: tuple[Side, ...] = ("inputs", "outputs")
TIMES, LEAST_SECONDS = 2.0, 0.05
"""How much worse than its aim a figure may be; seconds below the least ones are not compared."""


@dataclass(frozen=True)
class Figures:
    """Cost over the bound, and what its two proofs and those of the single margins have and take.

    Attributes
    ----------
    ratio : float
    bytes, checked : float
        Of the proofs of the cost and of the bound; seconds.
    margin_bytes, margins_checked : float
        Of the proofs of all single margins.
    """

    ratio: float
    bytes: float
    checked: float
    margin_bytes: float
    margins_checked: float


AIMS: Mapping[str, Figures | None] = {
    "chain-10": Figures(1.2488, 4e3, 0.0, 5e3, 0.01),
    "canal-4-pools": Figures(1.2248, 10e3, 0.01, 16e3, 0.03),
    "power-6-machines": Figures(1.2145, 22e3, 0.04, 72e3, 0.13),
    "building-25-sampled": None,
    "power-16-machines": Figures(1.6327, 129e3, 0.4, 843e3, 2.6),
    "platoon-50": Figures(2.235, 612e3, 3.8, 10e6, 60.0),
}
"""By the names of the plants, the smallest loop first; none for the building."""


@dataclass(frozen=True)
class Measured:
    """What was measured of a loop.

    Attributes
    ----------
    name : str
    states, ports : int
        Of the loop, and how many inputs and outputs have a margin of their own.
    least : float
        The least proved margin of a single one.
    found, margins_found : float
        Seconds.
    figures : Figures
    refused : int
        How many certificates the checker does not find valid.
    """

    name: str
    states: int
    ports: int
    least: float
    found: float
    margins_found: float
    figures: Figures
    refused: int

    def worse(self) -> list[str]:
        """The figures that are above twice their aims."""
        aims = AIMS[self.name]
        if aims is None:
            return []
        return [
            name
            for name, value in vars(self.figures).items()
            if value > TIMES * getattr(aims, name)
            and not (name.endswith("checked") and value < LEAST_SECONDS)
        ]


def timed(make: Callable[[], object]) -> float:
    """The seconds of the processor that something takes."""
    began = time.process_time()
    make()
    return time.process_time() - began


def measured(name: str) -> Measured:
    """Prove and check all of a loop."""
    plant = load_system(LOOPS / f"{name}.plant.json")
    controller = load_controller(LOOPS / f"{name}.controller.json")
    pairs: list[Answer] = []
    margins: list[Answer] = []
    found = timed(lambda: pairs.extend([loop_cost(plant, controller), cost_bound(plant)]))
    both = (lambda at=at: margins.append(disk_margin(plant, controller, at)) for at in SIDES)
    margins_found = sum(timed(each) for each in both)
    verdicts = list[str]()
    seconds = [
        timed(lambda each=each: verdicts.append(check(each).verdict)) for each in pairs + margins
    ]
    cost, bound = pairs
    least = min(each.margin for each in margins if isinstance(each, DiskMargin))
    figures = Figures(
        to_float(cost.cost / bound.cost) if isinstance(cost, LoopCost) else 0.0,
        sum(len(encode(each)) for each in pairs),
        sum(seconds[:2]),
        sum(len(encode(each)) for each in margins),
        sum(seconds[2:]),
    )
    loop = closed_loop(plant, controller)
    ports = sum(plant.p(i) + plant.q(i) for i in range(plant.m))
    refused = sum(verdict != "VALID" for verdict in verdicts)
    return Measured(
        name, loop.dimension, ports, to_float(least), found, margins_found, figures, refused
    )


_HEAD = """\
# What the proofs of six loops have, and take

Made by `make six-loops`, from the plants and controllers in `loops/`. A loop has N states. Proved
are its cost, a lower bound for every linear time-invariant controller, and the disk margin of every
input and output by itself, however large the certificates are. In parentheses is what the method
was designed for, measured on a prototype with its own controllers for the same plants: kB and
seconds of checking. Seconds are those of a processor, on a machine that had other work.
"""
_COLUMNS = (
    "loop", "N", "cost/bound", "kB of both", "found", "checked", "margins", "least", "kB", "found",
    "checked",
)  # fmt: skip


def page(rows: list[Measured]) -> str:
    """The page of what was measured."""
    lines = [_HEAD, f"Measured on {machine()}.", ""]
    lines += [f"| {' | '.join(_COLUMNS)} |", f"|{'---|' * len(_COLUMNS)}"]
    lines += [f"| {' | '.join(_cells(row))} |" for row in rows]
    worse = {row.name: row.worse() for row in rows if row.worse()}
    told = "; ".join(f"{name}: {', '.join(which)}" for name, which in worse.items())
    told = told.replace("_", " ")
    refused = sum(row.refused for row in rows)
    lines += [
        "",
        f"More than twice what the method was designed for: {told or 'none'}.",
        f"Certificates that the checker does not find valid: {refused}.",
        "",
    ]
    return "\n".join(lines)


def _cells(row: Measured) -> tuple[str, ...]:
    seen, aims = row.figures, AIMS[row.name]

    def beside(value: str, aim: str) -> str:
        return value if aims is None else f"{value} ({aim})"

    wanted = aims or seen
    return (
        row.name,
        str(row.states),
        beside(f"{seen.ratio:.4f}", f"{wanted.ratio:.4f}"),
        beside(f"{seen.bytes / 1e3:.0f}", f"{wanted.bytes / 1e3:.0f}"),
        f"{row.found:.2f} s",
        beside(f"{seen.checked:.2f} s", f"{wanted.checked:g} s"),
        str(row.ports),
        f"{row.least:.3g}",
        beside(f"{seen.margin_bytes / 1e3:.0f}", f"{wanted.margin_bytes / 1e3:.0f}"),
        f"{row.margins_found:.2f} s",
        beside(f"{seen.margins_checked:.2f} s", f"{wanted.margins_checked:g} s"),
    )


def main(names: list[str]) -> int:
    """Measure; the status is 1 if the checker refuses a certificate."""
    rows = list[Measured]()
    for name in names or AIMS:
        rows.append(measured(name))
        print(" | ".join(_cells(rows[-1])), "|", ", ".join(rows[-1].worse()) or "as aimed")
    if not names:
        PAGE.write_text(page(rows), encoding="utf-8")
    return 1 if any(row.refused for row in rows) else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
