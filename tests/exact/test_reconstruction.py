"""Rational numbers from their residues."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from mcexact.exact.modular import combine, integers, rational, rationals, residue

ELLS = (1_000_003, 998_244_353)
MODULUS = ELLS[0] * ELLS[1]


@given(st.lists(st.integers(0, MODULUS - 1), min_size=1, max_size=4))
def test_chinese_remainders_bring_a_row_back(row):
    parts = [[value % ell for value in row] for ell in ELLS]
    assert combine([parts[0]], ELLS[0], [parts[1]], ELLS[1]) == [row]


@given(st.fractions(-99, 99, max_denominator=99))
def test_a_small_fraction_comes_back(q):
    assert rational(residue(q, ELLS[1]), ELLS[1], 2**14) == (q.numerator, q.denominator)


@given(st.lists(st.fractions(-9, 9, max_denominator=20), min_size=1, max_size=3))
def test_fractions_with_a_small_common_denominator_come_back_over_it(row):
    remainders = [q.numerator * pow(q.denominator, -1, MODULUS) % MODULUS for q in row]
    numerators, denominator = rationals([remainders], MODULUS)
    assert [Fraction(p, denominator) for p in numerators[0]] == row


def test_a_residue_without_a_small_fraction_is_reported():
    assert rational(5000, 10007, 2) is None
    found = [rationals([[value]], 10007) for value in range(10007)]
    assert None in found


def test_integers_are_the_residues_of_least_absolute_value():
    assert integers([0, 1, 6, 3, 4], 7) == [0, 1, -1, 3, -3]
