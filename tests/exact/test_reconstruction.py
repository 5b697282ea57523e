"""Rational numbers from residues."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from mcexact.exact.reconstruction import combine, rational, rationals

PRIME, OTHER = 2**61 - 1, 2**31 - 1


@given(st.lists(st.fractions(-(10**8), 10**8, max_denominator=9), min_size=1, max_size=5))
def test_rationals_come_back_from_their_residues(values: list[Fraction]) -> None:
    modulus = PRIME * OTHER
    residues = [v.numerator * pow(v.denominator, -1, modulus) % modulus for v in values]
    found = rationals([residues], modulus)
    assert found is not None
    numerators, denominator = found
    assert [Fraction(p, denominator) for p in numerators[0]] == values


@given(st.integers(0, PRIME * OTHER - 1))
def test_remainders_are_combined(value: int) -> None:
    assert combine([[value % PRIME]], PRIME, [[value % OTHER]], OTHER) == [[value]]


def test_a_residue_without_a_small_fraction_has_none() -> None:
    assert rational(50, 101, 3) is None or rational(50, 101, 3) == (-1, 2)
    assert rationals([[10**9]], PRIME * OTHER) == ([[10**9]], 1)
