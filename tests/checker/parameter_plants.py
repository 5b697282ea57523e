"""Certificates about all values of parameters in a range, followed with a pencil."""

from __future__ import annotations

from typing import Any

from tests.checker.box_maker import control_witness, fixed_witness, in_cells
from tests.checker.box_plants import DUAL, gains
from tests.checker.handmade import Document, ranged

FIXED, CONTROLLABLE = "parametric_box_fixed", "parametric_box_controllable"


def fixed(system: Document, cuts: Any, given: Any, *steps: Document, bound: Any = None) -> Document:
    """That no mode is fixed, with these gains in every cell."""
    return in_cells(
        system, FIXED, {"bound": bound}, cuts, lambda box: fixed_witness(box, given, bound), *steps
    )


def controllable(system: Document, cuts: Any, channels: Any, *steps: Document) -> Document:
    """That channels control every mode."""
    claim = {"channels": channels, "bound": None}
    made = lambda box: control_witness(box, channels, None)  # noqa: E731
    return in_cells(system, CONTROLLABLE, claim, cuts, made, *steps)


SPRING = ranged(
    [["-k", "k"], ["k", "-k"]], ([[1], [0]], [[1, 0]]), ([[0], [1]], [[0, 1]]), k=("1/4", "3/4")
)
"""Two masses on a damper k: the mode 0 belongs to their sum, whatever k is."""
PRODUCT = ranged(
    [["a*b", "1/16*a"], ["1/16*a", "-a*b"]],
    ([["a"], [0]], [[1, 0]]),
    ([[0], [1]], [[0, "(1)/(b)"]]),
    time="discrete",
    a=("19/20", "21/20"),
    b=("39/40", "41/40"),
)
"""Two parameters, in products and in a denominator."""
SQUARE = ranged([["t^2", 0], [0, -1]], ([[1], [1]], [["(1)/(t + 2)", 0]]), t=(0, 1))
"""One parameter, of second order, and in a denominator that is a sum."""
POINT = ranged([["t"]], ([[1]], [[1]]), t=("1/2", "1/2"))

TIED = fixed(SPRING, [None], [gains((2, 1), (2, 1))])
HALVES = fixed(SPRING, [0, None, None], [gains((2, 1), (2, 1))])
STABILIZABLE = fixed(SPRING, [None], [gains((2, 1), (2, 1))], bound=0)
QUARTERS = fixed(PRODUCT, [1, 0, None, None, None], [gains((3, 1), (3, 1))])
CURVED = fixed(SQUARE, [0, 0, None, None, None], [gains((4, 1))], bound=0)
ONE_VALUE = fixed(POINT, [None], [gains((2, 1))])
CONTROLLED = controllable(SPRING, [None], ["1", "2"])
OBSERVED = controllable(PRODUCT, [0, None, None], ["1", "2"], DUAL)
ALL = {
    "tied entries": TIED,
    "two cells": HALVES,
    "stabilizable": STABILIZABLE,
    "two parameters": QUARTERS,
    "a square and a quotient": CURVED,
    "one value": ONE_VALUE,
    "controlled": CONTROLLED,
    "observed": OBSERVED,
}
