"""All sentences and rows about small plants with one to three parameters, at drawn values.

Run as ``python -m tests.assurance.campaigns.parametric_words [COUNT [FIRST [FILE]]]``: each plant
is asked at drawn points, on each of the hypersurfaces that are named, and at poles.  Systems in the
file (by default ``build/parametric_words.jsonl``) are not examined again.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

from mcexact import ParametricSystem, analyze
from mcexact.errors import LimitReached
from tests.assurance.campaigns.resumed import Examined, main
from tests.oracle.parametric_words import CONDITION, disagreements, value_at

FILE = Path("build") / "parametric_words.jsonl"
NAMES = ("a", "b", "c")
SHAPES = ("{0}", "{0} - 1", "{0} + 2", "-{0}", "1/{0}", "1/({0} - 1)", "{0}*{1}", "{0} - {1}")


def drawn(rng: random.Random) -> ParametricSystem:
    """A plant of one to three states, one or two channels and one to three parameters."""
    n, m = rng.randint(1, 3), rng.randint(1, 2)
    parameters = NAMES[: rng.choice([1, 1, 2, 2, 3])]
    depending = 0

    def entry() -> Any:
        nonlocal depending
        if rng.random() < 0.25 and depending < 4:
            depending += 1
            shape = rng.choice(SHAPES)
            return shape.format(rng.choice(parameters), rng.choice(parameters))
        return rng.choice([0, 0, 0, 1, 1, -1, 2])

    def table(r: int, c: int) -> list[list[Any]]:
        return [[entry() for _ in range(c)] for _ in range(r)]

    B, C = [table(n, 1) for _ in range(m)], [table(1, n) for _ in range(m)]
    ranges = {name: (0, 1) for name in parameters if rng.random() < 0.2}
    return ParametricSystem(
        table(n, n),
        B,
        C,
        parameters=list(parameters),
        assume=ranges,
        time=rng.choice(["continuous", "discrete"]),
    )


def conditions(account: Any) -> list[str]:
    """The functions of the parameters of which something is said to be special where they are 0."""
    texts = [where for name in account.answers for where, *_ in account.rows(name)]
    found = [pair for where in texts for pair in CONDITION.findall(where)]
    return [*dict.fromkeys(f"{left.strip()} - ({right})" for left, right in found)]


def point(parameters: tuple[str, ...], rng: random.Random) -> dict[str, Fraction]:
    """A point that lies on no hypersurface but by chance."""
    return {name: Fraction(rng.randint(-99, 99), rng.choice([7, 11, 13])) for name in parameters}


def points(
    plant: ParametricSystem, account: Any, rng: random.Random, count: int
) -> Iterator[dict[str, Fraction]]:
    """Drawn points, and on each hypersurface that is linear in a parameter some, alone on it."""
    every = conditions(account)
    small = [Fraction(k) for k in (0, 1, -1)] if len(plant.parameters) == 1 else []
    yield from ({plant.parameters[0]: value} for value in small)
    drawn_points = [point(plant.parameters, rng) for _ in range(count)]
    for each in [*drawn_points, *(p for h in every for p in _on(h, plant.parameters, rng))]:
        several = len(plant.parameters) > 1
        if not several or sum(_vanishes(h, each) for h in every) < 2:
            yield each


def _vanishes(h: str, at: dict[str, Fraction]) -> bool:
    return value_at(h, at) == 0


def _on(h: str, parameters: tuple[str, ...], rng: random.Random) -> Iterator[dict[str, Fraction]]:
    """A drawn point on a hypersurface, where its function is linear in a parameter."""
    for name in parameters:
        at = point(parameters, rng)
        first, second, third = (value_at(h, {**at, name: Fraction(k)}) for k in (0, 1, 2))
        if third - second == second - first != 0:
            yield {**at, name: -first / (second - first)}


def examined(number: int, count: int = 3) -> Examined:
    """What is wrong about the words on a drawn system, and what was looked at."""
    rng = random.Random(number)
    plant = drawn(rng)
    seen = {"systems": 1, f"with {len(plant.parameters)} parameters": 1}
    try:
        account = analyze(plant).account
        asked = [*points(plant, account, rng, count)]
        wrong = [each for at in asked for each in disagreements(plant, account, at)]
    except LimitReached:
        return [], {**seen, "open": 1}
    seen |= {"points": len(asked), "with conditions": int(bool(conditions(account)))}
    seen["with ranges"] = int(any(each != (None, None) for each in plant.ranges))
    return wrong, seen


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:], 500, FILE, examined, "disagreements"))
