"""Enclosures of the best rate."""

from fractions import Fraction

from mcexact.analysis.rate import best_rate
from mcexact.certificate.evidence import RootDisc


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
