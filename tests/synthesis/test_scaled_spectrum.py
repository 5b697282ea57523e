"""Tests of spectra near the own one."""

from fractions import Fraction

import pytest

from mcexact import design_decentralized
from mcexact.designs import Aims
from mcexact.errors import InputError
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion
from mcexact.model import gallery
from mcexact.synthesis.state_feedback import scaled_polynomial

OWN = {
    "nothing": Polynomial.of(1),
    "slow and fast": Polynomial.from_roots([-4, "1/3", 0]),
    "on the circle and beyond": Polynomial.from_roots([1, -1, "3/2"]),
    "repeated": Polynomial.of(2, 0, 1) ** 3 * Polynomial.from_roots([0, 0, 0, 0]),
    "irrational": Polynomial.of(-2, 0, 0, 0, 1),
    "very different": Polynomial.from_roots(["1/1000000", -1000000]),
    "a pair of modulus 1": Polynomial.of(1, "-6/5", 1),
}
REGIONS = [
    StabilityRegion.of("continuous", rate="5/2"),
    StabilityRegion.of("continuous", rate="1/1000"),
    StabilityRegion.of("discrete", radius=1),
    StabilityRegion.of("discrete", radius="0.9999"),
    StabilityRegion.of("discrete", radius="1/50"),
]


@pytest.mark.parametrize("own", OWN.values(), ids=OWN)
@pytest.mark.parametrize("region", REGIONS, ids=str)
@pytest.mark.parametrize("more", [0, 1, 5])
def test_all_roots_lie_in_the_region(own, region, more):
    p = scaled_polynomial(own, region, own.degree + more)
    assert p.degree == own.degree + more and p.leading == 1
    assert region.contains_roots_of(p)


def test_what_is_fast_enough_stays_where_it_is():
    own = Polynomial.from_roots([-2, -3]) * Polynomial.of(25, 6, 1)
    assert scaled_polynomial(own, StabilityRegion.of("continuous", rate=1), 4) == own
    slow = Polynomial.from_roots(["1/2", "-1/4", 0])
    assert scaled_polynomial(slow, StabilityRegion.of("discrete", radius="3/4"), 3) == slow


def test_unstable_roots_are_mirrored():
    own = Polynomial.from_roots([2])
    assert scaled_polynomial(own, REGIONS[1], 1) == Polynomial.from_roots([-2])
    assert scaled_polynomial(own, REGIONS[2], 1) == Polynomial.from_roots(["1/2"])


def test_slow_roots_become_a_little_faster_than_asked():
    found = scaled_polynomial(
        Polynomial.from_roots([0]), StabilityRegion("continuous", Fraction(2)), 1
    )
    assert found == Polynomial.from_roots(["-5/2"])
    found = scaled_polynomial(Polynomial.from_roots([1]), REGIONS[3], 1)
    assert Fraction(9998, 10000) < -found.coefficients[0] < Fraction(9999, 10000)


def test_further_roots_are_the_mean_of_the_others():
    own = Polynomial.from_roots([-2, -8])
    found = scaled_polynomial(own, REGIONS[1], 5)
    assert found == Polynomial.from_roots([-2, -8, -4, -8, -12])


def test_equal_roots_are_taken_apart():
    own = Polynomial.from_roots([-1] * 3)
    assert scaled_polynomial(own, REGIONS[1], 3) == Polynomial.from_roots([-1, -2, -3])


def test_a_degree_below_that_of_the_roots_is_refused():
    with pytest.raises(InputError, match="at least 2"):
        scaled_polynomial(Polynomial.from_roots([1, 2]), REGIONS[0], 1)


@pytest.mark.parametrize("name", ["quadruple-tank-pminus", "compleib-rea3-m1"])
def test_the_theorem_has_moderate_gains_for_slow_plants(name):
    made = design_decentralized(gallery.load(name), rate="1/100", aims=Aims(effort=0))
    assert made.parts["blocks"] and made.controller.largest_entry() < 10
