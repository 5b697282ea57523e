"""Roots are placed exactly, without ever being computed."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction

import pytest

from mcexact.checker.core import roots as location
from mcexact.checker.core.arithmetic import poly_product
from mcexact.checker.core.roots import in_region, in_stability_region, is_hurwitz, is_schur

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
        ([1, 2, 1, 1], True, False),
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
    assert in_region([Fraction(1)], "discrete", None)
    assert in_region([Fraction(1)], "continuous", None)
    assert not in_region(p, "continuous", None)


def test_a_rate_and_a_radius_move_every_root() -> None:
    rng = random.Random(6)
    for _ in range(200):
        p, real, square = [Fraction(1)], [], []
        for _ in range(rng.randint(1, 4)):
            re = Fraction(rng.randint(-12, 3), rng.choice([1, 2, 3, 8]))
            im = rng.choice([Fraction(0), Fraction(rng.randint(1, 5), rng.choice([1, 4, 5]))])
            p = poly_product(p, with_pair(re, im) if im else with_roots(re))
            real.append(re)
            square.append(re * re + im * im)
        slowest, largest = -max(real), max(square)
        scaled = [c * rng.choice([Fraction(1), Fraction(3), Fraction(1, 7)]) for c in p[:1]]
        scaled = [c * scaled[0] / p[0] if p[0] else c for c in p]
        for rate in (slowest, slowest - Fraction(1, 99), slowest + Fraction(1, 99)):
            assert in_region(scaled, "continuous", rate) == (rate < slowest)
        for radius in (Fraction(rng.randint(1, 40), 7) for _ in range(3)):
            assert in_region(scaled, "discrete", radius) == (radius**2 > largest)
        assert in_stability_region(scaled, "continuous") == (slowest > 0)
        assert in_stability_region(scaled, "discrete") == (largest < 1)


def test_a_radius_is_not_met_on_the_circle() -> None:
    pairs = with_pair(Fraction(-3, 5), Fraction(4, 5))
    for p in (with_roots(Fraction(-1)), with_roots(Fraction(1)), pairs, poly_product(pairs, pairs)):
        assert not in_stability_region(p, "discrete")
        assert in_region(p, "discrete", Fraction(101, 100))


def test_roots_on_the_axis_are_seen_behind_others() -> None:
    for behind in itertools.product((-1, -2, -5), repeat=3):
        left = with_roots(*map(Fraction, behind))
        assert is_hurwitz(left)
        for on_axis in (with_roots(Fraction(0)), with_pair(Fraction(0), Fraction(3))):
            assert not is_hurwitz(poly_product(left, on_axis))


@pytest.mark.parametrize("time", ["continuous", "discrete"])
def test_roots_are_placed_with_integers_alone(time: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*numbers: object) -> None:
        raise AssertionError("a sum of fractions may have a much longer denominator than each")

    strange = [*(Fraction(1, 10**22 + 2 * k + 1) for k in range(9)), Fraction(1)]
    for name in ("add", "radd", "sub", "rsub", "mul", "rmul", "truediv", "rtruediv", "pow"):
        monkeypatch.setattr(Fraction, f"__{name}__", refused)
    assert in_region(strange, time, Fraction(1, 2)) is (time == "discrete")


def test_a_division_with_a_remainder_is_an_error_and_no_verdict(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(location, "divmod", lambda a, b: (a // b, 1), raising=False)
    with pytest.raises(ArithmeticError):
        is_hurwitz(with_roots(Fraction(-1), Fraction(-3)))
