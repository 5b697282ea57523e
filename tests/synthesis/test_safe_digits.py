"""How many digits of gains are enough: however they are rounded, and rounded to the nearest."""

from __future__ import annotations

from fractions import Fraction

import pytest

from mcexact import MultiChannelSystem, certify_controller, check
from mcexact.analysis.boxes.loops import digit_radii, rounded_ends
from mcexact.designs import local_controllers
from mcexact.synthesis.certify import safe_digits

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
        assert found.rounded is not None and unsafe is not None
        assert not certify_controller(PLANT, found.rounded).stable
        [agent], [given] = found.rounded.agents, controller.agents
        ends = rounded_ends(given.input.outputs[0][0, 0], unsafe)
        assert agent.input.outputs[0][0, 0] in ends


@pytest.mark.parametrize(
    ("entry", "digits", "radius"),
    [
        ("31.4", 2, Fraction(3, 5)),
        ("0.00999", 1, Fraction(99, 10**5)),
        ("-0.00999", 1, Fraction(99, 10**5)),
        ("1000", 3, 0),
        ("-1", 1, 0),
        ("1.2e-30", 1, Fraction(8, 10**31)),
    ],
)
def test_a_digit_is_counted_from_the_first_that_is_not_zero(
    entry: str, digits: int, radius: Fraction
) -> None:
    [agent] = digit_radii(local_controllers(PLANT, [[[entry]]]), digits).agents
    moved = agent.input.outputs.get(0)
    assert (0 if moved is None else moved[0, 0]) == radius
