"""Polynomials in two variables, number fields and null spaces, against sympy and plain laws."""

from __future__ import annotations

import random
from typing import Any

import flint
import pytest
import sympy

from mcexact.errors import InputError, LimitReached
from mcexact.exact import bivariate
from mcexact.exact.bivariate import Tower, X, line, modulus_at, over_functions
from mcexact.exact.linear_algebra import PolynomialMatrix
from mcexact.exact.matrix import Matrix
from mcexact.exact.rational_functions import RationalFunction
from tests.oracle.resultants import resultant

P = flint.fmpq_poly
t, x = sympy.symbols("t x")


def drawn(rng: random.Random, degree: int) -> list[Any]:
    """A polynomial that is monic in x."""
    parts = [P([rng.randint(-3, 3) for _ in range(rng.randint(0, 3))]) for _ in range(degree)]
    return [*parts, P([1])]


def as_sympy(f: list[Any]) -> Any:
    return sum(
        sympy.Rational(int(c.p), int(c.q)) * t**i * x**k
        for k, part in enumerate(f)
        for i, c in enumerate(part.coeffs())
    )


@pytest.mark.parametrize("seed", range(6))
def test_resultants_are_those_of_sympy(seed: int) -> None:
    rng = random.Random(seed)
    f, g = drawn(rng, rng.randint(1, 3)), drawn(rng, rng.randint(1, 3))
    found = resultant(f, g)
    expected = sympy.Poly(sympy.resultant(as_sympy(f), as_sympy(g), x), t)
    assert sympy.Poly(as_sympy([found]), t) in (expected, -expected)
    ell = 1000003
    assert bivariate.of_rationals(f, g, ell) == bivariate.residues(found, ell)


@pytest.mark.parametrize("seed", range(6))
def test_the_characteristic_polynomial_is_that_of_sympy(seed: int) -> None:
    rng = random.Random(seed)
    layers = [
        Matrix.from_rows([[rng.randint(-2, 2) for _ in range(3)] for _ in range(3)])
        for _ in range(3)
    ]
    M = PolynomialMatrix.from_matrices(*layers)
    found = bivariate.characteristic(M)
    rows = [[sum(L[i, j] * t**k for k, L in enumerate(layers)) for j in range(3)] for i in range(3)]
    expected = sympy.Matrix(rows).charpoly(x).as_expr()
    assert sympy.expand(as_sympy(found) - expected) == 0
    assert max(int(c.degree()) for c in found) <= bivariate.degree_bound(M)


@pytest.mark.parametrize("q", ["t - 2", "t**2 - 2", "t**3 + t + 1"])
def test_factors_over_a_number_field_multiply_to_the_squarefree_part(q: str) -> None:
    modulus = P([int(c) for c in reversed(sympy.Poly(q, t).all_coeffs())])
    first = [P([0, 1]) % modulus, P([1])]  # x + t
    second = [P([-2]), P([0]), P([1])]  # x² − 2
    product: list[Any] = [P([0])] * 5
    for i, a in enumerate(first):
        for j, b in enumerate(first):
            for k, c in enumerate(second):
                product[i + j + k] = (product[i + j + k] + a * b * c) % modulus
    found = bivariate.factors(product, modulus)
    splits = q == "t**2 - 2"  # √2 is in the field, and −√2 a root of the first factor as well
    assert sorted(len(p) - 1 for p in found) == ([1, 1] if splits else [1, 2])
    for p in found:
        assert bivariate.divided(product, p, modulus)[1] == []
    common = bivariate.gcd(product, first, modulus)
    assert common == bivariate.monic(first, modulus)


def test_a_null_space_over_a_tower_is_annihilated() -> None:
    q, p = P([-2, 0, 1]), [P([0, -1]), P([0]), P([1])]  # t² = 2, x² = t
    rows = [[[P([0, 1])], [P([0]), P([-1])]], [[P([0]), P([1])], [P([-1])]]]  # [t, −x; x, −1]
    free, columns = Tower(q, p).nullspace(rows, 2)
    assert free == (1,)
    ((first, second),) = columns
    assert second == [P([1]), P([])]
    # first = x/t = x·t/2
    assert first == [P([]), P([0, flint.fmpq(1, 2)])]
    assert Tower(line(3), X).nullspace([], 2)[0] == (0, 1)


def test_null_spaces_over_functions_are_found_from_their_values() -> None:
    def sample(value: int) -> Any:
        row = [[[P([value**2 + 1])], [P([value - 1])]]]
        return Tower(line(value), X).nullspace(row, 2)

    free, (column,) = over_functions(sample)
    assert free == (1,)
    # (t² + 1) u + (t − 1) v = 0
    assert column == [[P([1, -1])], [P([1, 0, 1])]]


def test_a_polynomial_that_factors_at_a_point_is_none_there() -> None:
    p = [P([0, -1]), P([0]), P([1])]  # x² − t
    assert modulus_at(p, 4) is None
    assert modulus_at(p, 0) is None
    assert modulus_at(p, 2) == [P([-2]), P([0]), P([1])]


def test_rational_functions_are_in_lowest_terms() -> None:
    s = RationalFunction.parameter("s", ("s",))
    assert (1 / s - 1 / s).is_constant
    assert str((s - 1) / (s * s) + 1 / (s * s)) == "(1)/(s)"
    assert str(2 - s) == "-s + 2" and s != 1 and hash(s) == hash(s + 0)
    assert (s / 3).substituted([6], RationalFunction.constant(0, ())).value == 2
    x = RationalFunction.parameter("x", ("x", "s"))
    assert str((x * x - 1) / (x - 1)) == "x + 1" and x.terms()[0] == {(1, 0): 1}
    with pytest.raises(ZeroDivisionError):
        1 / (s - s)
    with pytest.raises(InputError, match="undefined there"):
        (1 / s).substituted([0], RationalFunction.constant(0, ()))
    with pytest.raises(LimitReached, match="degree 1001"):
        s**1000 * s
    with pytest.raises(TypeError):
        s + RationalFunction.parameter("u", ("u",))
