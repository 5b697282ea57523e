"""The least dimensions that agents must share for every value of a parameter."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact import NeighborGraph, check
from mcexact.errors import InputError
from mcexact.parameters import shared_dimensions_for_every_value
from mcexact.sharing import minimal_shared_dimensions
from tests.answer.test_golden import PORTS, with_a_parameter
from tests.oracle.parametric_draws import drawn_parametric

EXAMPLE = with_a_parameter([[1, 0, 0], ["t", 1, 0], [0, 1, 1]], PORTS)


@pytest.mark.parametrize(
    ("share", "dimensions", "refused"), [("outputs+states", (0, 0, 1), 1), ("states", (1, 0, 1), 3)]
)
def test_the_example_needs_what_it_needs_at_0(share: Any, dimensions: Any, refused: int) -> None:
    ring = NeighborGraph.ring(EXAMPLE.names)
    found = shared_dimensions_for_every_value(EXAMPLE, ring, share)
    assert (found.dimensions, len(found.refused)) == (dimensions, refused)
    there = minimal_shared_dimensions(EXAMPLE.at({"t": 0}), ring, share)
    assert there.dimensions == dimensions
    assert not found.spectrum.exceptional
    assert all(each.exceptional for each in found.refused)
    assert all(check(each, EXAMPLE).verdict == "VALID" for each in found.certificates)


@pytest.mark.parametrize("number", (2, 3))
def test_no_value_needs_more(number: int) -> None:
    rng = random.Random(number)
    plant = drawn_parametric(rng)
    graph = NeighborGraph.complete(plant.names)
    found = shared_dimensions_for_every_value(plant, graph)
    for value in (Fraction(0), Fraction(1), Fraction(7, 2)):
        try:
            there = minimal_shared_dimensions(plant.at({"t": value}), graph)
        except InputError:
            continue
        if found.dimensions is not None:
            assert there.feasible and sum(there.dimensions) <= sum(found.dimensions)
        elif found.spectrum.generic:
            assert not there.feasible
