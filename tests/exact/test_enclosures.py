"""Root discs: the statement they make is tested in exact arithmetic."""

import re
from fractions import Fraction
from itertools import combinations, pairwise

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mcexact.errors import InputError
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import Disc, real_root_intervals, root_discs
from tests.exact.draws import polynomials
from tests.wording import refusal

DECIMAL = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]*[1-9])?")


def complex_value(p, a, b):
    """p at a + ib, as real and imaginary part."""
    re_part, im_part = Fraction(0), Fraction(0)
    for c in reversed(p.coefficients):
        re_part, im_part = re_part * a - im_part * b + c, re_part * b + im_part * a
    return re_part, im_part


def assert_one_root_each(p, discs):
    """Every disc holds a root, by d²|p(c)|² ≤ r²|p'(c)|², and no two discs touch."""
    assert len(discs) == p.degree
    for disc in discs:
        a, b, radius = disc.exact()
        value, slope = complex_value(p, a, b), complex_value(p.derivative(), a, b)
        square = slope[0] ** 2 + slope[1] ** 2
        assert square > 0
        assert p.degree**2 * (value[0] ** 2 + value[1] ** 2) <= radius**2 * square
        for text in (disc.re, disc.im, disc.radius):
            assert DECIMAL.fullmatch(text)
            assert text != "-0"
    for one, other in combinations(discs, 2):
        a, b, r = one.exact()
        c, d, s = other.exact()
        assert (a - c) ** 2 + (b - d) ** 2 > (r + s) ** 2
    mirrored = {(disc.re, disc.im.removeprefix("-")) for disc in discs if disc.im != "0"}
    assert 2 * len(mirrored) == sum(disc.im != "0" for disc in discs)


@given(polynomials(6))
def test_discs_hold_one_root_each(p):
    assume(p.degree >= 1)
    squarefree = p.squarefree_part()
    assert_one_root_each(squarefree, root_discs(squarefree))


@pytest.mark.parametrize(
    "p",
    [
        Polynomial.of(0, 1),
        Polynomial.of(1, 0, 1),
        Polynomial.from_roots([0, 1, -1, "1/3"]),
        # two roots that agree in 40 digits
        Polynomial.from_roots([1, 1 + Fraction(1, 10**40)]),
        # a conjugate pair very close to the real axis
        Polynomial.of(1 + Fraction(1, 10**60), -2, 1),
        # roots of very different sizes
        Polynomial.from_roots([10**30, Fraction(1, 10**30), -5]),
        Polynomial.of(Fraction(1, 10**400), 1),
        Polynomial.of(-2 * 10**400, 0, 1),
        # Mignotte: two roots of x^9 − 2(50x − 1)² are closer than 10⁻¹⁰
        Polynomial.x() ** 9 - 2 * Polynomial.of(-1, 50) ** 2,
        Polynomial.from_roots(range(1, 21)),
        product([Polynomial.of(k, 1, 1) for k in range(1, 16)]),
    ],
)
def test_difficult_polynomials(p):
    discs = root_discs(p)
    assert_one_root_each(p, discs)
    assert discs == root_discs(p)


def test_rational_roots_on_the_grid_are_exact():
    discs = root_discs(Polynomial.from_roots(["-1.25", 0, 7]))
    assert discs == (Disc("-1.25", "0", "0"), Disc("0", "0", "0"), Disc("7", "0", "0"))


def test_a_scaled_polynomial_has_the_same_discs():
    p = Polynomial.of(5, -3, 1, 2)
    assert root_discs(p) == root_discs(Fraction(-2, 7) * p)


def test_a_small_root_is_shown_with_twelve_digits():
    (disc,) = root_discs(Polynomial.of(Fraction(-1, 3 * 10**9), 1))
    assert disc.re == "0.0000000003333333333333"


@given(st.sets(st.fractions(-4, 4, max_denominator=50), min_size=1, max_size=5), polynomials(2))
def test_intervals_hold_the_real_roots(roots, other):
    p = Polynomial.from_roots(roots)
    intervals = real_root_intervals(p)
    assert len(intervals) == len(roots)
    for root, (lower, upper) in zip(sorted(roots), intervals, strict=True):
        assert lower <= root <= upper
    shifted = p * Polynomial.of(17, 0, 1)
    assert len(real_root_intervals(shifted)) == len(roots)


def test_intervals_are_disjoint_and_ascending():
    p = Polynomial.of(1, -3, 0, 1)
    intervals = real_root_intervals(p)
    assert len(intervals) == 3
    for (_, upper), (lower, _) in pairwise(intervals):
        assert upper < lower
    for lower, upper in intervals:
        assert p(lower) * p(upper) < 0


def test_constants_have_no_real_roots():
    assert real_root_intervals(Polynomial.of(3)) == ()


@pytest.mark.parametrize("p", [Polynomial(()), Polynomial.of(2)])
def test_a_constant_has_no_discs(p):
    with refusal(InputError):
        root_discs(p)


def test_repeated_roots_are_refused():
    with refusal(InputError):
        root_discs(Polynomial.from_roots([1, 1]))


def test_intervals_of_the_zero_polynomial_are_refused():
    with refusal(InputError):
        real_root_intervals(Polynomial(()))


@pytest.mark.parametrize("root", [10**5000 + 1, Fraction(1, 10**5000)], ids=["long", "short"])
def test_roots_may_be_longer_than_python_prints_by_default(root):
    (disc,) = root_discs(Polynomial.from_roots([root]))
    assert disc.exact() == (root, 0, 0)
