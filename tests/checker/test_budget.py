"""What is granted, what is counted, and what is named where a budget does not suffice."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import comb

import pytest

from mcexact.checker import command
from mcexact.checker.core import budget
from mcexact.checker.core.arithmetic import Polynomial
from mcexact.checker.core.budget import GRANTED, MORE, PER_BYTE, Budget, Refused, current, limited
from mcexact.checker.core.roots import is_hurwitz
from tests.checker.test_work import named


def asked(given: Budget, units: int, after: int = 0) -> int:
    """The work that is named where a budget refuses a step."""
    with pytest.raises(Refused) as refused:
        given.spend(units, after)
    return named(refused.value.message)


def test_what_is_granted_is_what_the_documents_say() -> None:
    told = f"{GRANTED:,} units and {PER_BYTE:,} for each byte"
    assert told == "40,000,000 units and 4,000 for each byte"
    assert MORE == 4
    more = f"{told}, four times as many if the plant has a parameter"
    assert more in " ".join((command.__doc__ or "").split())
    assert Budget() == Budget(None, GRANTED, 0, [], False, 0, 1)


def test_a_limb_holds_thirty_bits() -> None:
    assert [budget.limbs([2**k]) for k in (28, 29, 58, 59)] == [1, 2, 2, 3]


def test_most_that_is_named_is_a_power_of_ten() -> None:
    assert asked(Budget(1, 0), 10**40) == 10**30


@pytest.mark.parametrize(
    ("units", "after", "enough"),
    [
        (1250, 0, 5000),
        (1251, 0, 5100),
        (1250, 1, 5100),
        (1251, -1, 5000),
        (2, 0, 8),
        (260, 0, 1100),
        (26, 0, 110),
    ],
)
def test_four_times_the_work_is_named_rounded_up_to_two_digits(
    units: int, after: int, enough: int
) -> None:
    assert asked(Budget(1, 0), units, after) == enough
    with limited(Budget(1, 0)), pytest.raises(Refused) as refused:
        budget.spend(units, after)
    assert named(refused.value.message) == enough
    assert asked(Budget(1, 10**6), units, after) == 10**6


@pytest.mark.parametrize(("units", "enough"), [(1250, 5000), (1251, 5100)])
def test_nothing_follows_a_step_unless_it_is_told(units: int, enough: int) -> None:
    for spend in (Budget(1, 0).spend, budget.spend):
        with limited(Budget(1, 0)), pytest.raises(Refused) as refused:
            spend(units)
        assert named(refused.value.message) == enough


@pytest.mark.parametrize(("largest", "n"), [(0, 1), (71, 3), (72, 4), (8 * 81, 10)])
def test_a_subject_under_way_is_followed_by_a_characteristic_polynomial(
    largest: int, n: int
) -> None:
    building = Budget(largest, 0, builds=True)
    building.spend(largest)
    after = budget.products(2 * n**3, n // 8 + 1, n // 8 + 1)
    assert asked(building, 1) == rounded(4 * (largest + 1 + after))
    building.builds = False
    assert asked(building, 1) == rounded(4 * (largest + 1))


def rounded(number: int) -> int:
    """The least number from this one on with zeros after its first two digits."""
    unit = 10 ** max(len(str(number)) - 2, 0)
    return -(-number // unit) * unit


def test_the_largest_step_is_that_of_the_subject() -> None:
    spent = Budget()
    spent.spend(5)
    assert spent.largest == 0
    spent.builds = True
    for units in (3, 7, 2):
        spent.spend(units)
    assert (spent.largest, spent.spent) == (7, 17)


@pytest.mark.parametrize(
    ("units", "most", "reached", "whole"),
    [
        ([100, 100, 100, 5000], 300, 300, 7 * 5000),  # the turn that is refused is the longest
        ([300, 10], 305, 300, 9 * 300),  # the turns before it were longer
        ([400], 300, 0, 10 * 400),
    ],
)
def test_a_loop_goes_on_as_it_began(units: list[int], most: int, reached: int, whole: int) -> None:
    with limited(Budget(most, 0)), pytest.raises(Refused) as refused:
        for each in budget.counted(units + [0] * (10 - len(units))):
            budget.spend(each)
    assert named(refused.value.message) == rounded(4 * (reached + whole))


def test_what_is_granted_can_be_multiplied() -> None:
    given = Budget(usual=100, times=3)
    given.spend(300)
    assert asked(given, 1) == 1300
    given.grant(1)
    assert given.granted == 3 * (100 + PER_BYTE)
    given.spend(3 * PER_BYTE)
    assert asked(Budget(1, 10**6, times=2), 3) == 2 * 10**6
    assert Budget(5, 100, times=3).granted == 300
    assert asked(Budget(5, 0, times=3), 6) == 24


def test_a_budget_holds_for_what_is_inside() -> None:
    inside = Budget(10, 0)
    with limited(inside):
        budget.spend(10)
        assert current(None) is inside
    budget.spend(10**40)
    assert (inside.spent, inside.usual, current(7)) == (10, 0, Budget(7))
    with limited(inside, 3):
        assert inside.usual == 3 * PER_BYTE


def test_what_is_refused_has_its_four_parts() -> None:
    parts = ("INCOMPLETE", "work", "checker", "a message")
    assert Refused(*parts).args == parts


SCALED: dict[str, tuple[Callable[[int], Polynomial], float]] = {
    "by powers of 2": (
        lambda s: [comb(30, k) * Fraction(3) ** k * 4 ** (k * s) for k in range(31)],
        1.8,
    ),
    "by powers of 2 with a period": (
        lambda s: [comb(30, k) * Fraction(3) ** k * 2 ** (k * s + 5 * (k % 3)) for k in range(31)],
        2.4,
    ),
    "with gaps": (
        lambda s: [Fraction(comb(15, k // 2)) * 4 ** (k * s) * (k % 2 == 0) for k in range(31)],
        4.7,
    ),
    "by a common factor": (
        lambda s: [comb(30, k) * Fraction(3) ** k * 10 ** (50 * s) for k in range(31)],
        2.2,
    ),
}
"""Polynomials that a large s makes long, and a bound on the work for s = 10 over that for s = 0."""


@pytest.mark.parametrize("name", SCALED)
def test_numbers_are_made_short_before_rouths_array(name: str) -> None:
    made, bound = SCALED[name]
    assert units_of(is_hurwitz, made(10)) < bound * units_of(is_hurwitz, made(0))


def units_of(place: Callable[[Polynomial], bool], p: Polynomial) -> int:
    """The units of looking where the roots of a polynomial are."""
    taken = Budget(10**12, 0)
    with limited(taken):
        place(p)
    return taken.spent


@pytest.mark.parametrize(
    ("p", "bound"),
    [
        ([comb(30, k) * Fraction(3) ** k for k in range(31)], 44_000),
        ([Fraction(comb(15, k // 2) * (k % 2 == 0)) for k in range(31)], 11_500),
        ([Fraction(3)], 2_400),
    ],
    ids=["(3x + 1)^30", "(x^2 + 1)^15", "3"],
)
def test_numbers_that_are_short_are_not_made_longer(p: Polynomial, bound: int) -> None:
    assert units_of(is_hurwitz, p) < bound
