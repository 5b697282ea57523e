"""Resultants of polynomials in x and t, beside Sylvester's determinant."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest
import sympy

from mcexact.checker.bivariate import (
    degree_bound,
    difference,
    integer_resultant,
    residues,
    resultant,
)
from mcexact.checker.core.arithmetic import NotAUnit
from mcexact.checker.core.reading import Refused

t = sympy.Symbol("t")
PRIME = 1000003


def polynomial(*coefficients: list[Any]) -> list[list[Fraction]]:
    """A polynomial in x and t."""
    return [[Fraction(c) for c in part] for part in coefficients]


def sylvester(f: list[list[Fraction]], g: list[list[Fraction]]) -> list[Fraction]:
    """The coefficients of the determinant of Sylvester's matrix, constant first."""
    size = len(f) + len(g) - 2
    rows = []
    for p, count in ((f, len(g) - 1), (g, len(f) - 1)):
        values = [
            sum(sympy.Rational(c.numerator, c.denominator) * t**i for i, c in enumerate(part))
            for part in reversed(p)
        ]
        rows += [[0] * k + values + [0] * (size - k - len(values)) for k in range(count)]
    found = sympy.Poly(sympy.Matrix(rows).det() if rows else 1, t)
    return [Fraction(int(c.p), int(c.q)) for c in reversed(found.all_coeffs())]


def drawn(rng: random.Random, degree: int) -> list[list[Fraction]]:
    """Monic in x, with coefficients of degree up to 2 in t."""
    parts = [
        [Fraction(rng.randint(-4, 4), rng.choice((1, 1, 2, 3))) for _ in range(rng.randint(0, 3))]
        for _ in range(degree)
    ]
    for part in parts:
        while part and not part[-1]:
            part.pop()
    return [*parts, [Fraction(1)]]


def multiple(f: list[list[Fraction]]) -> int:
    """The least number that makes all coefficients integers."""
    return int(sympy.ilcm(1, *(c.denominator for part in f for c in part)))


@pytest.mark.parametrize("seed", range(24))
def test_resultants_are_sylvester_s_determinants(seed: int) -> None:
    rng = random.Random(seed)
    f, g = drawn(rng, seed % 4), drawn(rng, rng.randint(1, 3))
    expected = sylvester(f, g)
    found = resultant(residues(f, PRIME), residues(g, PRIME), PRIME)
    wanted = [c.numerator * pow(c.denominator, -1, PRIME) % PRIME for c in expected]
    assert found == (wanted if any(wanted) else [])
    factor = multiple(f) ** (len(g) - 1) * multiple(g) ** (len(f) - 1)
    whole = integer_resultant(f, g, [PRIME, 2**61 - 1, 2**89 - 1])
    assert whole == ([c * factor for c in expected] if any(expected) else [])


X: Any = [1]
BOUNDS: dict[str, tuple[list[list[Fraction]], list[list[Fraction]], int]] = {
    "no roots": (polynomial(X), polynomial([0, 0, 1], X), 0),
    "a root for a constant": (polynomial([0, -1], X), polynomial([0, 0, 0, 1]), 3),
    "one root each, the larger degree": (polynomial([0, -1], X), polynomial([0, 0, 0, 1], X), 3),
    "the same the other way round": (polynomial([0, 0, 0, 1], X), polynomial([0, -1], X), 3),
    "roots of degree 1/2 and a root of degree 1": (
        polynomial([0, -1], [], X),
        polynomial([], [0, -1], X),
        3,
    ),
    "three roots of degree 1/3 and two of degree 1/2, rounded down": (
        polynomial([0, 1], [], [], X),
        polynomial([0, 1], [], X),
        3,
    ),
    "a root of degree 2/3 at a root of degree 1/2": (
        polynomial([0, 0, 1], [], [], X),
        polynomial([0, 1], [], X),
        4,
    ),
    "roots of degrees 1 and -1": (polynomial([1], [0, 1], X), polynomial([3], X), 1),
    "roots of degrees -1 alone": (polynomial([1], [0, 1], X), polynomial([], X), 0),
    "the root 0 and a root of degree 1": (polynomial([], [0, 1], X), polynomial([0, 0, 5], X), 4),
    "the root 0 twice": (polynomial([], [], X), polynomial([1], [0, 0, 0, 1], X), 0),
    "the root 0 of both": (polynomial([], [0, 1], X), polynomial([], X), 0),
    "a line above a coefficient": (
        polynomial([0, 0, 1], [0, 1], X),
        polynomial([0, 0, 0, 2], [0, 1], X),
        6,
    ),
    "a steep line first": (polynomial([0, 1], [0, 0, 0, 1], X), polynomial([7], X), 3),
    "a steep line of one step, then one of two": (
        polynomial([0, 1], [], [0, 0, 0, 1], X),
        polynomial([], X),
        1,
    ),
    "nothing": (polynomial([0, 1], X), polynomial(), 0),
    "zeros": (polynomial([0, 1], X), polynomial([], []), 0),
}


@pytest.mark.parametrize("name", BOUNDS)
def test_the_degree_is_bounded_by_newton_polygons(name: str) -> None:
    f, g, expected = BOUNDS[name]
    assert degree_bound(f, g) == expected
    if g and g[-1] == [1]:
        assert len(sylvester(f, g)) - 1 <= degree_bound(f, difference(g, f))


@pytest.mark.parametrize("seed", range(12))
def test_the_degree_of_a_resultant_is_within_both_bounds(seed: int) -> None:
    rng = random.Random(100 + seed)
    f, g = drawn(rng, 3), drawn(rng, 2)
    found = len(sylvester(f, g)) - 1
    assert found <= degree_bound(f, g) <= 3 * 2 + 2 * 2
    assert found <= degree_bound(f, difference(g, f))


def test_the_bound_is_smaller_where_roots_agree_at_infinity() -> None:
    f, g = polynomial([5, 0, 1], [0, 3], X), polynomial([6, 1, 1], [1, 3], X)
    assert (degree_bound(f, g), degree_bound(f, difference(g, f))) == (4, 2)
    assert difference(f, g) == polynomial([-1, -1], [-1], [])
    assert difference(f, polynomial([5])) == polynomial([0, 0, 1], [0, 3], X)
    assert difference(polynomial([5]), f) == polynomial([0, 0, -1], [0, -3], [-1])


def test_the_last_value_that_a_degree_needs_is_taken() -> None:
    f, g = polynomial([-1], [1]), polynomial([0, 0, -1], [1])  # x − 1 and x − t²
    assert resultant(residues(f, PRIME), residues(g, PRIME), PRIME) == [1, 0, PRIME - 1]
    assert resultant(residues(f, 3), residues(g, 3), 3) == [1, 0, 2]
    with pytest.raises(NotAUnit):  # 0 and 2 are the same modulo 2
        resultant(residues(f, 2), residues(g, 2), 2)


def test_the_moduli_have_to_exceed_twice_the_bound() -> None:
    f, g = polynomial([0, "-1/2"], [1]), polynomial(["-1/3"], [1])  # 2x − t and 3x − 1
    assert integer_resultant(f, g, [25]) == [-2, 3]
    assert integer_resultant(f, g, [5, 7]) == [-2, 3]
    for moduli in ([], [23], [5], [24 // 5]):
        with pytest.raises((Refused, NotAUnit)):
            integer_resultant(f, g, moduli)
    with pytest.raises(NotAUnit):
        integer_resultant(f, g, [5, 5])
    with pytest.raises(Refused, match="expected a product"):
        integer_resultant(polynomial([], [1]), polynomial([-1], [1]), [])


def test_a_coefficient_of_half_the_product_is_positive() -> None:
    f, g = polynomial([-3], [1]), polynomial([], [1])  # x − 3 and x: the bound is 4
    assert integer_resultant(f, g, [9]) == [3]
    assert integer_resultant(g, f, [9]) == [-3]
    with pytest.raises(Refused):
        integer_resultant(f, g, [8])


@pytest.mark.parametrize(("ell", "enough"), [(101, False), (250, False), (251, True)])
def test_the_bound_is_a_product_of_powers(ell: int, enough: bool) -> None:
    f, g = polynomial([-4], [1]), polynomial([], [], [], [1])  # x − 4 and x³: the bound is 5³
    for first, second, expected in ((f, g, 64), (g, f, -64)):
        if enough:
            assert integer_resultant(first, second, [ell]) == [expected]
        else:
            with pytest.raises(Refused, match="expected a product above"):
                integer_resultant(first, second, [ell])


def test_a_remainder_of_much_smaller_degree_is_divided_by() -> None:
    f, g = polynomial([], [], [], [], [1]), polynomial([2], [], [], [1])  # x⁴ and x³ + 2, then −2x
    assert resultant(residues(f, PRIME), residues(g, PRIME), PRIME) == [16]
    assert resultant(residues(g, PRIME), residues(f, PRIME), PRIME) == [16]
