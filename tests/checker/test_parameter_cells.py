"""Cells of ranges of parameters, and the boxes around the plants of a cell."""

from __future__ import annotations

import random
from fractions import Fraction
from typing import Any

import pytest

from mcexact import ParametricSystem
from mcexact.checker.cells import box_of_cell, cells_of
from mcexact.checker.core.reading import Refused
from mcexact.checker.discs import Box
from mcexact.checker.parametric_system import read_parametric
from tests.checker.box_maker import fractions
from tests.checker.handmade import ranged

PAIR = ranged([["a*b"]], ([[1]], [[1]]), a=(0, 4), b=(-1, 1))


def test_cells_are_halved_in_the_order_of_the_cuts() -> None:
    plant = read_parametric(PAIR)
    whole = [(Fraction(0), Fraction(4)), (Fraction(-1), Fraction(1))]
    assert cells_of([None], "cuts", plant) == [whole]
    assert cells_of([0, None, 1, None, None], "cuts", plant) == [
        [(0, 2), (-1, 1)],
        [(2, 4), (-1, 0)],
        [(2, 4), (0, 1)],
    ]


def test_the_parameters_are_in_alphabetical_order() -> None:
    turned = {**PAIR, "parameters": dict(reversed(PAIR["parameters"].items()))}
    assert cells_of([None], "cuts", read_parametric(turned)) == [[(0, 4), (-1, 1)]]


def test_an_entry_is_its_value_its_slopes_and_what_is_left() -> None:
    system = ranged([["a*b^2 + 3*a - 1"]], ([[1]], [["(a)/(b)"]]), a=(1, 3), b=("3/2", "5/2"))
    plant = read_parametric(system)
    box = box_of_cell(plant, cells_of([None], "cuts", plant)[0])
    # (2 + h)(2 + k)² + 3(2 + h) − 1 = 13 + 7h + 8k + 4hk + 2k² + hk², |h| ≤ 1, |k| ≤ 1/2
    assert fractions(box.A) == [[13]]
    assert [fractions(each.A) for each in box.tied] == [[[7]], [[4]]]
    assert fractions(box.radii.A) == [[2 + Fraction(1, 2) + Fraction(1, 4)]]
    # (2 + h)/(2 + k) = 1 + h/2 − k/2 + (k²/2 − hk/2)/(2 + k)
    assert fractions(box.C[0]) == [[1]]
    assert [fractions(each.C[0]) for each in box.tied] == [[[Fraction(1, 2)]], [[Fraction(-1, 4)]]]
    assert fractions(box.radii.C[0]) == [[(Fraction(1, 8) + Fraction(1, 4)) / Fraction(3, 2)]]
    assert [fractions(each.B[0]) for each in (box.radii, *box.tied)] == [[[0]]] * 3


def test_an_entry_around_0_is_as_it_is() -> None:
    plant = read_parametric(ranged([["a*b^2 - a"]], ([[1]], [[1]]), a=(-1, 1), b=(-2, 2)))
    box = box_of_cell(plant, cells_of([None], "cuts", plant)[0])
    assert fractions(box.A) == [[0]]
    assert [fractions(each.A) for each in box.tied] == [[[-1]], [[0]]]
    assert fractions(box.radii.A) == [[4]]


def test_without_ties_the_radii_are_those_of_all_directions_together() -> None:
    system = ranged([["a*b^2 + 3*a - 1"]], ([[1]], [["(a)/(b)"]]), a=(1, 3), b=("3/2", "5/2"))
    plant = read_parametric(system)
    tied = box_of_cell(plant, cells_of([None], "cuts", plant)[0])
    free = tied.independent()
    assert free.tied == () and fractions(free.A) == [[13]]
    assert fractions(free.radii.A) == [[2 + Fraction(3, 4) + 7 + 4]]
    assert fractions(free.radii.B[0]) == [[0]]
    assert fractions(free.radii.C[0]) == [[Fraction(1, 4) + Fraction(1, 2) + Fraction(1, 4)]]


@pytest.mark.parametrize(
    "place", ["A", "channels[0].B", "channels[0].C", "channels[1].B", "channels[1].C"]
)
def test_a_matrix_that_is_not_defined_in_a_range_is_named(place: str) -> None:
    known = ("A", "channels[0].B", "channels[0].C", "channels[1].B", "channels[1].C")
    A, *ports = ([["(1)/(a)" if each == place else 1]] for each in known)
    plant = read_parametric(
        ranged(A, (ports[0], ports[1]), (ports[2], ports[3]), a=("-1/2", "1/2"))
    )
    with pytest.raises(Refused) as refused:
        box_of_cell(plant, cells_of([None], "cuts", plant)[0])
    assert refused.value.args[:3] == ("INVALID", "undefined", place)


def test_terms_of_a_denominator_are_counted_whatever_their_signs() -> None:
    """(t − 1)(t − 2) is 0 at an end, and the others are nowhere."""

    def box_of(entry: str) -> Box:
        plant = read_parametric(ranged([[entry]], ([[1]], [[1]]), t=("1/2", 1)))
        return box_of_cell(plant, cells_of([None], "cuts", plant)[0])

    with pytest.raises(Refused) as refused:
        box_of("(1)/(t^2 - 3*t + 2)")
    assert refused.value.args[:3] == ("INVALID", "undefined", "A")
    for a, b, c in ((1, -3, 3), (0, 1, -2)):
        box = box_of("(1)/(t^2 - 3*t + 3)" if a else "(1)/(t - 2)")
        [[value]], [[radius]] = fractions(box.A), fractions(box.radii.A)
        slope = fractions(box.tied[0].A)[0][0]
        for share in (Fraction(k, 8) for k in range(-8, 9)):
            t = Fraction(3, 4) + share / 4
            assert abs(1 / (a * t**2 + b * t + c) - value - share * slope) <= radius


ENTRIES = ("a*b", "a^2 - b", "(a + 1)*(b - 2)^2", "1/a", "(a*b + 1)/(a*b^2)", "a/2 - 3", "7")


@pytest.mark.parametrize("seed", range(8))
def test_the_plants_of_a_cell_are_in_its_box(seed: int) -> None:
    rng = random.Random(seed)
    rows = [[rng.choice(ENTRIES) for _ in range(2)] for _ in range(2)]
    system = ParametricSystem(
        rows,
        [[[rng.choice(ENTRIES)], [0]]],
        [[[rng.choice(ENTRIES), 1]]],
        parameters=["a", "b"],
        assume={"a": (1, "5/4"), "b": (1, 2)},
    )
    plant: Any = read_parametric(system.document())
    for cell in cells_of([1, 0, None, None, None], "cuts", plant):
        box = box_of_cell(plant, cell)
        for _ in range(5):
            shares = [Fraction(rng.randint(-4, 4), 4) for _ in cell]
            ends = zip(cell, shares, strict=True)
            values = [(low + high) / 2 + s * (high - low) / 2 for (low, high), s in ends]
            member = system.at(dict(zip(("a", "b"), values, strict=True)))
            parts = (member.A, member.B[0], member.C[0])
            known = zip(
                (box.A, box.B[0], box.C[0]),
                (box.radii.A, box.radii.B[0], box.radii.C[0]),
                *((each.A, each.B[0], each.C[0]) for each in box.tied),
                strict=True,
            )
            for M, (M0, D, *slopes) in zip(parts, known, strict=True):
                for i, row in enumerate(M.rows()):
                    for j, x in enumerate(row):
                        moved = [
                            s * fractions(S)[i][j] for s, S in zip(shares, slopes, strict=True)
                        ]
                        near = fractions(M0)[i][j] + sum(moved)
                        assert abs(x - near) <= fractions(D)[i][j]
