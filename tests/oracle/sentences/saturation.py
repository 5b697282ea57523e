"""Judges of sentences about inputs that are cut off at their limits.

The sentences can only be refuted: by the loop with constant parts of its inputs, and by solutions
that start where a region is said to be.  Anti-windup gains are not among the values of a sentence;
where there are some, only the loop itself is judged, in which nothing is cut off.
"""

from __future__ import annotations

import random
from typing import Any

import numpy as np

from tests.oracle.certificates.performance import Disturbed, disturbed_loop
from tests.oracle.certificates.roots import inside
from tests.oracle.sentences.analysis import judge
from tests.oracle.sentences.cases import Case, Said, number
from tests.oracle.sentences.performance import floats

DRAWS, STEPS = 40, 400
Ends = list[tuple[float, float]]


def _ends(said: Said) -> Ends:
    """The limits of all inputs, infinite where there are none."""
    pairs = [pair for _, own in said.values["limits"] for pair in own]
    free = (-np.inf, np.inf)
    return [free if each is None else _floats(each) for each in pairs]


def _floats(pair: Any) -> tuple[float, float]:
    low, high = (float(int(x.p) / int(x.q)) for x in map(number, pair))
    return low, high


def _is_stable(M: np.ndarray[Any, Any], time: str) -> bool:
    poles = np.linalg.eigvals(M)
    return bool(np.all(np.abs(poles) < 1) if time == "discrete" else np.all(poles.real < 0))


@judge("first-saturation")
def _first(said: Said, case: Case) -> bool:
    """The loop itself."""
    loop = disturbed_loop(case.plant, case.loop.agents)
    return inside(loop.M.charpoly(), case.plant.time, None)


@judge("first-saturation-region")
def _first_region(said: Said, case: Case) -> bool:
    """The loop itself, from a ball."""
    return bool(number(said.values["radius"]) > 0) and _first(said, case)


@judge("saturation-global")
def _everywhere(said: Said, case: Case) -> bool:
    """The loop with constant parts of the inputs that have limits."""
    loop, ends, rng = disturbed_loop(case.plant, case.loop.agents), _ends(said), random.Random(1)
    if len(ends) != loop.U.nrows() or not all(low <= 0 <= high for low, high in ends):
        return False
    if said.values["gains"]:
        return inside(loop.M.charpoly(), case.plant.time, None)
    M, E, U = (floats(each) for each in (loop.M, loop.E, loop.U))
    for k in range(DRAWS):
        parts = [
            1.0 if high == np.inf else (rng.choice((0.0, 1.0)) if k % 2 else rng.random())
            for _, high in ends
        ]
        if not _is_stable(M + E @ np.diag(np.array(parts) - 1) @ U, case.plant.time):
            return False
    return True


@judge("saturation-region")
def _from_a_region(said: Said, case: Case) -> bool:
    """Solutions from the border of the ball."""
    loop, ends, rng = disturbed_loop(case.plant, case.loop.agents), _ends(said), random.Random(1)
    radius = number(said.values["radius"])
    if len(ends) != loop.U.nrows() or radius <= 0:
        return False
    if said.values["gains"]:
        return inside(loop.M.charpoly(), case.plant.time, None)
    sizes = [number(x) for x in said.values["sizes"] or [1] * case.plant.n]
    if len(sizes) != case.plant.n or not all(x > 0 for x in sizes):
        return False
    ball = np.array([float(int(x.p) / int(x.q)) for x in (radius * size for size in sizes)])
    return all(_returns(loop, ends, ball, rng) for _ in range(8))


def _returns(loop: Disturbed, ends: Ends, radius: np.ndarray[Any, Any], rng: random.Random) -> bool:
    """Whether a solution comes closer to rest than it was, with inputs cut off."""
    M, E, U = (floats(each) for each in (loop.M, loop.E, loop.U))
    low, high = np.array(ends).reshape(-1, 2).T
    n, z = loop.plant.n, np.zeros(len(M))
    z[:n] = [rng.gauss(0, 1) for _ in range(n)]
    z *= 0.999 / max(float(np.linalg.norm(z)), 1e-300)
    z[:n] *= radius

    def change(z: np.ndarray[Any, Any]) -> Any:
        v = U @ z
        return M @ z + E @ (np.clip(v, low, high) - v)

    if not len(z):
        return True
    first, discrete = float(np.linalg.norm(z)), loop.plant.time == "discrete"
    size = max(float(np.linalg.norm(M, 2)), 1.0)
    rate = np.linalg.eigvals(M)
    slowest = float(np.max(np.abs(rate))) if discrete else float(np.max(rate.real))
    slow = -np.log(max(slowest, 1e-9)) if discrete else -slowest
    if slow <= 0:
        return False
    steps = int(min(20_000, STEPS + 10 / slow * (1 if discrete else 10 * size)))
    for _ in range(steps):
        if discrete:
            z = change(z)
        else:
            h = 0.1 / size
            half = z + h / 2 * change(z)
            z = z + h * change(half)
        if float(np.linalg.norm(z)) > 1e6 * first:
            return False
    return float(np.linalg.norm(z)) < first
