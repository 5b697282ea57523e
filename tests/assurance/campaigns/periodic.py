"""Designs over graphs that vary periodically, simulated step by step with messages really sent.

Run as ``python -m tests.assurance.campaigns.periodic [COUNT [FIRST [FILE]]]``; systems in the file
(by default ``build/periodic.jsonl``) are not examined again.  The loop of every design is
certified, and its states after each window are exactly those of the simulation.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from fractions import Fraction
from pathlib import Path
from typing import Any

import mcexact
from mcexact.derived.constructions import slow_system
from mcexact.exact.matrix import Matrix
from mcexact.model.graph import NeighborGraph
from mcexact.model.loop import closed_loop
from mcexact.model.system import MultiChannelSystem
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle.windows import Network, drawn_graphs, drawn_matrices, strongly_connected

WINDOWS = 8
FILE = Path("build") / "periodic.jsonl"


def drawn(number: int) -> tuple[MultiChannelSystem, list[list[set[int]]], int]:
    """A jointly controllable and observable plant, graphs of one period, and a window."""
    rng = random.Random(number)
    while True:
        n, m, period = rng.randint(1, 2), rng.randint(2, 4), rng.randint(2, 4)
        made = drawn_matrices(rng, n, m)
        plant = MultiChannelSystem(made["A"], made["B"], made["C"], time="discrete")
        if (
            mcexact.joint_controllability(plant).controllable
            and mcexact.joint_observability(plant).controllable
        ):
            return plant, drawn_graphs(rng, m, period), max(2 * n, period) + rng.randint(0, 1)


def examined(number: int) -> Examined:
    """Design for a drawn plant, and simulate the loop step by step until it must be at rest."""
    plant, graphs, window = drawn(number)
    names = plant.names
    slow = slow_system(plant, window, [NeighborGraph(names, graph) for graph in graphs])
    bound = mcexact.sharing.shared_dimension_bound(slow, share="states")
    seen = Counter[str](
        systems=1,
        shared=int(bound.deficiency > 0),
        with_no_graph_connected=int(not any(map(strongly_connected, graphs))),
    )
    held = mcexact.constructions.held_system(slow, [bound.deficiency] * plant.m)
    spectrum = mcexact.fixed_spectrum(held)
    wrong = [] if spectrum.empty else ["a mode of the held system is fixed"]
    wrong += [v.line() for v in map(mcexact.check, (bound, spectrum)) if v.verdict != "VALID"]
    if wrong:
        return wrong, seen
    design = mcexact.design_extended(
        slow, agent=names[0], network="held", dimensions="bound", radius="1/2"
    )
    wrong += differing(plant, slow, design.controller, graphs, window)
    seen["simulated"] += 1
    return wrong, seen


def differing(
    plant: MultiChannelSystem, slow: MultiChannelSystem, controller: Any, graphs: Any, window: int
) -> list[str]:
    """Windows after which the step-by-step simulation has another state than the certified loop."""
    loop = closed_loop(slow, controller).system.A
    x = [Fraction(k + 1) for k in range(plant.n)]
    state = Matrix.column([*x, *[0] * (loop.nrows - plant.n)])
    network = Network(plant, controller.agents, graphs, window)
    for k in range(WINDOWS):
        x, state = network.run(x), loop @ state
        if x != [entry for [entry] in state.rows()][: plant.n]:
            return [f"another state after window {k}"]
    return []


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 500, FILE, examined, "things that are wrong"))
