"""Branch trees: what they prove of integer programs, and what they only seem to."""

from __future__ import annotations

import itertools
import random
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.reading import Refused
from mcexact.checker.sharing import Program

Cuts = Sequence[tuple[set[int], int]]


def program(costs: Sequence[Any], cuts: Cuts, value: Any) -> Program:
    """A program whose variables are named a, b, c."""
    exact = [Fraction(cost) for cost in costs]
    target = None if value is None else Fraction(value)
    return Program(exact, cuts, "variable", "abc"[: len(costs)], target)


def violated(cut: int) -> dict[str, Any]:
    return {"violated": cut}


def multipliers(*pairs: tuple[int, str]) -> dict[str, Any]:
    weights = ((cut, Fraction(weight)) for cut, weight in pairs)
    return {"multipliers": [[k, int(y) if y.denominator == 1 else str(y)] for k, y in weights]}


def split(variable: str, at_most: int) -> dict[str, Any]:
    return {"variable": variable, "at_most": at_most}


ONE: Cuts = [({0}, 1)]
BOTH: Cuts = [({0, 1}, 2)]
TRIANGLE: Cuts = [({0, 1}, 1), ({1, 2}, 1), ({0, 2}, 1)]
HALVES = [(0, "1/2"), (1, "1/2"), (2, "1/2")]
QUARTERS = [(0, "1/4"), (1, "1/4"), (2, "1/4")]
APART: Cuts = [({0, 1}, 1), ({0}, 5)]
CUT_BELOW = [split("a", 4), violated(1)]

PROVED: list[tuple[str, Program, Any, Any]] = [
    ("nothing costs nothing", program([1], [], 0), [multipliers()], [None]),
    ("a cut at its price", program([1, 1], BOTH, 2), [multipliers((0, "1"))], [None] * 2),
    ("two cuts at once", program([1, 1], [*BOTH, ({0}, 1)], 2), [multipliers((0, "1"))], [9, 9]),
    (
        "an integer above 3/2, where prices are integers",
        program([1, 1, 1], TRIANGLE, 2),
        [multipliers(*HALVES)],
        [None] * 3,
    ),
    (
        "a multiple of 1/2 above 3/4, where prices are halves",
        program(["1/2"] * 3, TRIANGLE, 1),
        [multipliers(*QUARTERS)],
        [None] * 3,
    ),
    ("more than is claimed", program([1], [({0}, 2)], 1), [multipliers((0, "1"))], [None]),
    ("a price left over", program([1], ONE, 1), [multipliers((0, "1/2"))], [None]),
    ("a price overdrawn", program([1], ONE, 1), [multipliers((0, "3"))], [1]),
    ("overdrawn where nothing is allowed", program([1], ONE, 3), [multipliers((0, "3"))], [0]),
    (
        "one branch by a cut, the other by its least value",
        program([1, 1], APART, 5),
        [*CUT_BELOW, multipliers((0, "0"))],
        [None] * 2,
    ),
    (
        "the lower branch comes first",
        program([1, 1], [({0, 1}, 4), ({0}, 1)], 4),
        [split("b", 0), multipliers((0, "1")), multipliers((0, "1"))],
        [None] * 2,
    ),
    (
        "the second variable is split",
        program([1, 1], [({1}, 5)], 5),
        [split("b", 4), violated(0), multipliers()],
        [None] * 2,
    ),
    (
        "what is split twice keeps both bounds",
        program([1, 1], [({0}, 3)], 3),
        [split("a", 1), violated(0), split("a", 2), violated(0), multipliers()],
        [None] * 2,
    ),
    ("more would cost as much", program([2], [({0}, 2)], 3), [violated(0)], [None]),
    ("more would cost as much, and is allowed", program([2], [({0}, 2)], 3), [violated(0)], [9]),
    ("no more is allowed", program([1], [({0}, 2)], 9), [violated(0)], [1]),
    ("no common point", program([1, 1], [({0, 1}, 5)], None), [violated(0)], [1, 3]),
    ("no common point within one cut", program([1, 1], [({0}, 5)], None), [violated(0)], [4, None]),
    (
        "no common point in either branch",
        program([1, 1], [({0, 1}, 5), ({1}, 0)], None),
        [split("a", 1), violated(0), violated(0)],
        [2, 2],
    ),
]

UNPROVED: list[tuple[str, Program, Any, Any]] = [
    ("a value too high", program([1, 1], BOTH, 3), [multipliers((0, "1"))], [None] * 2),
    (
        "rounded up too far",
        program(["1/2", "1/2"], [({0, 1}, 1)], 1),
        [multipliers((0, "1/2"))],
        [None] * 2,
    ),
    ("rounded up by 1", program([1, 1], BOTH, "5/2"), [multipliers((0, "1"))], [None] * 2),
    (
        "a cut taken less than no times",
        program([1, 1], APART, 6),
        [*CUT_BELOW, multipliers((0, "-1"))],
        [None] * 2,
    ),
    (
        "the least value of a branch, and one more",
        program([1, 1], APART, 6),
        [*CUT_BELOW, multipliers((0, "0"))],
        [None] * 2,
    ),
    ("what is left over at its upper bound", program([1], ONE, 2), [multipliers((0, "1/2"))], [3]),
    ("overdrawn, at the lower bound", program([1], ONE, 2), [multipliers((0, "3"))], [1]),
    ("overdrawn where nothing is allowed", program([1], ONE, 5), [multipliers((0, "3"))], [0]),
    ("more costs less", program([2], [({0}, 2)], 5), [violated(0)], [None]),
    ("the bound meets the cut", program([1, 1], [({0, 1}, 5)], None), [violated(0)], [2, 3]),
    ("no bound on one variable", program([1, 1], [({0, 1}, 5)], None), [violated(0)], [1, None]),
    ("no bound at all", program([1], [({0}, 5)], None), [violated(0)], [None]),
    ("another cut", program([1, 1], [({0}, 5), ({1}, 1)], None), [violated(1)], [1, 1]),
    ("a price for what has no point", program([1], ONE, None), [multipliers((0, "1"))], [0]),
    ("no tree", program([1], [], 0), [], [None]),
    ("a branch is missing", program([1, 1], APART, 5), CUT_BELOW, [None] * 2),
    ("a node too many", program([1], ONE, 1), [multipliers((0, "1"))] * 2, [None]),
    (
        "the upper branch comes first",
        program([1, 1], APART, 5),
        [split("a", 4), multipliers((0, "0")), violated(1)],
        [None] * 2,
    ),
    (
        "the bound of another variable",
        program([1, 1], [({0, 1}, 9), ({0}, 5)], 5),
        [split("b", 4), violated(1), multipliers()],
        [None] * 2,
    ),
]

MALFORMED: list[tuple[str, Program, Any, Any]] = [
    ("no such cut", program([1], ONE, 1), [violated(1)], [0]),
    ("no such cut by far", program([1], ONE, 1), [violated(7)], [0]),
    ("a cut before the first", program([1], ONE, 1), [violated(-1)], [0]),
    ("no such cut to multiply", program([1], ONE, 1), [multipliers((1, "1"))], [0]),
    ("no such variable", program([1], ONE, 1), [split("b", 0)], [None]),
    ("a negative bound", program([1], ONE, 1), [split("a", -1)], [None]),
    ("two kinds of leaf at once", program([1], ONE, 1), [violated(0) | multipliers()], [0]),
    ("a leaf with more to it", program([1], ONE, 1), [multipliers() | {"x": 1}], [0]),
    ("not a node", program([1], ONE, 1), [[]], [0]),
    ("no weight", program([1], ONE, 1), [{"multipliers": [[0]]}], [0]),
]


@pytest.mark.parametrize(("reason", "task", "tree", "upper"), PROVED)
def test_a_bound_is_proved(reason: str, task: Program, tree: Any, upper: Any) -> None:
    task.require_bound(tree, upper)


@pytest.mark.parametrize(("reason", "task", "tree", "upper"), UNPROVED)
def test_a_bound_is_not_proved(reason: str, task: Program, tree: Any, upper: Any) -> None:
    with pytest.raises(Refused) as found:
        task.require_bound(tree, upper)
    assert found.value.verdict == "INVALID"


@pytest.mark.parametrize(("reason", "task", "tree", "upper"), MALFORMED)
def test_a_tree_is_malformed(reason: str, task: Program, tree: Any, upper: Any) -> None:
    with pytest.raises(Refused) as found:
        task.require_bound(tree, upper)
    assert found.value.verdict == "MALFORMED"


def drawn_tree(rng: random.Random, width: int, cuts: int, depth: int) -> list[dict[str, Any]]:
    """A tree that is complete, and proves whatever it proves."""
    kind = rng.random()
    if depth and kind < 0.4:
        branches = [drawn_tree(rng, width, cuts, depth - 1) for _ in range(2)]
        return [split("abc"[rng.randrange(width)], rng.randint(0, 2)), *branches[0], *branches[1]]
    if kind < 0.6:
        return [violated(rng.randrange(cuts))]
    pairs = [(rng.randrange(cuts), str(Fraction(rng.randint(0, 4), 2))) for _ in range(2)]
    return [multipliers(*pairs)]


def test_no_drawn_tree_proves_more_than_the_minimum() -> None:
    rng = random.Random(7)
    proved = 0
    for _ in range(4000):
        width = rng.randint(1, 3)
        costs = [Fraction(rng.randint(1, 4), rng.choice([1, 2])) for _ in range(width)]
        cuts = [
            (set(rng.sample(range(width), rng.randint(1, width))), rng.randint(0, 3))
            for _ in range(rng.randint(1, 3))
        ]
        upper = [rng.choice([None, 0, 1, 3]) for _ in range(width)]
        boxes = itertools.product(*(range((3 if u is None else u) + 1) for u in upper))
        fitting = [x for x in boxes if all(sum(x[i] for i in S) >= d for S, d in cuts)]
        least = min(
            (sum(c * k for c, k in zip(costs, x, strict=True)) for x in fitting), default=None
        )
        value = rng.choice([None, *(Fraction(k, 2) for k in range(1, 9))])
        tree = drawn_tree(rng, width, len(cuts), 2)
        try:
            program(costs, cuts, value).require_bound(tree, upper)
        except Refused:
            continue
        proved += 1
        assert least is None or (value is not None and least >= value)
    assert proved > 100
