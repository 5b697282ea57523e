"""How many digits of gains are enough: however they are rounded, and rounded to the nearest."""

from __future__ import annotations

from fractions import Fraction

import pytest

from mcexact import MultiChannelSystem, certify_controller, check, local_controllers
from mcexact.analysis.boxes.box_stable import digit_radii
from mcexact.synthesis.safe_digits import safe_digits

PLANT = MultiChannelSystem([[1]], [[[1]]], [[[1]]])


@pytest.mark.parametrize(
    ("gain", "safe", "unsafe"),
    [("-3.04", 1, None), ("-1.04", 3, 2), ("-1.4", 2, 1), ("-1.0004", None, 4)],
)
def test_digits_are_safe_or_too_few(gain: str, safe: int | None, unsafe: int | None) -> None:
    controller = local_controllers(PLANT, [[[gain]]])
    found = safe_digits(PLANT, controller, most=4)
    assert (found.safe, found.unsafe) == (safe, unsafe)
    if found.proof is not None:
        assert check(found.proof, PLANT).valid
    if found.refutation is not None:
        assert not found.refutation.stable
        assert not certify_controller(PLANT, controller, round_gains=unsafe).stable


@pytest.mark.parametrize(
    ("entry", "digits", "radius"),
    [
        ("31.4", 2, Fraction(1, 2)),
        ("0.00999", 1, Fraction(1, 2000)),
        ("1000", 3, 5),
        ("-1", 1, Fraction(1, 2)),
        ("1e-30", 2, Fraction(1, 2 * 10**31)),
    ],
)
def test_a_digit_is_counted_from_the_first_that_is_not_zero(
    entry: str, digits: int, radius: Fraction
) -> None:
    [agent] = digit_radii(local_controllers(PLANT, [[[entry]]]), digits).agents
    assert agent.input.outputs[0][0, 0] == radius
