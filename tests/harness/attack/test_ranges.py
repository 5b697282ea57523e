"""The oracle about ranges of parameters: known answers, at single values and at ends too."""

from __future__ import annotations

from typing import Any

import pytest

from tests.checker.handmade import certificate
from tests.checker.parameter_plants import CONTROLLABLE, FIXED, ranged
from tests.oracle.certificates.judge import FALSE, TRUE, judge

MILLIONTH = "1/1000000"


def scalar(B: Any, A: Any = 1, low: Any = 0, high: Any = 1, time: str = "continuous") -> Any:
    """One state that a channel measures: what makes B vanish fixes A."""
    return ranged([[A]], ([[B]], [[1]]), time=time, t=(low, high))


def beside(second: str, time: str = "continuous") -> Any:
    """A state that no channel moves, for t from 0 to 1."""
    return ranged([["t", 0], [0, second]], ([[1], [0]], [[1, 0]]), time=time, t=(0, 1))


def together(first: str, second: str, low: Any, high: Any) -> Any:
    """Two states that one channel moves as long as their modes differ."""
    return ranged([[first, 0], [0, second]], ([[1], [1]], [[1, 1]]), t=(low, high))


def turning(high: Any) -> Any:
    """Modes ti and −ti, which no channel moves."""
    return ranged([[0, "t"], ["-t", 0]], ([[0], [0]], [[1, 1]]), time="discrete", t=(0, high))


def two(first: str, second: str) -> Any:
    """What makes both entries vanish fixes the mode 1, for a and b from 1 to 2."""
    ports = ([[first], [1]], [[1, 1]]), ([[second], [0]], [[1, 1]])
    return ranged([[1, 0], [0, 2]], *ports, a=(1, 2), b=(1, 2))


ROWS: dict[str, tuple[Any, Any, str]] = {
    "a value inside": (scalar("t - 3/4"), None, FALSE),
    "an irrational value": (scalar("t^2 - 1/2"), None, FALSE),
    "below an irrational value": (scalar("t^2 - 1/2", high="7/10"), None, TRUE),
    "the first end": (scalar("t"), None, FALSE),
    "the last end": (scalar("t - 1"), None, FALSE),
    "beside the first end": (scalar(f"t + {MILLIONTH}"), None, TRUE),
    "beside the last end": (scalar("t - 1000001/1000000"), None, TRUE),
    "a range of one value": (scalar("t - 1/2", low="1/2", high="1/2"), None, FALSE),
    "no real value": (scalar("t^2 + 1"), None, TRUE),
    "no states": (ranged([], ([], []), t=(0, 1)), None, TRUE),
    "a pole inside": (scalar("(1)/(t - 1/3)"), None, FALSE),
    "an irrational pole": (scalar("(1)/(t^2 - 1/2)"), None, FALSE),
    "poles that are not real": (scalar("(1)/(t^2 + 1)"), None, TRUE),
    "modes that meet inside": (together("t", "-t + 1", 0, 1), None, FALSE),
    "modes that meet before": (together("t", "-t + 1", "51/100", 1), None, TRUE),
    "modes that meet at an irrational value": (together("t^2", "t + 1", 1, 2), None, FALSE),
    # with a region
    "a fixed mode inside of the region": (scalar("t - 3/4", -1), 0, TRUE),
    "a fixed mode outside": (scalar("t - 3/4", 1), 0, FALSE),
    "a fixed mode on the border": (scalar("t - 3/4", "t - 3/4"), 0, FALSE),
    "a mode that is outside elsewhere": (scalar("t - 3/4", "t - 4/5"), 0, TRUE),
    "an irrational value, inside": (scalar("t^2 - 1/2", "t - 3/4"), 0, TRUE),
    "an irrational value, outside": (scalar("t^2 - 1/2", "t - 7/10"), 0, FALSE),
    "an irrational value, on the border": (scalar("t^2 - 1/2", "t^2 - 1/2"), 0, FALSE),
    "modes that meet outside": (together("t^2 - 2", "t - 1", 0, 2), 0, FALSE),
    "modes that meet inside of the region": (together("t^2 - 5", "t - 4", 0, 2), 0, TRUE),
    "and not fast enough": (together("t^2 - 5", "t - 4", 0, 2), "5/2", FALSE),
    "a mode that no gains move": (beside("t - 5/4"), 0, TRUE),
    "it reaches the border at the end": (beside("t - 1"), 0, FALSE),
    "it crosses": (beside("t - 3/4"), 0, FALSE),
    "it is outside between two values": (beside("-t^2 + t - 6/25"), 0, FALSE),
    "it stays inside by little": (beside("-t^2 + t - 251/1000"), 0, TRUE),
    "a radius": (beside("t^2 - 3/2*t", "discrete"), "5/8", TRUE),
    "a radius that is reached": (beside("t^2 - 3/2*t", "discrete"), "9/16", FALSE),
    "a pair of modes at a radius": (turning(1), 1, FALSE),
    "a pair of modes within": (turning("9/10"), 1, TRUE),
    # several parameters
    "two entries that vanish apart": (two("a - b", "a + b"), None, TRUE),
    "entries that vanish together": (two("a + b - 3", "a + b - 3"), None, FALSE),
    "entries that vanish at one point": (two("a - 4/3", "b - 7/5"), None, FALSE),
}  # fmt: skip


@pytest.mark.parametrize("name", ROWS)
def test_every_value_in_a_range_is_decided(name: str) -> None:
    system, bound, expected = ROWS[name]
    assert judge(certificate(FIXED, system, {"bound": bound}, {}))[0] == expected


@pytest.mark.parametrize("name", ROWS)
def test_what_no_gains_from_the_state_move_is_not_controlled(name: str) -> None:
    """What the plants of the table measure does not matter: the same modes are fixed."""
    system, bound, expected = ROWS[name]
    channels = [channel["name"] for channel in system["channels"]]
    claim = {"channels": channels, "bound": bound}
    assert judge(certificate(CONTROLLABLE, system, claim, {}))[0] == expected


def test_channels_that_are_not_named_control_nothing() -> None:
    system = two("a - b", "a + b")
    for channels, expected in ((["1"], FALSE), (["2"], FALSE), (["1", "2"], TRUE), ([], FALSE)):
        claim = {"channels": channels, "bound": None}
        assert judge(certificate(CONTROLLABLE, system, claim, {}))[0] == expected
