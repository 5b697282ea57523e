"""Numbers as they are written, and what is refused."""

import math
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import FloatRefused, InputError
from mcexact.exact.rational import Limits, as_fraction, parse_rational, written
from tests.wording import refusal


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0", Fraction(0)),
        ("-0", Fraction(0)),
        ("007", Fraction(7)),
        ("0.1", Fraction(1, 10)),
        ("-2.50", Fraction(-5, 2)),
        ("1e3", Fraction(1000)),
        ("1E+3", Fraction(1000)),
        ("12.5e-1", Fraction(5, 4)),
        ("-6/4", Fraction(-3, 2)),
        ("0/7", Fraction(0)),
        (f"1/{2**200}", Fraction(1, 2**200)),
        ("1e-0000000000000000000000002", Fraction(1, 100)),
    ],
)
def test_a_written_number_is_read_exactly(text, value):
    assert parse_rational(text) == value


@pytest.mark.parametrize(
    "text",
    [
        "",
        " 1",
        "1 ",
        "+1",
        "1_000",
        "\uff11",  # full-width digit one
        "\u0661",  # Arabic-Indic digit one
        "1.",
        ".5",
        "--1",
        "1/-2",
        "1/2/3",
        "1.5/2",
        "0x10",
        "nan",
        "inf",
        "1e",
        "1e2.5",
        "__import__('os')",
        "1\n",
    ],
)
def test_what_is_not_in_the_grammar_is_refused(text):
    with pytest.raises(InputError, match="expected an integer, a decimal"):
        parse_rational(text)


def test_a_refusal_names_the_place():
    with pytest.raises(InputError, match=r"^channels\[2\]\.B: expected an integer"):
        parse_rational("x", where="channels[2].B")


def test_a_zero_denominator_is_refused():
    with refusal(InputError):
        parse_rational("1/0")


@pytest.mark.parametrize("text", ["9" * 4301, "1/" + "9" * 4301, "0." + "9" * 4300, "9" * 10**6])
def test_too_many_digits_are_refused(text):
    with refusal(InputError):
        parse_rational(text)


def test_the_limit_on_digits_can_be_raised():
    digits = "7" * 20000
    q = parse_rational(digits, Limits(digits=20000))
    assert q.numerator % 10**5 == 77777
    assert q.numerator.bit_length() == math.ceil(20000 * math.log2(10) - math.log2(9 / 7))


def test_a_number_at_the_limit_is_read():
    assert parse_rational("1" + "0" * 4299) == 10**4299


@pytest.mark.parametrize("text", ["1e1001", "1e-1001", "1e999999999", "1e" + "9" * 4000])
def test_a_large_exponent_is_refused_before_it_is_used(text):
    with refusal(InputError):
        parse_rational(text)


def test_the_limit_on_exponents_can_be_raised():
    assert parse_rational("1e2000", Limits(exponent=2000)) == 10**2000


@pytest.mark.parametrize(
    ("entry", "value"),
    [
        (3, Fraction(3)),
        (Fraction(1, 3), Fraction(1, 3)),
        (Decimal("-0.125"), Fraction(-1, 8)),
        (Decimal("0"), Fraction(0)),
        ("1/3", Fraction(1, 3)),
        (sympy.Rational(2, 6), Fraction(1, 3)),
        (sympy.Integer(5), Fraction(5)),
        (np.int64(-4), Fraction(-4)),
        (Fraction(np.int64(3), np.int64(2)), Fraction(3, 2)),  # type: ignore[call-overload]
        (2**100, Fraction(2**100)),
    ],
)
def test_every_exact_kind_of_entry_is_accepted(entry, value):
    found = as_fraction(entry)
    assert found == value
    assert type(found) is Fraction
    assert type(found.numerator) is type(found.denominator) is int


@pytest.mark.parametrize(
    "entry", [0.5, float("nan"), np.float64(0.5), np.float32(0.5), sympy.Float("0.5")]
)
def test_a_float_is_refused_and_the_two_ways_in_are_named(entry):
    with pytest.raises(FloatRefused, match=r"from_float\(A, B, C\)"):
        as_fraction(entry)


@pytest.mark.parametrize("entry", [True, np.bool_(False)])
def test_a_boolean_is_not_a_number(entry):
    with pytest.raises(InputError, match="expected a number, found the Boolean"):
        as_fraction(entry)


@pytest.mark.parametrize("entry", [None, [1], b"1", sympy.sqrt(2), object()])
def test_what_is_no_number_is_refused(entry):
    with pytest.raises(InputError, match="expected a rational number"):
        as_fraction(entry, where="A[0][0]")


@pytest.mark.parametrize("entry", [Decimal("NaN"), Decimal("-Infinity")])
def test_a_decimal_that_is_not_finite_is_refused(entry):
    with pytest.raises(InputError, match="expected a finite number"):
        as_fraction(entry)


def test_a_decimal_with_a_huge_exponent_is_refused():
    with refusal(InputError):
        as_fraction(Decimal("1e999999999"))


@given(st.fractions())
def test_what_is_written_is_read_back(q):
    assert as_fraction(written(q)) == q
