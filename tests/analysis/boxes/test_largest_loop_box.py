"""The largest box in which a controller keeps all loops stable, and a plant that it fails."""

from __future__ import annotations

from fractions import Fraction

import pytest

from mcexact import MultiChannelSystem, certify_controller, check
from mcexact.boxes import Box, largest_loop_uncertainty
from mcexact.designs import local_controllers

PLANT = MultiChannelSystem([[1]], [[[1]]], [[[1]]])
GAIN = local_controllers(PLANT, [[[-3]]])


def test_both_ends_are_near_the_exact_one() -> None:
    """1 + τ < 3 (1 − τ)² holds up to τ = 1/3, where (1 + τ) = 3 (1 − τ)²."""
    found = largest_loop_uncertainty(PLANT, GAIN, effort=1)
    assert found.proof is not None and found.failing is not None and found.upper is not None
    assert Fraction(3, 10) < found.lower < Fraction(1, 3) <= found.upper + Fraction(1, 10**6)
    assert found.upper < Fraction(35, 100)
    assert check(found.proof, Box.relative(PLANT, found.lower).system).valid
    assert not certify_controller(found.failing, GAIN).stable
    assert Box.relative(PLANT, found.upper).contains(found.failing)
    assert found.refutation is not None and check(found.refutation, found.failing).valid


def test_radii_of_the_gains_make_the_box_smaller() -> None:
    with_gains = largest_loop_uncertainty(PLANT, GAIN, gains=True, effort=1)
    assert Fraction(1, 5) < with_gains.lower < Fraction(26, 100)


def test_loops_in_discrete_time_have_ends_on_the_circle() -> None:
    plant = MultiChannelSystem([["3/2"]], [[[1]]], [[[1]]], time="discrete")
    gain = local_controllers(plant, [[["-5/4"]]])
    found = largest_loop_uncertainty(Box.absolute(plant, A=[[1]]).system, gain, effort=1)
    assert not found.relative and found.upper is not None
    assert Fraction(7, 10) < found.lower < Fraction(3, 4) <= found.upper < Fraction(76, 100)


@pytest.mark.parametrize("rate", [None, "1/2"])
def test_an_unstable_loop_has_no_box(rate: str | None) -> None:
    found = largest_loop_uncertainty(PLANT, local_controllers(PLANT, [[[-1]]]), rate=rate, effort=1)
    assert found.lower == 0 and found.proof is None
    assert found.upper == 0 and found.failing == PLANT and found.refutation is not None


def test_a_plant_that_stands_still_is_not_stable_under_any_gains() -> None:
    """No member with the radii 1 of the entries is nearer: A, and B or C, are 0 there."""
    plant = MultiChannelSystem([[-1]], [[[1]]], [[[1]]])
    found = largest_loop_uncertainty(plant, local_controllers(plant, [[[-3]]]), effort=0.1)
    assert found.upper is not None and found.failing is not None
    assert Fraction(3, 5) < found.lower < found.upper <= 1
    assert not certify_controller(found.failing, GAIN).stable
