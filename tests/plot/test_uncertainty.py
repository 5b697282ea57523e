"""The proved part and the part where a plant fails, as two bars and what lies between."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace

import pytest

from mcexact.plot.uncertainty import uncertainty


@pytest.mark.parametrize(
    ("lower", "upper", "bars", "scale"),
    [
        (Fraction(1, 10), Fraction(1, 5), 3, "log"),
        (Fraction(1, 10), None, 1, "linear"),
        (Fraction(0), Fraction(1, 5), 2, "linear"),
        (Fraction(0), None, 0, "linear"),
    ],
)
def test_each_end_that_is_known_is_drawn(
    lower: Fraction, upper: Fraction | None, bars: int, scale: str
) -> None:
    found = SimpleNamespace(lower=lower, upper=upper, relative=True, wanted="no fixed mode")
    [axis] = uncertainty(found).axes
    assert len(axis.patches) == bars and axis.get_xscale() == scale
    if bars == 3:
        known, between, fails = axis.patches
        assert known.get_x() + known.get_width() == pytest.approx(10)
        assert between.get_x() + between.get_width() == pytest.approx(20) == fails.get_x()
