"""The proved part and the part where a plant fails, as two bars and what lies between."""

from __future__ import annotations

from fractions import Fraction
from types import SimpleNamespace

import pytest

from mcexact.errors import UsageError
from mcexact.plot.parameters import uncertainty, uncertainty_shares
from tests.wording import refusal


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


def _ends(lower: str, upper: str | None, wanted: str = "no fixed mode") -> SimpleNamespace:
    above = None if upper is None else Fraction(upper)
    return SimpleNamespace(lower=Fraction(lower), upper=above, relative=True, wanted=wanted)


def test_shares_are_those_of_plants_that_are_proved_or_fail_within_a_part() -> None:
    found = [_ends("1/100", "1/10"), _ends("1/50", None), _ends("0", "0"), _ends("0", "1/50")]
    [axis] = uncertainty_shares(found).axes
    proved, between, fails = (patch.get_data() for patch in axis.patches)
    assert proved.edges[1:-1] == pytest.approx([1, 2, 10])
    assert list(proved.values) == [50, 25, 0, 0]
    assert list(between.baseline) == list(proved.values)
    assert list(between.values) == list(fails.baseline) == [75, 75, 50, 25]
    assert list(fails.values) == [100] * 4


@pytest.mark.parametrize("found", [[], [_ends("0", "1"), _ends("0", "1", "controllable")]])
def test_shares_are_those_of_one_property(found: list[SimpleNamespace]) -> None:
    with refusal(UsageError):
        uncertainty_shares(found)


def test_bars_end_on_the_safe_side_of_what_is_known() -> None:
    lower, upper = Fraction(2, 3), Fraction(4, 5) + Fraction(1, 10**30)
    found = SimpleNamespace(lower=lower, upper=upper, relative=True, wanted="no fixed mode")
    known, _, fails = uncertainty(found).axes[0].patches
    assert Fraction(known.get_x()) + Fraction(known.get_width()) <= 100 * lower + Fraction(
        1, 10**12
    )
    assert Fraction(fails.get_x()) >= 100 * upper
