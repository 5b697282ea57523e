"""Covering programs: the optimum and its proof, whatever the size of the prices."""

import itertools
import random
from fractions import Fraction

import pytest

from mcexact.analysis.covering import (
    CoveringCut,
    CoveringProgram,
    branch_tree,
    leaf_bound,
    minimize,
)
from mcexact.analysis.sharing import minimal_shared_dimensions
from mcexact.errors import LimitReached
from mcexact.model import gallery
from mcexact.model.graph import NeighborGraph
from tests.wording import refusal

TRIANGLE = tuple(CoveringCut(frozenset(pair), 1) for pair in ((0, 1), (1, 2), (0, 2)))


def enumerated(program: CoveringProgram, most: int) -> tuple[int, ...]:
    """The cheapest point, the lexicographically least of them."""
    points = itertools.product(range(most + 1), repeat=len(program.costs))
    fitting = [
        x
        for x in points
        if all(sum(x[i] for i in cut.support) >= cut.demand for cut in program.cuts)
        and all(u is None or value <= u for value, u in zip(x, program.upper, strict=True))
    ]
    return min(fitting, key=lambda x: (program.cost(x), x))


@pytest.mark.parametrize(
    "unit", [Fraction(1), Fraction(1, 10**8), Fraction(10**9, 7), Fraction(1, 10**400)]
)
def test_the_unit_in_which_prices_are_counted_does_not_matter(unit):
    program = CoveringProgram((2 * unit, 3 * unit, 3 * unit), (None,) * 3, TRIANGLE)
    values = minimize(program)
    assert values == (1, 0, 1)
    tree = branch_tree(program, program.cost(values))
    assert any("multipliers" in node for node in tree)


def test_prices_that_differ_in_the_sixth_digit_are_told_apart():
    rng = random.Random(1)
    for _ in range(30):
        costs = tuple(Fraction(10**6 + rng.randrange(9)) for _ in range(5))
        cuts = tuple(
            CoveringCut(frozenset(rng.sample(range(5), 3)), rng.randint(1, 2)) for _ in range(4)
        )
        program = CoveringProgram(costs, (None,) * 5, cuts)
        values = minimize(program)
        assert values == enumerated(program, 2)
        branch_tree(program, program.cost(values))


def test_upper_bounds_beyond_floats_bound_nothing():
    program = CoveringProgram((Fraction(1),) * 3, (10**400, None, 0), TRIANGLE)
    assert minimize(program) == (1, 1, 0)
    branch_tree(program, Fraction(2))


def test_prices_too_far_apart_for_floating_point_are_a_limit_not_a_bug():
    plant = gallery.load("liu2020-3ch-no-communication")
    ring = NeighborGraph.ring(plant.names)
    with refusal(LimitReached):
        minimal_shared_dimensions(plant, ring, "states", costs=[Fraction(1, 10**12), 1, 10**20])


def test_a_leaf_without_a_finite_bound_proves_nothing():
    program = CoveringProgram((Fraction(1),) * 3, (None,) * 3, TRIANGLE)
    assert leaf_bound(program, (0, 0, 0), (None,) * 3, [(0, Fraction(2))]) is None
