"""The matrices of a sampled plant are enclosed: exactly where they are rational, and tightly."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest

from mcexact.errors import LimitReached
from mcexact.exact.matrix import Matrix
from mcexact.exact.sampling import held_exponential
from tests.oracle.sampling import Rows, drawn_plant, drawn_radii, exponential, member
from tests.wording import refusal

ERROR = Fraction(1, 10**99)
"""More than the error of the oracle."""


def enclosed(M: Rows, D: Rows, h: Fraction, decimals: int = 12) -> tuple[Rows, Rows]:
    pair = held_exponential(Matrix.from_rows(M), Matrix.from_rows(D), h, decimals)
    center, radii = ([list(row) for row in each.rows()] for each in pair)
    return center, radii


def missed(center: Rows, M: Rows, h: Fraction) -> Rows:
    """How far the exact matrices of M = [A, B] are from the center."""
    n = len(M)
    exact = exponential([row[:n] for row in M], [row[n:] for row in M], h)
    return [
        [abs(x - y) for x, y in zip(*rows, strict=True)] for rows in zip(center, exact, strict=True)
    ]


def flat(rows: Rows) -> list[Fraction]:
    return [x for row in rows for x in row]


def certain(M: Rows) -> Rows:
    return [[Fraction(0)] * len(row) for row in M]


@pytest.mark.parametrize("decimals", [0, 1, 12, 60])
def test_a_chain_of_integrators_is_a_polynomial_and_exact_if_its_decimals_suffice(
    decimals: int,
) -> None:
    h = Fraction(1, 10)
    M = [[Fraction(x) for x in row] for row in ((0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 6))]
    one, zero = Fraction(1), Fraction(0)
    exact = [[one, h, h**2 / 2, h**3], [zero, one, h, 3 * h**2], [zero, zero, one, 6 * h]]
    center, radii = enclosed(M, certain(M), h, decimals)
    unit = Fraction(1, 10**decimals)
    for i, row in enumerate(exact):
        for j, x in enumerate(row):
            assert abs(center[i][j] - x) <= radii[i][j] <= unit / 2
            assert (center[i][j] / unit).denominator == 1
            assert radii[i][j] == 0 or (x / unit).denominator > 1


def test_the_exact_matrices_are_within_radii_that_are_hardly_larger_than_their_distance() -> None:
    for seed in range(40):
        A, B, h = drawn_plant(random.Random(seed))
        M = [[*a, *b] for a, b in zip(A, B, strict=True)]
        center, radii = enclosed(M, certain(M), h)
        distance = missed(center, M, h)
        for r, d in zip(flat(radii), flat(distance), strict=True):
            assert d <= r + ERROR
            assert r <= d + Fraction(3, 10**15), "the radius has three digits more than the entry"


def test_every_member_is_within_the_radii_and_the_center_is_that_of_certain_entries() -> None:
    for seed in range(40):
        rng = random.Random(seed)
        A, B, h = drawn_plant(rng)
        M = [[*a, *b] for a, b in zip(A, B, strict=True)]
        D = drawn_radii(rng, M)
        center, radii = enclosed(M, D, h)
        assert center == enclosed(M, certain(M), h)[0]
        for _ in range(4):
            distance = missed(center, member(rng, M, D), h)
            pairs = zip(flat(distance), flat(radii), strict=True)
            assert all(d <= r + ERROR for d, r in pairs)


def test_the_radii_of_a_matrix_of_positive_entries_are_reached_by_the_largest_member() -> None:
    M = [[Fraction(1, 3), Fraction(2), Fraction(1)], [Fraction(1), Fraction(1, 2), Fraction(0)]]
    D = [[x / 100 for x in row] for row in M]
    center, radii = enclosed(M, D, Fraction(1, 2))
    largest = [[x + r for x, r in zip(*rows, strict=True)] for rows in zip(M, D, strict=True)]
    distance = missed(center, largest, Fraction(1, 2))
    for d, r in zip(flat(distance), flat(radii), strict=True):
        assert r <= d + Fraction(4, 10**12)


def test_what_nothing_leads_to_is_certain() -> None:
    M = [[Fraction(-1), Fraction(0), Fraction(1)], [Fraction(2), Fraction(-3), Fraction(0)]]
    D = [[Fraction(1, 10), Fraction(0), Fraction(0)], [Fraction(0), Fraction(0), Fraction(0)]]
    center, radii = enclosed(M, D, Fraction(1))
    assert center[0][1] == radii[0][1] == 0
    assert all(x for i, row in enumerate(radii) for j, x in enumerate(row) if (i, j) != (0, 1))


def test_units_of_the_states_do_not_make_a_step_long() -> None:
    """The row sums of h|A| are 10⁸, its spectral radius is 1."""
    M = [
        [Fraction(0), Fraction(10**8), Fraction(0)],
        [Fraction(-1, 10**8), Fraction(0), Fraction(1)],
    ]
    center, radii = enclosed(M, certain(M), Fraction(1))
    distance = missed(center, M, Fraction(1))
    assert all(d <= r + ERROR for d, r in zip(flat(distance), flat(radii), strict=True))
    assert max(flat(radii)) < Fraction(1, 10**11)


def test_a_step_that_is_far_too_long_is_refused() -> None:
    with refusal(LimitReached):
        held_exponential(Matrix.from_rows([[-(10**6)]]), Matrix.zeros(1, 1), Fraction(1), 3)


@pytest.mark.parametrize("shape", [(0, 0), (0, 2)])
def test_nothing_is_sampled_as_nothing(shape: tuple[int, int]) -> None:
    center, radii = held_exponential(Matrix.zeros(*shape), Matrix.zeros(*shape), Fraction(1), 3)
    assert center.shape == radii.shape == shape


def test_inputs_that_do_nothing_stay_so() -> None:
    M = [[Fraction(-1), Fraction(0)]]
    center, radii = enclosed(M, certain(M), Fraction(1))
    assert center[0][1] == radii[0][1] == 0 and radii[0][0] > 0
