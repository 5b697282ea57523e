"""Quadratic forms that decrease, and the coordinates in which they are given."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Refused
from mcexact.checker.loops import decreasing, require_dominant, transformed
from tests.checker.handmade import matrix


def square(*rows: list[int], denominator: int = 1) -> Matrix:
    return Matrix([list(row) for row in rows], len(rows), denominator)


@pytest.mark.parametrize(
    "S",
    [
        square(),
        square([1]),
        square([1], denominator=9),
        square([2, 1], [1, 2]),
        square([2, -1], [-1, 2]),
        square([4, -2, 1], [0, 1, 0], [3, 3, 7]),
    ],
    ids=str,
)
def test_dominant_matrices(S: Matrix) -> None:
    require_dominant(S, "S")


@pytest.mark.parametrize(
    "S",
    [
        square([0]),
        square([-1]),
        square([1, 1], [0, 1]),
        square([1, 0], [1, 1]),
        square([1, -1], [0, 1]),
        square([-3, 1], [0, 1]),
        square([3, 1], [0, -1]),
        square([3, -2, 1], [0, 1, 0], [0, 0, 1]),
        square([1, 0, 0], [0, 1, 0], [2, 2, 4]),
    ],
    ids=str,
)
def test_matrices_that_are_not_dominant(S: Matrix) -> None:
    with pytest.raises(Refused) as found:
        require_dominant(S, "S")
    assert found.value.verdict == "INVALID"


ONE, UNIT = matrix([1]), matrix([1, 0], [0, 1])
SLOW = square([-1])
SLOWER = square([-9, 0], [0, -9])
CHAIN = square([-1, 1], [0, -1])
HALF = square([1], denominator=2)
SHIFT = square([0, 1], [0, 0])
NOTHING = matrix([0, 0], [0, 0])
LOPSIDED = matrix([9, 1], [0, 9])
WEIGHTED = matrix([2, 0], [0, 1])
LATE = matrix([1, 0], [0, 2])

FORMS: list[tuple[str, Matrix, str, Any, Any, Any, bool]] = [
    ("one state, at rest", SLOW, "continuous", 0, ONE, ONE, True),
    ("nearly its rate", SLOW, "continuous", "99/100", ONE, ONE, True),
    ("its rate", SLOW, "continuous", 1, ONE, ONE, False),
    ("not moving", square([0]), "continuous", 0, ONE, ONE, False),
    ("growing", square([1]), "continuous", 0, ONE, ONE, False),
    ("growing, under a negative form", square([1]), "continuous", 0, matrix([-1]), ONE, True),
    ("two states", CHAIN, "continuous", "1/4", UNIT, UNIT, True),
    ("two states, less slowly", CHAIN, "continuous", "1/2", UNIT, UNIT, False),
    ("other weights", CHAIN, "continuous", 0, WEIGHTED, UNIT, False),
    ("in other units", CHAIN, "continuous", 0, WEIGHTED, matrix([2, 0], [0, 3]), True),
    ("in units in which nothing is left", CHAIN, "continuous", 0, UNIT, NOTHING, False),
    ("a form that is not symmetric", SLOWER, "continuous", 0, LOPSIDED, UNIT, False),
    ("the same, symmetric", SLOWER, "continuous", 0, matrix([9, 1], [1, 9]), UNIT, True),
    ("one half, within the unit disc", HALF, "discrete", 1, ONE, ONE, True),
    ("little more than one half", HALF, "discrete", "51/100", ONE, ONE, True),
    ("one half itself", HALF, "discrete", "1/2", ONE, ONE, False),
    ("a shift", SHIFT, "discrete", 1, UNIT, UNIT, False),
    ("a shift, weighted", SHIFT, "discrete", 1, LATE, UNIT, True),
    ("a shift within 3/4", SHIFT, "discrete", "3/4", LATE, UNIT, True),
    ("a shift within 1/2", SHIFT, "discrete", "1/2", LATE, UNIT, False),
]  # fmt: skip


@pytest.mark.parametrize(("reason", "D", "time", "bound", "P", "R2", "good"), FORMS)
def test_a_form_decreases_or_not(
    reason: str, D: Matrix, time: str, bound: Any, P: Any, R2: Any, good: bool
) -> None:
    evidence = {"P": P, "R2": R2}
    if good:
        found = decreasing(evidence, "form", D, time, Fraction(bound))
        assert found.rows == P["entries"]
    else:
        with pytest.raises(Refused) as refused:
            decreasing(evidence, "form", D, time, Fraction(bound))
        assert refused.value.verdict == "INVALID"


COMPANION = square([0, 1], [-2, -3])
EIGENVECTORS: dict[str, Any] = {
    "T": matrix([1, 1], [-1, -2]),
    "Delta": matrix([-1, 0], [0, -2]),
    "modulus": 7,
}


@pytest.mark.parametrize(
    ("reason", "changes", "verdict"),
    [
        ("eigenvectors", {}, "VALID"),
        ("another modulus", {"modulus": 2}, "VALID"),
        ("a composite modulus", {"modulus": 6}, "VALID"),
        ("longer eigenvectors", {"T": matrix([3, 2], [-3, -4])}, "VALID"),
        (
            "eigenvectors over a denominator",
            {"T": matrix([1, 1], [-1, -2], denominator=3)},
            "VALID",
        ),
        ("eigenvectors in another order", {"T": matrix([1, 1], [-2, -1])}, "INVALID"),
        ("another diagonal", {"Delta": matrix([-1, 0], [0, -3])}, "INVALID"),
        ("one vector twice", {"T": matrix([1, 1], [-1, -1])}, "INVALID"),
        ("no vectors", {"T": matrix([0, 0], [0, 0])}, "INVALID"),
        ("singular modulo ℓ", {"T": matrix([7, 1], [-7, -2])}, "INVALID"),
        ("modulus 1", {"modulus": 1}, "INVALID"),
        ("one vector", {"T": matrix([1], [-1])}, "MALFORMED"),
        ("a short diagonal", {"Delta": matrix([-1])}, "MALFORMED"),
    ],
)
def test_a_transformation_keeps_what_the_loop_does(
    reason: str, changes: dict[str, Any], verdict: str
) -> None:
    if verdict == "VALID":
        found = transformed({**EIGENVECTORS, **changes}, COMPANION)
        assert found.rows == EIGENVECTORS["Delta"]["entries"]
    else:
        with pytest.raises(Refused) as refused:
            transformed({**EIGENVECTORS, **changes}, COMPANION)
        assert refused.value.verdict == verdict
