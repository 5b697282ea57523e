"""Where roots lie: against products of factors whose roots are known, and against numpy."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from mcexact.errors import InputError, UsageError
from mcexact.exact.polynomial import Polynomial, product
from mcexact.exact.roots import StabilityRegion, is_hurwitz, is_schur
from tests.exact.draws import polynomials
from tests.wording import refusal

parts = st.builds(Fraction, st.integers(-6, 6), st.integers(1, 4))


def quadratic(re: Fraction, im: Fraction) -> Polynomial:
    """The polynomial with the roots re ± i·im."""
    return Polynomial.of(re * re + im * im, -2 * re, 1)


@given(st.lists(parts, max_size=4), st.lists(st.tuples(parts, parts), max_size=3), parts)
def test_products_of_known_factors_are_placed(real, pairs, lead):
    assume(lead)
    p = lead * Polynomial.from_roots(real) * product([quadratic(*pair) for pair in pairs])
    assert is_hurwitz(p) == all(r < 0 for r in [*real, *(re for re, _ in pairs)])
    assert is_schur(p) == all(r * r < 1 for r in real) * all(
        re * re + im * im < 1 for re, im in pairs
    )


@given(polynomials(6, st.integers(-9, 9)))
def test_numpy_agrees_away_from_the_boundary(p):
    assume(p.degree >= 1)
    roots = np.roots([float(c) for c in reversed(p.coefficients)])
    assume(len(roots) == p.degree)
    if abs(roots.real.max()) > 1e-3:
        assert is_hurwitz(p) == (roots.real.max() < 0)
    if abs(abs(roots).max() - 1) > 1e-3:
        assert is_schur(p) == (abs(roots).max() < 1)


@given(polynomials(5, st.integers(-4, 4)), st.integers(1, 5), st.integers(1, 5))
def test_a_bound_moves_the_region(p, numerator, denominator):
    assume(not p.is_zero())
    R = Fraction(numerator, denominator)
    faster = StabilityRegion.of("continuous", rate=R)
    assert faster.contains_roots_of(p) == is_hurwitz(p.compose_shift(-R))
    radius = min(R, Fraction(1))
    smaller = StabilityRegion.of("discrete", radius=radius)
    assert smaller.contains_roots_of(p) == is_schur(p.scale(radius))
    assert StabilityRegion.of("discrete").contains_roots_of(p) == is_schur(p)
    assert StabilityRegion.of("continuous").contains_roots_of(p) == is_hurwitz(p)


def test_roots_on_the_boundary_are_outside():
    assert not is_hurwitz(Polynomial.of(0, 1))
    assert not is_hurwitz(Polynomial.of(1, 0, 1))
    assert not is_hurwitz(Polynomial.of(1, 1, 1, 1))
    assert not is_schur(Polynomial.of(1, 1))
    assert not is_schur(Polynomial.of(1, "6/5", 1))
    assert not StabilityRegion.of("continuous", rate=2).contains_roots_of(Polynomial.of(2, 1))
    half = StabilityRegion.of("discrete", radius="1/2")
    assert not half.contains_roots_of(Polynomial.of(-1, 2))


def test_constants_have_no_root_that_could_be_outside():
    assert is_hurwitz(Polynomial.of(-3))
    assert is_schur(Polynomial.of("1/7"))


def test_a_margin_that_no_float_shows():
    tiny = Fraction(1, 10**50)
    assert is_hurwitz(Polynomial.of(tiny, 1))
    assert not is_hurwitz(Polynomial.of(-tiny, 1))
    assert is_schur(Polynomial.of(-1 + tiny, 1))
    assert not is_schur(Polynomial.of(-1 - tiny, 1))
    assert is_hurwitz(quadratic(-tiny, Fraction(1)))


def test_all_roots_at_zero_are_schur():
    assert is_schur(Polynomial.of(0, 0, 0, 5))


@pytest.mark.parametrize("test", [is_hurwitz, is_schur])
def test_the_zero_polynomial_is_refused(test):
    with pytest.raises(InputError, match="every number is a root of 0"):
        test(Polynomial(()))


def test_a_region_of_an_unknown_time_is_refused():
    with pytest.raises(InputError, match='time: expected "continuous" or "discrete", found'):
        StabilityRegion("sampled")


@pytest.mark.parametrize(
    ("time", "bound", "message"),
    [
        ("continuous", 0, "expected a rate above 0, found 0"),
        ("continuous", Fraction(-1), "expected a rate above 0"),
        ("discrete", 0, "expected a radius above 0 and at most 1"),
        ("discrete", Fraction(3, 2), "expected a radius above 0 and at most 1, found 3/2"),
        ("discrete", 1.5, "expected a radius above 0 and at most 1, found 3/2"),
    ],
)
def test_a_bound_out_of_range_is_wrong_usage(time, bound, message):
    with pytest.raises(UsageError, match=message):
        StabilityRegion(time, bound)


def test_the_bound_of_the_other_time_is_wrong_usage():
    with refusal(UsageError):
        StabilityRegion.of("continuous", radius=1)
    with refusal(UsageError):
        StabilityRegion.of("discrete", rate=1)
    with pytest.raises(UsageError, match="give a bound or a radius, not both"):
        StabilityRegion.of("discrete", radius=1, bound=1)


@pytest.mark.parametrize("tenth", [0.1, np.float64(0.1), np.float32(0.1), "0.1", "1/10"])
def test_a_float_asks_for_the_decimal_that_prints_it(tenth):
    assert StabilityRegion.of("continuous", rate=tenth).bound == Fraction(1, 10)
    assert StabilityRegion("discrete", tenth) == StabilityRegion.of("discrete", radius="1/10")


@pytest.mark.parametrize("rate", [True, float("nan"), float("inf"), 1j, "fast"])
def test_what_is_not_a_finite_rational_number_is_no_rate(rate):
    with pytest.raises(InputError, match=r"^rate: "):
        StabilityRegion("continuous", rate)
    with pytest.raises(InputError, match=r"^rate: "):
        StabilityRegion.of("continuous", rate=rate)


def test_a_bound_as_certificates_write_it_may_be_the_rate_0():
    assert StabilityRegion.of("continuous", bound=0) == StabilityRegion("continuous")
    assert StabilityRegion.of("discrete", bound=1).bound == 1
    with pytest.raises(UsageError, match="expected a radius above 0"):
        StabilityRegion.of("discrete", bound=0)


@pytest.mark.parametrize("time", ["continuous", "discrete"])
@pytest.mark.parametrize("bound", [None, "1/3"])
def test_a_tightened_region_lies_inside(time, bound):
    region = StabilityRegion.of(time, bound=bound)
    inner = region.tightened(Fraction(1, 8), offset=1)
    assert inner.limit < region.limit
    at_the_edge = Polynomial.of(-inner.limit, 1)
    assert region.contains_roots_of(at_the_edge) and not inner.contains_roots_of(at_the_edge)


def test_regions_show_their_inequality():
    assert str(StabilityRegion("continuous")) == "Re λ < 0"
    assert str(StabilityRegion("continuous", Fraction(1, 2))) == "Re λ < -1/2"
    assert str(StabilityRegion("discrete")) == "|λ| < 1"
    assert str(StabilityRegion("discrete", Fraction(3, 4))) == "|λ| < 3/4"
    assert StabilityRegion("discrete", Fraction(1)) == StabilityRegion("discrete", Fraction(1))
