"""Regions, and the absence of fixed modes beyond them."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.reading import Refused
from mcexact.checker.core.system import System, read_plant
from mcexact.checker.modes import (
    claimed_cost,
    read_rate_or_radius,
    require_fixed_modes_inside,
    require_outside,
)
from tests.checker.handmade import CHAIN, PAIR, changed, matrix, plant

CONTINUOUS = read_plant(PAIR)
DISCRETE = read_plant(changed(PAIR, ("time", "discrete")))


@pytest.mark.parametrize(
    ("system", "value", "bound"),
    [
        (CONTINUOUS, None, None),
        (CONTINUOUS, 0, 0),
        (CONTINUOUS, 7, 7),
        (CONTINUOUS, "1/3", Fraction(1, 3)),
        (DISCRETE, None, None),
        (DISCRETE, 1, 1),
        (DISCRETE, "1/3", Fraction(1, 3)),
    ],
)
def test_a_bound_is_a_rate_or_a_radius(system: System, value: Any, bound: Any) -> None:
    assert read_rate_or_radius(value, system) == bound


@pytest.mark.parametrize(
    ("system", "value"),
    [(CONTINUOUS, -1), (CONTINUOUS, "-1/9"), (DISCRETE, 0), (DISCRETE, -1), (DISCRETE, "10/9")],
)
def test_no_other_number_is_a_bound(system: System, value: Any) -> None:
    with pytest.raises(Refused) as found:
        read_rate_or_radius(value, system)
    assert found.value.verdict == "INVALID"


def exact(*coefficients: Any) -> list[Fraction]:
    return [Fraction(c) for c in coefficients]


@pytest.mark.parametrize(
    ("system", "p", "bound", "outside"),
    [
        (CONTINUOUS, exact(-2, 1), 0, True),
        (CONTINUOUS, exact(0, 1), 0, True),
        (CONTINUOUS, exact(2, 1), 0, False),
        (CONTINUOUS, exact(2, 1), 2, True),
        (CONTINUOUS, exact(2, 1), None, True),
        (CONTINUOUS, exact(2, 3, 1), "3/2", True),
        (CONTINUOUS, exact(2, 3, 1), "1/2", False),
        (DISCRETE, exact("1/2", 1), 1, False),
        (DISCRETE, exact("1/2", 1), "1/2", True),
    ],
)
def test_a_polynomial_has_a_root_outside_or_not(
    system: System, p: list[Fraction], bound: Any, outside: bool
) -> None:
    limit = None if bound is None else Fraction(bound)
    if outside:
        require_outside(p, system, limit, "p")
    else:
        with pytest.raises(Refused) as found:
            require_outside(p, system, limit, "p")
        assert found.value.verdict == "INVALID"


def test_a_cost_is_claimed_with_an_answer_or_neither_is() -> None:
    some = {"feasible": True, "added": [], "cost": "1/2"}
    none = {"feasible": False, "added": None, "cost": None}
    assert claimed_cost(some, "added", {}) == Fraction(1, 2)
    assert claimed_cost(none, "added", None) is None
    refused: list[tuple[dict[str, Any], Any]] = [
        ({**none, "added": []}, None),
        ({**none, "cost": 0}, None),
        (none, {}),
        ({**some, "feasible": False}, {}),
        ({**some, "cost": None}, {}),
        ({**some, "feasible": 1}, {}),
    ]
    for claim, absence in refused:
        with pytest.raises(Refused):
            claimed_cost(claim, "added", absence)


SLOW = read_plant(plant([[1, 0], [0, -2]], ([[1], [0]], [[1, 0]])))
"""−2 is fixed."""
TWICE = read_plant(plant([[1, 0, 0], [0, -2, 0], [0, 0, -2]], ([[1], [0], [0]], [[1, 0, 0]])))
"""−2 is fixed, twice."""
LINKED = read_plant(CHAIN)
RING = read_plant(changed(CHAIN, ("A", [[0, 1], [1, 0]])))


def absence(gains: list[Any], *allowed: Any, arcs: Any = None, modulus: int = 101) -> Any:
    return {"gains": gains, "modulus": modulus, "allowed": list(allowed), "arcs": arcs}


MINUS_TWO = [[2, 1], 1]
MINUS_TWO_TWICE = [[2, 1], 2]
EDGES = [["1", "2", 1], ["2", "1", 1]]
GAIN = [matrix([1])]
ONE_AND_TWO = [matrix([1]), matrix([2])]
TWO_GAINS = [matrix([1]), matrix([1])]

ABSENT: list[tuple[str, System, Any, Any, bool]] = [
    ("the mode −2, beyond no rate", SLOW, absence(GAIN, MINUS_TWO), 1, False),
    ("another gain", SLOW, absence([matrix([5])], MINUS_TWO), 1, False),
    ("another modulus", SLOW, absence(GAIN, MINUS_TWO, modulus=7), 1, False),
    ("the mode −2, twice", TWICE, absence(GAIN, MINUS_TWO_TWICE), 1, False),
    ("both as one factor", TWICE, absence(GAIN, [[4, 4, 1], 1]), 1, False),
    ("no mode at all", LINKED, absence(TWO_GAINS), None, False),
    ("no mode, and connected", RING, absence(ONE_AND_TWO, arcs=EDGES), None, True),
]  # fmt: skip
PRESENT: list[tuple[str, System, Any, Any, bool]] = [
    ("the mode −2, at its rate", SLOW, absence(GAIN, MINUS_TWO), 2, False),
    ("the mode −2, with no bound", SLOW, absence(GAIN, MINUS_TWO), None, False),
    ("a mode that is not mentioned", SLOW, absence(GAIN), 1, False),
    ("a mode that is mentioned once", TWICE, absence(GAIN, MINUS_TWO), 1, False),
    ("a mode that is mentioned too often", SLOW, absence(GAIN, MINUS_TWO_TWICE), 1, False),
    ("a mode that is not there", SLOW, absence(GAIN, MINUS_TWO, [[3, 1], 1]), 1, False),
    ("the unstable mode excused", SLOW, absence(GAIN, [[-1, 1], 1], MINUS_TWO), 1, False),
    ("no gains", SLOW, absence([matrix([0])], MINUS_TWO), 1, False),
    ("edges that are not asked for", RING, absence(TWO_GAINS, arcs=EDGES), None, False),
    ("edges that are missing", RING, absence(TWO_GAINS), None, True),
    ("one edge", RING, absence(TWO_GAINS, arcs=EDGES[:1]), None, True),
    ("an edge that is not there", LINKED, absence(TWO_GAINS, arcs=EDGES), None, True),
    ("modulus 1", SLOW, absence(GAIN, MINUS_TWO, modulus=1), 1, False),
]  # fmt: skip
MALFORMED: list[tuple[str, Any]] = [
    ("an exponent of 0", absence(GAIN, [[2, 1], 0])),
    ("a factor of degree 0", absence(GAIN, [[1], 1], MINUS_TWO)),
    ("a factor without exponent", absence(GAIN, [[2, 1]])),
    ("no gains", absence([], MINUS_TWO)),
    ("a key too many", absence(GAIN, MINUS_TWO) | {"roots": []}),
]


@pytest.mark.parametrize(("reason", "system", "value", "bound", "connected"), ABSENT)
def test_every_fixed_mode_lies_in_the_region(
    reason: str, system: System, value: Any, bound: Any, connected: bool
) -> None:
    limit = None if bound is None else Fraction(bound)
    require_fixed_modes_inside(value, system, limit, connected=connected)


@pytest.mark.parametrize(("reason", "system", "value", "bound", "connected"), PRESENT)
def test_a_fixed_mode_may_lie_beyond_the_region(
    reason: str, system: System, value: Any, bound: Any, connected: bool
) -> None:
    limit = None if bound is None else Fraction(bound)
    with pytest.raises(Refused) as found:
        require_fixed_modes_inside(value, system, limit, connected=connected)
    assert found.value.verdict == "INVALID"


@pytest.mark.parametrize(("reason", "value"), MALFORMED)
def test_absence_has_one_form(reason: str, value: Any) -> None:
    with pytest.raises(Refused) as found:
        require_fixed_modes_inside(value, SLOW, Fraction(1))
    assert found.value.verdict == "MALFORMED"
