"""True certificates about costs, margins, sectors and steps of loops, and about drawn plants."""

from __future__ import annotations

import json
import random
from fractions import Fraction
from typing import Any

import numpy as np

from mcexact.analysis.performance import bound_of, cost_of, influences, margin_of, sectors_of
from mcexact.analysis.saturation import gains_for, gains_none, saturation_of
from mcexact.analysis.steps import steps_of
from mcexact.answer import protocol
from mcexact.answer.performance import CostWeights
from mcexact.errors import McexactError
from mcexact.exact.matrix import Matrix, matrix_to_float
from mcexact.model.controller import read_controller
from mcexact.model.loop import ClosedLoop, closed_loop
from mcexact.model.system import MultiChannelSystem
from mcexact.model.system_file import read_system
from tests.oracle.certificates.systems import read_plant

from .plants import Document, drawn_plant, number, rows_of, table
from .subjects import drawn_controller

KINDS = ("loop_cost", "cost_bound", "disk_margin", "saturation", "sector", "step_peaks")


def damped_plant(rng: random.Random) -> Document:
    """A drawn plant that is more stable than most: A less a multiple of I, or a part of A."""
    plant = drawn_plant(rng)
    rows, n = rows_of(plant["A"]), len(rows_of(plant["A"]))
    by = rng.choice((0, 1, 2, 4))
    for i in range(n):
        for j in range(n):
            x = Fraction(rows[i][j])
            x = x - by * (i == j) if plant["time"] == "continuous" else x / (1 + by)
            rows[i][j] = number(x)
    plant["A"] = table(rows, n)
    return plant


def drawn_weights(rng: random.Random, plant: MultiChannelSystem) -> CostWeights:
    """Weights, some of them 0 where they may be, with or without a bandwidth."""
    p, q = (sum(map(size, range(plant.m))) for size in (plant.p, plant.q))
    some = tuple(map(Fraction, ("0", "1/100", "1/3", "1", "1", "1", "7")))

    def draw(count: int, least: int = 0) -> tuple[Fraction, ...]:
        return tuple(rng.choice(some[least:]) for _ in range(count))

    band = rng.choice((None, Fraction(3), Fraction(50)))
    return CostWeights(
        draw(plant.n),
        draw(p, 1),
        draw(plant.n, rng.randrange(2)),
        draw(q, rng.randrange(2)),
        bandwidth=None if plant.time == "discrete" else band,
    )


ATTEMPTS = 12
"""So many loops are drawn until one is stable."""


def drawn_loop(rng: random.Random) -> tuple[Document, Document, ClosedLoop] | None:
    """A plant, its controller as in a certificate, and their loop, if a drawn one is stable."""
    for _ in range(ATTEMPTS):
        plant = damped_plant(rng)
        system = read_plant(plant)
        controller = drawn_controller(rng, system)
        text = json.dumps({"format": "mcexact-controller/1", "system": "", **controller})
        read = read_system(json.dumps({"format": "mcexact-system/1", **plant}))
        loop = closed_loop(read, read_controller(text))
        poles = np.linalg.eigvals(matrix_to_float(loop.matrix))
        beyond = np.abs(poles) >= 1 if plant["time"] == "discrete" else poles.real >= 0
        if not np.any(beyond):
            return plant, controller, loop
    return None


def drawn_performance(rng: random.Random, kind: str) -> Document | None:
    """One attempt at a true certificate of one of these kinds."""
    try:
        return _about_plant(rng) if kind == "cost_bound" else _about_loop(rng, kind)
    except (McexactError, ValueError):
        return None


def _about_plant(rng: random.Random) -> Document | None:
    document = damped_plant(rng)
    plant = read_system(json.dumps({"format": "mcexact-system/1", **document}))
    graph = influences(plant, messages=rng.random() < 0.5) if rng.random() < 0.7 else None
    return _written(bound_of(plant, drawn_weights(rng, plant), graph), document, [])


def _about_loop(rng: random.Random, kind: str) -> Document | None:
    drawn = drawn_loop(rng)
    if drawn is None:
        return None
    plant, controller, loop = drawn
    answer: Any
    if kind == "loop_cost":
        answer = cost_of(loop, drawn_weights(rng, loop.plant))
    elif kind == "disk_margin":
        at: Any = rng.choice(("inputs", "outputs"))
        margin = rng.choice((None, None, Fraction(1, 10), Fraction(2, 5)))
        answer = margin_of(loop, at, together=rng.random() < 0.5, margin=margin)
    elif kind == "step_peaks":
        sides: Any = ("inputs", "outputs", "setpoints")
        answer = steps_of(loop, rng.choice(sides), most=400)
    elif kind == "saturation":
        answer = _saturated(rng, loop)
    else:
        ends = [(Fraction(1, 2), Fraction(2)), (Fraction(9, 10), Fraction(11, 10))]
        ends += [(Fraction(0), Fraction(1)), (Fraction(1, 4), Fraction(3, 2))]
        count = loop.disturbed.U.nrows
        answer = sectors_of(loop, [rng.choice(ends) for _ in range(count)])
    steps = [{"construction": "closed_loop", "controller": controller}]
    return _written(answer, plant, steps)


def _saturated(rng: random.Random, loop: ClosedLoop) -> Any:
    """The loop with drawn limits, and with anti-windup gains that were chosen, or drawn."""
    some: Any = (None, (-1, 1), (-1, Fraction(1, 2)), (0, 3), (Fraction(-1, 7), 2), (-2, 2))
    p = [loop.plant.p(i) for i in range(loop.plant.m)]
    limits = tuple(tuple(rng.choice(some) for _ in range(count)) for count in p)
    exact: Any = tuple(
        tuple(None if pair is None else tuple(map(Fraction, pair)) for pair in own)
        for own in limits
    )
    if rng.random() < 0.5:
        return gains_for(loop, exact)[1]
    gains = [
        Matrix.from_rows(
            [[Fraction(rng.choice((0, 0, 1, -1, 3)), 10) for _ in range(L.ncols)]] * L.nrows,
            ncols=L.ncols,
        )
        for L in gains_none(loop)
    ]
    return saturation_of(loop, exact, gains)


def _written(answer: Any, plant: Document, steps: list[Document]) -> Document | None:
    if answer is None:
        return None
    return {**protocol.document(answer), "system": plant, "subject": steps}
