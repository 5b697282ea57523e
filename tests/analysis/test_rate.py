"""Enclosures of the best rate."""

from fractions import Fraction

from mcexact.analysis.fixed_spectrum import fixed_spectrum
from mcexact.analysis.rate import best_rate
from mcexact.certificate.evidence import RootDisc
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
    assert repr(factor.polynomial) == "Polynomial.of(1" + "0" * 4999 + "1, 1)"
    assert found.best_rate is not None and found.best_rate.lower == "1" + "0" * 4999 + "1"
