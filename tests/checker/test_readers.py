"""Every reader of a value by itself: what it takes, what it gives, and what it refuses."""

from __future__ import annotations

import io
from collections.abc import Callable
from fractions import Fraction
from functools import partial
from typing import Any

import pytest

from mcexact.checker.core import reading
from mcexact.checker.core.arithmetic import Matrix
from mcexact.checker.core.reading import Limits, Refused


def verdict_of(call: Callable[[], Any]) -> str:
    """The verdict with which a reader refuses, or "" if it does not."""
    try:
        call()
    except Refused as found:
        return found.verdict
    return ""


INTEGERS = [(0, 0), (7, 7), (-3, None), ("7", None), (7.0, None), (True, None), (None, None)]
BOOLEANS = [(True, True), (False, False), (1, None), (0, None), ("true", None), (None, None)]
RATIONALS = [
    (0, Fraction(0)),
    (-7, Fraction(-7)),
    ("1/2", Fraction(1, 2)),
    ("-3/2", Fraction(-3, 2)),
    ("10/21", Fraction(10, 21)),
    *((text, None) for text in ("1/1", "7", "2/4", "0/2", "1/0", "1/-2", "+1/2", "1/02", "01/2")),
    *((text, None) for text in ("1/2 ", "1 /2", "a/b", "", "1/2/3", "0.5", "\u0661/2", "1/2\n")),
    *((other, None) for other in (0.5, True, None, [1, 2], {})),
]
DECIMALS = [
    ("0", Fraction(0)),
    ("-1.25", Fraction(-5, 4)),
    ("10.50", Fraction(21, 2)),
    ("-0", Fraction(0)),
    *(
        (text, None)
        for text in ("1e3", "01", ".5", "5.", "+1", "1/2", "", " 1", "1\n", "--1", "\u0661")
    ),
    *((other, None) for other in (1, 1.5, True, None, [])),
]


@pytest.mark.parametrize(
    ("reader", "value", "expected"),
    [
        *((reading.integer, *row) for row in INTEGERS),
        *((reading.boolean, *row) for row in BOOLEANS),
        *((reading.rational, *row) for row in RATIONALS),
        *((reading.decimal, *row) for row in DECIMALS),
    ],
)
def test_a_value_has_one_form(reader: Any, value: Any, expected: Any) -> None:
    if expected is None:
        assert verdict_of(lambda: reader(value, "here")) == "MALFORMED"
    else:
        found = reader(value, "here")
        assert found == expected
        assert type(found) is type(expected)


@pytest.mark.parametrize(("value", "least"), [(5, 5), (6, 5), (-3, -3), (1, 1), (0, 0)])
def test_an_integer_may_be_the_least(value: int, least: int) -> None:
    assert reading.integer(value, "here", least) == value
    assert verdict_of(lambda: reading.integer(least - 1, "here", least)) == "MALFORMED"


def test_a_string_may_be_one_of_some() -> None:
    assert reading.string("a", "here") == "a"
    assert reading.string("", "here") == ""
    assert reading.string("b", "here", "a", "b") == "b"
    for value, *choices in (("c", "a", "b"), ("", "a"), (1,), (None, "None"), (["a"], "a")):
        call = lambda value=value, choices=choices: reading.string(value, "here", *choices)  # noqa: E731
        assert verdict_of(call) == "MALFORMED"


def test_an_object_has_its_keys_and_no_others() -> None:
    assert reading.fields({"b": 2, "a": 1}, "here", "a", "b") == [1, 2]
    assert reading.fields({}, "here") == []
    assert reading.fields({"a": None}, "here", "a") == [None]
    assert reading.fields({"a": 1}, "here", "a", optional=("b", "c")) == [1, None, None]
    assert reading.fields({"a": 1, "c": 3}, "here", "a", optional=("b", "c")) == [1, None, 3]
    value: Any
    for value in ({}, {"a": 1}, {"b": 1}, {"a": 1, "b": 2, "c": 3}, {"a": 1, "B": 2}, [1, 2], None):
        assert verdict_of(partial(reading.fields, value, "here", "a", "b")) == "MALFORMED"
    for value in ({"b": None}, {"c": 1}, [], None):
        call = partial(reading.fields, value, "here", optional=("b",))
        assert verdict_of(call) == "MALFORMED"


def test_a_list_may_have_a_length() -> None:
    assert reading.items([1, "a"], "here") == reading.items([1, "a"], "here", 2) == [1, "a"]
    assert reading.items([], "here") == reading.items([], "here", 0) == []
    for value, length in (
        ([1], 0),
        ([1], 2),
        ([], 1),
        ((1,), None),
        ("a", None),
        ({}, None),
        (None, 0),
    ):
        call = lambda value=value, length=length: reading.items(value, "here", length)  # noqa: E731
        assert verdict_of(call) == "MALFORMED"


@pytest.mark.parametrize(
    ("value", "least", "good"),
    [
        ([1], 0, True),
        (["1/2", 0, 1], 0, True),
        ([5, 1], 1, True),
        ([5, 4, 1], 2, True),
        ([], 0, False),
        ([1], 1, False),
        ([5, 1], 2, False),
        ([5, 2], 0, False),
        ([5, 1, 0], 0, False),
        ([5, "1"], 0, False),
        ([5.0, 1], 0, False),
        ("1", 0, False),
    ],
)
def test_a_polynomial_is_monic_and_has_some_degree(value: Any, least: int, good: bool) -> None:
    if good:
        assert reading.polynomial(value, "here", least) == [Fraction(c) for c in value]
    else:
        assert verdict_of(lambda: reading.polynomial(value, "here", least)) == "MALFORMED"


def entries(rows: Any, denominator: Any = 1) -> Any:
    return {"denominator": denominator, "entries": rows}


@pytest.mark.parametrize(
    ("value", "nrows", "ncols", "good"),
    [
        (entries([[1, -2], [3, 4]]), 2, 2, True),
        (entries([[1, 2, 3]], 7), 1, 3, True),
        (entries([]), 0, 3, True),
        (entries([[], []]), 2, 0, True),
        (entries([[1, 2]]), 2, 2, False),
        (entries([[1], [2]]), 2, 2, False),
        (entries([[1, 2], [3]]), 2, 2, False),
        (entries([[1, 2], [3, 4], [5, 6]]), 2, 2, False),
        (entries([[1, "2"]]), 1, 2, False),
        (entries([["1", 2]]), 1, 2, False),
        (entries([[True, 2]]), 1, 2, False),
        (entries([[1, 2.0]]), 1, 2, False),
        (entries([1, 2]), 2, 1, False),
        (entries([[1]], 0), 1, 1, False),
        (entries([[1]], -1), 1, 1, False),
        (entries([[1]], "1"), 1, 1, False),
        ([[1]], 1, 1, False),
    ],
)
def test_a_matrix_has_integers_over_a_denominator(
    value: Any, nrows: int, ncols: int, good: bool
) -> None:
    if good:
        expected = Matrix(value["entries"], ncols, value["denominator"])
        assert reading.matrix(value, "here", nrows, ncols) == expected
        assert reading.matrices([value] * 2, "here", [(nrows, ncols)] * 2) == [expected] * 2
    else:
        assert verdict_of(lambda: reading.matrix(value, "here", nrows, ncols)) == "MALFORMED"
    for count in (0, 1, 3):
        call = lambda count=count: reading.matrices([value] * count, "here", [(nrows, ncols)] * 2)  # noqa: E731
        assert verdict_of(call) == "MALFORMED"


def layers(*parts: Any, denominator: Any = 1) -> Any:
    return {"denominator": denominator, "coefficients": list(parts)}


@pytest.mark.parametrize(
    ("value", "degree", "good"),
    [
        (layers([[1, 2]]), 1, True),
        (layers([[1, 2]], [[3, 4]], denominator=5), 2, True),
        (layers([[1, 2]]), 3, True),
        (layers(), 1, False),
        (layers([[1, 2]], [[3, 4]]), 1, False),
        (layers([[1]]), 1, False),
        (layers([[1, 2], [3, 4]]), 1, False),
        (layers([[1, 2]], [[3]]), 2, False),
        (layers([[1, 2]], denominator=0), 1, False),
    ],
)
def test_a_polynomial_matrix_is_reduced(value: Any, degree: int, good: bool) -> None:
    if good:
        found = reading.polynomial_matrix(value, "here", 1, 2, degree)
        given = [Matrix(rows, 2, value["denominator"]) for rows in value["coefficients"]]
        assert found[: len(given)] == given
        assert len(found) == degree
        assert all(layer.is_zero() for layer in found[len(given) :])
        assert all((layer.nrows, layer.ncols) == (1, 2) for layer in found)
    else:
        call = lambda: reading.polynomial_matrix(value, "here", 1, 2, degree)  # noqa: E731
        assert verdict_of(call) == "MALFORMED"


def test_positions_increase_below_a_bound() -> None:
    value: Any
    for value in ([], [0], [2], [0, 1, 2], [0, 2]):
        assert reading.positions(value, "here", 3) == value
    for value in ([3], [0, 3], [-1], [1, 0], [1, 1], [0, 0, 1], ["0"], [True], None, 0):
        assert verdict_of(partial(reading.positions, value, "here", 3)) == "MALFORMED"


def test_names_are_known_and_in_order() -> None:
    known = ["b", "a", "c"]
    value: Any
    for value, expected in (([], []), (["a"], [1]), (["b", "c"], [0, 2]), (known, [0, 1, 2])):
        assert reading.names(value, "here", known) == expected
    for value in (["d"], ["a", "b"], ["a", "a"], ["b", "b", "c"], [0], [["a"]], [None], "a", None):
        assert verdict_of(partial(reading.names, value, "here", known)) == "MALFORMED"


LIMITS = Limits(bytes=40, depth=3, digits=5)


@pytest.mark.parametrize(
    ("text", "verdict"),
    [
        (b'{"a": [1, {}], "b": null}', ""),
        (b"99999", ""),
        (b'"99999/88888"', ""),
        (b"[[[]]]", ""),
        (b'"[[[[["', ""),
        (b'"\\"[[[["', ""),
        (b" " * 38 + b"[]", ""),
        (b" " * 39 + b"[]", "INCOMPLETE"),
        (b"999990", "INCOMPLETE"),
        (b'"1/999990"', "INCOMPLETE"),
        (rb'"\u0031\u0031\u0031\u0031\u0031\u0031"', "INCOMPLETE"),
        (b"[[[[]]]]", "MALFORMED"),
        (b'{"a": {"b": {"c": {}}}}', "MALFORMED"),
        (b'{"a": 1, "a": 1}', "MALFORMED"),
        (b"1.5", "MALFORMED"),
        (b"1e3", "MALFORMED"),
        (b"NaN", "MALFORMED"),
        (b"[Infinity]", "MALFORMED"),
        (b"-Infinity", "MALFORMED"),
        (b'"\xff"', "MALFORMED"),
        (b"", "MALFORMED"),
        (b"[1,]", "MALFORMED"),
        (b"[1] 2", "MALFORMED"),
        (b"{1: 2}", "MALFORMED"),
        (b"'a'", "MALFORMED"),
    ],
)
def test_a_text_is_parsed_within_limits(text: bytes, verdict: str) -> None:
    assert verdict_of(lambda: reading.parse(text, LIMITS)) == verdict


def test_a_number_with_a_point_is_read_where_that_is_allowed() -> None:
    found = reading.parse(b"[1, 1.5, -2e1]", LIMITS, Fraction)
    assert found == [1, Fraction(3, 2), -20]
    assert verdict_of(lambda: reading.parse(b"NaN", LIMITS, Fraction)) == "MALFORMED"


def test_a_stream_is_read_to_one_byte_beyond_the_limit() -> None:
    class Drops(io.BytesIO):
        """A stream that gives two bytes at a time."""

        def read(self, size: int | None = -1) -> bytes:
            return super().read(min(2, 2 if size is None else size))

    for length in (0, 1, 2, 39, 40, 41, 42, 99):
        data = bytes(range(length))
        for stream in (io.BytesIO(data), Drops(data)):
            assert reading.read_bytes(stream, LIMITS) == data[:41]


def test_requirements_and_refusals() -> None:
    reading.require(True, "code", "here", "no")
    assert verdict_of(lambda: reading.require(False, "code", "here", "no")) == "INVALID"
    assert verdict_of(lambda: reading.malformed("here", "no")) == "MALFORMED"
    assert verdict_of(lambda: reading.incomplete("size", "here", "no")) == "INCOMPLETE"


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("a", '"a"'),
        ("\u00e9\n", '"\\u00e9\\n"'),
        ("x" * 41, '"' + "x" * 40 + '"'),
        (7, "7"),
        (True, "true"),
        (None, "null"),
        (2**99, "a large integer"),
        (2**98, str(2**98)),
        (-(2**99), "a large integer"),
        ([1], "a value of type list"),
        ({}, "a value of type dict"),
        (1.5, "a value of type float"),
    ],
)
def test_a_value_is_shown_short_and_in_ascii(value: Any, text: str) -> None:
    assert reading.shown(value) == text
