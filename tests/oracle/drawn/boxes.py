"""Certificates about boxes of drawn plants, whose channels each move a state of their own."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from fractions import Fraction
from typing import Any

from mcexact.checker.core.reading import Limits
from mcexact.checker.discs import Box
from mcexact.checker.parametric_system import plant_of_file
from tests.checker.box_maker import (
    control_witness,
    controllable,
    fixed,
    fixed_witness,
    in_cells,
    stable,
)
from tests.checker.box_plants import LOOP, gains, programs, radii_of_first
from tests.checker.handmade import matrix, plant
from tests.checker.parameter_plants import stable as stable_in_ranges

from .plants import Document, number, table

SMALL = (0, 0, Fraction(1, 8), Fraction(-1, 4))
RADII = (0, 0, Fraction(1, 20), Fraction(1, 10))
GAINS = (0, 1, -3, 5, Fraction(1, 4))
DUAL: Document = {"construction": "dual"}
FED_BACK: Document = {
    "construction": "feedback",
    "gains": [matrix([-1], denominator=8), matrix([1], denominator=4)],
}


def drawn_box(rng: random.Random, diagonal: tuple[Fraction | int, ...], time: str) -> Document:
    """A plant of two states, nearly diagonal, some of whose entries are uncertain."""
    values = [[rng.choice(SMALL) for _ in range(2)] for _ in range(2)]
    for i in range(2):
        values[i][i] = rng.choice(diagonal)
    ports: list[Any] = [([[1], [0]], [[1, 0]]), ([[rng.choice(SMALL)], [1]], [[0, 1]])]
    written = [(table([[number(x) for x in row] for row in B], 1), table(C, 2)) for B, C in ports]
    A = table([[number(x) for x in row] for row in values], 2)
    found = plant(A, *written, time=time)
    doubts = {"A": drawn_radii(rng, 2, 2)}
    for key, shape in (("B", (2, 1)), ("C", (1, 2))):
        listed = {name: drawn_radii(rng, *shape) for name in ("1", "2")}
        doubts[key] = {name: form for name, form in listed.items() if form}
    if any(doubts.values()):
        found["uncertainty"] = {"absolute": {key: part for key, part in doubts.items() if part}}
    return found


def drawn_radii(rng: random.Random, nrows: int, ncols: int) -> Document | None:
    """The radii of a matrix, None if all are 0."""
    cells = ((i, j, rng.choice(RADII)) for i in range(nrows) for j in range(ncols))
    entries = [[i, j, number(radius)] for i, j, radius in cells if radius]
    return {"shape": [nrows, ncols], "entries": entries} if entries else None


def drawn_about_a_box(rng: random.Random, kind: str) -> Document | None:
    """A true certificate of a kind, or None where its maker finds none."""
    time = rng.choice(("continuous", "discrete"))
    try:
        if kind == "box_stable":
            return drawn_stable(rng, time)
        bound = rng.choice((None, None, 0 if time == "continuous" else 1))
        found = drawn_box(rng, (-1, 1, 2, Fraction(1, 2)), time)
        if kind == "box_fixed":
            x = rng.choice((2, 3, -3))
            steps: tuple[Document, ...] = (FED_BACK,) if rng.random() < 0.3 else ()
            under = drawn_gains(rng, lambda: [[[rng.choice(GAINS)]] for _ in range(2)])
            return fixed(found, [gains((x, 1), (x, 1))], *steps, bound=bound, under=under)
        steps = rng.choice(((), (DUAL,), (FED_BACK,), (FED_BACK, DUAL)))
        under = drawn_gains(rng, lambda: [[[rng.choice(GAINS) for _ in "12"] for _ in "12"]])
        return controllable(found, ["1", "2"], *steps, bound=bound, under=under)
    except ArithmeticError:
        return None


def drawn_gains(rng: random.Random, draw: Callable[[], Any]) -> tuple[Any, ...]:
    """Of which matrices there are exterior discs: of A, of some A_F, or of several of them."""
    found = [rng.choice((None, draw())) for _ in range(rng.choice((1, 1, 2, 3)))]
    return tuple(found)


ENTRIES = {"a": ("a", "b - 1", "a*b", "b - 2"), "t": ("t", "-t + 1", "t^2 - 2", "-t")}
"""Entries of plants with one parameter, or with two, by the first one."""


def dense(M: Any) -> list[list[Any]]:
    """The rows of a matrix, which plants with parameters have always."""
    if isinstance(M, list):
        return M
    rows = [[0] * M["shape"][1] for _ in range(M["shape"][0])]
    for i, j, value in M["entries"]:
        rows[i][j] = value
    return rows


def vanishing(name: str, value: Fraction, power: int = 1) -> str:
    """An entry that vanishes where the power of a parameter has this value."""
    raised = name if power == 1 else f"{name}^{power}"
    return raised if not value else f"{raised} {'-' if value > 0 else '+'} {abs(value)}"


def beside_failure(rng: random.Random) -> tuple[Document, list[int | None]]:
    """A plant whose channel 1 does nothing at a value beyond the last one, and its cells.

    They are the smaller the nearer they are to it.
    """
    found = drawn_box(rng, (-1, 1, 2, Fraction(1, 2)), rng.choice(("continuous", "discrete")))
    times, power = rng.choice((1, 2, 4, 8, 18)), rng.choice((1, 2))
    beyond = vanishing("t", 1 + Fraction(power, 4 * 2**times), power)
    ports: list[Any] = [([[beyond], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]])]
    for channel, (B, C) in zip(found["channels"], ports, strict=True):
        channel["B"], channel["C"] = B, C
    found = in_ranges(found, t=("3/4", 1))
    found["A"][0][1] = 0
    return found, [*[0, None] * times, None]


def in_ranges(found: Document, **ranges: tuple[Any, Any]) -> Document:
    """The plant with parameters and without radii, with rows in its matrices."""
    ports = [{**c, "B": dense(c["B"]), "C": dense(c["C"])} for c in found["channels"]]
    known = {name: {"range": list(ends)} for name, ends in ranges.items()}
    plain = {key: part for key, part in found.items() if key != "uncertainty"}
    return {**plain, "A": dense(found["A"]), "channels": ports, "parameters": known}


def with_parameters(rng: random.Random) -> tuple[Document, list[int | None]]:
    """A plant with one or two parameters, and cells."""
    names = rng.choice((("t",), ("t",), ("a", "b")))
    values = {"a": ("3/4", "5/4"), "b": ("1/2", 1), "t": ("3/4", 1)}
    some = ENTRIES[names[0]]
    found = drawn_box(rng, (-1, 1, 2, Fraction(1, 2)), rng.choice(("continuous", "discrete")))
    found = in_ranges(found, **{name: values[name] for name in names})
    for _ in range(rng.choice((1, 2, 3))):
        found["A"][rng.randrange(2)][rng.randrange(2)] = rng.choice(some)
    if rng.random() < 0.3:
        found["channels"][0]["B"] = [[rng.choice(some)], [0]]
    last = len(names) - 1
    ways: list[list[int | None]] = [[None], [0, None, None], [last, None, 0, None, None]]
    return found, rng.choice(ways)


def drawn_in_ranges(rng: random.Random, kind: str) -> Document | None:
    """A true certificate about all values of one or two parameters, or None."""
    if kind == "parametric_box_stable":
        return drawn_stable_in_ranges(rng)
    found, cuts = rng.choice((beside_failure, with_parameters, with_parameters))(rng)
    claim, made, steps = proof_in_cells(rng, kind, found["time"])
    try:
        return in_cells(found, kind, claim, cuts, made, *steps)
    except ArithmeticError:
        return None


def proof_in_cells(
    rng: random.Random, kind: str, time: str
) -> tuple[Document, Callable[[Box], Document], tuple[Document, ...]]:
    """A claim of a kind, what finds the evidence about a cell, and constructions."""
    if kind == "parametric_box_fixed":
        bound = rng.choice((None, None, 0 if time == "continuous" else 1))
        given = [gains((x, 1), (x, 1)) for x in (3, -3)]
        return {"bound": bound}, lambda box: fixed_witness(box, given, bound), ()
    claim = {"channels": ["1", "2"], "bound": None}
    steps = (DUAL,) if rng.random() < 0.5 else ()
    return claim, lambda box: control_witness(box, ["1", "2"], None), steps


def drawn_stable_in_ranges(rng: random.Random) -> Document:
    """About a stable plant some of whose entries have a parameter, or about a loop with it."""
    if rng.random() < 0.3:
        return beside_crossing(rng)
    found, cuts = with_parameters(rng)
    some = ENTRIES[min(found["parameters"])]
    discrete = found["time"] == "discrete"
    rows = [["1/4", "0"], ["0", "-1/4"]] if discrete else [["-4", "0"], ["0", "-3"]]
    for _ in range(rng.choice((1, 2, 3))):
        i, j = rng.randrange(2), rng.randrange(2)
        rows[i][j] = f"{rows[i][j].split(' ')[0]} {rng.choice('+-')} 1/8*({rng.choice(some)})"
    found["A"] = rows
    found = canonical_plant(found)
    bound = rng.choice((None, "15/16" if discrete else "1/16"))
    if discrete:
        points: list[Any] = ["1/8", "1/4", "1/2", "3/4", 1, "4/3", 2, 4, 8]
        return stable_in_ranges(found, cuts, points, bound=bound)
    points = ["1/4", "1/2", "3/4", 1, "3/2", 2, 3, 4, 5, 6, 8]
    if rng.random() < 0.5:
        return stable_in_ranges(found, cuts, points, growth=[1, 1], bound=bound)
    radii = programs("continuous", radii_of_first("1/50", "1/100"), {"input": {}})["controller"]
    known = {"gain_radii": rng.choice((None, radii)), "bound": bound}
    return stable_in_ranges(found, cuts, points, LOOP, growth=[2, 2, 2], **known)


def beside_crossing(rng: random.Random, crosses: Fraction | None = None) -> Document:
    """About a plant one of whose eigenvalues is at the border for one value of its parameter.

    By default the value is beyond the last one; otherwise the evidence is wrong where it is.  Cells
    and segments are the smaller the nearer they are to it.
    """
    time, times = rng.choice(("continuous", "discrete")), rng.choice((1, 2, 4, 8))
    power = rng.choice((1, 2))
    value = 1 + Fraction(power, 4 * 2**times) if crosses is None else crosses
    border = value - (time == "discrete")
    coupled = number(rng.choice(SMALL))
    A = table([["0", 0], [coupled, number(Fraction(-1, 4))]], 2)
    found = plant(A, ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]), time=time)
    found = in_ranges(found, t=("3/4", 1))
    found["A"][0][0] = vanishing("t", border, power)
    near = [number(Fraction(1, 2**k)) for k in range(times + 5, -1, -1)]
    points, growth = (
        ([*near, "3/2", 2], [1, 1]) if time == "continuous" else ([*near, 2, 4, 8], None)
    )
    return stable_in_ranges(found, [*[0, None] * times, None], points, growth=growth)


def canonical_plant(found: Document) -> Document:
    """The plant of a file, as certificates have it."""
    text = json.dumps({"format": "mcexact-system/1", **found})
    plant: Document = plant_of_file(text.encode(), Limits())
    return plant


def drawn_stable(rng: random.Random, time: str) -> Document:
    """About a plant that is stable, or about a loop with it."""
    if time == "discrete":
        found = drawn_box(rng, (Fraction(-1, 4), Fraction(1, 4)), time)
        return stable(found, ["1/8", "1/4", "1/2", "3/4", 1, "4/3", 2, 4, 8])
    found = drawn_box(rng, (-1, -2), time)
    if rng.random() < 0.5:
        return stable(found, ["1/2", 1, 2, 4], growth=[1, 1])
    radius = rng.choice(("1/100", "1/50"))
    radii = programs(time, radii_of_first(radius, "1/100"), {"input": {}})["controller"]
    points = ["1/4", "1/2", "3/4", 1, "3/2", 2, 3, 4, 5, 6, 8]
    given = rng.choice((None, radii))
    return stable(found, points, LOOP, growth=[2, 2, 2], gain_radii=given)
