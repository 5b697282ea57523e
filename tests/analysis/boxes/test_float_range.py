"""Entries beyond floating point end a search with a reason, and leave other questions alone."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from mcexact import MultiChannelSystem, analyze
from mcexact.boxes import (
    Box,
    box_controllability,
    box_fixed_modes,
    box_observability,
    box_stability,
    box_stabilizability,
    largest_uncertainty,
)
from mcexact.designs import local_controllers
from mcexact.errors import InputError, LimitReached
from tests.wording import refusal, says

ASKED: list[Callable[[MultiChannelSystem], Any]] = [
    box_fixed_modes,
    box_stabilizability,
    box_controllability,
    box_observability,
    lambda plant: largest_uncertainty(plant, effort=1),
    lambda plant: box_stability(plant, local_controllers(plant, [[[-3]]])),
]


def near(A: str, B: str) -> MultiChannelSystem:
    """All plants within 10 % of x' = A x + B u, y = x."""
    return Box.relative(MultiChannelSystem([[A]], [[[B]]], [[[1]]]), "1/10").system


@pytest.mark.parametrize("ask", ASKED)
@pytest.mark.parametrize(("A", "B"), [("1e300", "1e-300"), ("1e1000", "1"), ("1", "1e-1000")])
def test_entries_beyond_floating_point_are_a_limit(
    ask: Callable[[MultiChannelSystem], Any], A: str, B: str
) -> None:
    with refusal(LimitReached, quantity="1e60 or below 1e-60"):
        ask(near(A, B))


@pytest.mark.parametrize("ask", ASKED[:4])
@pytest.mark.parametrize(("A", "B"), [("1e60", "1e-60"), ("1e-60", "1e60"), ("1e60", "1e60")])
def test_entries_within_are_decided_or_left_open(
    ask: Callable[[MultiChannelSystem], Any], A: str, B: str
) -> None:
    try:
        found = ask(near(A, B))
    except LimitReached as error:
        assert says(str(error), "proof found")
    else:
        assert found.explain().startswith("within the radii")


def test_what_needs_no_floating_point_is_answered_all_the_same() -> None:
    found = analyze(near("1e300", "1e-300"))
    assert found.fixed_spectrum.empty
    with pytest.raises(LimitReached, match="choose other units"):
        _ = found.box_fixed_modes


def test_radii_of_gains_are_not_negative() -> None:
    plant = near("1", "1")
    gains = local_controllers(plant, [[[-3]]])
    for radii in (-1, local_controllers(plant, [[["-1/10"]]])):
        with refusal(InputError, where="gains"):
            box_stability(plant, gains, gains=radii)
