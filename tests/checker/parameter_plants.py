"""Certificates about all values of parameters in a range, followed with a pencil."""

from __future__ import annotations

from typing import Any

from tests.checker.box_maker import control_witness, fixed_witness, in_cells, stable_witness
from tests.checker.box_plants import DUAL, GAIN_RADII, LOOP, gains, programs
from tests.checker.handmade import Document, ranged

FIXED, CONTROLLABLE = "parametric_box_fixed", "parametric_box_controllable"
STABLE = "parametric_box_stable"


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


def stable(
    system: Document,
    cuts: Any,
    points: list[Any],
    *steps: Document,
    growth: Any = None,
    bound: Any = None,
    gain_radii: Any = None,
) -> Document:
    """That every eigenvalue is in a region, with the same points in every cell."""
    claim = {"bound": bound, "gain_radii": gain_radii}
    made = lambda box: stable_witness(box, points, bound, gain_radii, growth)  # noqa: E731
    return in_cells(system, STABLE, claim, cuts, made, *steps)


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
WAYS = ["1/4", "1/2", "3/4", 1, "3/2", 2, 3, 4, 5, 6, 8]
TURNING = ranged([[-1, "t"], ["-t", -1]], ([[1], [0]], [[1, 0]]), t=(-1, 1))
"""The eigenvalues are −1 ± it; with independent entries one could be 0."""
TURNED = stable(TURNING, [0, 0, None, None, 0, None, None], ["1/2", 1, "3/2", 2, 3], growth=[1, 1])
DAMPED = ranged(
    [["-k - 2", "k"], ["k", "-k - 1"]],
    ([["k + 1/2"], [0]], [[1, 0]]),
    ([[0], [1]], [[0, "(1)/(k + 1/2)"]]),
    k=("1/4", "3/4"),
)
"""A damper k between two masses, also in an input and an output."""
LOOP_DAMPED = stable(
    DAMPED, [0, None, None], WAYS, LOOP, growth=[2, 2, 2], bound="1/8", gain_radii=GAIN_RADII
)
LINKS = {"construction": "arcs", "added": [["1", "2"], ["2", "1"]]}
SAMPLED = ranged(
    [["a*b", "1/8*a"], ["1/8*a", "-1/4*b"]],
    ([["a"], [0]], [[1, 0]]),
    ([[0], [1]], [[0, "(1)/(b)"]]),
    time="discrete",
    a=("7/16", "9/16"),
    b=("15/16", "17/16"),
)
SHARING = programs(
    "discrete",
    {
        "shared_update": {},
        "private_update": {"outputs": {"2": [["1/8"]]}, "private": [["1/4"]]},
        "input": {"private": [["1/4"]]},
    },
    {"input": {"outputs": {"1": [["1/8"]], "2": [["1/8"]]}}},
)
CIRCLE = ["1/8", "1/4", "3/8", "1/2", "3/4", 1, "4/3", 2, "8/3", 4, 8]
LOOP_SAMPLED = stable(SAMPLED, [1, None, None], CIRCLE, LINKS, SHARING)
"""Each agent uses the other's output, too."""
SLIDING = ranged([["-k"]], ([[1]], [[1]]), k=("7/4", "9/4"))
PULLED = {
    "name": "1",
    "shared": 0,
    "private": 0,
    "shared_update": {},
    "private_update": {},
    "input": {"outputs": {"1": [[-1]]}},
}
HELD = stable(
    SLIDING,
    [None],
    WAYS,
    {"construction": "integrators"},
    {"construction": "closed_loop", "controller": {"time": "continuous", "agents": [PULLED]}},
    growth=[2, 2],
)
"""x' = −k x − w and w' = x."""
ALL = {
    "tied entries": TIED,
    "two cells": HALVES,
    "stabilizable": STABILIZABLE,
    "two parameters": QUARTERS,
    "a square and a quotient": CURVED,
    "one value": ONE_VALUE,
    "controlled": CONTROLLED,
    "observed": OBSERVED,
    "turning": TURNED,
    "a loop with uncertain gains": LOOP_DAMPED,
    "a loop with links and two parameters": LOOP_SAMPLED,
    "a loop with integrators": HELD,
}
