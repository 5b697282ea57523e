"""Discs that hold one root each, and the interval for the slowest of them."""

from __future__ import annotations

import math
import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.arithmetic import poly_product
from mcexact.checker.core.reading import Refused
from mcexact.checker.core.roots import Disc, require_rate, root_discs


def disc(re: Any, im: Any, radius: Any) -> dict[str, Any]:
    return {"re": str(re), "im": str(im), "radius": str(radius)}


def refused(p: list[Any], *discs: dict[str, Any]) -> bool:
    """Whether these discs are not proved to hold one root of p each."""
    try:
        root_discs(list(discs), "roots", [Fraction(c) for c in p])
    except Refused as found:
        assert found.verdict == "INVALID"
        return True
    return False


SQUARE = [-1, 0, 1]
CIRCLE = [1, 0, 1]
DOUBLE = [1, -2, 1]

HELD: list[tuple[str, list[int], list[dict[str, Any]]]] = [
    ("no roots", [1], []),
    ("a root itself", [-1, 1], [disc(1, 0, 0)]),
    ("both roots themselves", SQUARE, [disc(-1, 0, 0), disc(1, 0, 0)]),
    ("2 |p / p'| from the center at most", SQUARE, [disc(2, 0, "1.5"), disc(-1, 0, 0)]),
    ("the same beside the axis", CIRCLE, [disc(0, 2, "1.5"), disc(0, -1, 0)]),
    ("discs that nearly meet", SQUARE, [disc(2, 0, "1.5"), disc(-1, 0, "1.49")]),
    ("beside the axis, too", CIRCLE, [disc(0, 2, "1.5"), disc(0, -1, "1.49")]),
]
NOT_HELD: list[tuple[str, list[int], list[dict[str, Any]]]] = [
    ("a center without a root", [-1, 1], [disc(2, 0, 0)]),
    ("less than 2 |p / p'|", SQUARE, [disc(2, 0, "1.49"), disc(-1, 0, 0)]),
    ("less than 2 |p / p'| beside the axis", CIRCLE, [disc(0, 2, "1.49"), disc(0, -1, 0)]),
    ("a center where p' is 0", SQUARE, [disc(0, 0, 9), disc(9, 0, 0)]),
    ("a double root", DOUBLE, [disc(1, 0, 0), disc(1, 0, 0)]),
    ("a negative radius", SQUARE, [disc(2, 0, "-1.5"), disc(-1, 0, 0)]),
    ("a small negative radius", SQUARE, [disc("1.1", 0, "-0.5"), disc(-1, 0, 0)]),
    ("a disc within another", SQUARE, [disc(1, 0, 3), disc(-1, 0, 0)]),
    ("a disc around another", SQUARE, [disc(-1, 0, 0), disc(1, 0, 3)]),
    ("discs that touch", SQUARE, [disc(2, 0, "1.5"), disc(-1, 0, "1.5")]),
    ("discs that touch beside the axis", CIRCLE, [disc(0, 2, "1.5"), disc(0, -1, "1.5")]),
    ("one root twice", SQUARE, [disc(1, 0, 0), disc(1, 0, 0)]),
    ("the last disc meets the first", [0, -1, 0, 1], [disc(k, 0, 0) for k in (-1, 1, -1)]),
]


@pytest.mark.parametrize(("reason", "p", "discs"), HELD)
def test_discs_hold_one_root_each(reason: str, p: list[Any], discs: list[Any]) -> None:
    assert not refused(p, *discs)


@pytest.mark.parametrize(("reason", "p", "discs"), NOT_HELD)
def test_discs_are_not_proved_to_hold_one_root_each(
    reason: str, p: list[Any], discs: list[Any]
) -> None:
    assert refused(p, *discs)


@pytest.mark.parametrize("discs", [[], [disc(1, 0, 0)], [disc(k, 0, 0) for k in (-1, 1, 2)]])
def test_there_are_as_many_discs_as_roots(discs: list[Any]) -> None:
    with pytest.raises(Refused) as found:
        root_discs(discs, "roots", [Fraction(c) for c in SQUARE])
    assert found.value.verdict == "MALFORMED"


def test_the_least_radius_is_that_of_complex_numbers() -> None:
    rng = random.Random(5)
    for _ in range(60):
        roots: list[complex] = []
        while len(roots) < rng.randint(1, 5):
            re, im = rng.randint(-3, 3), rng.choice([0, 0, 1, 2])
            if complex(re, im) not in roots:
                roots += [complex(re, im)] + [complex(re, -im)] * (im > 0)
        p = [Fraction(1)]
        for root in roots:
            if root.imag == 0:
                p = poly_product(p, [Fraction(-int(root.real)), Fraction(1)])
            elif root.imag > 0:
                square = int(root.real**2 + root.imag**2)
                p = poly_product(p, [Fraction(c) for c in (square, -2 * int(root.real), 1)])
        center = roots[0] + complex(rng.choice([-1, 1, 2]), rng.choice([-1, 0, 1])) / 64
        # every number is a multiple of a power of 1/2 and short, so that floats are exact
        value, slope = 0j, 0j
        for c in reversed(p):
            slope = slope * center + value
            value = value * center + int(c)
        least = (len(p) - 1) * abs(value) / abs(slope)
        others = [disc(int(root.real), int(root.imag), 0) for root in roots[1:]]
        above, below = math.ceil(least * 10**6 + 1), math.floor(least * 10**6 - 1)
        for micro, wrong in ((above, False), (below, True)):
            first = disc(center.real, center.imag, f"{micro // 10**6}.{micro % 10**6:06}")
            assert refused([*p], first, *others) == wrong


def exact(*numbers: Any) -> Disc:
    re, im, radius = map(Fraction, numbers)
    return re, im, radius


LEFT = [exact(-3, 1, "1/4"), exact(-1, 2, "1/2")]
"""The largest real part is from −1.5 to −0.5."""
ROUND = [exact(0, 0, 1), exact(3, -4, 1)]
"""The largest modulus is from 4 to 6."""
TWO = [exact(-5, 0, 1), exact(3, 4, 2)]
"""The largest modulus is from 4 to 7."""


@pytest.mark.parametrize(
    ("discs", "time", "lower", "upper", "good"),
    [
        (LEFT, "continuous", "0.5", "1.5", True),
        (LEFT, "continuous", "-9", "9", True),
        (LEFT, "continuous", "0.501", "1.5", False),
        (LEFT, "continuous", "0.5", "1.499", False),
        (LEFT[::-1], "continuous", "0.501", "1.5", False),
        (LEFT[::-1], "continuous", "0.5", "1.499", False),
        ([exact(-2, 0, "1/4")], "continuous", "1.75", "2.25", True),
        ([exact(-2, 0, "1/4")], "continuous", "1.76", "2.25", False),
        ([exact(-2, 0, "1/4")], "continuous", "1.75", "2.24", False),
        (ROUND, "discrete", "3.5", "6.5", True),
        (ROUND, "discrete", "4", "6", True),
        (ROUND, "discrete", "-9", "9", True),
        (ROUND, "discrete", "4.001", "6", False),
        (ROUND, "discrete", "4", "5.999", False),
        (ROUND, "discrete", "4", "-4", False),
        (ROUND[::-1], "discrete", "4.001", "6", False),
        (ROUND[::-1], "discrete", "4", "5.999", False),
        (TWO, "discrete", "4", "7", True),
        (TWO, "discrete", "4.001", "7", False),
        (TWO, "discrete", "4", "6.999", False),
        ([exact(0, 0, 1)], "discrete", "-1", "1", True),
        ([exact(0, 0, 1)], "discrete", "-1", "0.999", False),
        ([exact(0, 0, 1)], "discrete", "-0.999", "1", False),
        ([exact(-4, 0, 1)], "discrete", "3", "5", True),
        ([exact(0, 4, 1)], "discrete", "3", "5", True),
        ([exact(0, 4, 1)], "discrete", "3.001", "5", False),
        ([exact(0, 4, 1)], "discrete", "3", "4.999", False),
    ],
)
def test_an_interval_holds_what_the_discs_allow(
    discs: list[Disc], time: str, lower: str, upper: str, good: bool
) -> None:
    interval = {"lower": lower, "upper": upper}
    if good:
        require_rate(interval, "rate", discs, time)
    else:
        with pytest.raises(Refused) as found:
            require_rate(interval, "rate", discs, time)
        assert found.value.verdict == "INVALID"
