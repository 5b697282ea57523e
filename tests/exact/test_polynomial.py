"""Rational polynomials against sympy."""

import pickle
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from mcexact.errors import FloatRefused, InputError
from mcexact.exact.polynomial import Polynomial, from_integer_coefficients, product
from tests.exact.draws import (
    from_sympy_polynomial,
    polynomials,
    rationals,
    small,
    sympy_polynomial,
)
from tests.wording import refusal

ZERO, ONE, X = Polynomial(()), Polynomial.of(1), Polynomial.x()
nonzero = polynomials().filter(lambda p: p.degree >= 0)
nonconstant = polynomials(entries=small).filter(lambda p: p.degree >= 1)


@given(polynomials(), polynomials())
def test_ring_operations_are_those_of_sympy(p, q):
    a, b = sympy_polynomial(p), sympy_polynomial(q)
    assert p + q == from_sympy_polynomial(a + b)
    assert p - q == from_sympy_polynomial(a - b)
    assert p * q == from_sympy_polynomial(a * b)
    assert -p == ZERO - p
    assert p.gcd(q) == from_sympy_polynomial(a.gcd(b).monic() if a or b else a)


@given(polynomials(), nonzero)
def test_division_leaves_a_remainder_of_smaller_degree(p, q):
    quotient, remainder = divmod(p, q)
    assert quotient * q + remainder == p
    assert remainder.degree < q.degree
    assert (p // q, p % q) == (quotient, remainder)
    assert q.divides(p) == remainder.is_zero()


@given(polynomials(), rationals)
def test_values_and_substitutions(p, a):
    value = sum((c * a**k for k, c in enumerate(p.coefficients)), Fraction(0))
    assert p(a) == value
    assert p.compose_shift(a)(1) == p(1 + a)
    assert p.scale(a)(3) == p(3 * a)


@given(nonzero)
def test_factors_multiply_to_the_polynomial_and_are_those_of_sympy(p):
    factors = p.factor()
    assert product([f**e for f, e in factors]) == p.monic()
    assert all(f.leading == 1 and f.degree >= 1 and f.is_irreducible() for f, _ in factors)
    expected = {
        (from_sympy_polynomial(f.monic()), e) for f, e in sympy_polynomial(p).factor_list()[1]
    }
    assert set(factors) == expected
    assert p.squarefree_part() == product([f for f, _ in factors])
    assert p.is_squarefree() == all(e == 1 for _, e in factors)


@given(nonconstant, nonconstant, st.integers(0, 3))
def test_multiplicities_are_counted(p, q, e):
    p = p.factor()[0][0]
    assert p.multiplicity_in(q * p**e) == e + p.multiplicity_in(q)


@given(polynomials())
def test_derivatives_and_pickles(p):
    assert p.derivative() == from_sympy_polynomial(sympy_polynomial(p).diff())
    assert pickle.loads(pickle.dumps(p)) == p
    assert (p * p, pickle.loads(pickle.dumps(p))) == (p**2, p)
    assert hash(Polynomial.from_coefficients(p.as_json())) == hash(p)
    assert from_integer_coefficients(p.numerators, p.denominator) == p


def test_the_zero_polynomial():
    assert ZERO.degree == -1
    assert ZERO.leading == 0
    assert ZERO(5) == 0
    assert ZERO.derivative() == ZERO
    assert ZERO.as_json() == []
    assert str(ZERO) == ZERO.latex() == "0"
    assert Polynomial.of(0, 0) == ZERO
    assert ZERO.divides(ZERO)
    assert not ZERO.divides(ONE)
    assert not ZERO.is_squarefree()
    assert not ZERO.is_irreducible()
    assert ZERO.gcd(ZERO) == ZERO
    assert product([]) == ONE
    assert ZERO**0 == ONE


def test_constants_have_no_factors():
    assert Polynomial.of("3/2").factor() == []
    assert Polynomial.of(7).squarefree_part() == ONE
    assert not ONE.is_irreducible()


def test_sums_with_numbers():
    assert 1 + X == X + 1 == Polynomial.of(1, 1)
    assert Polynomial.of(1, -1) == 1 - X
    assert Fraction(1, 2) * X == Polynomial.of(0, "1/2")
    wrong: Any
    for wrong in (0.5, True, "x"):
        with pytest.raises(TypeError):
            X + wrong
        with pytest.raises(TypeError):
            X * wrong
        with pytest.raises(TypeError):
            X - wrong
    with pytest.raises(TypeError):
        divmod(X, 2)  # type: ignore[operator]


def test_roots_make_a_monic_polynomial():
    assert Polynomial.from_roots([1, "-1/2"]).as_json() == ["-1/2", "-1/2", 1]
    assert Polynomial.from_roots([]) == ONE


@pytest.mark.parametrize(
    ("coefficients", "text", "latex"),
    [
        ([-1, 1], "x - 1", "x - 1"),
        (["-1/2", 0, -1], "-x^2 - 1/2", "-x^{2} - \\frac{1}{2}"),
        ([0, "2/3", 0, 5], "5*x^3 + 2/3*x", "5 x^{3} + \\frac{2}{3} x"),
        ([-7], "-7", "-7"),
    ],
)
def test_polynomials_are_shown_from_the_highest_power_down(coefficients, text, latex):
    p = Polynomial.from_coefficients(coefficients)
    assert str(p) == text
    assert p.latex() == latex


def test_repr_builds_the_polynomial_again():
    p = Polynomial.of("1/2", -3)
    assert repr(p) == "Polynomial.of('1/2', -3)"


@pytest.mark.parametrize(
    ("operation", "message"),
    [
        (lambda: Polynomial((1, 2)), "expected a tuple of Fractions"),  # type: ignore[arg-type]
        (lambda: Polynomial([Fraction(1)]), "expected a tuple of Fractions"),  # type: ignore[arg-type]
        (lambda: Polynomial((Fraction(0),)), "expected a last coefficient that is not 0"),
        (lambda: ZERO.monic(), "the zero polynomial has no monic multiple"),
        (lambda: ZERO.factor(), "the zero polynomial has no factorization"),
        (lambda: X**-1, "expected an exponent that is at least 0"),
        (lambda: ONE.multiplicity_in(X), "expected a divisor of degree at least 1"),
        (lambda: X.multiplicity_in(ZERO), "expected a divisor of degree at least 1"),
        (lambda: Polynomial.from_coefficients(["x"], where="spectrum"), "^spectrum: expected"),
    ],
)
def test_what_makes_no_sense_is_refused(operation, message):
    with pytest.raises(InputError, match=message):
        operation()


def test_floats_are_no_coefficients():
    with pytest.raises(FloatRefused):
        Polynomial.of(0.5)


def test_division_by_zero():
    with refusal(ZeroDivisionError):
        divmod(X, ZERO)
