"""Loops whose inputs are cut off at 40 % of what they ask for, with and without anti-windup.

Run as ``python -m benchmarks.limited``, which takes a minute, or with files of plants in continuous
time and the step of each, ``python -m benchmarks.limited plant.json=1/10``.

For the samples of each plant, one step late, a controller is designed that holds the outputs at
set-points; of each agent as many as can be held.  Their set-points step from 0 to 1.
Limits are 40 % of the largest input of each agent in the ideal loop.  Then the loop is run with
the exported arithmetic, inputs cut off at the plant alone, and once more with anti-windup gains.
A line holds for each run what is proved of it, the largest overshoot beyond the set-points, and the
last time at which an output is farther than 2 % from its end, beside those of the ideal loop.

What is proved is about set-points and disturbances of any size; the run is one run.
"""

from __future__ import annotations

import os
import sys
import time
from fractions import Fraction

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from mcexact import LimitReached, MultiChannelSystem, design_setpoint, gallery, load_system
from mcexact.constructions import sampled_system
from mcexact.model.controller import Controller
from mcexact.model.limits import InputLimits, Range
from mcexact.performance import saturation_stability, with_anti_windup
from mcexact.simulation.real import RealRun, simulate_real
from mcexact.synthesis.setpoint import held_together, selected

PART, LONGER, LITTLE = Fraction(2, 5), 4, 0.01
"""The part of the largest inputs that is left, how many times longer limited loops are run than
ideal ones, and the least set-point of which an overshoot is told."""
STANDARD = (("quadruple-tank-pminus", "5"), ("siljak-two-subsystems-farina", "1/10"))
"""Plants of the gallery, and steps."""


def limits_of(run: RealRun, plant: MultiChannelSystem) -> InputLimits:
    """40 % of the largest input of each agent in the ideal loop, to both sides."""
    peaks = [Fraction(f"{figures.peak[0]:.3g}") * PART for figures in run.inputs]
    pairs: list[Range | None] = [(-peak, peak) if peak else None for peak in peaks]
    counts = [plant.p(i) for i in range(plant.m)]
    starts = [sum(counts[:i]) for i in range(plant.m)]
    return tuple(tuple(pairs[k : k + p]) for k, p in zip(starts, counts, strict=True))


def proved(plant: MultiChannelSystem, controller: Controller, limits: InputLimits) -> str:
    """What is proved of the loop with its inputs cut off."""
    try:
        found = saturation_stability(
            plant, controller, limits=dict(zip(plant.names, limits, strict=True))
        )
    except LimitReached:
        return "nothing proved"
    if found.region is None:
        return "proved everywhere"
    return f"proved from states of norm {float(found.region.radius):.3g}"


def figures_of(run: RealRun, *, real: bool) -> str:
    """The largest overshoot beyond the set-points, and the time at which outputs have settled."""
    which, k = (run.real, 1) if real else (run.ideal, 0)
    beyond = [
        max(values) / out.rest - 1
        for out, values in zip(run.outputs, which.values("outputs").values(), strict=True)
        if out.rest > LITTLE
    ]
    settled = [out.settled[k] for out in run.outputs]
    known = [each for each in settled if each is not None]
    end = f"settled at {float(max(known)):.3g}" if known == settled else "not settled"
    return f"overshoot {100 * max([0.0, *beyond]):.0f} %, {end}"


def lines(name: str, plant: MultiChannelSystem, step: str) -> list[str]:
    """The lines about one plant."""
    begin = time.process_time()
    sampled = sampled_system(plant, step, 1)
    kept = held_together(sampled, selected(sampled, None))
    held = dict(zip(plant.names, kept, strict=True))
    controller = design_setpoint(sampled, regulate=held).controller
    wanted = [float(any(S[k, j] for k in range(S.nrows))) for S in kept for j in range(S.ncols)]
    given = {"step": step, "late": 1, "initial": [0] * plant.n, "reference": wanted}
    ideal = simulate_real(plant, controller, **given)
    limits = limits_of(ideal, plant)
    flat = [pair for own in limits for pair in own]
    saturated = with_anti_windup(
        sampled, controller, limits=dict(zip(plant.names, limits, strict=True))
    )
    horizon = ideal.times[-1] * LONGER
    told = [f"{name} at {step}: ideal: {figures_of(ideal, real=False)}"]
    for words, each in (("without", controller), ("with", saturated)):
        run = simulate_real(plant, each, limits=flat, horizon=horizon, **given)
        said = figures_of(run, real=True)
        told.append(f"  {words} anti-windup: {proved(sampled, each, limits)}; {said}")
    return [*told, f"  {time.process_time() - begin:.1f} s"]


def main(files: list[str]) -> None:
    """Print the lines."""
    plants = [(name, gallery(name), step) for name, step in STANDARD]
    if files:
        pairs = [each.rpartition("=") for each in files]
        plants = [(file, load_system(file), step) for file, _, step in pairs]
    for name, plant, step in plants:
        print("\n".join(lines(os.path.basename(name), plant, step)), flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
