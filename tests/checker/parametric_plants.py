"""Certificates about plants with a parameter, small enough to be followed with a pencil."""

from __future__ import annotations

import json
from typing import Any

from mcexact import ParametricSystem
from mcexact.analysis.parameters.modes import parametric_fixed_spectrum
from mcexact.answer.protocol import document

Document = dict[str, Any]


def certified(A: Any, B: Any, C: Any, assume: Any = None, time: str = "continuous") -> Document:
    """The certificate of a plant whose parameter is t."""
    plant = ParametricSystem(
        A, B, C, parameters=["t"], assume={"t": assume} if assume else {}, time=time
    )
    return json.loads(json.dumps(document(parametric_fixed_spectrum(plant))))


PAPER = certified(
    [[1, 0, 0], ["t", 1, 0], [0, 1, 1]],
    [[[1], [0], [0]], [[0], [1], [0]], [[1], [0], [0]]],
    [[[1, 0, 0], [0, 0, 1]], [[0, 1, 0]], [[0, 1, 0]]],
)
"""Nothing is fixed but 1 at t = 0."""
SETTLED = certified(
    [[0, 0, 0, 0], [0, "t^2 + t - 2", 2, 0], [0, -2, -1, 0], [0, 0, "t - 1", 1]],
    [[[0], [0], [0], [0]], [[0], [0], [-2], [0]]],
    [[[-1, 2, 0, 0], [2, 0, 2, -2]], [[0, -1, 0, -1], [0, 0, 0, 2]]],
)
"""0 for every t, 1 at t = 1 and at two irrational values, from an exact resultant."""
GROWN = certified([[0, 0], [0, 0]], [[[0], ["t - 1"]]], [[[1, 1]]])
"""0 for every t; at t = 1 its multiplicity grows."""
TANGENT = certified([[2, 1], [0, 1]], [[[1], ["t^2"]]], [[[1, 0]]])
"""1 at t = 0, where the resultant vanishes twice: it has to be exact."""
RANGED = certified(
    [[2, 0, -1], [0, 0, -2], ["t", 0, 0]],
    [[[0], ["t^2 - 2"], ["t^3 - 2"]], [[], [], []]],
    [[[0, 0, 0], [0, 0, 1]], [[0, 0, 0]]],
    (0, 1),
)
"""The roots of t³ − 2 are out of range, and 2 is fixed at t = 0."""
POLES = certified(
    [[0, 0, 0, 0], [0, 1, 2, 0], [-2, 0, -1, -2], [0, -1, 1, "t/(t + 1)"]],
    [
        [[0, 1], [0, -2], [0, 0], [2, "t/(t + 1)"]],
        [[-1], [-2], [1], [1]],
        [[0, 0], [0, 0], [-1, 1], [0, 0]],
    ],
    [[[0, 0, 0, 0]], [[0, 0, 0, 0]], [[2, 2, 0, 0]]],
)
"""Modes multiplied by t + 1: 0 for every t, and −3/2 at t = −3/2; t = −1 is a pole."""
MOVING = certified(
    [[0, 0, 0, "2*t - 3"], [0, 0, "1/(t - 2)", 0], [-2, "t", 0, 0], [0, "t", 0, 2]],
    [[[1], [-1], [0], [0]], [[0], [0], [1], [0]], [[0], [0], [0], [0]]],
    [[[0, 0, 0, 0]], [[0, 0, 0, 0]], [[0, 0, 2, 0]]],
)
"""A generic polynomial of degree 4, with a zero block that depends on t and on x."""
IRRATIONAL = certified([["t", 1], [0, 2]], [[[1], ["t^2 - 2"]]], [[[1, 0]]], time="discrete")
"""x − t where t² + t = 4, and 2 where t² = 2."""
DIAGONAL = certified([["t", 0], [0, "2*t"]], [[[0], [0]]], [[[1, 1]]])
"""t and 2t for every t; at t = 1, 3/2, 2 and 3 one of them is a root of x + 2t² − 9t + 6."""
EMPTY = certified([], [[]], [[[]]])
"""No states."""
TWO = certified([[1, 0], [0, 2]], [[["t"], ["t"]]], [[[1, 1]]])
"""Both modes are fixed at t = 0, where nothing is controlled."""
PAIR = certified([[1, 0], [0, 2]], [[["t"], [0]], [[0], [1]]], [[[1, 1]], [[1, 1]]])
"""1 at t = 0, where gains of the second channel move 2."""
SCALAR = certified([[1]], [[["t"]]], [[[1]]])
"""1 at t = 0."""
ALL = {
    "paper": PAPER,
    "settled": SETTLED,
    "grown": GROWN,
    "tangent": TANGENT,
    "ranged": RANGED,
    "poles": POLES,
    "moving": MOVING,
    "irrational": IRRATIONAL,
    "diagonal": DIAGONAL,
    "empty": EMPTY,
    "two": TWO,
    "pair": PAIR,
    "scalar": SCALAR,
}


def exactly(document: Document) -> Document:
    """The same with an exact resultant, modulo prime numbers of Mersenne."""
    witness = document["witness"] | {"moduli": [2**521 - 1, 2**607 - 1], "common": []}
    return document | {"witness": witness}
