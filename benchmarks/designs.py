"""How good are the controllers that the ladder of starts finds, on plants of some families?

Run as ``python -m benchmarks.designs FOLDER [PLANT …]`` with a folder of system files; plants are
named by their files without ``.json``.  Prints a line for each request: the order, the largest
gain, the margin, the cost relative to the central optimum of the same rate, the peak, the digits
that suffice, the sensible rate and the seconds of the processor; beside these reference figures
where there are some, whose costs were measured without the noise that gains pass on and against the
optimum without a rate.  Times are those of this machine: compare figures, not seconds.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from mcexact import design_decentralized, design_extended, design_setpoint, load_system
from mcexact.errors import Impossible, LimitReached
from mcexact.exact.roots import is_discrete
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.gate import Request
from mcexact.synthesis.optimum.diagnosis import diagnosed, step_peak


@dataclass(frozen=True)
class Asked:
    """A plant, a rate or radius, a structure, and reference figures."""

    plant: str
    bound: str
    structure: str
    before: str = ""


REQUESTS = (
    Asked("farina-power-network-5area", "0.2", "decentralized", "0 / 4.3 / 1.0 / 1.29, 0.1 s"),
    Asked("farina-coupled-pendula-k0-02", "0.9", "decentralized", "0 / 17 / 0.41 / 0.74"),
    Asked("farina-9-masses", "0.2", "decentralized", "0 / 2.3 / 0.77 / 1.01"),
    Asked("heat_n20_m4", "0.5", "decentralized", "4 / 2.5 / 0.82 / 1.09"),
    Asked("chain_n20_m4", "0.1", "decentralized", "4 / 4.3 / 0.71 / 1.05"),
    Asked("formation_n10_m5", "0.5", "extended", "5 / – / 0.44 / 1.65"),
    Asked("power_n60_m20", "0.05", "decentralized", "0 / 0.49 / 1.0 / 1.10, 0.3 s"),
    Asked("heat_n200_m4", "0.5", "decentralized", "4 / 18 / 0.78 / 1.51, 26 s"),
    Asked("three-states-dense", "0.5", "setpoint", "5 / – / 0.33 / 1.7"),
    Asked("three-states-dense", "0.5", "decentralized"),
    Asked("three-states-slow", "0.001", "decentralized"),
    Asked("platoon_n9_m3_d", "0.99", "decentralized"),
    Asked("platoon_n9_m3_d", "0.99", "extended"),
    Asked("platoon_n60_m20", "0.1", "decentralized"),
    Asked("compleib-ac12", "0.1", "decentralized"),
    Asked("compleib-ac13", "0.01", "decentralized"),
    Asked("compleib-ags", "0.2", "decentralized"),
    Asked("compleib-ags", "0.5", "diagnosis"),
    Asked("compleib-nn11", "1.5", "diagnosis"),
    Asked("compleib-bdt1", "0.01", "diagnosis"),
    Asked("compleib-ac13", "0.01", "diagnosis"),
)


def request_of(system: MultiChannelSystem, asked: Asked) -> Request:
    """The request, for the time domain of the plant."""
    if is_discrete(system.time):
        return Request.of(system, radius=asked.bound, arithmetic="float")
    return Request.of(system, rate=asked.bound, arithmetic="float")


def designed(system: MultiChannelSystem, asked: Asked) -> str:
    """Design, certify, and say the figures."""
    bound = {request_of(system, asked).region.word: asked.bound}
    if asked.structure == "setpoint":
        design = design_setpoint(system, **bound)
        told = figures(design.parts["designed"], design.order)
        return f"{told}, step peak {step_peak(design.loop.closed):.3g}"
    function = design_extended if asked.structure == "extended" else design_decentralized
    design = function(system, **bound)
    if "optimum" not in design.parts:
        return f"the controller of the theorem, of order {design.order}"
    return figures(design.parts, design.order)


def figures(parts: Mapping[str, Any], order: int) -> str:
    """The figures of a controller in one line."""
    found, known = parts["optimum"], parts["diagnosis"]
    seen = found.figures
    return (
        f"{order} / {seen.largest_gain:.3g} / {seen.margin:.2f} / {found.relative_cost:.2f}, "
        f"peak {seen.peak:.3g}, digits {found.digits}, {found.step}, "
        f"sensible {known.sensible_bound}"
    )


def answered(folder: Path, asked: Asked) -> str:
    """What a request is answered with."""
    system = load_system(folder / f"{asked.plant}.json")
    try:
        if asked.structure == "diagnosis":
            return str(diagnosed(system, request_of(system, asked).region))
        return designed(system, asked)
    except (Impossible, LimitReached) as refused:
        return str(refused)


def main(arguments: list[str]) -> int:
    """Answer the requests about the plants of a folder."""
    folder, names = Path(arguments[0]), arguments[1:]
    print("plant, bound, structure | order / largest gain / margin / J/Jc | reference", flush=True)
    for asked in REQUESTS:
        if names and asked.plant not in names:
            continue
        began = time.process_time()
        told = answered(folder, asked)
        spent = time.process_time() - began
        print(
            f"{asked.plant}, {asked.bound}, {asked.structure} | {told}, {spent:.1f} s"
            f" | {asked.before or 'none'}",
            flush=True,
        )
    return 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
