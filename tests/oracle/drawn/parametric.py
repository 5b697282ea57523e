"""Plants with a parameter, of at most three states, as the objects of certificates."""

from __future__ import annotations

import json
import random

from mcexact.derived.constructions import along_line
from mcexact.errors import McexactError
from mcexact.model.parametric import ParametricSystem
from mcexact.model.system_file import read_parametric_system
from tests.oracle.certificates.constructions import subject_of
from tests.oracle.certificates.reading import Unspecified
from tests.oracle.certificates.rearranged import REARRANGING

from .plants import NAMES, Document, number, table
from .subjects import drawn_step

ENTRIES = (
    "t", "t", "t", "t + 1", "1 - t", "t^2", "t^2 - 2", "t^2 + 1", "2*t - 3", "t^3 - 2",
    "1/(t - 2)", "t/(t + 1)", "(t - 1)*(t + 2)",
)  # fmt: skip
RANGES = ((0, 1), (None, 0), ("-1/2", None))


def drawn_parametric_plant(rng: random.Random) -> Document:
    """A plant; often a row of A that few entries or inputs couple to the others."""
    n, m = rng.choice((0, 1, 2, 2, 2, 3, 3)), rng.choice((1, 2, 2))

    def rows(nrows: int, ncols: int, density: float) -> list[list[object]]:
        return [
            [number(rng.choice((1, -1, 2))) if rng.random() < density else 0 for _ in range(ncols)]
            for _ in range(nrows)
        ]

    A = rows(n, n, 0.4)
    B = [rows(n, rng.choice((1, 1, 0)), 0.5) for _ in range(m)]
    C = [rows(rng.choice((1, 1, 0)) if n else 0, n, 0.5) for _ in range(m)]
    if n > 1 and rng.random() < 0.5:
        A[-1] = [0] * (n - 1) + A[-1][-1:]
        A[-1][rng.randrange(n)] = rng.choice(ENTRIES)
        for B_i in B:
            B_i[-1] = [0] * len(B_i[-1])
    for _ in range(rng.choice((1, 1, 2))):
        table = rng.choice([A, A, *B, *C])
        if table and table[0]:
            rng.choice(table)[rng.randrange(len(table[0]))] = rng.choice(ENTRIES)
    plant = ParametricSystem(
        A,
        B,
        C,
        parameters=["t"],
        assume={"t": rng.choice(RANGES)} if rng.random() < 0.2 else {},
        time=rng.choice(("continuous", "discrete")),
        names=rng.choice(NAMES)[:m],
    )
    return plant.document()


INSIDE = ("u1 + v1", "u1*v1", "u1 - 2*v1 + 1", "u1", "u1^2 - v1", "1/(u1 + v1)", "(u1 + 1)/v1")
"""What t is in terms of two parameters."""


def drawn_on_a_line(rng: random.Random) -> tuple[Document, list[Document]]:
    """A plant with two parameters, and a line, perhaps with constructions that place entries."""
    while True:
        text = json.dumps({"format": "mcexact-system/1", **drawn_parametric_plant(rng)})
        curve = {"t": rng.choice(INSIDE)}
        assume = {"u1": (0, 1)} if rng.random() < 0.1 else {}
        try:
            plant = read_parametric_system(text).along(curve, ["u1", "v1"], assume)
            point, direction = (
                {name: rng.choice((0, 1, -1, 2, "1/2")) for name in plant.parameters}
                for _ in range(2)
            )
            line = along_line(plant, point, direction, rng.choice(("s", "t", "u2")))
        except (McexactError, ZeroDivisionError):
            continue
        return plant.document(), [dict(line.subject[0]), *drawn_moves(rng, plant.document())]


def drawn_moves(rng: random.Random, plant: Document, largest: int = 5) -> list[Document]:
    """Constructions that move the entries of a plant; often none."""
    A = plant["A"]
    bare = {
        "time": plant["time"],
        "A": table([[0] * len(A) for _ in A], len(A)),
        "channels": [{**c, "B": _zeros(c["B"]), "C": _zeros(c["C"])} for c in plant["channels"]],
        "neighbors": {c["name"]: [] for c in plant["channels"]},
    }
    steps: list[Document] = []
    while rng.random() < 0.35 and len(steps) < 3:
        system = subject_of({"system": bare, "subject": steps})
        step = drawn_step(rng, rng.choice(REARRANGING), system)
        if step is None:
            continue
        try:
            made = subject_of({"system": bare, "subject": [*steps, step]})
        except Unspecified:
            continue
        if made.n <= largest:
            steps.append(step)
    return steps


def _zeros(M: Document | list[list[object]]) -> object:
    return M if isinstance(M, dict) else table([[0] * len(row) for row in M], len(M[0]) if M else 0)
