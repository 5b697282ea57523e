"""The sector of a damping ratio: as the stability of other roots, and of another matrix."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import UsageError
from mcexact.exact.linear_algebra import characteristic_polynomial
from mcexact.exact.matrix import Matrix
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.roots import StabilityRegion, is_hurwitz, lifted, turned

PARTS = st.integers(-6, 6)
RATIOS = st.fractions(Fraction(1, 40), Fraction(39, 40), max_denominator=40)


@given(st.lists(st.tuples(PARTS, PARTS), max_size=3), RATIOS)
def test_roots_are_in_the_sector_iff_the_turned_ones_are_stable(pairs, zeta):
    p = Polynomial.of(1)
    for x, y in pairs:
        p = p * Polynomial.of(x * x + y * y, -2 * x, 1)
    expected = all(x < 0 and x * x > zeta**2 * (x * x + y * y) for x, y in pairs)
    assert is_hurwitz(turned(p, zeta)) == expected
    assert StabilityRegion("continuous", damping=zeta).contains_roots_of(p) == expected


@given(st.lists(st.lists(PARTS, min_size=3, max_size=3), min_size=3, max_size=3), RATIOS)
def test_the_lifted_matrix_has_the_turned_roots(rows, zeta):
    M = Matrix.from_rows(rows)
    found = characteristic_polynomial(lifted(M, zeta))
    assert found == turned(characteristic_polynomial(M), zeta).monic()


def test_a_root_on_the_border_is_outside():
    p = Polynomial.of(25, 6, 1)  # -3 + 4i, -3 - 4i
    near = Fraction(1, 10**30)
    inside = StabilityRegion("continuous", damping=Fraction(3, 5) - near, largest_modulus=5 + near)
    assert inside.contains_roots_of(p)
    assert not inside.limited(damping=Fraction(3, 5)).contains_roots_of(p)
    assert not inside.limited(largest_modulus=5).contains_roots_of(p)
    assert (
        not StabilityRegion("continuous")
        .limited(damping="1/100")
        .contains_roots_of(Polynomial.of(0, 1))
    )


@pytest.mark.parametrize(
    ("time", "limits", "message"),
    [
        ("continuous", {"damping": 1}, "expected a number above 0 and below 1, found 1"),
        ("continuous", {"damping": 0}, "expected a number above 0 and below 1, found 0"),
        ("continuous", {"largest_modulus": 0}, "expected a number above 0, found 0"),
        ("discrete", {"damping": 0.5}, "a damping ratio is certified in continuous time only"),
        ("discrete", {"largest_modulus": 2}, "largest modulus is certified in continuous time"),
    ],
)
def test_a_limit_out_of_range_is_wrong_usage(time, limits, message):
    with pytest.raises(UsageError, match=message):
        StabilityRegion(time, **limits)


def test_a_region_says_all_its_inequalities():
    region = StabilityRegion.of("continuous", 1).limited(largest_modulus=10)
    assert str(region) == "Re λ < -1 and |λ| < 10"
    assert str(region.tightened(Fraction(1))) == "Re λ < -2 and |λ| < 10"
    assert str(region.limited(damping=0.5)) == "Re λ < -1 and damping ratio > 1/2"
