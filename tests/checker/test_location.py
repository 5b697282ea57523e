"""Roots are placed exactly, without ever being computed."""

from __future__ import annotations

import itertools
from fractions import Fraction

import pytest

from mcexact.checker.arithmetic import poly_product
from mcexact.checker.location import in_region, in_stability_region, is_hurwitz, is_schur

GRID = [Fraction(k, 2) for k in range(-4, 5)]


def with_roots(*roots: complex | Fraction) -> list[Fraction]:
    """The monic polynomial with these rational roots."""
    p = [Fraction(1)]
    for root in roots:
        p = poly_product(p, [-Fraction(root), Fraction(1)])  # type: ignore[arg-type]
    return p


def with_pair(re: Fraction, im: Fraction) -> list[Fraction]:
    """The monic polynomial with the roots re ± i·im."""
    return [re * re + im * im, -2 * re, Fraction(1)]


def test_every_product_of_known_roots_is_placed() -> None:
    for a, re, im in itertools.product(GRID, repeat=3):
        p = poly_product(with_roots(a), with_pair(re, im))
        assert is_hurwitz(p) == (a < 0 and re < 0)
        assert is_schur(p) == (abs(a) < 1 and re * re + im * im < 1)


@pytest.mark.parametrize(
    ("p", "hurwitz", "schur"),
    [
        ([1], True, True),
        ([0, 1], False, True),
        ([1, 1], True, False),
        ([1, 0, 1], False, False),
        ([1, 2, 1], True, False),
        ([0, 0, 0, 1], False, True),
        ([1, 1, 1, 1], False, False),
        ([Fraction(1, 4), 0, 0, 0, 1], False, True),
        ([24, 50, 35, 10, 1], True, False),
    ],
)
def test_boundary_cases(p: list[Fraction], hurwitz: bool, schur: bool) -> None:
    exact = [Fraction(c) for c in p]
    assert in_stability_region(exact, "continuous") is hurwitz
    assert in_stability_region(exact, "discrete") is schur


def test_a_rate_and_a_radius_are_strict() -> None:
    p = with_roots(Fraction(-1), Fraction(-3))
    assert in_region(p, "continuous", Fraction(99, 100))
    assert not in_region(p, "continuous", Fraction(1))
    q = with_pair(Fraction(3, 10), Fraction(4, 10))
    assert in_region(q, "discrete", Fraction(51, 100))
    assert not in_region(q, "discrete", Fraction(1, 2))
    assert not in_region(q, "discrete", None)
