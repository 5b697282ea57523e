"""Polynomials as users of numpy and sympy expect them."""

import numpy as np
import sympy
from hypothesis import given

from mcexact.exact.polynomial import Polynomial
from mcexact.shown import LINE
from tests.exact.draws import polynomials

LONG = Polynomial.of(*range(100, 200))


@given(polynomials())
def test_sympy_gets_the_exact_coefficients(p):
    found = p.to_sympy()
    assert Polynomial.from_coefficients(found.all_coeffs()[::-1]) == p
    assert sympy.sympify(p) == found.as_expr()
    assert sympy.Poly(p, sympy.Symbol("x"), domain="QQ") == found


def test_the_variable_can_be_chosen():
    assert str(Polynomial.of("1/3", 0, 1).to_sympy("s").as_expr()) == "s**2 + 1/3"
    assert Polynomial.of(0, 1).to_sympy(sympy.Symbol("z")).gen == sympy.Symbol("z")


def test_numpy_gets_rounded_coefficients_with_the_constant_first():
    found = Polynomial.of("1/3", 0, 1).to_numpy()
    assert isinstance(found, np.polynomial.Polynomial)
    assert found.coef.tolist() == [1 / 3, 0.0, 1.0]
    assert Polynomial.of().to_numpy().coef.tolist() == [0.0]


@given(polynomials())
def test_the_repr_of_a_short_polynomial_makes_it_again(p):
    assert len(repr(p)) <= LINE
    assert repr(p).startswith("<") or eval(repr(p)) == p


def test_a_long_polynomial_is_shown_by_its_first_and_last_terms():
    assert len(repr(LONG)) <= LINE
    assert repr(LONG).startswith("<polynomial 199*x^99 + 198*x^98 + ")
    assert repr(LONG).endswith(" + … + 100 (degree 99)>")
    assert "199 x<sup>99</sup>" in LONG._repr_html_() and len(LONG._repr_html_()) < 4_000
    assert r"\text{199 x}^{99}" in LONG._repr_latex_() and len(LONG._repr_latex_()) < 400


def test_a_short_polynomial_is_shown_completely_in_notebooks():
    p = Polynomial.of(-2, "1/3", 1)
    assert p._repr_html_().endswith("x<sup>2</sup> + 1/3 x - 2</div>")
    assert p._repr_latex_() == r"$\displaystyle x^{2} + \frac{1}{3} x - 2$"
