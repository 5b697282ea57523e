"""Rows as long integers: the same as number by number, however many there are."""

from __future__ import annotations

import random

import pytest

from mcexact.checker.core.arithmetic import (
    FEW,
    LONG,
    SMALL,
    Combination,
    PackedRows,
    byte_sum,
    convolution,
    integer_product,
    most_addends,
    multiples,
)
from mcexact.checker.core.budget import Budget, limited
from mcexact.checker.core.reading import Refused

MODULI = [2, 3, 7, SMALL - 1, SMALL, SMALL + 1, 127, 128, 2**30 - 35, 10**20 + 39]


def test_no_sum_of_rows_leaves_a_byte() -> None:
    for ell in (29, 31, 61):
        rows = [[pow(-factor, -1, ell)] * 2 for factor in range(1, ell)]
        u = list(range(1, ell))  # every product is ell - 1
        assert list(PackedRows(rows, 2, ell).combined(u)) == [-len(u) % ell] * 2


def test_a_slot_is_as_wide_as_it_has_to_be() -> None:
    assert [PackedRows([[1]], 1, ell).size for ell in (64, 65, 182, 183)] == [1, 2, 2, 3]


@pytest.mark.parametrize("ell", MODULI)
@pytest.mark.parametrize("nrows", [0, 1, 4, 5, 300])
@pytest.mark.parametrize("ncols", [0, 1, 3])
def test_rows_are_combined_as_number_by_number(ell: int, nrows: int, ncols: int) -> None:
    rng = random.Random(ell)
    rows = [[rng.randrange(ell) for _ in range(ncols)] for _ in range(nrows)]
    packed = PackedRows(rows, ncols, ell)
    drawn = [rng.randrange(ell) for _ in range(nrows)]
    for u in (drawn, [ell - 1] * nrows, [0] * nrows, [1] * nrows):
        expected = [
            sum(x * row[j] for x, row in zip(u, rows, strict=True)) % ell for j in range(ncols)
        ]
        assert list(packed.combined(u)) == expected


@pytest.mark.parametrize("ell", MODULI)
def test_the_largest_residues_do_not_run_into_the_next_slot(ell: int) -> None:
    nrows = 70_000 if ell == 2 else 1100
    packed = PackedRows([[ell - 1, 0, ell - 1]] * nrows, 3, ell)
    found = nrows * (ell - 1) ** 2 % ell
    assert list(packed.combined([ell - 1] * nrows)) == [found, 0, found]


@pytest.mark.parametrize("ell", [SMALL - 3, SMALL])
def test_no_sum_of_many_rows_leaves_its_byte(ell: int) -> None:
    rng, nrows, ncols = random.Random(ell), 400, 500
    rows = [[rng.randrange(ell) for _ in range(ncols)] for _ in range(nrows)]
    u = [rng.randrange(ell) for _ in range(nrows)]
    expected = [sum(x * row[j] for x, row in zip(u, rows, strict=True)) % ell for j in range(ncols)]
    assert list(PackedRows(rows, ncols, ell).combined(u)) == expected


@pytest.mark.parametrize("ell", [ell for ell in MODULI if ell <= SMALL])
def test_bytes_never_overflow_however_many_rows_are_added(ell: int) -> None:
    assert most_addends(ell) * (ell - 1) <= 255 < (most_addends(ell) + 1) * (ell - 1)
    for count in (0, 1, most_addends(ell) - 1, most_addends(ell), most_addends(ell) + 1, 600):
        row = bytes([ell - 1, 0, 1])
        found = byte_sum([row] * count, 3, ell)
        assert found == bytes([count * x % ell for x in row])
    assert byte_sum([], 2, ell) == bytes(2) and byte_sum([b""], 0, ell) == b""


def test_the_multiples_of_bytes_are_made_once() -> None:
    assert multiples(7) is multiples(7)


@pytest.mark.parametrize("ell", MODULI)
def test_polynomials_are_multiplied_as_coefficient_by_coefficient(ell: int) -> None:
    rng = random.Random(ell)
    for m, n in ((1, 1), (1, 7), (7, 1), (5, 6), (40, 300)):
        for most in (0, ell - 1):
            f, g = ([rng.randint(most, ell - 1) for _ in range(k)] for k in (m, n))
            expected = [0] * (m + n - 1)
            for i, a in enumerate(f):
                for k, b in enumerate(g):
                    expected[i + k] += a * b
            assert convolution(f, g, ell) == [c % ell for c in expected]


@pytest.mark.parametrize(("ell", "terms"), [(2, 256), (3, 127), (5, 63), (65, 17), (257, 256)])
def test_the_largest_sums_have_room(ell: int, terms: int) -> None:
    most = [ell - 1] * terms
    ends = [*range(1, terms + 1), *range(terms - 1, 0, -1)]
    assert convolution(most, most, ell) == [count % ell for count in ends]
    if ell > 64:
        assert PackedRows([[ell - 1]] * terms, 1, ell).combined(most) == [terms % ell]


@pytest.mark.parametrize(
    ("f", "g"), [([], [1]), ([1], []), ([], []), ([], [1, 2, 3]), ([1, 2, 3], [])]
)
def test_a_product_with_zero_has_no_coefficients(f: list[int], g: list[int]) -> None:
    assert convolution(f, g, 7) == []


def _units(ell: int, nrows: int, ncols: int) -> tuple[int, int]:
    """What it takes to pack rows of zeros, and to combine them once."""
    budget = Budget(10**12, 0)
    with limited(budget):
        packed = PackedRows([[0] * ncols] * nrows, ncols, ell)
        before = budget.spent
        packed.combined([0] * nrows)
    return before, budget.spent - before


@pytest.mark.parametrize("ell", [7, 10**20 + 39])
def test_packing_takes_a_unit_for_each_byte_and_combining_less(ell: int) -> None:
    packed, combined = _units(ell, 200, 300)
    slot = 1 if ell == 7 else 18
    assert 200 * 300 * slot <= packed <= 200 * 300 * (slot + 10)
    assert 200 * 4 < combined <= 200 * 300 * slot
    assert 5 < _units(ell, 4000, 300)[1] / _units(ell, 400, 300)[1] < 10
    assert 5 < _units(ell, 400, 30_000)[1] / _units(ell, 400, 3000)[1] < 10


def test_no_product_is_begun_beyond_the_budget() -> None:
    with limited(Budget(10**4, 0)), pytest.raises(Refused, match="work"):
        convolution([1] * 5000, [1] * 5000, 7)


@pytest.mark.parametrize("ell", MODULI)
def test_rows_that_come_one_after_the_other_are_combined(ell: int) -> None:
    rng, ncols = random.Random(ell), 5
    total, expected = Combination(ncols, ell), [0] * ncols
    assert total.is_zero()
    rows = [[ell - 1] * ncols] * 600 + [[rng.randrange(ell) for _ in range(ncols)]] * 300
    for k, row in enumerate(rows):
        factor = ell - 1 if k < 600 else rng.randrange(ell)
        total.add(factor, bytes(row) if ell <= SMALL and k % 2 else row)
        expected = [(x + factor * y) % ell for x, y in zip(expected, row, strict=True)]
        if k % 37 == 0:
            assert total.is_zero() == (not any(expected))
    for j in range(ncols):
        assert not total.is_zero() or not any(expected[j:])
        total.add(ell - expected[j] if expected[j] else 0, [int(i == j) for i in range(ncols)])
    assert total.is_zero()
    total.add(1, [0] * (ncols - 1) + [1])
    assert not total.is_zero()
    assert Combination(0, ell).is_zero()


@pytest.mark.parametrize("ell", [3, 7, 31])
def test_rows_as_long_integers_may_have_the_modulus_in_place_of_zero(ell: int) -> None:
    for factor in range(1, ell):
        for many in (1, 255 // ell, 255 // ell + 1, 1000):
            total, row = Combination(3, ell), int.from_bytes(bytes([ell, ell, 1]), "little")
            for _ in range(many):
                total.add(factor, row)
            assert total.is_zero() == (many * factor % ell == 0)


@pytest.mark.parametrize(("ell", "units"), [(31, 90), (97, 1000)])
def test_a_combination_is_charged_row_by_row(ell: int, units: int) -> None:
    with limited(Budget(units * 3)), pytest.raises(Refused, match="units of work"):
        total = Combination(1000, ell)
        for _ in range(4):
            total.add(1, [0] * 1000)


@pytest.mark.parametrize("bits", [1, 8, 29, 60, 4 * LONG - 8, 4 * LONG, 5 * LONG])
@pytest.mark.parametrize(
    "shape",
    [
        (FEW, FEW, FEW),
        (FEW, 31, FEW),
        (FEW + 9, FEW, FEW + 3),
        (FEW - 1, 40, FEW),
        (FEW, FEW - 1, FEW),
        (20, 20, 1),
    ],
)
def test_products_of_integers_are_those_of_rows_and_columns(
    shape: tuple[int, int, int], bits: int
) -> None:
    rng, (nrows, inner, ncols), most = random.Random(bits), shape, 2**bits - 1
    drawn = [rng.randint(-most, most) for _ in range(50)]
    for entries in ([-most, most], [most], [0, 0, 0, -1, most], drawn):
        A = [[rng.choice(entries) for _ in range(inner)] for _ in range(nrows)]
        B = [[-rng.choice(entries) for _ in range(ncols)] for _ in range(inner)]
        expected = [
            [sum(row[k] * B[k][j] for k in range(inner)) for j in range(ncols)] for row in A
        ]
        assert integer_product(A, B, ncols) == expected


def test_products_of_empty_matrices_are_zero() -> None:
    assert integer_product([], [], 3) == []
    assert integer_product([[], []], [], 3) == [[0] * 3] * 2
    assert integer_product([[]] * FEW, [], FEW) == [[0] * FEW] * FEW
    assert integer_product([[1]], [[]], 0) == [[]]
