"""The rounding "simplest", compared with a slow search by other means, and its laws.

The search looks for fractions by `Fraction.limit_denominator` and for decimals by the printed
digits; the package follows the continued fraction.
"""

import decimal
import math
import sys
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import scipy.sparse
from hypothesis import example, given
from hypothesis import strategies as st

from mcexact.errors import InputError
from mcexact.exact.matrix import from_float, matrix_from_float, to_float

UNITS, BITS, KEPT, FEW = 4, 44, 15, 11


def simplest(x: Any) -> Fraction:
    return from_float(x, "simplest")


def digits_of(text: str) -> int:
    """The significant digits of a decimal."""
    mantissa = decimal.Decimal(text).normalize().as_tuple().digits
    return len(mantissa)


def within(r: Fraction, x: float) -> bool:
    return abs(r - Fraction(x)) <= UNITS * Fraction(math.ulp(x))


def short_fractions(x: float) -> set[Fraction]:
    """All fractions of at most 44 bits within 4 units of a float above 0, by their denominators."""
    near = {Fraction(x).limit_denominator(2**k - 1) for k in range(1, BITS + 1)}
    return {
        r
        for r in near
        if r and within(r, x) and r.numerator.bit_length() + r.denominator.bit_length() <= BITS
    }


def expected(x: float) -> Fraction:
    """The rule of `from_float`, word by word, for a float above 0."""
    if x.is_integer() and x <= 2**53:
        return Fraction(int(x))
    for r in accepted(x):
        return r
    if digits_of(repr(x)) <= KEPT:
        return Fraction(repr(x))
    typed = Fraction(f"{x:.{FEW - 1}e}")
    if within(typed, x) and accepted(float(typed)) <= {typed}:
        return typed
    return Fraction(repr(x))


def accepted(x: float) -> set[Fraction]:
    """The short fractions near a float that are no longer than the decimals."""
    found = set()
    for r in short_fractions(x):
        length, near = len(f"{r.numerator}{r.denominator}"), repr(float(r))
        if Fraction(near) == r:
            length = min(length, digits_of(near))
        if length <= digits_of(near) and length <= digits_of(repr(x)):
            found.add(r)
    return found


NEAR_BOTH = 0.051537883595000014
"""A float near the decimal 0.051537883595, near which is 13239/256879, but not near the latter."""
positive = st.floats(min_value=0, exclude_min=True, allow_infinity=False)
whole = st.integers(1, 10**7)


@st.composite
def results(draw: st.DrawFn) -> float:
    """Floats as arithmetic makes them: few digits, quotients, sums, and some units off."""
    p, q, shift = draw(whole), draw(whole), draw(st.integers(-12, 12))
    x = draw(st.sampled_from([p / q, p * 10.0**shift, (p + 0.1) / q, p / 10 + q / 100, p**0.5]))
    for _ in range(draw(st.integers(0, 5))):
        x = math.nextafter(x, draw(st.sampled_from([0.0, math.inf])))
    return x


@example(0.1 + 0.2)
@example(5e-324)
@example(2.2250738585072014e-308)
@example(1.1125369292536007e-308)
@example(1e308)
@example(sys.float_info.max)
@example(9007199254740994.0)
@example(2.9999999999999996)
@example(2.0**-42)
@example(2.0**-43)
@example(NEAR_BOTH)
@given(positive | results())
def test_a_slow_search_by_other_means_gives_the_same(x: float) -> None:
    assert simplest(x) == expected(x)
    assert simplest(-x) == -expected(x)


@example(0.0)
@example(-0.0)
@example(NEAR_BOTH)
@given(st.floats(allow_nan=False, allow_infinity=False) | results())
def test_the_result_is_near_and_reading_it_again_changes_nothing(x: float) -> None:
    r = simplest(x)
    assert within(r, x)
    assert simplest(to_float(r)) == r
    assert simplest(-x) == -r


@given(results())
def test_two_short_fractions_are_never_near_the_same_float(x: float) -> None:
    assert len(short_fractions(x)) <= 1


@given(st.integers(1, 2000), st.integers(1, 2000), st.integers(-3, 3))
def test_every_small_fraction_is_recovered_from_floats_near_it(p: int, q: int, steps: int) -> None:
    """Whichever float around p/q is read; units below a power of 2 are half of those above."""
    x = p / q + steps * math.ulp(p / q * (1 - 2**-52))
    assert simplest(x) == Fraction(p, q)


@example(2482392178, -10)
@given(st.integers(1, 10**10 - 1), st.integers(-20, 20))
def test_up_to_ten_typed_digits_are_read_as_typed_unless_a_shorter_fraction_is_near(
    mantissa: int, shift: int
) -> None:
    typed = Fraction(mantissa) * Fraction(10) ** shift
    r = simplest(float(typed))
    length = len(f"{r.numerator}{r.denominator}")
    assert r == typed or length <= digits_of(str(mantissa))


@pytest.mark.parametrize(
    ("x", "exact"),
    [
        (0.0, "0"),
        (-0.0, "0"),
        (0.1, "1/10"),
        (0.1 + 0.2, "3/10"),
        (1 / 3, "1/3"),
        (-(1.7 + 2.4) / 12, "-41/120"),
        (1.1 * 1.1, "121/100"),
        (3 * 0.1234567891, "0.3703703673"),
        (1e-20, "1e-20"),
        (5e-324, "5e-324"),
        (1e308, "1e308"),
        (2.0**-42, f"1/{2**42}"),
        # 45 bits are too many.
        (2.0**-43, "1.1368683772161603e-13"),
        # Integers are exact up to 2**53, and decimals of their digits beyond.
        (2.0**53, str(2**53)),
        (2.0**53 - 1, str(2**53 - 1)),
        (2.0**53 + 2, str(2**53 + 2)),
        (2.0**70, "1180591620717411300000"),
        # Few units from 5e15, and an integer.
        (5e15 + 1, "5000000000000001"),
        # Within 4 units is 1607798/6476809, which has more digits.
        (0.2482392178, "0.2482392178"),
        # Three units away is 3021367/3228011, whose float prints the shorter decimal.
        (0.9359841091000002, "0.9359841091"),
        # Fifteen digits are as typed.  More are a result, of which few digits may be near.
        (0.123456789012345, "0.123456789012345"),
        (math.nextafter(12345678901e-5, 1), "123456.78901"),
        (math.nextafter(123456789012e-6, 1), "123456.78901199998"),
        # What is irrational stays the decimal that it prints.
        (2**0.5, "1.4142135623730951"),
        (math.pi, "3.141592653589793"),
    ],
)
def test_known_floats(x: float, exact: str) -> None:
    assert simplest(x) == Fraction(exact)


# What numpy and lists hold besides.


@pytest.mark.parametrize("x", [math.inf, -math.inf, math.nan, np.float32("inf"), np.float16("nan")])
def test_infinities_and_nan_are_refused(x: float) -> None:
    with pytest.raises(InputError, match="expected a finite number"):
        simplest(x)


@pytest.mark.parametrize("x", [1j, np.complex64(1)])
def test_complex_numbers_are_refused(x: Any) -> None:
    with pytest.raises(InputError, match="expected a real number, found complex"):
        simplest(x)


def nearest(r: Fraction, kind: Callable[[Any], Any], start: Any) -> Any:
    """The float of a kind that is nearest to a fraction which is a few units from another."""
    low = high = start
    near = [start]
    for _ in range(6):
        low, high = np.nextafter(low, kind(-np.inf)), np.nextafter(high, kind(np.inf))
        near += [low, high]
    return min(near, key=lambda x: abs(Fraction(*x.as_integer_ratio()) - r))


@pytest.mark.parametrize("kind", [np.float16, np.float32, np.float64, np.longdouble])
def test_a_float_of_every_length_is_read_in_its_own_precision(kind: Callable[[Any], Any]) -> None:
    assert simplest(kind("0.1")) == Fraction(1, 10)
    assert simplest(kind(2) ** 10) == 1024
    dice = np.random.default_rng(1)
    for p, q, steps in dice.integers([1, 1, -4], [200, 200, 5], (400, 3)):
        x = kind(p) / kind(q)
        x += kind(steps) * np.spacing(x)
        r = simplest(x)
        exact, unit = (Fraction(*y.as_integer_ratio()) for y in (x, np.spacing(x)))
        assert abs(r - exact) <= UNITS * unit
        assert simplest(nearest(r, kind, x)) == r
        if kind is not np.float16 and p.item().bit_length() + q.item().bit_length() <= 15:
            assert abs(steps) == 4 or r == Fraction(p.item(), q.item())


@pytest.mark.parametrize("kind", [np.int8, np.int64, np.uint64, object])
def test_integers_and_exact_entries_do_not_change(kind: Any) -> None:
    largest = 2**64 + 1 if kind is object else int(np.iinfo(kind).max)
    array = np.array([[largest, 0], [1, 2]], dtype=kind)
    assert matrix_from_float(array, "simplest").rows() == (
        (Fraction(largest), Fraction(0)),
        (Fraction(1), Fraction(2)),
    )
    assert simplest(Fraction(2**60 + 1, 3**40)) == Fraction(2**60 + 1, 3**40)


@pytest.mark.parametrize("form", [np.array, list, scipy.sparse.csr_array])
def test_matrices_of_every_form_are_read_entry_by_entry(form: Callable[[Any], Any]) -> None:
    rows = np.array([[1 / 3, 0.0], [-(1.7 + 2.4) / 12, 0.1 + 0.2]])
    M = matrix_from_float(form(rows), "simplest")
    assert M.rows() == (
        (Fraction(1, 3), Fraction(0)),
        (Fraction(-41, 120), Fraction(3, 10)),
    )


@pytest.mark.parametrize("array", [np.array([[1j]]), [[1j]], [[1.0, math.nan]], [[True]], [["1"]]])
def test_matrices_of_anything_else_are_refused(array: Any) -> None:
    with pytest.raises(InputError):
        matrix_from_float(array, "simplest")
