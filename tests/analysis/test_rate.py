"""Enclosures of the best rate."""

from fractions import Fraction

import pytest

from mcexact.analysis.fixed_modes import fixed_spectrum
from mcexact.analysis.stability import best_rate, closed_loop_spectrum, located
from mcexact.answer import protocol
from mcexact.answer.evidence import RateInterval, RootDisc
from mcexact.checker.kinds import check_document
from mcexact.exact.linear_algebra import companions
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model.system import MultiChannelSystem


def test_nothing_fixed_leaves_no_bound() -> None:
    assert best_rate("continuous", []) is None


def test_a_modulus_that_is_no_decimal_is_rounded_outward() -> None:
    rate = best_rate("discrete", [RootDisc("1", "1", "0"), RootDisc("0.5", "0", "0")])
    assert rate is not None
    assert Fraction(rate.lower) ** 2 <= 2 <= Fraction(rate.upper) ** 2


def test_a_disc_around_zero_has_no_negative_modulus() -> None:
    rate = best_rate("discrete", [RootDisc("0", "0", "0.1")])
    assert rate is not None
    assert (rate.lower, rate.upper) == ("0", "0.1")


def test_an_unstable_mode_gives_a_negative_rate() -> None:
    rate = best_rate("continuous", [RootDisc("2", "1", "0.5"), RootDisc("2", "-1", "0.5")])
    assert rate is not None
    assert (rate.lower, rate.upper) == ("-2.5", "-1.5")


def test_a_plant_with_longer_numbers_than_python_prints_by_default_has_its_rate() -> None:
    long = 10**5000 + 1
    plant = MultiChannelSystem([[-long, 0], [0, 1]], [[[0], [1]]], [[[1, 1]]])
    found = fixed_spectrum(plant)
    (factor,) = found.factors
    assert str(factor.polynomial) == "x + 1" + "0" * 4999 + "1"
    assert len(repr(factor.polynomial)) < 200
    assert found.best_rate is not None and found.best_rate.lower == "1" + "0" * 4999 + "1"


def pair(re: str, im: str) -> Polynomial:
    """The real polynomial with the roots re ± i·im."""
    a, b = Fraction(re), Fraction(im)
    return Polynomial.of(a * a + b * b, -2 * a, 1)


def assert_encloses_to_ten_digits(rate: RateInterval | None, time: str, p: Polynomial) -> None:
    """All roots are at least as good as the lower end, some root is no better than the upper one.

    Decided on the polynomial by the Routh array, not on its roots.
    """
    assert rate is not None
    lower, upper = Fraction(rate.lower), Fraction(rate.upper)
    assert 0 <= upper - lower <= Fraction(1, 10**10) * min(abs(lower), abs(upper))
    slack = (upper - lower) / 10 + Fraction(1, 10**40)

    def all_better_than(bound: Fraction) -> bool:
        if time == "continuous":
            return StabilityRegion(time).contains_roots_of(p.compose_shift(-bound))
        return StabilityRegion(time).contains_roots_of(p.scale(bound))

    better, worse = lower - slack, upper + slack
    if time == "discrete":
        better, worse = worse, better
    assert all_better_than(better)
    assert not all_better_than(worse)


MODES = [
    ("discrete", pair("1", "1")),
    ("discrete", pair("0.9", "0.4")),
    ("discrete", pair("0.0003", "0.0001")),
    ("discrete", pair("1/3", "1/7")),
    ("discrete", pair("300", "0.5")),
    ("discrete", Polynomial.of(-2, 0, 0, 1)),
    ("discrete", Polynomial.of(Fraction(1, 10**30), 1, 5)),
    ("continuous", pair("-1e-11", "1")),
    ("continuous", pair("1e-14", "3")),
    ("continuous", Polynomial.of(3, Fraction(1, 10**15), 1)),
    ("continuous", Polynomial.of(3, Fraction(1, 10**15), 1) * Polynomial.of(1, 0, 0, 1)),
    ("continuous", Polynomial.of(1, 1, 0, 0, 1)),
]


@pytest.mark.parametrize(("time", "p"), MODES)
def test_the_best_rate_is_enclosed_to_ten_digits_and_the_checker_agrees(
    time: str, p: Polynomial
) -> None:
    A = companions(tuple(factor for factor, _ in p.factor()))
    nothing = [[[0]] * p.degree], [[[0] * p.degree]]
    found = fixed_spectrum(MultiChannelSystem(A, *nothing, time=time))
    assert_encloses_to_ten_digits(found.best_rate, time, p)
    assert check_document(protocol.encode(found).encode()).verdict == "VALID"
    assert_encloses_to_ten_digits(closed_loop_spectrum(A, time).rate, time, p)


def test_a_largest_modulus_that_is_a_decimal_is_given_exactly() -> None:
    assert located("discrete", [pair("0.6", "0.8")])[1] == RateInterval("1", "1")
    assert located("discrete", [Polynomial.of(0, 1)])[1] == RateInterval("0", "0")


@pytest.mark.parametrize(
    "p",
    [
        Polynomial.of(2, 0, 1),
        Polynomial.of(2, 0, 1) * Polynomial.of(3, 0, 1) * Polynomial.of(3, 1),
        Polynomial.of(0, 1) * Polynomial.of(2, 0, 1),
    ],
)
def test_irrational_modes_on_the_imaginary_axis_leave_no_rate_and_end_the_search(
    p: Polynomial,
) -> None:
    discs, rate = located("continuous", [factor for factor, _ in p.factor()])
    assert rate is not None
    assert Fraction(rate.lower) <= 0 <= Fraction(rate.upper)
    assert Fraction(rate.upper) - Fraction(rate.lower) <= Fraction(1, 10**10)
    assert len([disc for those in discs for disc in those]) == p.degree


def test_a_mode_to_the_right_of_others_on_the_axis_is_enclosed_all_the_same() -> None:
    right = Polynomial.of(-2, 0, 10**40)
    p = right * Polynomial.of(2, 0, 1)
    assert_encloses_to_ten_digits(
        located("continuous", [right.monic(), Polynomial.of(2, 0, 1)])[1], "continuous", p
    )
