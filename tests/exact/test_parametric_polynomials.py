"""Polynomials in x and parameters: the same laws in both forms, for one parameter and two."""

from __future__ import annotations

import random
from functools import reduce
from operator import mul
from typing import Any

import pytest
import sympy

from mcexact.errors import InputError, InternalError
from mcexact.exact.linear_algebra import PolynomialMatrix, stacked
from mcexact.exact.matrix import Matrix
from mcexact.exact.parametric_polynomials import (
    ParametricPolynomial,
    characteristic,
    common_factors,
    resultant_factors,
)
from mcexact.exact.polynomial import Polynomial
from mcexact.exact.rational_functions import polynomial_matrix, ring

ONE, TWO = ("t",), ("a", "b")
BOTH = pytest.mark.parametrize("names", [ONE, TWO])
X = sympy.Symbol("x")


def parsed(text: str, names: tuple[str, ...]) -> ParametricPolynomial:
    """The polynomial that a text says, in its joined form."""
    symbols = sympy.symbols((*names, "x"))
    terms = sympy.Poly(sympy.sympify(text), *symbols).terms()
    inside = ring(names)
    f = sum((int(c) * inside.from_dict({e: 1}) for e, c in terms), inside.constant(0))
    return ParametricPolynomial(names, f)


def drawn(rng: random.Random, names: tuple[str, ...], degree: int) -> ParametricPolynomial:
    """A polynomial that is monic in x."""
    *parameters, x = ring(names).gens()
    f = x**degree
    for k in range(degree):
        for t in parameters:
            f = f + (rng.randint(-2, 2) * t ** rng.randint(0, 2) + rng.randint(-1, 1)) * x**k
    return ParametricPolynomial(names, f)


def as_sympy(f: ParametricPolynomial) -> Any:
    symbols = sympy.symbols((*f.parameters, "x"))
    return sum(
        sympy.Rational(int(c.p), int(c.q))
        * sympy.prod([s ** int(e) for s, e in zip(symbols, exponents, strict=True)])
        for exponents, c in f.joined.to_dict().items()
    )


def in_dense_form(f: ParametricPolynomial) -> ParametricPolynomial:
    return ParametricPolynomial(f.parameters, f.dense)


@pytest.mark.parametrize("text", ["0", "1", "t", "x", "x^2 - t", "t^3*x + x^5 - 2*t"])
def test_each_form_gives_the_other(text: str) -> None:
    f = parsed(text.replace("^", "**"), ONE)
    g = in_dense_form(f)
    assert g.joined == f.joined and f == g and hash(f) == hash(g)
    assert f.degree == g.degree == max(sympy.degree(as_sympy(f), X), 0)
    assert ParametricPolynomial.from_polynomials(f.polynomials(), ONE) == f
    assert [str(c).replace("x", "t") for c in f.polynomials()] == [str(c) for c in f.functions()]


@BOTH
@pytest.mark.parametrize("seed", range(6))
def test_factors_and_divisors_are_those_of_sympy(seed: int, names: tuple[str, ...]) -> None:
    rng = random.Random(seed)
    f, g, h = (drawn(rng, names, rng.randint(1, 2)) for _ in range(3))
    first, second = f * g, f * h
    assert sympy.expand(as_sympy(first) - as_sympy(f) * as_sympy(g)) == 0
    _, factors = sympy.factor_list(as_sympy(first * second))
    assert {sympy.expand(as_sympy(p)) for p in (first * second).factors()} == {
        sympy.expand(p / sympy.Poly(p, X).LC()) for p, _ in factors
    }
    common = common_factors([first, second])
    assert {*f.factors()} <= {*common}
    assert all(not p.is_coprime(first) and not p.is_coprime(second) for p in common)
    left, right = (reduce(ParametricPolynomial.without, common, p) for p in (first, second))
    assert all((p * p * left).without(p) == left.without(p) for p in common)
    assert left.is_coprime(right)
    assert sympy.gcd(as_sympy(left), as_sympy(right)).is_number


@pytest.mark.parametrize("seed", range(6))
def test_the_dense_form_computes_as_the_joined_one(seed: int) -> None:
    """Two parameters of which one does not occur have the joined form alone."""
    rng = random.Random(seed)
    f, g = drawn(rng, ONE, 2), drawn(rng, ONE, 2)

    def with_another(p: ParametricPolynomial) -> ParametricPolynomial:
        terms = {(i, 0, k): c for (i, k), c in p.joined.to_dict().items()}
        return ParametricPolynomial(("t", "u"), ring(("t", "u")).from_dict(terms))

    square, both = f * f, in_dense_form(f) * in_dense_form(g)
    wide = with_another(f) * with_another(g)
    assert with_another(both) == wide
    assert with_another(both.without(f)) == wide.without(with_another(f))
    assert with_another(square.gcd(both)) == with_another(square).gcd(wide)
    assert f.is_coprime(g) == with_another(f).is_coprime(with_another(g))
    assert {*map(with_another, both.factors())} == {*wide.factors()}
    if f.is_coprime(g):
        narrow = resultant_factors([f], [g])
        assert {*map(str, narrow)} == {
            *map(str, resultant_factors([with_another(f)], [with_another(g)]))
        }


@pytest.mark.parametrize("q", [Polynomial.of(-2, 1), Polynomial.of(-2, 0, 1)])
def test_reduction_to_a_field_respects_products_and_divisors(q: Polynomial) -> None:
    rng = random.Random(3)
    f, g = drawn(rng, ONE, 2), drawn(rng, ONE, 1)
    square = parsed("x + t", ONE).modulo(q)
    assert square * square == parsed("x**2 + 2*t*x + t**2", ONE).modulo(q)
    both = (f * g).modulo(q)
    assert both == f.modulo(q) * g.modulo(q) and both.modulus == q
    assert g.modulo(q).divides(both) and both.gcd(g.modulo(q)) == g.modulo(q)
    factors = both.factors()
    assert all(p.divides(both) for p in factors)
    assert reduce(ParametricPolynomial.without, factors, both).degree == 0
    assert reduce(mul, factors).divides(both)
    assert not parsed("x**2 - t", ONE).modulo(q).divides(parsed("x - 1", ONE).modulo(q))


@BOTH
def test_characteristic_polynomials_vanish_on_the_diagonal_of_a_triangle(
    names: tuple[str, ...],
) -> None:
    t, *_ = inside = ring(names).gens()
    zero = ring(names).constant(0)
    rows = [[t, t * t, zero + 1], [zero, zero - 1, t], [zero, zero, 2 * t]]
    expected = as_sympy(parsed(f"(x - {names[0]})*(x + 1)*(x - 2*{names[0]})", names))
    assert len(inside) == len(names) + 1
    assert sympy.expand(as_sympy(characteristic(rows, names)) - expected) == 0
    if names == ONE:
        by_values = characteristic(polynomial_matrix(rows, 3), names)
        assert by_values == characteristic(rows, names)


def test_what_is_over_different_rings_is_not_combined() -> None:
    f, q = parsed("x - t", ONE), Polynomial.of(-2, 0, 1)
    for other in (f.modulo(q), parsed("x - a", TWO)):
        assert f != other
        for operation in (mul, *(getattr(ParametricPolynomial, n) for n in OPERATIONS)):
            with pytest.raises(InputError, match="different"):
                operation(f, other)
    with pytest.raises(InputError, match="one parameter, found a, b"):
        parsed("x - a", TWO).polynomials()


OPERATIONS = ("divides", "without", "gcd", "is_coprime")


@pytest.mark.parametrize("text", ["t*x - 1", "(t + 1)*x + 2", "2*t*x + x - t"])
def test_a_factor_that_is_not_monic_is_refused(text: str) -> None:
    with pytest.raises(InternalError, match="not monic"):
        parsed(text, ONE).factors()


def test_matrices_are_stacked_and_evaluated() -> None:
    identity = PolynomialMatrix.identity(2)
    M = stacked([identity, identity.times_x(), identity.take(rows=())], 2)
    assert M.shape == (4, 2) and stacked([], 3).shape == (0, 3)
    assert M.at(3) == Matrix.from_rows([[1, 0], [0, 1], [3, 0], [0, 3]])
    assert polynomial_matrix([], 2) == PolynomialMatrix.from_matrices(Matrix.zeros(0, 2))
