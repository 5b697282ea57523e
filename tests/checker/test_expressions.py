"""Entries with a parameter: the grammar of expressions, and their canonical text."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.reading import Limits, Refused
from mcexact.checker.parametric_system import LONGEST, common_divisor, function, function_text
from mcexact.errors import InputError
from mcexact.model.entries import parse_expression

TEXTS: dict[Any, Any] = {
    "1/2 + 3*t^2": "3*t^2 + 1/2",
    "-t^2": "-t^2",
    "- t^2 - -1": None,
    "2 - 3 - t": "-t - 1",
    "2 - (3 - t)": "t - 1",
    "12/2/3*t": "2*t",
    "0.25*t": "1/4*t",
    "1e-3": "1/1000",
    "-6/4": "-3/2",
    7: 7,
    "(t^2 - 1)/(t - 1)": "t + 1",
    "1/(2 - 2*t)": "(-1/2)/(t - 1)",
    "1/t - 1/t": 0,
    "1/t + 1/(t + 1)": "(2*t + 1)/(t^2 + t)",
    " ( t ) ": "t",
    "(2*t^2 + t - 1)/(2*t^2 - 7*t + 3)": "(t + 1)/(t - 3)",
    "t^0": 1,
    "(1/t)^3": "(1)/(t^3)",
    "0*t": 0,
    "(0*t)^2": 0,
    "t^1000": "t^1000",
    "2*t^1000": "2*t^1000",
    "t^1000*2": "2*t^1000",
    "t^500*t^500": "t^1000",
    "t^500*t^501": None,
    "1/t^500*(1/t^500)": "(1)/(t^1000)",
    "1/t^500*(1/t^501)": None,
    "t^500 + 1/t^500": "(t^1000 + 1)/(t^500)",
    "t^501 + 1/t^500": None,
    "1/t^500 + t^501": None,
    "1/t^500 + 1/(t^500 - 1)": "(2*t^500 - 1)/(t^1000 - t^500)",
    "1/t^501 + 1/(t^500 - 1)": None,
    "1^1000": 1,
    "(1/t)^1000": "(1)/(t^1000)",
    "t^000000001": "t",
    "t^0000000001": None,
    "t" + " " * (LONGEST - 1): "t",
    "": None,
    "   ": None,
    "t t": None,
    "2t": None,
    "t**2": None,
    "2*-t": None,
    "+t": None,
    "t^-1": None,
    "t^": None,
    "t^2^2": None,
    "t^1001": None,
    "1^1001": None,
    "(t^100)^100": None,
    "t^600*t^500": None,
    "1/t^600 + 1/(t + 1)^600": None,
    "t^9999999999": None,
    "1e2*t": None,
    "(t": None,
    "t)": None,
    "u": None,
    "tt": None,
    "1/(t - t)": None,
    "t;": None,
    "t\n": None,
    "٣*t": None,
    "(" * 49 + "t" + ")" * 49: "t",
    "(" * 50 + "t" + ")" * 50: None,
    "(t) - (t) + " + "(" * 49 + "t" + ")" * 49: "t",
    "(t) - (t) + " + "(" * 50 + "t" + ")" * 50: None,
    "t" + " " * LONGEST: None,
    None: None,
    True: None,
}


def read(value: Any) -> Any:
    """What the checker makes of an entry; None where it is malformed."""
    try:
        return function_text(function(value, "A", "t", Limits()), "t")
    except Refused as found:
        assert found.verdict == "MALFORMED", found.message
        return None


@pytest.mark.parametrize("value", TEXTS, ids=lambda value: repr(value)[:24])
def test_an_entry_has_one_canonical_form(value: Any) -> None:
    expected = TEXTS[value]
    assert read(value) == (expected if expected not in ("1/1000", "-3/2") else str(expected))
    if expected is not None:
        assert read(expected) == expected


@pytest.mark.parametrize("value", [v for v in TEXTS if isinstance(v, str)], ids=lambda v: v[:24])
def test_the_package_reads_the_same_entries(value: str) -> None:
    assert read(value) == parsed(value)


def parsed(value: str) -> Any:
    """What the package makes of a text."""
    try:
        entry = parse_expression(value, ("t",))
    except InputError:
        return None
    found = entry.value
    if not entry.is_constant:
        return str(entry)
    return int(found) if found.denominator == 1 else str(found)


TOKENS = ("t", "t", "1", "2", "0.5", "+", "-", "*", "/", "^", "(", ")", " ", "3", "t^2", "u", "^2")


def test_drawn_entries_are_read_alike() -> None:
    rng, good = random.Random(1), 0
    for _ in range(3000):
        value = "".join(rng.choice(TOKENS) for _ in range(rng.randint(1, 9)))
        found = read(value)
        assert found == parsed(value), value
        good += found is not None
    assert good > 200


def test_a_common_divisor_is_monic() -> None:
    f, g = [Fraction(c) for c in (-1, 1, 2)], [Fraction(c) for c in (3, -7, 2)]
    assert common_divisor(f, g) == [Fraction(-1, 2), 1]
    assert common_divisor([], g) == [Fraction(3, 2), Fraction(-7, 2), 1]
    assert common_divisor([Fraction(5)], g) == [1]


@pytest.mark.parametrize(
    ("top", "bottom", "text"),
    [
        ([], [1], 0),
        ([Fraction(1, 2)], [1], "1/2"),
        ([0, 1], [1], "t"),
        ([1], [0, 1], "(1)/(t)"),
        ([0, 2], [-1, 1], "(2*t)/(t - 1)"),
    ],
)
def test_a_function_has_one_text(top: Any, bottom: Any, text: Any) -> None:
    assert function_text(([Fraction(c) for c in top], [Fraction(c) for c in bottom]), "t") == text


@pytest.mark.parametrize("text", ["u", "t t", "(t", "2*", "1/0", "t^", "t$", "t^1001"])
def test_the_place_of_what_is_refused_is_named(text: str) -> None:
    with pytest.raises(Refused) as found:
        function(text, "channels[0].B", "t", Limits())
    assert found.value.place == "channels[0].B"
