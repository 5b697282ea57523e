"""Plants of at most three states, channels, inputs and outputs, as the objects of certificates."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

from tests.oracle.certificates.reading import is_sparse

Document = dict[str, Any]

NAMES = (
    ("1", "2", "3"),
    ("a", "b", "c"),
    ("b", "a", "ab"),
    ("1+2", "1", "2"),
    ('", "', 'a" of: ', "plant"),
    ("ä", "∅", "a\\"),
)
VALUES = ((1,), (1, -1), (1, 2, -1, -2), (1, Fraction(1, 2), Fraction(-2, 3), 3))


def number(value: Fraction | int) -> int | str:
    """A rational as a certificate writes it."""
    value = Fraction(value)
    return value.numerator if value.denominator == 1 else f"{value.numerator}/{value.denominator}"


def entries(
    rng: random.Random, nrows: int, ncols: int, density: float, values: tuple[Any, ...]
) -> list[list[int | str]]:
    """Rows of drawn numbers, most of them 0 where the density is small."""
    return [
        [number(rng.choice(values)) if rng.random() < density else 0 for _ in range(ncols)]
        for _ in range(nrows)
    ]


def table(rows: list[list[int | str]], ncols: int) -> Any:
    """A matrix of a system; without rows it has to say how many columns it has."""
    found = [[i, j, x] for i, row in enumerate(rows) for j, x in enumerate(row) if x != 0]
    if (ncols and not rows) or is_sparse(len(rows), ncols, len(found)):
        return {"shape": [len(rows), ncols], "entries": found}
    return rows


def rows_of(value: Any) -> list[list[int | str]]:
    """The rows of a matrix of a system."""
    if isinstance(value, list):
        return value
    r, c = value["shape"]
    rows: list[list[int | str]] = [[0] * c for _ in range(r)]
    for i, j, x in value["entries"]:
        rows[i][j] = x
    return rows


def columns_of(value: Any) -> int:
    """The number of columns of a matrix of a system."""
    if isinstance(value, list):
        return len(value[0]) if value else 0
    return int(value["shape"][1])


def drawn_plant(rng: random.Random, *, graph: bool = False, most: int = 3) -> Document:
    """A plant, often with fixed modes, inactive channels, or none of something.

    Parameters
    ----------
    graph : bool
        Whether it has to have a neighbor graph.
    most : int
        The largest number of states, and of channels.
    """
    n = min(rng.choice((0, 1, 1, 2, 2, 2, 3, 3, 3)), most)
    m = min(rng.choice((1, 1, 2, 2, 2, 3, 3)), most)
    values, density = rng.choice(VALUES), rng.choice((0.3, 0.5, 0.8))
    A = entries(rng, n, n, rng.choice((0.2, 0.4, 0.7)), values)
    if rng.random() < 0.4:
        for i in range(n):
            A[i][i] = rng.choice((0, 1, -1, -2, "1/2"))
    names = list(rng.choice(NAMES)[:m])
    widths = rng.choice(((1,), (1,), (0, 1, 1, 2), (0, 1, 2, 3)))
    channels = []
    for name in names:
        p, q = rng.choice(widths), rng.choice(widths)
        B, C = entries(rng, n, p, density, values), entries(rng, q, n, density, values)
        channels.append({"name": name, "B": table(B, p), "C": table(C, n)})
    time = rng.choice(("continuous", "discrete"))
    plant: Document = {"time": time, "A": table(A, n), "channels": channels}
    if graph or rng.random() < 0.6:
        add_graph(rng, plant)
    return plant


def add_feedthrough(rng: random.Random, plant: Document) -> None:
    """A drawn D that is not 0, with a row for each output and a column for each input, if any."""
    p = sum(columns_of(each["B"]) for each in plant["channels"])
    q = sum(len(rows_of(each["C"])) for each in plant["channels"])
    if not p or not q:
        return
    D = entries(rng, q, p, 0.5, rng.choice(VALUES))
    D[rng.randrange(q)][rng.randrange(p)] = rng.choice((1, -1, 2))
    plant["D"] = table(D, p)


def add_graph(rng: random.Random, plant: Document) -> None:
    """A drawn neighbor graph; in discrete time with delays now and then."""
    names = [channel["name"] for channel in plant["channels"]]
    chance = rng.choice((0.2, 0.5, 0.8))
    plant["neighbors"] = {i: [j for j in names if j != i and rng.random() < chance] for i in names}
    if plant["time"] == "discrete" and rng.random() < 0.5:
        delays = {
            i: {j: rng.choice((1, 1, 2)) for j in senders if rng.random() < 0.6}
            for i, senders in plant["neighbors"].items()
        }
        delays = {i: row for i, row in delays.items() if row}
        if delays:
            plant["delays"] = delays
