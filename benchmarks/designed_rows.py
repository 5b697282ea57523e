"""What a design without a rate is answered with, as a row of a table.

`answered` designs, proves the cost, its bound and the margins, searches a box, and asks for the
verdict, as `mcexact design` does.  Every row has the same effort, but where the search of a family
finds no controller: then it is given once more, for longer (`families`).  Where a plant within 1 %
fails, `beyond_all` looks for one that no controller stabilizes, not even one that has all outputs
and all inputs: then no controller is worth installing.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from fractions import Fraction
from math import isfinite, nan
from typing import Any

from benchmarks.kept_rows import Row
from mcexact.analysis.boxes.failure import failing_plant
from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.derived.constructions import merged
from mcexact.designs import Aims
from mcexact.errors import Impossible, LimitReached, OutOfReach
from mcexact.exact.roots import StabilityRegion
from mcexact.model.box import Box
from mcexact.model.system import MultiChannelSystem
from mcexact.synthesis.assessment import FAILS, assess
from mcexact.synthesis.design import Design
from mcexact.synthesis.performance import performance_of

EFFORT, BOX = 12.0, 3.0
"""About the seconds for each search of a controller and of a box."""
_MOST_STATES, _TRIES = 60, 8
_COMPUTED, _SOUGHT = "(computed)", "(a search, not a proof)"
"""How notes about aims end that were missed."""


def answered(
    function: Callable[..., Design],
    system: MultiChannelSystem,
    effort: float = EFFORT,
    box: float = BOX,
) -> Row:
    """The row of a plant: its figures, or the reason why there is no controller.

    Parameters
    ----------
    function : callable
        A ``design_…`` function.
    system : MultiChannelSystem
    effort, box : float
        About the seconds of the search of a controller, and of a proof for a box of plants.
    """
    began = time.process_time()
    try:
        design = function(system, arithmetic="float", aims=Aims(effort=effort))
    except Impossible as refused:
        row: Row = {"answer": "refused", "told": str(refused)}
    except OutOfReach as far:
        row = {"answer": "out of reach", "told": str(far)}
    except LimitReached as limit:
        row = {"answer": "limit", "told": str(limit)}
    else:
        row = _figures(design, effort, box)
    seconds = round(time.process_time() - began, 1)
    fails = row.get("fails within")
    if fails is not None and fails < FAILS and system.n <= _MOST_STATES:
        beyond = beyond_all(system)
        row["beyond all"] = None if beyond is None else float(beyond)
    return {**row, "seconds": seconds}


def beyond_all(system: MultiChannelSystem) -> Fraction | None:
    """The part of each entry within which a plant is that no controller stabilizes.

    Returns
    -------
    Fraction or None
        None if none was found, which proves nothing.  It is decided exactly that a mode of the
        plant is fixed for all agents together, and is not stable.

    Examples
    --------
    >>> beyond_all(MultiChannelSystem([[1, 0], [0, -1]], [[["1/10"], [1]]], [[[1, 1]]]))
    Fraction(1, 1)
    """
    unit, region = Box.relative(system, 1).system, StabilityRegion(system.time)
    box = Box(unit)
    together = [(), tuple(range(system.m))]
    near = failing_plant(box.nominal, box.radii, together, _TRIES, region)
    if near is None:
        return None
    fixed = fixed_spectrum(merged(near.plant, [system.names])).polynomial
    return None if region.contains_roots_of(fixed) else near.distance


def _figures(design: Design, effort: float, box: float) -> Row:
    """What is proved and computed of a design."""
    around = design.every_loop(box)
    seen = performance_of(design.loop.closed)
    account = design.account_with(around, seen)
    known = assess(design, Aims(effort=effort), around, seen)
    parts = design.parts.get("designed", design.parts)
    optimum, failing = parts.get("optimum"), around.failing
    return {
        "answer": "designed" if optimum is not None else "theorem",
        design.region.word: str(design.region.edge),
        "states": design.loop.matrix.nrows,
        "order": design.order,
        "proved ratio": None if seen.ratio is None else float(seen.ratio),
        "ratio": _known(seen.times_the_bound),
        "least": _known(seen.computed.get("cost_bound", nan)),
        "why not": dict(seen.left_out),
        "disk": _known(seen.least_margin),
        "disk is proved": seen.margin is not None,
        "joint": _known(seen.joint_margin),
        "damping": _known(known.figures.damping),
        "margin": _known(known.figures.margin),
        "box": None if around.part is None else float(around.part),
        "fails within": None if failing is None else float(failing.distance),
        "digits": known.digits,
        "step": None if optimum is None else optimum.step,
        "install": known.install,
        "first line": known.first_line(account.sentences.at("first")),
        "warnings": list(known.warnings),
        "missed": [each for each in design.notes if each.endswith((_COMPUTED, _SOUGHT))],
    }


def _known(value: float) -> float | None:
    return value if isfinite(value) else None


def told(row: Row) -> str:
    """The figures of a row in one line."""
    if row["answer"] not in ("designed", "theorem"):
        return str(row["told"])
    figures: dict[str, Any] = {name: row[name] or nan for name in ("disk", "joint", "damping")}
    ratio = row["proved ratio"] or nan
    listed = ", ".join(f"{name} {value:.2f}" for name, value in figures.items())
    return f"order {row['order']}, ratio {ratio:.3g}, {listed}: {row['first line']}"
