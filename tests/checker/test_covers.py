"""Cells that cover discs: which are outside, and how squares are cut."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from mcexact.checker.core.reading import Refused
from mcexact.checker.discs import ROOT_2, Cell, Regular, magnitude, require_covered


def cell(re: Any, im: Any, size: Any, square: bool) -> Cell:
    return Cell(Fraction(re), Fraction(im), Fraction(size), square)


@pytest.mark.parametrize(
    ("where", "time", "bound", "outside"),
    [
        (cell(0, -2, 1, False), "continuous", None, True),
        (cell(0, -1, 1, False), "continuous", None, False),
        (cell(-5, 0, 1, False), "continuous", None, False),
        (cell(-5, 0, 1, False), "continuous", 3, True),
        (cell(-5, 0, 1, True), "continuous", 4, False),
        (cell(-5, 0, 1, True), "continuous", "7/2", True),
        (cell("3/10", "2/5", "1/4", False), "discrete", 1, True),
        (cell("3/10", "2/5", "1/2", False), "discrete", 1, False),
        (cell(0, 0, 2, False), "discrete", 1, False),
        (cell(0, 0, 1, False), "discrete", 1, False),
        (cell("3/5", "4/5", "1/2", False), "discrete", 1, False),
        (cell("2/5", 0, "1/2", False), "discrete", 1, True),
        (cell(0, 0, "3/10", True), "discrete", "1/2", True),
        (cell(0, 0, "2/5", True), "discrete", "1/2", False),
        (cell("-3/5", 0, "1/2", False), "discrete", 1, False),
        (cell(0, "-3/5", "7/10", False), "discrete", 1, False),
        (cell("3/10", "2/5", "3/10", True), "discrete", 1, True),
        (cell("3/10", "2/5", "2/5", True), "discrete", 1, False),
        (cell("-1/5", "-1/10", "2/5", True), "discrete", 1, True),
        (cell("-3/5", "1/10", "7/10", True), "discrete", 1, False),
        (cell("3/5", "4/5", 0, False), "discrete", 1, False),
        (cell("3/5", "4/5", 0, True), "discrete", 1, False),
    ],
)
def test_a_cell_is_outside_where_all_of_it_is(
    where: Cell, time: str, bound: Any, outside: bool
) -> None:
    limit = None if bound is None else Fraction(bound)
    assert where.outside(time, limit) == outside


def test_a_square_is_cut_into_four_that_are_taken_in_order() -> None:
    parts = cell(1, 2, 4, False).parts()
    assert [part[:2] for part in parts[::-1]] == [(-1, 0), (-1, 4), (3, 0), (3, 4)]
    assert {part[2:] for part in parts} == {(2, True)}
    assert ROOT_2**2 > 2 > (ROOT_2 - Fraction(1, 10**6)) ** 2


def test_every_cell_is_asked_of_its_own_frame() -> None:
    asked: list[tuple[Fraction, ...]] = []

    def frame(number: int) -> Regular:
        def regular(re: Fraction, im: Fraction, rho: Fraction) -> bool:
            asked.append((Fraction(number), re, im, rho / ROOT_2))
            return True

        return regular

    discs = [(Fraction(1), Fraction(0), Fraction(4))]
    nodes = [[None, 1, None, 0, 1, 0, 1, 0, 1]]
    require_covered(nodes, "cover", [discs], lambda c: False, [frame(0), frame(1)])
    small = [(0, -2, 1, 1), (1, -2, 3, 1), (0, 0, 1, 1), (1, 0, 3, 1)]
    assert asked == [(1, -1, -2, 2), *small, (0, 3, -2, 2), (1, 3, 2, 2)]
    asked.clear()
    require_covered([[1]], "cover", [discs], lambda c: False, [frame(0), frame(1)])
    assert asked == [(1, 1, 0, 4 / ROOT_2)]
    require_covered([[]], "cover", [discs], lambda c: not c.square, [])


@pytest.mark.parametrize(
    ("where", "disc", "meets"),
    [
        (cell(0, 0, 1, False), (3, 0, 2), True),
        (cell(0, 0, 1, False), (3, 0, "199/100"), False),
        (cell(0, 0, 1, False), (0, "-301/100", 2), False),
        (cell(0, 1, 1, False), (0, -2, "3/2"), False),
        (cell(0, 0, 2, False), (3, 4, 3), True),
        (cell(0, 0, 2, False), (3, 4, "299/100"), False),
        (cell(0, 0, 2, False), (-3, -4, 3), True),
        (cell(0, 0, 2, True), (3, 4, 3), True),
        (cell(0, 0, 2, True), (5, 6, 5), True),
        (cell(0, 0, 2, True), (-5, 6, "499/100"), False),
        (cell(0, 0, 2, True), (5, -6, "499/100"), False),
        (cell(0, 0, 2, True), (4, 1, 2), True),
        (cell(0, 0, 2, True), (4, 1, "199/100"), False),
        (cell(0, 0, 2, True), (-1, 4, 2), True),
        (cell(0, 0, 2, True), (-1, 4, "199/100"), False),
        (cell(0, 0, 2, True), (1, 1, "1/100"), True),
        (cell(1, 2, 5, False), (1, 2, "1/100"), True),
        (cell("1/2", "1/2", 1, False), ("1/2", "-5/2", 2), True),
    ],
)
def test_a_cell_meets_a_disc_where_they_have_a_point_in_common(
    where: Cell, disc: tuple[Any, Any, Any], meets: bool
) -> None:
    re, im, radius = map(Fraction, disc)
    assert where.meets((re, im, radius)) == meets


def test_cells_that_meet_no_disc_of_another_list_need_no_node() -> None:
    def disc(re: Any, im: Any, radius: Any) -> tuple[Fraction, Fraction, Fraction]:
        return Fraction(re), Fraction(im), Fraction(radius)

    first, far, corner = disc(0, 0, 2), disc(9, 0, 1), disc("3/2", "3/2", "1/4")
    for others, nodes, good in (
        ([], [0], True),
        ([[far]], [], True),
        ([[far]], [0], False),
        ([[far, corner]], [0], True),
        ([[far, corner]], [], False),
        ([[far, corner]], [None, 0], True),
        ([[far, corner]], [None, None, 0], True),
        ([[far, corner]], [None, 0, 0], False),
        ([[corner], [far]], [], True),
        ([[corner], [disc(0, 0, 1)]], [None, 0], True),
        ([[corner], [disc(0, 0, "1/2")]], [None, None], True),
        ([[]], [], True),
    ):
        found = True
        try:
            discs = [[first], *others]
            require_covered([nodes], "cover", discs, lambda c: False, [lambda *c: True])
        except Refused:
            found = False
        assert found == good, (others, nodes)


@pytest.mark.parametrize(
    ("nodes", "verdict"),
    [
        ([[0]], "VALID"),
        ([[None, 0, 0, 0, 0]], "VALID"),
        ([[None, 0, 0, 0]], "INVALID"),
        ([[None, 0, 0, 0, 0, 0]], "MALFORMED"),
        ([[]], "INVALID"),
        ([[1]], "MALFORMED"),
        ([[True]], "MALFORMED"),
        ([[-1]], "MALFORMED"),
        ([[0], [0]], "MALFORMED"),
        ([None], "MALFORMED"),
        ([{}], "MALFORMED"),
    ],
)
def test_a_cover_has_a_node_for_each_cell(nodes: Any, verdict: str) -> None:
    disc = (Fraction(0), Fraction(0), Fraction(1))
    found = "VALID"
    try:
        require_covered(nodes, "cover", [[disc]], lambda c: False, [lambda *c: True])
    except Refused as refused:
        found = refused.verdict
    assert found == verdict


@pytest.mark.parametrize(
    ("re", "im", "size"), [(0, 0, 0), (-3, 0, 3), (3, 4, 5), (1, 1, 2), (0, -2, 2), (10, 1, 11)]
)
def test_absolute_values_are_rounded_up_and_exact_where_they_are_integers(
    re: int, im: int, size: int
) -> None:
    assert magnitude(re, im) == size
