"""The rule of ``setpoint``."""

from __future__ import annotations

from typing import Any

from tests.checker.handmade import Document, certificate, changed, checked, layers, matrix, plant
from tests.checker.tables import accepts, rejects


def claim(solvable: bool, rank: int, zero: Any = None) -> Document:
    return {"solvable": solvable, "rank": rank, "invariant_zero": zero}


def witness(left: Document, pivots: list[int], point: Any = None, normal: Any = None) -> Document:
    return {"modulus": 101, "left": left, "pivots": pivots, "point": point, "normal": normal}


NONE = matrix()
# Position of a spring: x1' = x2, x2' = -2 x1 - 3 x2 + u.
SPRING = [[0, 1], [-2, -3]]
POSITION = certificate(
    "setpoint", plant(SPRING, ([[0], [1]], [[1, 0]])), claim(True, 3), witness(NONE, [])
)
# The velocity cannot be held away from 0: row 1 of S is (0, 1, 0), and so is row 3.
VELOCITY = certificate(
    "setpoint",
    plant(SPRING, ([[0], [1]], [[0, 1]])),
    claim(False, 2, True),
    witness(matrix([-1, 0, 1]), [2], point=5),
)
# The same sum measured twice: y1 - y2 = 0 whatever happens.
TWICE = certificate(
    "setpoint",
    plant([[-1, 0], [0, -2]], ([[1], [0]], [[1, 1]]), ([[0], [1]], [[1, 1]])),
    claim(False, 3, False),
    witness(matrix([0, 0, 1, -1]), [2], normal=layers([[0, 0, 1, -1]])),
)
# The second state, y2, stays where nothing drives it: x times its row of C minus the row of A.
DIFFERENCE = certificate(
    "setpoint",
    plant([[0, 0], [0, 0]], ([[1], [0]], [[1, 0], [0, 1]]), time="discrete"),
    claim(False, 3, False),
    witness(
        matrix([0, 1, 0, 1]),
        [1],
        normal=layers([[0, 1, 0, 0]], [[0, 0, 0, -1]]),
    ),
)
ROW, ZERO = DIFFERENCE["witness"]["normal"]["coefficients"], [[0, 0, 0, 0]]
# From u to y = x2 + x3 stands s (s + 1) / s^3: besides 0, the zero -1.
TWO_ZEROS = certificate(
    "setpoint",
    plant([[0, 1, 0], [0, 0, 1], [0, 0, 0]], ([[0], [0], [1]], [[0, 1, 1]])),
    claim(False, 3, True),
    witness(matrix([-1, -1, 0, 1]), [3], point=1),
)
INTEGRATOR_IN_DISCRETE_TIME = certificate(
    "setpoint", plant([[1]], ([[1]], [[1]]), time="discrete"), claim(True, 2), witness(NONE, [])
)
NOTHING = certificate(
    "setpoint",
    plant([], ([], [])),
    claim(True, 0),
    witness(NONE, []),
)

ACCEPTED = [
    ("a position can be held", POSITION),
    ("a velocity has an invariant zero at 0", VELOCITY),
    ("a place on the other side of 0 than the second zero", TWO_ZEROS),
    ("a row times x^3, of the highest degree", changed(
        DIFFERENCE, ("witness.normal.coefficients", [ZERO, ZERO, ZERO, *ROW])
    )),
    ("another place of full rank", changed(VELOCITY, ("witness.point", 1))),
    ("the same output twice is no invariant zero", TWICE),
    ("a polynomial row that annihilates", DIFFERENCE),
    ("an integrator in discrete time", INTEGRATOR_IN_DISCRETE_TIME),
    ("no states and no outputs", NOTHING),
    ("another modulus", changed(VELOCITY, ("witness.modulus", 7))),
    ("a multiple of the annihilating row", changed(
        TWICE, ("witness.normal", layers([[0, 0, 3, -3]]))
    )),
]  # fmt: skip

REJECTED = [
    ("solvable called an invariant zero", POSITION, (
        ("claim", claim(False, 3, True)), ("witness.point", 5)
    )),
    ("an invariant zero called solvable", VELOCITY, (
        ("claim", claim(True, 2)), ("witness.point", None)
    )),
    ("dependent outputs called solvable", TWICE, (
        ("claim", claim(True, 3)), ("witness.normal", None)
    )),
    ("a row besides the point", VELOCITY, ("witness.normal", layers([[0, 0, 0]]))),
    ("a point besides the row", TWICE, ("witness.point", 3)),
    ("an unused row", POSITION, ("witness.normal", layers([[0, 0, 0]]))),
    ("solvable called unsolvable", POSITION, ("claim.solvable", False)),
    ("unsolvable called solvable", VELOCITY, ("claim.solvable", True)),
    ("a rank too large", VELOCITY, ("claim.rank", 3)),
    ("a rank too small", POSITION, ("claim.rank", 2)),
    ("a rank beyond the rows", POSITION, ("claim.rank", 4)),
    ("a verdict on zeros where all can be held", POSITION, ("claim.invariant_zero", False)),
    ("an unused point", POSITION, ("witness.point", 3)),
    ("an invariant zero denied", VELOCITY, ("claim.invariant_zero", False)),
    ("no verdict on the zero", VELOCITY, ("claim.invariant_zero", None)),
    ("the zero itself as the point", VELOCITY, ("witness.point", 0)),
    ("no point", VELOCITY, ("witness.point", None)),
    ("W of zeros", VELOCITY, ("witness.left", matrix([0, 0, 0]))),
    ("W that does not annihilate", VELOCITY, ("witness.left", matrix([1, 0, 1]))),
    ("a pivot too many", VELOCITY, ("witness.pivots", [1, 2])),
    ("an invariant zero where outputs are dependent", TWICE, ("claim.invariant_zero", True)),
    ("a row of zeros", TWICE, ("witness.normal", layers([[0, 0, 0, 0]]))),
    ("a row that does not annihilate", TWICE, ("witness.normal", layers([[0, 0, 1, 1]]))),
    ("no row", TWICE, ("witness.normal", None)),
    ("a term of higher degree left over", DIFFERENCE, (
        "witness.normal", layers([[0, 1, 0, 0]], [[0, 0, 0, -1]], [[0, 0, 1, 0]])
    )),
    ("a row of too high a degree", DIFFERENCE, (
        "witness.normal.coefficients", [ZERO, ZERO, ZERO, ZERO, *ROW]
    )),
    ("modulus 1", POSITION, ("witness.modulus", 1)),
    ("the other time domain", VELOCITY, ("system.time", "discrete")),
    ("another plant", POSITION, ("system.A.0.1", 0)),
]  # fmt: skip


test_sound_evidence_is_accepted = accepts(ACCEPTED)
test_a_change_of_one_place_is_rejected = rejects(REJECTED)


def test_the_theorem_names_the_zero_only_where_it_is_one() -> None:
    assert "invariant zero" in checked(VELOCITY).statement
    assert "invariant zero" not in checked(TWICE).statement
